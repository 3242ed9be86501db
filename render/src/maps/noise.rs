//! Noise to paint with: the same on every machine.

/// Scrambles two cell numbers into 32 bits.
pub(crate) fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(0x9E37_79B1)
        ^ (y as u32).wrapping_mul(0x85EB_CA77)
        ^ seed.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 13)).wrapping_mul(0x297A_2D39);
    h ^ (h >> 16)
}

/// 0..1 from a hash.
pub(crate) fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 / 16_777_216.0
}

/// The whole number below. `f32::floor` is a call into the C library on plain x86-64, and this is
/// asked for millions of times.
fn below(x: f32) -> i32 {
    let cut = x as i32;
    cut - i32::from(x < cut as f32)
}

/// Smooth noise over a lattice of side 1, 0..1.
pub(crate) fn value(x: f32, y: f32, seed: u32) -> f32 {
    let (xi, yi) = (below(x), below(y));
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v) = (smooth(x - xi as f32), smooth(y - yi as f32));
    let at = |dx: i32, dy: i32| unit(hash(xi + dx, yi + dy, seed));
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    low + (high - low) * v
}

/// Three octaves of [`value`], about 0..1.
pub(crate) fn fractal(x: f32, y: f32, seed: u32) -> f32 {
    (value(x, y, seed) * 4.0
        + value(x * 2.1, y * 2.1, seed + 1) * 2.0
        + value(x * 4.3, y * 4.3, seed + 2))
        / 7.0
}

/// A cell number that runs out of 0..period by less than a period, brought back.
fn wrapped(i: i32, period: i32) -> i32 {
    if i < 0 {
        i + period
    } else if i >= period {
        i - period
    } else {
        i
    }
}

/// [`value`] that repeats after `period` cells both ways. Places lie in the first period or just outside it.
pub(crate) fn value_tiled(x: f32, y: f32, period: i32, seed: u32) -> f32 {
    let (xi, yi) = (below(x), below(y));
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v) = (smooth(x - xi as f32), smooth(y - yi as f32));
    let at = |dx: i32, dy: i32| {
        unit(hash(
            wrapped(xi + dx, period),
            wrapped(yi + dy, period),
            seed,
        ))
    };
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    low + (high - low) * v
}

/// The three nearest of points scattered one a cell of side 1, repeating after `period` cells both ways.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// Distances, nearest first.
    pub(crate) distance: [f32; 3],
    /// What the nearest is known by.
    pub(crate) hash: u32,
}

/// See [`Near`]. Places lie in the first period or just outside it. Points stay within `spread` of their cells' middles: the less, the more even the pattern.
pub(crate) fn cells(x: f32, y: f32, period: i32, spread: f32, seed: u32) -> Near {
    let (xi, yi) = (below(x), below(y));
    let (fx, fy) = (x - xi as f32 - 0.5, y - yi as f32 - 0.5);
    let mut near = Near {
        distance: [9.0; 3],
        hash: 0,
    };
    for dy in -1..=1 {
        for dx in -1..=1 {
            let h = hash(wrapped(xi + dx, period), wrapped(yi + dy, period), seed);
            let off = |bits: u32| ((bits & 0xFFFF) as f32 / 65536.0 - 0.5) * 2.0 * spread;
            let px = dx as f32 + off(h) - fx;
            let py = dy as f32 + off(h >> 16) - fy;
            let d = px * px + py * py;
            let [first, second, third] = near.distance;
            if d < first {
                near.distance = [d, first, second];
                near.hash = h;
            } else if d < second {
                near.distance = [first, d, second];
            } else if d < third {
                near.distance[2] = d;
            }
        }
    }
    near.distance = near.distance.map(f32::sqrt);
    near
}

/// A small generator for scattering: SplitMix's step, cut to 32 bits.
#[derive(Clone, Debug)]
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 0..1.
    pub(crate) fn roll(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        unit((z >> 32) as u32)
    }

    /// -1..1, near 0 more often.
    pub(crate) fn spread(&mut self) -> f32 {
        self.roll() + self.roll() - 1.0
    }
}
