//! Time in integer ticks of 48 kHz, and the exact way there from a file's own sample rate and back.

use thiserror::Error;

/// Ticks in a second. Every usual sound rate up to it keeps its sample positions apart.
pub const TICK_RATE: i64 = 48_000;

/// The latest time that a label may have: a day. Nobody speaks longer in one utterance, and sums
/// of such times stay far from overflow.
pub const TICKS_MAX: i64 = 24 * 3600 * TICK_RATE;

/// Slowest rate that a label file may count in: 1 Hz.
pub const RATE_MIN: u32 = 1;

/// Fastest rate that a label file may count in, that of the fastest sound converters.
pub const RATE_MAX: u32 = 768_000;

/// A rate that no label file counts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0} Hz is no sample rate; give one from {RATE_MIN} to {RATE_MAX}")]
pub struct BadRate(pub u32);

/// Samples in a second, of the sound that a label file's numbers count.
///
/// Conversions round to the nearest. Up to 48 kHz, sample -> tick -> sample is exact; from 48 kHz,
/// tick -> sample -> tick is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleRate(u32);

impl SampleRate {
    /// TIMIT's own, 16 kHz.
    pub const TIMIT: Self = Self(16_000);

    /// A rate from [`RATE_MIN`] to [`RATE_MAX`].
    pub const fn new(hz: u32) -> Result<Self, BadRate> {
        if hz < RATE_MIN || hz > RATE_MAX {
            return Err(BadRate(hz));
        }
        Ok(Self(hz))
    }

    /// Samples in a second.
    pub const fn hz(self) -> u32 {
        self.0
    }

    /// The tick nearest to a sample, or `None` beyond [`TICKS_MAX`] either way.
    pub fn ticks(self, sample: i64) -> Option<i64> {
        let ticks = rounded(i128::from(sample) * i128::from(TICK_RATE), self.0.into());
        i64::try_from(ticks).ok().filter(|t| t.abs() <= TICKS_MAX)
    }

    /// The sample nearest to a tick.
    pub fn samples(self, tick: i64) -> i64 {
        let samples = rounded(i128::from(tick) * i128::from(self.0), TICK_RATE.into());
        i64::try_from(samples).unwrap_or(if tick < 0 { i64::MIN } else { i64::MAX })
    }
}

/// `value / by` to the nearest, halves upwards.
fn rounded(value: i128, by: i128) -> i128 {
    (2 * value + by).div_euclid(2 * by)
}
