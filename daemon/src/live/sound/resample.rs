//! One channel of sound from one rate to another, in pieces of any size, in step to the sample: the
//! resampler's own delay is taken off. Runs on the sound thread and on connections, never in the
//! device's callback.

use anyhow::{Context as _, Result};
use rubato::audioadapter_buffers::direct::InterleavedSlice;
use rubato::{Fft, FixedSync, Resampler};

/// Frames that go through at once: 10 ms at 48 kHz, so that it adds little delay.
const CHUNK: usize = 480;

/// A resampler with what it has not used yet.
pub struct Resample {
    fft: Option<Fft<f32>>,
    from: u32,
    to: u32,
    waiting: Vec<f32>,
    chunk: Vec<f32>,
    /// Frames of the resampler's delay that are still to be dropped.
    skip: usize,
    taken: u64,
    given: u64,
}

impl Resample {
    /// From `from` Hz to `to` Hz; equal rates pass through.
    pub fn new(from: u32, to: u32) -> Result<Self> {
        let fft = if from == to {
            None
        } else {
            let (a, b) = (usize::try_from(from)?, usize::try_from(to)?);
            let fft = Fft::new(a, b, CHUNK, 1, FixedSync::Input);
            Some(fft.with_context(|| format!("sound at {from} Hz cannot be turned to {to} Hz"))?)
        };
        Ok(Self {
            skip: fft.as_ref().map_or(0, Resampler::output_delay),
            fft,
            from,
            to,
            waiting: Vec::new(),
            chunk: Vec::new(),
            taken: 0,
            given: 0,
        })
    }

    /// Takes in `input` and appends to `out` what is ready.
    pub fn push(&mut self, input: &[f32], out: &mut Vec<f32>) -> Result<()> {
        self.taken += input.len() as u64;
        let before = out.len();
        if self.fft.is_some() {
            self.waiting.extend_from_slice(input);
            self.run(out)?;
        } else {
            out.extend_from_slice(input);
        }
        self.given += (out.len() - before) as u64;
        Ok(())
    }

    /// The sound is over: appends its rest, so that the whole is as long as the input.
    pub fn finish(&mut self, out: &mut Vec<f32>) -> Result<()> {
        let whole = (u128::from(self.taken) * u128::from(self.to)).div_ceil(u128::from(self.from));
        let whole = u64::try_from(whole)?;
        let before = out.len();
        let missing = usize::try_from(whole.saturating_sub(self.given))?;
        while self.fft.is_some() && out.len() - before < missing {
            let chunk = self.fft.as_ref().map_or(0, Resampler::input_frames_next);
            self.waiting.resize(self.waiting.len() + chunk, 0.0);
            self.run(out)?;
        }
        out.truncate(before + missing);
        self.given = whole;
        Ok(())
    }

    /// Frames that may still come out of what went in.
    pub fn inside(&self) -> i64 {
        let whole = u128::from(self.taken) * u128::from(self.to) / u128::from(self.from.max(1));
        i64::try_from(whole.saturating_sub(u128::from(self.given))).unwrap_or(0)
    }

    fn run(&mut self, out: &mut Vec<f32>) -> Result<()> {
        let Some(fft) = &mut self.fft else {
            return Ok(());
        };
        let mut used = 0;
        while self.waiting.len() - used >= fft.input_frames_next() {
            let need = fft.input_frames_next();
            self.chunk.resize(fft.output_frames_max(), 0.0);
            let input = InterleavedSlice::new(&self.waiting[used..used + need], 1, need)?;
            let frames = self.chunk.len();
            let mut output = InterleavedSlice::new_mut(&mut self.chunk, 1, frames)?;
            let (read, written) = fft.process_into_buffer(&input, &mut output, None)?;
            used += read;
            let skip = self.skip.min(written);
            self.skip -= skip;
            out.extend_from_slice(&self.chunk[skip..written]);
        }
        self.waiting.drain(..used);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sine in pieces comes out as the same sine: same length, same phase.
    fn sine_through(from: u32, to: u32) -> f32 {
        let sine = |rate: u32, n: usize| {
            (n as f32 / rate as f32 * 440.0 * std::f32::consts::TAU).sin() * 0.5
        };
        let input: Vec<f32> = (0..from as usize).map(|n| sine(from, n)).collect();
        let mut resample = Resample::new(from, to).unwrap();
        let mut out = Vec::new();
        for piece in input.chunks(777) {
            resample.push(piece, &mut out).unwrap();
        }
        resample.finish(&mut out).unwrap();
        assert_eq!(out.len(), to as usize);
        // The ends ring, since the sine begins and ends there.
        let inner = 2000..out.len() - 2000;
        inner
            .map(|n| (out[n] - sine(to, n)).abs())
            .fold(0.0, f32::max)
    }

    #[test]
    fn any_rate_keeps_length_and_phase() {
        for from in [8_000, 16_000, 22_050, 44_100, 48_000, 96_000] {
            let worst = sine_through(from, 48_000);
            assert!(worst < 0.01, "{from} Hz: off by {worst}");
        }
        // Half a sample of delay cannot be taken off here: 11 us.
        let worst = sine_through(48_000, 44_100);
        assert!(worst < 0.02, "to 44100 Hz: off by {worst}");
    }
}
