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
    let at = |dx: i32, dy: i32| unit(hash(xi + dx, yi + dy, seed));
    let corners = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    between(corners, x - xi as f32, y - yi as f32)
}

/// The corners of a cell (those of the first row, then of the second) blended smoothly.
#[inline]
fn between([a, b, c, d]: [f32; 4], x: f32, y: f32) -> f32 {
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v) = (smooth(x), smooth(y));
    let (low, high) = (a + (b - a) * u, c + (d - c) * u);
    low + (high - low) * v
}

/// Three octaves of [`value`], about 0..1.
pub(crate) fn fractal(x: f32, y: f32, seed: u32) -> f32 {
    (value(x, y, seed) * 4.0
        + value(x * 2.1, y * 2.1, seed + 1) * 2.0
        + value(x * 4.3, y * 4.3, seed + 2))
        / 7.0
}

/// Smooth noise that repeats: over a tile whose side is 1.
#[derive(Clone, Debug)]
pub(crate) struct Tiled {
    /// Lattice cells along the tile's side.
    cells: usize,
    values: Vec<f32>,
}

impl Tiled {
    pub(crate) fn new(cells: usize, seed: u32) -> Self {
        let values = (0..cells * cells)
            .map(|i| unit(hash((i % cells) as i32, (i / cells) as i32, seed)) - 0.5)
            .collect();
        Self { cells, values }
    }

    /// -0.5..0.5 at a place of the tile, 0..1 both ways.
    pub(crate) fn at(&self, x: f32, y: f32) -> f32 {
        let scale = self.cells as f32;
        let last = self.cells - 1;
        let (x, y) = ((x * scale).max(0.0), (y * scale).max(0.0));
        let (xi, yi) = ((x as usize).min(last), (y as usize).min(last));
        let next = |i: usize| if i == last { 0 } else { i + 1 };
        let (above, below) = (yi * self.cells, next(yi) * self.cells);
        let corners = [above + xi, above + next(xi), below + xi, below + next(xi)];
        between(
            corners.map(|i| self.values[i]),
            x - xi as f32,
            y - yi as f32,
        )
    }
}

/// The three nearest of points scattered one a cell of side 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// Distances, nearest first.
    pub(crate) distance: [f32; 3],
    /// What the nearest is known by.
    pub(crate) hash: u32,
}

/// See [`Near`]. Points stay within `spread` of their cells' middles: the less, the more even the pattern.
pub(crate) fn cells(x: f32, y: f32, spread: f32, seed: u32) -> Near {
    nearest(x, y, |xi, yi| scattered(xi, yi, spread, seed))
}

/// The point of a cell off the cell's middle, and what it is known by.
fn scattered(x: i32, y: i32, spread: f32, seed: u32) -> ([f32; 2], u32) {
    let h = hash(x, y, seed);
    let off = |bits: u32| ((bits & 0xFFFF) as f32 / 65536.0 - 0.5) * 2.0 * spread;
    ([off(h), off(h >> 16)], h)
}

fn nearest(x: f32, y: f32, point: impl Fn(i32, i32) -> ([f32; 2], u32)) -> Near {
    let (xi, yi) = (below(x), below(y));
    let (fx, fy) = (x - xi as f32 - 0.5, y - yi as f32 - 0.5);
    let mut near = Near {
        distance: [9.0; 3],
        hash: 0,
    };
    for dy in -1..=1 {
        for dx in -1..=1 {
            let (off, h) = point(xi + dx, yi + dy);
            let px = dx as f32 + off[0] - fx;
            let py = dy as f32 + off[1] - fy;
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

/// [`cells`] that repeat: over a tile whose side is 1.
#[derive(Clone, Debug)]
pub(crate) struct TiledCells {
    cells: i32,
    points: Vec<([f32; 2], u32)>,
}

impl TiledCells {
    pub(crate) fn new(cells: i32, spread: f32, seed: u32) -> Self {
        let points = (0..cells * cells)
            .map(|i| scattered(i % cells, i / cells, spread, seed))
            .collect();
        Self { cells, points }
    }

    /// At a place in cells, which may lie outside the tile by less than the tile's side.
    pub(crate) fn at(&self, x: f32, y: f32) -> Near {
        let wrapped = |i: i32| {
            let i = if i < 0 { i + self.cells } else { i };
            let i = if i >= self.cells { i - self.cells } else { i };
            i.clamp(0, self.cells - 1) as usize
        };
        nearest(x, y, |xi, yi| {
            self.points[wrapped(yi) * self.cells as usize + wrapped(xi)]
        })
    }
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
