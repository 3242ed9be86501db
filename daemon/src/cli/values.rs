//! Values on the command line that have a syntax of their own: sizes, rates, colours.

use std::fmt;
use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mouthpiece_phonemes::{Alphabet, READERS, WRITERS};
use mouthpiece_rig::{STEP_TICKS, TICK_RATE};

use crate::input::AUTO;

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    pub width: u32,
    pub height: u32,
}

impl Size {
    /// The longest side: what every GPU and every software driver we know can draw to.
    pub const SIDE_MAX: u32 = 8192;
    /// The shortest side: less is not a picture, and video encoders refuse it.
    pub const SIDE_MIN: u32 = 16;
}

impl FromStr for Size {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text
            .split_once(['x', 'X'])
            .and_then(|(w, h)| Some((w.parse::<u32>().ok()?, h.parse::<u32>().ok()?)));
        let sides = Self::SIDE_MIN..=Self::SIDE_MAX;
        match parsed {
            Some((width, height)) if sides.contains(&width) && sides.contains(&height) => {
                Ok(Self { width, height })
            }
            Some(_) => Err(format!(
                "each side must be {} to {} pixels",
                Self::SIDE_MIN,
                Self::SIDE_MAX
            )),
            None => Err("write it as WIDTHxHEIGHT, like 640x480".into()),
        }
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// Instants a second, as a fraction: 29.97 is 30000/1001 and stays so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fps {
    pub num: u32,
    pub den: u32,
}

impl Fps {
    /// The highest rate: that of the simulation's steps, so more shows nothing new.
    const HZ_MAX: u32 = (TICK_RATE / STEP_TICKS) as u32;

    /// When frame `k` is due, in ticks of 48 kHz, rounded down.
    pub fn ticks(self, k: u64) -> i64 {
        let ticks = u128::from(k) * 48_000 * u128::from(self.den) / u128::from(self.num);
        i64::try_from(ticks).unwrap_or(i64::MAX)
    }

    /// How many frames it takes to cover `ticks`: the last may reach past them by less than one.
    pub fn frames(self, ticks: i64) -> u64 {
        let ticks = u128::try_from(ticks).unwrap_or(0);
        let frames = (ticks * u128::from(self.num)).div_ceil(48_000 * u128::from(self.den));
        u64::try_from(frames).unwrap_or(u64::MAX)
    }

    /// How many instants there are from 0 to `ticks`, both ends counted: a second at 100 Hz has 101.
    pub fn instants(self, ticks: i64) -> u64 {
        let last = self.frames(ticks);
        last + u64::from(self.ticks(last) <= ticks)
    }

    fn new(num: u32, den: u32) -> Option<Self> {
        let ok =
            num >= den && den > 0 && u64::from(num) <= u64::from(den) * u64::from(Self::HZ_MAX);
        ok.then_some(Self { num, den })
    }
}

impl FromStr for Fps {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let bounds = || format!("the rate must be 1 to {}", Self::HZ_MAX);
        let syntax = || "write it as 30, 29.97 or 30000/1001".to_string();
        if let Some((num, den)) = text.split_once('/') {
            let (Ok(num), Ok(den)) = (num.parse(), den.parse()) else {
                return Err(syntax());
            };
            return Self::new(num, den).ok_or_else(bounds);
        }
        // The rates of broadcast that people write as decimals.
        match text {
            "23.976" | "23.98" => {
                return Ok(Self {
                    num: 24_000,
                    den: 1001,
                });
            }
            "29.97" => {
                return Ok(Self {
                    num: 30_000,
                    den: 1001,
                });
            }
            "59.94" => {
                return Ok(Self {
                    num: 60_000,
                    den: 1001,
                });
            }
            _ => {}
        }
        let (whole, part) = text.split_once('.').unwrap_or((text, ""));
        let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
        if whole.is_empty() || whole.len() > 6 || part.len() > 3 || !digits(whole) || !digits(part)
        {
            return Err(syntax());
        }
        let den = 10_u32.pow(u32::try_from(part.len()).map_err(|_| syntax())?);
        let whole: u32 = whole.parse().map_err(|_| syntax())?;
        let part: u32 = if part.is_empty() {
            0
        } else {
            part.parse().map_err(|_| syntax())?
        };
        whole
            .checked_mul(den)
            .and_then(|n| Self::new(n + part, den))
            .ok_or_else(bounds)
    }
}

impl fmt::Display for Fps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.den == 1 {
            write!(f, "{}", self.num)
        } else {
            write!(f, "{}/{}", self.num, self.den)
        }
    }
}

/// A colour as it is shown (sRGB), 0..255 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub [u8; 3]);

impl FromStr for Rgb {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let named = match text {
            "black" => Some([0; 3]),
            "white" => Some([255; 3]),
            "green" => Some([0, 177, 64]), // the green of a chroma-key cloth
            _ => None,
        };
        let hex = text.strip_prefix('#').unwrap_or(text);
        let parsed = (hex.len() == 6 && hex.bytes().all(|b| b.is_ascii_hexdigit()))
            .then(|| u32::from_str_radix(hex, 16).ok())
            .flatten()
            .map(|n| {
                let [_, r, g, b] = n.to_be_bytes();
                [r, g, b]
            });
        named
            .or(parsed)
            .map(Self)
            .ok_or_else(|| "write it as #rrggbb, or black, white, green".into())
    }
}

impl fmt::Display for Rgb {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// The label formats that can be read, by name.
pub fn label_formats() -> PossibleValuesParser {
    let formats = READERS.iter();
    let auto = PossibleValue::new(AUTO).help("any of these, found by name and content");
    let formats = formats.map(|r| PossibleValue::new(r.name()).help(r.about()));
    PossibleValuesParser::new([auto].into_iter().chain(formats))
}

/// The label formats that can be written, by name.
pub fn written_formats() -> PossibleValuesParser {
    PossibleValuesParser::new(WRITERS.iter().map(|w| PossibleValue::new(w.name())))
}

/// The alphabets that phones can be written in, by name.
pub fn alphabet() -> impl TypedValueParser<Value = Alphabet> {
    let all = Alphabet::ALL.map(|a| PossibleValue::new(a.name()).help(a.about()));
    PossibleValuesParser::new(all).try_map(|name| name.parse::<Alphabet>())
}

/// Bits a second: a number, with `k` or `M` behind it.
pub fn bitrate(text: &str) -> Result<u32, String> {
    let (number, unit) = match text.as_bytes().last() {
        Some(b'k' | b'K') => (&text[..text.len() - 1], 1e3),
        Some(b'm' | b'M') => (&text[..text.len() - 1], 1e6),
        _ => (text, 1.0),
    };
    let value = number.parse::<f64>().unwrap_or(f64::NAN) * unit;
    // Below, openh264 gives mud; above, no level of H.264 allows it.
    if (10e3..=200e6).contains(&value) {
        Ok(value as u32)
    } else {
        Err("write it as 800k or 2M, between 10k and 200M".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broadcast_rates_stay_fractions() {
        let ntsc: Fps = "29.97".parse().unwrap();
        assert_eq!((ntsc.num, ntsc.den), (30_000, 1001));
        assert_eq!(ntsc.ticks(30_000), 48_000 * 1001);
        assert_eq!("25.5".parse::<Fps>().unwrap(), Fps { num: 255, den: 10 });
        for bad in [
            "0", "-1", "601", "1/0", "0/1", "x", "", ".", "1e3", "29.97001", "3/2/1",
        ] {
            assert!(bad.parse::<Fps>().is_err(), "{bad}");
        }
    }

    #[test]
    fn frames_cover_the_time_and_no_more() {
        let fps = Fps {
            num: 30_000,
            den: 1001,
        };
        for ticks in [0, 1, 1601, 1602, 48_000, 1_000_003] {
            let n = fps.frames(ticks);
            assert!(fps.ticks(n) >= ticks);
            assert!(n == 0 || fps.ticks(n - 1) < ticks);
            let n = fps.instants(ticks);
            assert!(fps.ticks(n - 1) <= ticks && fps.ticks(n) > ticks);
        }
    }

    #[test]
    fn sizes_colours_bitrates() {
        assert_eq!(
            "640x480".parse(),
            Ok(Size {
                width: 640,
                height: 480
            })
        );
        for bad in ["640", "0x480", "640x99999", "x", "-1x5", "640x480x3"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!("#102030".parse(), Ok(Rgb([16, 32, 48])));
        assert!("#12345g".parse::<Rgb>().is_err());
        assert!("#+12345".parse::<Rgb>().is_err());
        assert_eq!(bitrate("2M"), Ok(2_000_000));
        assert_eq!(bitrate("800k"), Ok(800_000));
        for bad in ["", "k", "-5M", "nan", "1", "9000M"] {
            assert!(bitrate(bad).is_err(), "{bad}");
        }
    }
}
