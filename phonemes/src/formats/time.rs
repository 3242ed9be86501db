//! Times as other formats write them, in exact integers: decimal text becomes picoseconds, and
//! picoseconds the nearest tick.
//!
//! No time passes through floating point, so that a file read on any machine gives the same ticks
//! and sums of durations (MBROLA, Gentle) stay exact however long the file is.

use crate::error::Fault;
use crate::tick::TICK_RATE;

/// Picoseconds in a second.
const PER_SECOND: i128 = 1_000_000_000_000;

/// A day, in picoseconds: what [`TICKS_MAX`](crate::TICKS_MAX) is in ticks.
const MAX: i128 = 24 * 3600 * PER_SECOND;

/// Digits that count; a day in picoseconds has 17.
const DIGITS_MAX: usize = 30;

/// Longest text of a time: a double takes 24 bytes, and some programs write more digits than it has.
const TEXT_BYTES_MAX: usize = 64;

/// What a written number counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Seconds,
    Milliseconds,
    /// HTK's and Azure's unit.
    HundredNanoseconds,
}

impl Unit {
    /// Picoseconds in one, as a power of ten.
    const fn exponent(self) -> i32 {
        match self {
            Self::Seconds => 12,
            Self::Milliseconds => 9,
            Self::HundredNanoseconds => 5,
        }
    }

    /// For messages.
    const fn about(self) -> &'static str {
        match self {
            Self::Seconds => "seconds, such as 1.25",
            Self::Milliseconds => "milliseconds, such as 125",
            Self::HundredNanoseconds => "units of 100 ns, such as 1250000",
        }
    }
}

/// An instant or a length, at most a day before or after 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Time(i64);

impl Time {
    pub(super) const ZERO: Self = Self(0);

    pub(super) const fn milliseconds(ms: i32) -> Self {
        Self(ms as i64 * 1_000_000_000)
    }

    /// Reads a decimal number: sign, point and exponent are optional.
    pub(super) fn parse(text: &str, unit: Unit) -> Result<Self, Fault> {
        let not_time = || Fault::NotTime {
            text: text.to_owned(),
            unit: unit.about(),
        };
        let beyond = || Fault::Beyond(text.to_owned());
        if text.len() > TEXT_BYTES_MAX {
            return Err(not_time());
        }
        let number = Number::parse(text).ok_or_else(not_time)?;
        let scaled = number.scaled(unit.exponent()).ok_or_else(beyond)?;
        Self::checked(scaled).ok_or_else(beyond)
    }

    /// `samples` at `rate`; `None` beyond a day.
    pub(super) fn of_samples(samples: i64, rate: u32) -> Option<Self> {
        let rate = i128::from(rate.max(1));
        Self::checked((2 * i128::from(samples) * PER_SECOND + rate).div_euclid(2 * rate))
    }

    fn checked(picoseconds: i128) -> Option<Self> {
        let within = (-MAX..=MAX).contains(&picoseconds);
        within
            .then(|| i64::try_from(picoseconds).ok().map(Self))
            .flatten()
    }

    /// The sum, unless it lies beyond a day.
    pub(super) fn plus(self, other: Self) -> Result<Self, Fault> {
        let sum = i128::from(self.0) + i128::from(other.0);
        Self::checked(sum).ok_or_else(|| Fault::Beyond(format!("{} s", sum / PER_SECOND)))
    }

    /// The difference.
    pub(super) const fn minus(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }

    /// The nearest tick, halves upwards.
    pub(super) fn ticks(self) -> i64 {
        let ticks = 2 * i128::from(self.0) * i128::from(TICK_RATE) + PER_SECOND;
        // Within a day either way, so it fits.
        ticks.div_euclid(2 * PER_SECOND) as i64
    }
}

/// For messages: seconds.
impl std::fmt::Display for Time {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let millionths = self.0 / 1_000_000;
        let sign = if millionths < 0 { "-" } else { "" };
        let millionths = millionths.unsigned_abs();
        let (whole, part) = (millionths / 1_000_000, millionths % 1_000_000);
        write!(f, "{sign}{whole}.{part:06}")
    }
}

/// Ticks as decimal seconds that read back as the same tick: a microsecond is a twentieth of one.
pub(super) fn seconds(ticks: i64) -> Time {
    Time::of_samples(ticks, TICK_RATE as u32).unwrap_or_default()
}

/// `mantissa * 10^exponent`.
struct Number {
    mantissa: i128,
    exponent: i32,
}

impl Number {
    fn parse(text: &str) -> Option<Self> {
        let (negative, text) = match text.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let (digits, exponent) = match text.split_once(['e', 'E']) {
            Some((digits, exponent)) => (digits, exponent.parse::<i16>().ok()?),
            None => (text, 0),
        };
        let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
        let all = whole.bytes().chain(part.bytes());
        if whole.len() + part.len() == 0 || !all.clone().all(|b| b.is_ascii_digit()) {
            return None;
        }
        let mut mantissa = 0_i128;
        let mut exponent = i32::from(exponent) - part.len() as i32;
        let mut taken = 0;
        for digit in all {
            if taken == DIGITS_MAX {
                exponent += 1;
                continue;
            }
            mantissa = 10 * mantissa + i128::from(digit - b'0');
            taken += usize::from(mantissa > 0);
        }
        Some(Self {
            mantissa: if negative { -mantissa } else { mantissa },
            exponent,
        })
    }

    /// The nearest integer to the number times `10^exponent`.
    fn scaled(&self, exponent: i32) -> Option<i128> {
        let exponent = exponent + self.exponent;
        let power = 10_i128.checked_pow(exponent.unsigned_abs());
        match (power, exponent >= 0) {
            _ if self.mantissa == 0 => Some(0),
            (Some(power), true) => self.mantissa.checked_mul(power),
            // Halves upwards; mantissas have far fewer digits than the type.
            (Some(power), false) => Some((self.mantissa + power / 2).div_euclid(power)),
            (None, true) => None,
            (None, false) => Some(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SampleRate;
    use proptest::prelude::*;

    fn seconds_of(text: &str) -> Result<i64, Fault> {
        Time::parse(text, Unit::Seconds).map(Time::ticks)
    }

    #[test]
    fn numbers_of_every_spelling_are_read() {
        for (text, ticks) in [
            ("1", 48_000),
            ("-0", 0),
            ("+0.5", 24_000),
            (".5", 24_000),
            ("2.", 96_000),
            ("1e-3", 48),
            ("1.5E3", 72_000_000),
            ("0.31542011822475630000000000000", 15_140),
            ("0.00000000000000000000000000000000000000000000000001", 0),
            ("1e-30000", 0),
            ("-0.25", -12_000),
        ] {
            assert_eq!(seconds_of(text), Ok(ticks), "{text}");
        }
        let ms = Time::parse("125", Unit::Milliseconds).unwrap();
        assert_eq!(ms.ticks(), 6000);
        let hns = Time::parse("2200000", Unit::HundredNanoseconds).unwrap();
        assert_eq!(hns.ticks(), 10_560);
    }

    #[test]
    fn what_is_no_time_has_its_fault() {
        for text in [
            "", "-", ".", "e5", "1e", "1,5", "NaN", "inf", "0x10", "1 2", "１",
        ] {
            let fault = seconds_of(text).unwrap_err();
            assert!(matches!(fault, Fault::NotTime { .. }), "{text}: {fault}");
        }
        for text in [
            "86401",
            "1e30",
            "1e30000",
            "-90000",
            "9999999999999999999999999999999999",
        ] {
            let fault = seconds_of(text).unwrap_err();
            assert!(matches!(fault, Fault::Beyond(_)), "{text}: {fault}");
        }
        let long = "1".repeat(1000);
        assert!(seconds_of(&long).unwrap_err().to_string().len() < 100);
    }

    proptest! {
        #[test]
        fn a_tick_survives_being_written_as_seconds(tick in 0..=crate::TICKS_MAX) {
            let text = seconds(tick).to_string();
            prop_assert_eq!(seconds_of(&text), Ok(tick));
        }

        #[test]
        fn halves_go_up_as_in_sample_rates(sample in -1_000_000_i64..86_400_000) {
            let units = Time::parse(&sample.to_string(), Unit::Milliseconds).unwrap();
            let rate = SampleRate::new(1000).unwrap();
            if let Some(ticks) = rate.ticks(sample) {
                prop_assert_eq!(units.ticks(), ticks);
            }
        }
    }
}
