//! One lip as it is drawn: columns from crest to inner side side by side, a coordinate each, so that facing columns
//! are compared many at a time.
//!
//! Between levels that can touch lie further rows, on the curve through the levels: the drawn surface bows there.

use glam::{Vec3A, Vec4, vec3a, vec4};

use super::drawn::{Drawn, Limit};
use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::{CONTACT, CREST};
use crate::tissue::Nodes;

/// Columns that are compared at a time.
pub(super) const LANES: usize = 4;
/// Levels from the crest inwards.
pub(super) const LEVELS: usize = LIP_LEVELS - CREST;
/// The first of these levels that has a row between itself and the next.
const BETWEEN: usize = 2;
/// Rows: the levels and what lies between.
pub(super) const ROWS: usize = LEVELS + LEVELS - 1 - BETWEEN;
/// The contact line, which is sharp, among these levels.
const SHARP: usize = CONTACT - CREST;

/// The row of a level.
pub(super) const fn row(level: usize) -> usize {
    if level <= BETWEEN {
        level
    } else {
        2 * level - BETWEEN
    }
}

/// A block of columns of one row.
pub(super) type Lane = Vec4;

/// A lip's columns.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    pub columns: usize,
    /// Row of [`Drawn`] `LEVELS * column + level`; empty where the vertex is that of the level before.
    drawn: Drawn,
    /// Of the vertices that are drawn.
    pub at: Sheet,
    /// Speeds of the same; x is not used.
    pub speed: Sheet,
    /// How height and depth change along a row, per mm of x.
    pub slope: Sheet,
    /// What contact adds up.
    pub push: Sheet,
    pub brake: Sheet,
    pub weight: Vec<[Lane; ROWS]>,
}

/// Three coordinates of all rows, in blocks of columns.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub x: Vec<[Lane; ROWS]>,
    pub y: Vec<[Lane; ROWS]>,
    pub z: Vec<[Lane; ROWS]>,
}

impl Sheet {
    fn new(blocks: usize) -> Self {
        let none = vec![[Lane::ZERO; ROWS]; blocks];
        Self {
            x: none.clone(),
            y: none.clone(),
            z: none,
        }
    }
}

/// The least and the greatest height of one block's vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights {
    pub low: f32,
    pub high: f32,
}

impl Profile {
    /// None where a vertex does not move.
    pub(super) fn new(columns: &[[u32; LIP_LEVELS]], limit: &Limit<'_>) -> Option<Self> {
        let mut drawn = Drawn::default();
        for column in columns {
            let levels = &column[CREST..];
            for (level, &vertex) in levels.iter().enumerate() {
                let node = limit.numbering().moving(vertex)?;
                if level > 0 && levels[level - 1] == vertex {
                    drawn.close();
                } else {
                    drawn.push(limit, vertex, node);
                }
            }
        }
        let blocks = columns.len().div_ceil(LANES);
        Some(Self {
            columns: columns.len(),
            drawn,
            at: Sheet::new(blocks),
            speed: Sheet::new(blocks),
            slope: Sheet::new(blocks),
            push: Sheet::new(blocks),
            brake: Sheet::new(blocks),
            weight: vec![[Lane::ZERO; ROWS]; blocks],
        })
    }

    pub(super) fn blocks(&self) -> usize {
        self.weight.len()
    }

    /// Bounds of the heights of a block's vertices and those a column beside it: what is drawn of it lies inside.
    pub(super) fn heights(&self, block: usize, skin: &Nodes) -> Heights {
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        let first = (block * LANES).saturating_sub(1);
        let end = ((block + 1) * LANES + 1).min(self.columns);
        for row in first * LEVELS..end * LEVELS {
            if let Some(node) = self.drawn.node(row) {
                let y = skin.place[node].y;
                (low, high) = (low.min(y), high.max(y));
            }
        }
        Heights { low, high }
    }

    /// Works out where a column is drawn; lanes past the last repeat it.
    pub(super) fn draw(&mut self, lane: usize, skin: &Nodes) {
        let column = lane.min(self.columns - 1);
        let (block, lane) = (lane / LANES, lane % LANES);
        let (at, speed) = (&mut self.at, &mut self.speed);
        let mut place = Vec3A::ZERO;
        let mut velocity = place;
        for level in 0..LEVELS {
            let number = column * LEVELS + level;
            if let Some(node) = self.drawn.node(number) {
                place = self.drawn.at(number, &skin.place);
                velocity = skin.velocity[node];
            }
            let row = row(level);
            at.x[block][row][lane] = place.x;
            at.y[block][row][lane] = place.y;
            at.z[block][row][lane] = place.z;
            speed.y[block][row][lane] = velocity.y;
            speed.z[block][row][lane] = velocity.z;
        }
    }

    /// Fills the rows between levels of a block that is drawn, and clears its sums.
    pub(super) fn bow(&mut self, block: usize) {
        for sheet in [&mut self.at.x, &mut self.at.y, &mut self.at.z] {
            between(&mut sheet[block]);
        }
        for sheet in [&mut self.speed.y, &mut self.speed.z] {
            let rows = &mut sheet[block];
            for level in BETWEEN..LEVELS - 1 {
                let (a, b) = (row(level), row(level + 1));
                rows[a + 1] = 0.5 * (rows[a] + rows[b]);
            }
        }
        for sums in [&mut self.push, &mut self.brake] {
            sums.y[block] = [Lane::ZERO; ROWS];
            sums.z[block] = [Lane::ZERO; ROWS];
        }
        self.weight[block] = [Lane::ZERO; ROWS];
    }

    /// Works out how a block's rows run from column to column.
    pub(super) fn lean(&mut self, block: usize) {
        let last = self.blocks() - 1;
        let (before, after) = (block.saturating_sub(1), (block + 1).min(last));
        let step = |sheet: &[[Lane; ROWS]], r: usize| {
            let (a, b, c) = (sheet[before][r], sheet[block][r], sheet[after][r]);
            let first = if before == block { b.x } else { a.w };
            let end = if after == block { b.w } else { c.x };
            vec4(b.y, b.z, b.w, end) - vec4(first, b.x, b.y, b.z)
        };
        for r in 0..ROWS {
            let per = step(&self.at.x, r).max(Lane::splat(NARROW_MM)).recip();
            self.slope.y[block][r] = step(&self.at.y, r) * per;
            self.slope.z[block][r] = step(&self.at.z, r) * per;
        }
    }

    /// Carries a block's sums to the nodes: each vertex moves by the mean of what it and the rows beside it are
    /// pushed by.
    pub(super) fn carry(&self, block: usize, skin: &mut Nodes) {
        let sheets = [
            &self.push.y,
            &self.push.z,
            &self.brake.y,
            &self.brake.z,
            &self.weight,
        ];
        let mut sums = [[Lane::ZERO; 5]; LEVELS];
        for (sum, sheet) in sheets.into_iter().enumerate() {
            let rows = &sheet[block];
            for (level, sums) in sums.iter_mut().enumerate() {
                let row = row(level);
                sums[sum] = rows[row];
                if level > BETWEEN {
                    sums[sum] += rows[row - 1];
                }
                // What lies behind the contact line is pushed by its inner end: the line itself stays shut.
                if (BETWEEN..LEVELS - 1).contains(&level) && level != SHARP {
                    sums[sum] += rows[row + 1];
                }
            }
        }
        for lane in 0..LANES {
            let column = block * LANES + lane;
            if column == 0 || column + 1 >= self.columns {
                continue;
            }
            let mut level = 0;
            while let Some(node) = (level < LEVELS)
                .then(|| self.drawn.node(column * LEVELS + level))
                .flatten()
            {
                let mut sum = sums[level].map(|s| s[lane]);
                level += 1;
                // Levels that are the same vertex count together.
                while level < LEVELS && self.drawn.node(column * LEVELS + level).is_none() {
                    for (sum, more) in sum.iter_mut().zip(sums[level]) {
                        *sum += more[lane];
                    }
                    level += 1;
                }
                let [y, z, vy, vz, weight] = sum;
                if weight > 0.0 {
                    let per = 1.0 / weight.max(1.0);
                    skin.place[node] += vec3a(0.0, y * per, z * per);
                    skin.velocity[node] += vec3a(0.0, vy * per, vz * per);
                }
            }
        }
    }
}

/// Share of the curve's second difference that it bows by: 1/16 on a cubic, a little more on this surface.
pub(super) const BOW: f32 = 0.075;
/// Columns count as no nearer than this to each other, mm, when it is worked out how a row runs.
const NARROW_MM: f32 = 0.5;

/// The curve through the levels half way between them: of third order, but of second beside the sharp line and at
/// the end, where the surface runs out straight.
fn between(rows: &mut [Lane; ROWS]) {
    for level in BETWEEN..LEVELS - 1 {
        let (a, b) = (row(level), row(level + 1));
        let before = row(level - 1);
        let after = if level + 2 < LEVELS {
            row(level + 2)
        } else {
            b
        };
        let (p, q) = (rows[a], rows[b]);
        let bow = if level == SHARP {
            2.0 * q - p - rows[after]
        } else if level + 1 == SHARP || level + 2 == LEVELS {
            2.0 * p - q - rows[before]
        } else {
            p + q - rows[before] - rows[after]
        };
        rows[a + 1] = 0.5 * (p + q) + bow * BOW;
    }
}
