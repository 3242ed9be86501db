//! How loud each band of frequencies is, every 5 ms.

use std::f32::consts::TAU;

use realfft::RealFftPlanner;

/// From frame to frame: 5 ms.
pub const HOP_TICKS: i64 = 240;

/// Samples that a frame looks at, a power of two: 21 ms.
const SIZE: usize = 1024;

/// Edges of the bands in Hz.
const EDGES: [(usize, usize); BANDS] = [
    (80, 300),
    (300, 650),
    (650, 1100),
    (1100, 1700),
    (1700, 2600),
    (2600, 4000),
    (4000, 8000),
];
/// How many bands there are.
pub const BANDS: usize = 7;
/// Voice bar.
pub const VOICE: usize = 0;
/// First formants, lower half.
pub const LOW: usize = 1;
/// First formants, upper half.
pub const DARK: usize = 2;
/// Second formants, lower half.
pub const MID: usize = 3;
/// Second formants, upper half.
pub const BRIGHT: usize = 4;
/// Third formants.
pub const UPPER: usize = 5;
/// Frication.
pub const HISS: usize = 6;

/// Levels in units of 10 dB; nothing is told apart below [`FLOOR`].
pub type Frame = [f32; BANDS];

/// The lowest level: 16-bit sound's own noise.
const FLOOR: f32 = 1.0;

/// Levels count from a full scale of 16 bits, as the thresholds that came with them.
const FULL_SCALE: f32 = 32_768.0;

/// The frames of a sound of 48 kHz.
pub fn bands(sound: &[f32]) -> Vec<Frame> {
    let window: Vec<f32> = (0..SIZE)
        .map(|i| 0.5 - 0.5 * (TAU * i as f32 / SIZE as f32).cos())
        .collect();
    let transform = RealFftPlanner::new().plan_fft_forward(SIZE);
    let (mut input, mut output) = (transform.make_input_vec(), transform.make_output_vec());
    let mut scratch = transform.make_scratch_vec();
    let hop = HOP_TICKS as usize;
    let count = (sound.len() + hop / 2) / hop;
    let frame = |number: usize| {
        let first = (number * hop + hop / 2) as i64 - (SIZE / 2) as i64;
        for (i, (slot, w)) in (first..).zip(input.iter_mut().zip(&window)) {
            let x = usize::try_from(i).ok().and_then(|i| sound.get(i)).copied();
            *slot = x.unwrap_or(0.0) * FULL_SCALE * w;
        }
        // It fails only on buffers of another length.
        let done = transform.process_with_scratch(&mut input, &mut output, &mut scratch);
        debug_assert!(done.is_ok());
        EDGES.map(|(low, high)| {
            let (a, b) = (
                low * SIZE / 48_000,
                (high * SIZE / 48_000).max(low * SIZE / 48_000 + 1),
            );
            let power: f32 = output[a..b]
                .iter()
                .map(realfft::num_complex::Complex::norm_sqr)
                .sum();
            (power / (SIZE * SIZE) as f32 + 1e-9).log10().max(FLOOR)
        })
    };
    (0..count).map(frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_is_in_its_band_alone() {
        for (hz, band) in [
            (200.0, VOICE),
            (900.0, DARK),
            (3300.0, UPPER),
            (6000.0, HISS),
        ] {
            let sound: Vec<f32> = (0..4800)
                .map(|i| 0.1 * (TAU * hz * i as f32 / 48_000.0).sin())
                .collect();
            let frames = bands(&sound);
            assert_eq!(frames.len(), 20);
            let frame = frames[10];
            for (other, level) in frame.iter().enumerate() {
                assert!(other == band || frame[band] > level + 2.0, "{hz} {frame:?}");
            }
        }
        assert!(bands(&[0.0; 960]).iter().flatten().all(|x| *x == FLOOR));
    }
}
