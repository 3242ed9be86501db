//! Level and pitch of one moment of sound: energy in dB, and the lag at which the sound is most like itself
//! (the normalised cross-correlation of Talkin's RAPT, without its path search).

/// Samples of 48 kHz in one of 8 kHz: pitch and the vowels' energy lie below 4 kHz, and hissing sibilants,
/// which are loud with a narrow jaw, above.
const DECIMATE: usize = 6;
/// Samples of 8 kHz from moment to moment: 10 ms.
const HOP: usize = 80;
/// What pitch and level are taken from: 30 ms.
const SPAN: usize = 240;
/// Lags of 400 and 70 Hz.
const LAG_MIN: usize = 20;
const LAG_MAX: usize = 114;
/// What is kept.
const KEPT: usize = SPAN + LAG_MAX;
/// Likeness of a voiced sound to itself one period on (judgement, after RAPT's).
const VOICED: f32 = 0.55;
/// Quieter than this there is no voice, dB of full scale.
pub(super) const FLOOR_DB: f32 = -55.0;

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// Level, dB of full scale.
    pub(super) db: f32,
    /// Pitch in semitones over 70 Hz; none where there is no voice.
    pub(super) pitch: Option<f32>,
}

impl Frame {
    pub(super) const SILENT: Self = Self {
        db: -120.0,
        pitch: None,
    };
}

/// The last sound, at 8 kHz.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// The newest last.
    kept: [f32; KEPT],
    coming: [f32; HOP],
    come: usize,
    sum: f32,
    summed: usize,
}

impl Window {
    pub(super) const fn new() -> Self {
        Self {
            kept: [0.0; KEPT],
            coming: [0.0; HOP],
            come: 0,
            sum: 0.0,
            summed: 0,
        }
    }

    /// Takes a sample; the moment that it completes.
    pub(super) fn push(&mut self, sample: f32) -> Option<Frame> {
        self.sum += if sample.is_finite() {
            sample.clamp(-1.0, 1.0)
        } else {
            0.0
        };
        self.summed += 1;
        if self.summed < DECIMATE {
            return None;
        }
        // The mean of six is filter enough: what folds back is weak in speech.
        self.coming[self.come] = self.sum / DECIMATE as f32;
        (self.sum, self.summed) = (0.0, 0);
        self.come += 1;
        if self.come < HOP {
            return None;
        }
        self.come = 0;
        self.kept.copy_within(HOP.., 0);
        self.kept[KEPT - HOP..].copy_from_slice(&self.coming);
        Some(frame(&self.kept))
    }
}

/// The sum of products, in eight parts so that they can be worked out at once.
fn product(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0_f32; 8];
    // Spans are multiples of eight.
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum()
}

fn frame(kept: &[f32; KEPT]) -> Frame {
    let now = &kept[LAG_MAX..];
    let energy = product(now, now);
    let db = 10.0 * (energy / SPAN as f32).max(1e-12).log10();
    let pitch = if db > FLOOR_DB {
        pitch(kept, energy)
    } else {
        None
    };
    Frame { db, pitch }
}

fn pitch(kept: &[f32; KEPT], energy: f32) -> Option<f32> {
    let now = &kept[LAG_MAX..];
    let mut likeness = [0.0_f32; LAG_MAX + 1];
    for (lag, like) in likeness.iter_mut().enumerate().skip(LAG_MIN) {
        let then = &kept[LAG_MAX - lag..KEPT - lag];
        *like = product(now, then) / (energy * product(then, then)).sqrt().max(1e-9);
    }
    let most = likeness.iter().copied().fold(0.0, f32::max);
    if most < VOICED {
        return None;
    }
    // Twice the period is as good as the period; the first peak that is nearly the best is meant.
    let peak = (LAG_MIN + 1..LAG_MAX).find(|&lag| {
        let [a, b, c] = [likeness[lag - 1], likeness[lag], likeness[lag + 1]];
        b > 0.9 * most && b >= a && b >= c
    })?;
    let [a, b, c] = [likeness[peak - 1], likeness[peak], likeness[peak + 1]];
    let bend = a - 2.0 * b + c;
    let between = if bend < -1e-6 {
        (0.5 * (a - c) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    };
    Some(12.0 * (LAG_MAX as f32 / (peak as f32 + between)).log2())
}
