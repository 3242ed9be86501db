//! How one sample is written in a sound file, and what it is worth: -1..1.

/// How a sample is coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    U8,
    S16,
    S16Be,
    S24,
    S32,
    F32,
    F64,
    ALaw,
    MuLaw,
}

impl Coding {
    /// Bytes of one sample.
    pub const fn width(self) -> usize {
        match self {
            Self::U8 | Self::ALaw | Self::MuLaw => 1,
            Self::S16 | Self::S16Be => 2,
            Self::S24 => 3,
            Self::S32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The value of the sample in `b`, which must be [`Self::width`] long; what is not a finite
    /// number counts as silence.
    fn value(self, b: &[u8]) -> f32 {
        let value = match (self, b) {
            (Self::U8, &[a]) => (f32::from(a) - 128.0) / 128.0,
            (Self::ALaw, &[a]) => f32::from(a_law(a)) / 32_768.0,
            (Self::MuLaw, &[a]) => f32::from(mu_law(a)) / 32_768.0,
            (Self::S16, &[a, b]) => f32::from(i16::from_le_bytes([a, b])) / 32_768.0,
            (Self::S16Be, &[a, b]) => f32::from(i16::from_be_bytes([a, b])) / 32_768.0,
            (Self::S24, &[a, b, c]) => i32::from_le_bytes([0, a, b, c]) as f32 / TWO_31,
            (Self::S32, &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]) as f32 / TWO_31,
            (Self::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (Self::F64, &[a, b, c, d, e, f, g, h]) => {
                f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32
            }
            _ => 0.0,
        };
        if value.is_finite() {
            value.clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// Appends the mean of the channels of each whole frame in `bytes`.
    pub fn mix(self, bytes: &[u8], channels: usize, out: &mut Vec<f32>) {
        let width = self.width();
        let share = 1.0 / channels as f32;
        out.extend(bytes.chunks_exact(width * channels).map(|frame| {
            frame
                .chunks_exact(width)
                .map(|b| self.value(b))
                .sum::<f32>()
                * share
        }));
    }
}

const TWO_31: f32 = 2_147_483_648.0;

/// ITU-T G.711 A-law to 16 bits.
fn a_law(code: u8) -> i16 {
    let code = code ^ 0x55;
    let (exponent, mantissa) = ((code >> 4) & 7, i16::from(code & 15));
    let size = match exponent {
        0 => (mantissa << 4) + 8,
        e => ((mantissa << 4) + 0x108) << (e - 1),
    };
    if code & 0x80 == 0 { -size } else { size }
}

/// ITU-T G.711 mu-law to 16 bits.
fn mu_law(code: u8) -> i16 {
    let code = !code;
    let size = (((i16::from(code & 15) << 3) + 0x84) << ((code >> 4) & 7)) - 0x84;
    if code & 0x80 == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_scale_and_silence_in_every_coding() {
        let one = |coding: Coding, b: &[u8]| coding.value(b);
        assert_eq!(one(Coding::U8, &[128]), 0.0);
        assert_eq!(one(Coding::U8, &[0]), -1.0);
        assert_eq!(one(Coding::S16, &[0, 0x40]), 0.5);
        assert_eq!(one(Coding::S16Be, &[0x40, 0]), 0.5);
        assert_eq!(one(Coding::S24, &[0, 0, 0xC0]), -0.5);
        assert_eq!(one(Coding::S32, &[0, 0, 0, 0x80]), -1.0);
        assert_eq!(one(Coding::F32, &f32::NAN.to_le_bytes()), 0.0);
        assert_eq!(one(Coding::F64, &1e300_f64.to_le_bytes()), 0.0);
        // G.711's quietest and loudest codes.
        assert_eq!(
            (mu_law(0xFF), mu_law(0x80), mu_law(0x00)),
            (0, 32_124, -32_124)
        );
        assert_eq!(
            (a_law(0xD5), a_law(0xAA), a_law(0x2A)),
            (8, 32_256, -32_256)
        );
    }

    #[test]
    fn channels_are_averaged_and_a_torn_frame_is_left_out() {
        let mut out = Vec::new();
        Coding::S16.mix(&[0, 0x40, 0, 0, 0, 0xC0, 0, 0xC0, 7, 7, 7], 2, &mut out);
        assert_eq!(out, [0.25, -0.5]);
    }
}
