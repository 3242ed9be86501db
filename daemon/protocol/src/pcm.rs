//! Sound as it is sent (interleaved, little-endian) to mono samples, in pieces that are cut anywhere.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a sample is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SampleFormat {
    /// 16-bit signed integers.
    #[default]
    S16,
    /// 32-bit floats, -1 to 1.
    F32,
}

/// The form of sound that is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pcm {
    /// Frames a second.
    pub rate: u32,
    /// Samples in a frame.
    pub channels: u16,
    /// What a sample is.
    pub format: SampleFormat,
}

impl Pcm {
    /// Bytes of one sample of every channel.
    pub(crate) fn frame_bytes(self) -> usize {
        let sample = match self.format {
            SampleFormat::S16 => 2,
            SampleFormat::F32 => 4,
        };
        sample * usize::from(self.channels.max(1))
    }
}

/// Keeps the bytes of a frame that a message cut in two.
#[derive(Debug)]
pub(crate) struct Decoder {
    pcm: Pcm,
    carry: Vec<u8>,
}

impl Decoder {
    pub(crate) fn new(pcm: Pcm) -> Self {
        Self {
            pcm,
            carry: Vec::new(),
        }
    }

    /// The whole frames so far, mixed to one channel; what is not a number is silent, what is too
    /// loud is cut at full scale.
    pub(crate) fn decode(&mut self, bytes: &[u8]) -> Vec<f32> {
        let size = self.pcm.frame_bytes();
        self.carry.extend_from_slice(bytes);
        let whole = self.carry.len() - self.carry.len() % size;
        let scale = 1.0 / f32::from(self.pcm.channels.max(1));
        let mono = self.carry[..whole]
            .chunks_exact(size)
            .map(|frame| (self.sum(frame) * scale).clamp(-1.0, 1.0))
            .collect();
        self.carry.drain(..whole);
        mono
    }

    fn sum(&self, frame: &[u8]) -> f32 {
        match self.pcm.format {
            SampleFormat::S16 => frame
                .chunks_exact(2)
                .map(|b| f32::from(i16::from_le_bytes([b[0], b[1]])) / 32_768.0)
                .sum(),
            SampleFormat::F32 => frame
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .map(|x| if x.is_finite() { x } else { 0.0 })
                .sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stereo_is_mixed_and_a_cut_frame_waits_for_its_rest() {
        let mut decoder = Decoder::new(Pcm {
            rate: 16_000,
            channels: 2,
            format: SampleFormat::S16,
        });
        let bytes: Vec<u8> = [16_384_i16, 0, -32_768, -32_768]
            .iter()
            .flat_map(|s| s.to_le_bytes())
            .collect();
        let mut mono = decoder.decode(&bytes[..3]);
        mono.extend(decoder.decode(&bytes[3..]));
        assert_eq!(mono, [0.25, -1.0]);
    }

    #[test]
    fn floats_that_are_no_numbers_are_silent() {
        let mut decoder = Decoder::new(Pcm {
            rate: 48_000,
            channels: 1,
            format: SampleFormat::F32,
        });
        let bytes: Vec<u8> = [f32::NAN, 3.0, f32::NEG_INFINITY, -0.5]
            .iter()
            .flat_map(|s| s.to_le_bytes())
            .collect();
        assert_eq!(decoder.decode(&bytes), [0.0, 1.0, 0.0, -0.5]);
    }
}
