//! Sound to Opus packets of 20 ms, one at a time.
//!
//! The decoder's output lags by the encoder's look-ahead: that many samples more are encoded, and
//! [`Packets::pre_skip`] says how many a player must drop, so that the first sample heard is the
//! first of the sound.

use std::sync::Arc;

use anyhow::anyhow;
use ropus::{Application, Bitrate, Channels, Encoder, Signal};

/// Samples in a packet.
pub const PACKET: u64 = 960;

/// Transparent for one voice.
const BITS_PER_SECOND: u32 = 96_000;

/// More than any packet at this rate.
const PACKET_BYTES_MAX: usize = 4000;

/// The packets of one sound, in order.
pub struct Packets {
    encoder: Encoder,
    sound: Arc<[f32]>,
    next: u64,
    bytes: Vec<u8>,
}

impl Packets {
    pub fn new(sound: Arc<[f32]>) -> anyhow::Result<Self> {
        let encoder = Encoder::builder(48_000, Channels::Mono, Application::Audio)
            .bitrate(Bitrate::Bits(BITS_PER_SECOND))
            .signal(Signal::Voice)
            .build()
            .map_err(|e| anyhow!("the Opus encoder does not start: {e}"))?;
        Ok(Self {
            encoder,
            sound,
            next: 0,
            bytes: vec![0; PACKET_BYTES_MAX],
        })
    }

    /// Samples of the sound itself.
    pub fn length(&self) -> u64 {
        self.sound.len() as u64
    }

    /// Samples that a player drops at the beginning.
    pub fn pre_skip(&self) -> u16 {
        u16::try_from(self.encoder.lookahead()).unwrap_or(0)
    }

    /// How many packets there are in all.
    pub fn count(&self) -> u64 {
        (self.length() + u64::from(self.pre_skip())).div_ceil(PACKET)
    }

    /// Where the next packet starts, in samples of the coded sound.
    pub fn next_start(&self) -> u64 {
        self.next * PACKET
    }

    /// Encodes the next packet; none behind the last.
    pub fn next(&mut self) -> anyhow::Result<Option<&[u8]>> {
        if self.next >= self.count() {
            return Ok(None);
        }
        let from = (self.next_start() as usize).min(self.sound.len());
        let to = (from + PACKET as usize).min(self.sound.len());
        let mut block = [0_i16; PACKET as usize];
        for (out, &x) in block.iter_mut().zip(&self.sound[from..to]) {
            *out = (x.clamp(-1.0, 1.0) * 32_767.0).round() as i16;
        }
        let written = self
            .encoder
            .encode(&block, &mut self.bytes)
            .map_err(|e| anyhow!("the Opus encoder gave up: {e}"))?;
        self.next += 1;
        Ok(Some(&self.bytes[..written]))
    }
}
