//! Brings sound of any rate to 48 kHz, block by block, without moving it in time.
//!
//! rubato's FFT resampler does the filtering (about 512 samples long at the lower of the two
//! rates). What is added here is the book-keeping that keeps sound in step with its labels: the
//! filter's delay is cut off exactly and the length is that of the input, to the sample.

use rubato::audioadapter_buffers::direct::InterleavedSlice;
use rubato::{Fft, FixedSync, Resampler as _, WindowFunction};

/// The one rate inside Mouthpiece, as `usize` for sizes of buffers.
const RATE: usize = 48_000;

/// The filter's length in samples of the lower rate: stop band below -90 dB with a transition of
/// some 2 % of the band, and ringing of 5 ms that no ear hears before a stop consonant.
const FILTER_LEN: usize = 512;

/// Takes mono samples of one rate and gathers them at 48 kHz.
pub struct Resampler {
    rate: usize,
    /// None where the rate is 48 kHz already.
    fft: Option<Fft<f32>>,
    pending: Vec<f32>,
    block_out: Vec<f32>,
    taken: u64,
    out: Vec<f32>,
}

impl Resampler {
    /// For sound at `rate` Hz.
    pub fn new(rate: u32) -> Result<Self, rubato::ResamplerConstructionError> {
        let rate = rate as usize;
        let fft = if rate == RATE {
            None
        } else {
            Some(Fft::new_custom(
                rate,
                RATE,
                block_len(rate),
                1,
                1,
                WindowFunction::BlackmanHarris2,
                FixedSync::Both,
            )?)
        };
        let block_out = vec![0.0; fft.as_ref().map_or(0, rubato::Resampler::output_frames_max)];
        Ok(Self {
            rate,
            fft,
            pending: Vec::new(),
            block_out,
            taken: 0,
            out: Vec::new(),
        })
    }

    /// How much there is at 48 kHz so far: a lower bound of what [`Self::finish`] will give.
    pub fn len(&self) -> usize {
        self.out.len()
    }

    /// Takes more samples.
    pub fn push(&mut self, samples: &[f32]) -> Result<(), rubato::ResampleError> {
        let Some(fft) = &mut self.fft else {
            self.out.extend_from_slice(samples);
            return Ok(());
        };
        self.taken += samples.len() as u64;
        self.pending.extend_from_slice(samples);
        let block = fft.input_frames_next();
        let mut from = 0;
        while self.pending.len() - from >= block {
            let input = &self.pending[from..from + block];
            run(fft, input, &mut self.block_out, &mut self.out)?;
            from += block;
        }
        self.pending.drain(..from);
        Ok(())
    }

    /// The whole sound at 48 kHz, as long as the input to within one sample.
    pub fn finish(mut self) -> Result<Vec<f32>, rubato::ResampleError> {
        let Some(fft) = &mut self.fft else {
            return Ok(self.out);
        };
        let length = (self.taken * RATE as u64).div_ceil(self.rate as u64) as usize;
        let delay = fft.output_delay();
        let block = fft.input_frames_next();
        while self.out.len() < delay + length {
            self.pending.resize(block, 0.0);
            run(fft, &self.pending, &mut self.block_out, &mut self.out)?;
            self.pending.clear();
        }
        self.out.drain(..delay);
        self.out.truncate(length);
        Ok(self.out)
    }
}

/// Input samples of a block, which is also the filter's length: a whole number of periods of the two
/// rates, and an even one, since the middle of an odd filter lies between two samples.
fn block_len(rate: usize) -> usize {
    let (mut a, mut b) = (rate, RATE);
    while b > 0 {
        (a, b) = (b, a % b);
    }
    let period = rate / a;
    let periods = (FILTER_LEN * rate.div_ceil(RATE)).div_ceil(period);
    period * periods.next_multiple_of(2)
}

/// One block through the filter, its result behind what is there.
fn run(
    fft: &mut Fft<f32>,
    input: &[f32],
    block_out: &mut [f32],
    out: &mut Vec<f32>,
) -> Result<(), rubato::ResampleError> {
    // The sizes are the resampler's own, so that a mismatch cannot come from the input.
    let frames_out = block_out.len();
    let (Ok(input), Ok(mut output)) = (
        InterleavedSlice::new(input, 1, input.len()),
        InterleavedSlice::new_mut(&mut *block_out, 1, frames_out),
    ) else {
        return Ok(());
    };
    let (_, written) = fft.process_into_buffer(&input, &mut output, None)?;
    out.extend_from_slice(&block_out[..written]);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(rate: u32, input: &[f32], block: usize) -> Vec<f32> {
        let mut resampler = Resampler::new(rate).unwrap();
        for part in input.chunks(block) {
            resampler.push(part).unwrap();
        }
        resampler.finish().unwrap()
    }

    /// An impulse comes out where it went in, to within a sample, for every rate and place.
    #[test]
    fn an_impulse_stays_where_it_is() {
        for rate in [
            8_000, 11_025, 16_000, 22_050, 24_000, 32_000, 44_100, 48_000, 96_000, 192_000, 8_191,
        ] {
            for place in [0_usize, 1, 700, 5_000] {
                let mut input = vec![0.0; 8_000];
                input[place] = 1.0;
                let out = through(rate, &input, 333);
                let peak = (0..out.len())
                    .max_by(|&a, &b| out[a].abs().total_cmp(&out[b].abs()))
                    .unwrap();
                let expected = place as f64 * 48_000.0 / f64::from(rate);
                assert!(
                    (peak as f64 - expected).abs() <= 1.0,
                    "{rate} Hz: {place} should be at {expected:.2}, is at {peak}"
                );
                assert_eq!(out.len(), (8_000_usize * 48_000).div_ceil(rate as usize));
            }
        }
    }

    /// A tone keeps its level; one that 48 kHz cannot hold is gone instead of folded down.
    #[test]
    fn tones_keep_their_level_and_nothing_folds() {
        let level = |rate: u32, hz: f64| {
            let n = rate as usize / 2;
            let input: Vec<f32> = (0..n)
                .map(|i| (i as f64 * hz / f64::from(rate) * std::f64::consts::TAU).sin() as f32)
                .collect();
            let out = through(rate, &input, 4096);
            let middle = &out[out.len() / 4..out.len() * 3 / 4];
            (middle.iter().map(|x| f64::from(x * x)).sum::<f64>() / middle.len() as f64).sqrt()
                * std::f64::consts::SQRT_2
        };
        for rate in [8_000, 16_000, 44_100, 96_000, 192_000] {
            assert!((level(rate, 1_000.0) - 1.0).abs() < 0.01, "{rate}");
        }
        assert!(level(96_000, 30_000.0) < 1e-3);
        assert!(level(192_000, 40_000.0) < 1e-3);
    }
}
