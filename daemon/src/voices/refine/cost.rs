//! What a stretch of frames costs as one phone: how uneven it is, how unlike the phone, how unusually
//! long. All weights are by judgement, set by ear and eye on spoken sentences.

use mouthpiece_phonemes::{Class, Phone};

use super::is_voiceless_closure;
use super::spectrum::{BANDS, BRIGHT, DARK, Frame, HISS, LOW, MID, UPPER, VOICE};

/// Seconds a frame.
const HOP_S: f32 = 0.005;

/// What a stretch costs, for starts from `from` on.
pub struct Cost<'a> {
    phone: Phone,
    frames: &'a [Frame],
    from: usize,
    sums: Vec<Frame>,
    squares: Vec<f32>,
    unlike: Vec<f32>,
}

impl<'a> Cost<'a> {
    /// For `phone` within the frames `from..to`, in a sound whose loudest band reaches `loud`.
    pub fn new(phone: Phone, frames: &'a [Frame], loud: f32, from: usize, to: usize) -> Self {
        let (mut sum, mut square, mut far) = ([0.0; BANDS], 0.0, 0.0);
        let (mut sums, mut squares, mut unlike_sums) = (vec![sum], vec![square], vec![far]);
        for frame in frames.get(from..to).unwrap_or(&[]) {
            for (a, b) in sum.iter_mut().zip(frame) {
                *a += b;
            }
            square += frame.iter().map(|b| b * b).sum::<f32>();
            far += unlike(phone, frame, loud);
            sums.push(sum);
            squares.push(square);
            unlike_sums.push(far);
        }
        Self {
            phone,
            frames,
            from,
            sums,
            squares,
            unlike: unlike_sums,
        }
    }

    /// Of the frames `start..end`.
    pub fn of(&self, start: usize, end: usize) -> f32 {
        let (a, b) = (start - self.from, end - self.from);
        if b >= self.sums.len() {
            return f32::INFINITY;
        }
        let length = (b - a) as f32;
        let square: f32 = self.sums[a]
            .iter()
            .zip(&self.sums[b])
            .map(|(a, b)| (b - a) * (b - a))
            .sum();
        let uneven = self.squares[b] - self.squares[a] - square / length;
        let mut price = 0.35 * uneven + 1.5 * (self.unlike[b] - self.unlike[a]);
        if !self.phone.is_silence() {
            price += 4.0 * (length * HOP_S / usual_s(self.phone)).ln().powi(2);
        }
        // A release begins with a jump.
        if self.phone.class() == Class::Stop
            && self.phone.closure().is_some()
            && start >= 2
            && start + 2 < self.frames.len()
        {
            let upper = |frame: &Frame| frame[MID..].iter().sum::<f32>() / 4.0;
            let before = upper(&self.frames[start - 2]);
            let after = upper(&self.frames[start]).max(upper(&self.frames[start + 1]));
            price -= 3.0 * (after - before).clamp(0.0, 1.5);
        }
        price
    }
}

/// How long a label likes to be.
const fn usual_s(phone: Phone) -> f32 {
    use Phone::{
        Aa, Ao, Aw, Ax, AxH, Axr, Ay, B, Ch, D, Dh, Dx, El, Em, En, Er, Ey, F, G, Hh, Hv, Ix, Jh,
        K, L, M, N, Ng, Nx, Ow, Oy, P, R, S, Sh, T, Th, V, W, Y, Z, Zh,
    };
    if phone.is_closure() {
        return 0.055;
    }
    match phone {
        P | T | K => 0.035,
        B | D | G => 0.018,
        M | N | Ng | Em | En | Nx => 0.060,
        V | Dh | L | El | R | W | Y | Hh | Hv => 0.055,
        F | Th | Z | Zh | Ch | Jh => 0.075,
        S | Sh => 0.110,
        Ax | AxH | Ix | Axr | Dx => 0.045,
        Ay | Aw | Oy | Ow | Ey | Ao | Aa | Er => 0.130,
        _ => 0.080,
    }
}

fn over(level: f32, limit: f32) -> f32 {
    (level - limit).max(0.0)
}

fn most(levels: &[f32]) -> f32 {
    levels.iter().copied().fold(f32::MIN, f32::max)
}

/// How unlike `phone` a frame is, from 0; each rule is a difference of levels that should hold.
fn unlike(phone: Phone, frame: &Frame, loud: f32) -> f32 {
    use Phone::{B, Ch, Dh, Em, F, Hh, Hv, Jh, L, P, S, Sh, Th, V, Z, Zh};
    let middle = most(&frame[DARK..UPPER]);
    let total = most(frame);
    match phone {
        _ if phone.is_silence() => return over(total, loud - 5.2),
        _ if phone.is_closure() => {
            let hiss = if is_voiceless_closure(phone) {
                over(frame[HISS], loud - 5.5)
            } else {
                0.0
            };
            return over(most(&frame[DARK..]), loud - 3.5) + 3.0 * hiss;
        }
        _ if phone.class() == Class::Stop && phone.closure().is_some() => {
            let voiced = most(&frame[..=DARK]);
            let voiceless = matches!(phone, P | Phone::T | Phone::K);
            let limit = most(&frame[MID..]) + if voiceless { 0.3 } else { 1.5 };
            let hiss = if matches!(phone, P | B) {
                over(frame[HISS], most(&frame[MID..HISS]))
            } else {
                0.0
            };
            return over(loud - 4.0, most(&frame[MID..])) + over(voiced, limit) + hiss;
        }
        S | Z | Sh | Zh | Ch | Jh => {
            let from = if matches!(phone, S | Z) {
                UPPER
            } else {
                BRIGHT
            };
            let bright = most(&frame[from..]);
            return over(frame[LOW].max(frame[DARK]), bright) + over(loud - 3.5, bright);
        }
        _ => {}
    }
    let mut hiss = over(frame[HISS], most(&frame[..UPPER]));
    match phone {
        F | Th | Hh | Hv => {
            let hum = over(most(&frame[VOICE..=DARK]), most(&frame[BRIGHT..]) + 0.3);
            over(total, loud - 2.5) + over(loud - 6.0, most(&frame[BRIGHT..])) + 0.3 * hum
        }
        V | Dh => over(middle, loud - 1.2) + hiss,
        _ if phone.class() == Class::Nasal || phone == Em => {
            over(middle, frame[VOICE].max(frame[LOW]) - 1.0) + hiss + over(loud - 3.0, total)
        }
        _ => {
            if phone == L {
                hiss += over(most(&frame[MID..=BRIGHT]), frame[LOW] - 2.0);
            }
            over(loud - 2.5, frame[LOW].max(frame[DARK])) + hiss
        }
    }
}
