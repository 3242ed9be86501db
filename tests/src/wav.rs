//! Writes WAV files of any coding, rate and number of channels, for tests of what reads them.

use std::f64::consts::TAU;

/// How a sample is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// Unsigned bytes.
    U8,
    /// 16-bit integers.
    S16,
    /// 24-bit integers.
    S24,
    /// 32-bit integers.
    S32,
    /// 32-bit floats.
    F32,
}

impl Coding {
    fn bytes(self) -> u16 {
        match self {
            Self::U8 => 1,
            Self::S16 => 2,
            Self::S24 => 3,
            Self::S32 | Self::F32 => 4,
        }
    }

    fn write(self, value: f64, out: &mut Vec<u8>) {
        let scaled = |bits: u32| (value * f64::from((1_u32 << (bits - 1)) - 1)).round() as i32;
        match self {
            Self::U8 => out.push((128 + scaled(8)) as u8),
            Self::S16 => out.extend((scaled(16) as i16).to_le_bytes()),
            Self::S24 => out.extend(&scaled(24).to_le_bytes()[..3]),
            Self::S32 => out.extend(((value * f64::from(i32::MAX)) as i32).to_le_bytes()),
            Self::F32 => out.extend((value as f32).to_le_bytes()),
        }
    }
}

/// A WAV file with the given sound, one value a frame, the same in every channel.
#[must_use]
pub fn file(coding: Coding, rate: u32, channels: u16, sound: &[f64]) -> Vec<u8> {
    let mut data = Vec::new();
    for &value in sound {
        for _ in 0..channels {
            coding.write(value, &mut data);
        }
    }
    let frame = coding.bytes() * channels;
    let mut out = b"RIFF".to_vec();
    let length = |bytes: usize| u32::try_from(bytes).expect("a short test file");
    out.extend((36 + length(data.len())).to_le_bytes());
    out.extend(b"WAVEfmt ");
    out.extend(16_u32.to_le_bytes());
    // 3 is IEEE float, 1 integers.
    out.extend(if coding == Coding::F32 { 3_u16 } else { 1 }.to_le_bytes());
    out.extend(channels.to_le_bytes());
    out.extend(rate.to_le_bytes());
    out.extend((rate * u32::from(frame)).to_le_bytes());
    out.extend(frame.to_le_bytes());
    out.extend((coding.bytes() * 8).to_le_bytes());
    out.extend(b"data");
    out.extend(length(data.len()).to_le_bytes());
    out.extend(data);
    out
}

/// Silence, then from `onset_s` a tone of `hz`, to `end_s`.
#[must_use]
pub fn tone(rate: u32, hz: f64, onset_s: f64, end_s: f64) -> Vec<f64> {
    let rate = f64::from(rate);
    (0..(end_s * rate).round() as usize)
        .map(|n| n as f64 / rate)
        .map(|t| {
            if t < onset_s {
                0.0
            } else {
                0.5 * (TAU * hz * (t - onset_s)).sin()
            }
        })
        .collect()
}
