//! One lip as it is drawn: columns from crest to inner side side by side, a coordinate each, so that facing columns
//! are compared many at a time.
//!
//! Between levels that can touch lie further rows, on the curve through the levels: the drawn surface bows there.

use glam::{Vec3, Vec3A, Vec4, vec3a, vec4};

use super::drawn::{Drawn, Limit};
use super::four::bits;
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
    /// By column, then level: row of `drawn`, node, and from there to where it is drawn at rest.
    levels: Vec<[Level; LEVELS]>,
    drawn: Drawn,
    /// 1 where a level is the vertex of the level before; and blocks that have some of these.
    twin: Vec<[Lane; LEVELS]>,
    twins: Vec<bool>,
    /// Of the vertices that are drawn.
    pub at: Sheet,
    /// Speeds of the same; x is not used.
    pub speed: Sheet,
    /// What contact adds up, and of how many; x is not used.
    pub change: Sheet,
    pub weight: Vec<[Lane; ROWS]>,
    /// The same by level, with an empty block at each end.
    sums: Vec<[Sums; LEVELS]>,
}

#[derive(Clone, Copy, Debug)]
struct Level {
    row: u32,
    node: u32,
    offset: Vec3A,
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

impl Profile {
    /// None where a vertex does not move.
    pub(super) fn new(
        columns: &[[u32; LIP_LEVELS]],
        limit: &Limit<'_>,
        rest: &[Vec3],
    ) -> Option<Self> {
        let blocks = columns.len().div_ceil(LANES);
        let mut drawn = Drawn::default();
        let mut twin = vec![[Lane::ZERO; LEVELS]; blocks];
        let mut levels = Vec::with_capacity(columns.len());
        for (c, column) in columns.iter().enumerate() {
            let vertices = &column[CREST..];
            let mut own = [Level {
                row: 0,
                node: 0,
                offset: Vec3A::ZERO,
            }; LEVELS];
            for (level, &vertex) in vertices.iter().enumerate() {
                let node = limit.numbering().moving(vertex)?;
                if level > 0 && vertices[level - 1] == vertex {
                    twin[c / LANES][level].as_mut()[c % LANES] = 1.0;
                } else {
                    drawn.push(limit, vertex, node);
                }
                own[level] = Level {
                    row: drawn.rows() as u32 - 1,
                    node,
                    offset: (limit.at(vertex, rest) - rest[vertex as usize]).into(),
                };
            }
            levels.push(own);
        }
        let some = |twin: &[Lane; LEVELS]| twin.iter().any(|t| *t != Lane::ZERO);
        Some(Self {
            columns: columns.len(),
            levels,
            drawn,
            twins: twin.iter().map(some).collect(),
            twin,
            at: Sheet::new(blocks),
            speed: Sheet::new(blocks),
            change: Sheet::new(blocks),
            weight: vec![[Lane::ZERO; ROWS]; blocks],
            sums: vec![[NOTHING; LEVELS]; blocks + 2],
        })
    }

    pub(super) fn blocks(&self) -> usize {
        self.weight.len()
    }

    /// The corner of the box round a column that is the least in all coordinates, and the greatest: as far as its
    /// points moved along with their nodes, at the end of the step.
    #[inline]
    pub(super) fn bounds(&self, column: usize, skin: &Nodes, step_s: f32) -> [Vec3A; 2] {
        let (mut low, mut high) = (Vec3A::MAX, Vec3A::MIN);
        for level in &self.levels[column] {
            let node = level.node as usize;
            let at = skin.place[node] + skin.velocity[node] * step_s + level.offset;
            (low, high) = (low.min(at), high.max(at));
        }
        [low, high]
    }

    /// Works out where a column is, as it is drawn what lies between two heights, the rest as far as it moved along
    /// with its nodes; lanes past the last repeat it.
    pub(super) fn draw(&mut self, lane: usize, [low, high]: [f32; 2], skin: &Nodes) {
        let levels = &self.levels[lane.min(self.columns - 1)];
        let (block, lane) = (lane / LANES, lane % LANES);
        let [x, y, z] = [
            &mut self.at.x[block],
            &mut self.at.y[block],
            &mut self.at.z[block],
        ];
        let (vy, vz) = (&mut self.speed.y[block], &mut self.speed.z[block]);
        let (mut place, mut last) = (Vec3A::ZERO, u32::MAX);
        for (i, level) in levels.iter().enumerate() {
            if level.row != last {
                place = skin.place[level.node as usize] + level.offset;
                if low < place.y && place.y < high {
                    place = self.drawn.at(level.row as usize, &skin.place);
                }
                last = level.row;
            }
            let (row, velocity) = (row(i), skin.velocity[level.node as usize]);
            x[row].as_mut()[lane] = place.x;
            y[row].as_mut()[lane] = place.y;
            z[row].as_mut()[lane] = place.z;
            vy[row].as_mut()[lane] = velocity.y;
            vz[row].as_mut()[lane] = velocity.z;
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
        self.change.y[block] = [Lane::ZERO; ROWS];
        self.change.z[block] = [Lane::ZERO; ROWS];
        self.weight[block] = [Lane::ZERO; ROWS];
    }

    /// Heights and depths of a block's rows where they pass the given x, straight on from column to column.
    pub(super) fn cut(&self, block: usize, x: Lane) -> Cut {
        let last = self.blocks() - 1;
        let (before, after) = (block.saturating_sub(1), (block + 1).min(last));
        let step = |sheet: &[[Lane; ROWS]], r: usize| {
            let (a, b, c) = (sheet[before][r], sheet[block][r], sheet[after][r]);
            let first = if before == block { b.x } else { a.w };
            let end = if after == block { b.w } else { c.x };
            vec4(b.y, b.z, b.w, end) - vec4(first, b.x, b.y, b.z)
        };
        let at = &self.at;
        let mut cut = Cut {
            y: at.y[block],
            z: at.z[block],
        };
        let most = Lane::splat(ASIDE_MM);
        for r in 0..ROWS {
            let aside = (x - at.x[block][r]).clamp(-most, most);
            let per = aside / step(&at.x, r).max(Lane::splat(NARROW_MM));
            cut.y[r] += step(&at.y, r) * per;
            cut.z[r] += step(&at.z, r) * per;
        }
        cut
    }

    /// Carries what contact adds up in these blocks to the nodes' places or velocities: each vertex changes by the mean
    /// of what it and the rows beside it are changed by, spread over the columns beside it.
    pub(super) fn carry(&mut self, touched: &[bool], nodes: &mut [Vec3A]) {
        let on = |block: usize| touched.get(block).copied().unwrap_or(false);
        let around = |block: usize| {
            [
                block.checked_sub(1).is_some_and(on),
                on(block),
                on(block + 1),
            ]
        };
        for block in 0..self.blocks() {
            let sums = if on(block) {
                self.sums(block)
            } else {
                [NOTHING; LEVELS]
            };
            self.sums[block + 1] = sums;
        }
        for block in (0..self.blocks()).filter(|b| around(*b).contains(&true)) {
            for level in 0..LEVELS {
                let three = [block, block + 1, block + 2].map(|b| &self.sums[b][level]);
                if three.iter().all(|sums| sums[WEIGHT] == Lane::ZERO) {
                    continue;
                }
                let [y, z, weight] = std::array::from_fn(|i| spread(three.map(|t| t[i])));
                let per = weight.max(Lane::ONE).recip();
                let [y, z] = [y * per, z * per].map(|v| v.to_array());
                for lane in bits(weight.cmpgt(Lane::ZERO).bitmask()) {
                    let column = block * LANES + lane;
                    if let Some(levels) = self.levels.get(column) {
                        nodes[levels[level].node as usize] += vec3a(0.0, y[lane], z[lane]);
                    }
                }
            }
        }
    }

    /// By level, what its own row and those beside it in a block add up to.
    fn sums(&self, block: usize) -> [Sums; LEVELS] {
        let sheets = [
            &self.change.y[block],
            &self.change.z[block],
            &self.weight[block],
        ];
        let mut sums = [NOTHING; LEVELS];
        for (level, sums) in sums.iter_mut().enumerate() {
            let row = row(level);
            for (sum, rows) in sums.iter_mut().zip(sheets) {
                *sum = rows[row];
                if level > BETWEEN {
                    *sum += rows[row - 1];
                }
                // What lies behind the contact line is pushed by its inner end: the line itself stays shut.
                if (BETWEEN..LEVELS - 1).contains(&level) && level != SHARP {
                    *sum += rows[row + 1];
                }
            }
        }
        if self.twins[block] {
            // Levels that are the same vertex count together, at the first of them.
            for level in (1..LEVELS).rev() {
                let twin = self.twin[block][level];
                let (before, own) = sums.split_at_mut(level);
                for (into, sum) in before[level - 1].iter_mut().zip(&mut own[0]) {
                    let more = *sum * twin;
                    *sum -= more;
                    *into += more;
                }
            }
        }
        sums
    }
}

/// What contact adds up for a level: changes along y and z, and how many they come from.
type Sums = [Lane; 3];
const WEIGHT: usize = 2;
const NOTHING: Sums = [Lane::ZERO; 3];

/// A block's values, spread, by those before and after it: half of each stays with its column. Pressed lips have many ways
/// to fold, column by column, and which they took would hang on the step.
#[inline]
fn spread([before, own, after]: [Lane; 3]) -> Lane {
    let left = vec4(before.w, own.x, own.y, own.z);
    let right = vec4(own.y, own.z, own.w, after.x);
    own * 0.5 + (left + right) * 0.25
}

/// Rows of a block where they pass a plane across the lip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub y: [Lane; ROWS],
    pub z: [Lane; ROWS],
}

/// Share of the curve's second difference that it bows by: 1/16 on a cubic, a little more on this surface.
pub(super) const BOW: f32 = 0.075;
/// Rows are not followed farther than this to the side, mm.
const ASIDE_MM: f32 = 2.0;
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
