//! Lips that meet: points of the lower lip are pushed out of the upper one, both by halves.
//!
//! Both lips' columns were built over one another and the muscles move them sideways together; what is left of a
//! sideways shift is made up for along the rows. Within a column the upper lip is a line of segments; a point inside
//! is pushed square to its segment, so that a lip neither climbs nor sticks.

use super::drawn::Limit;
use super::profile::{LANES, Lane, Profile, ROWS};
use crate::Head;
use crate::simulation::STEP_S;
use crate::tissue::Nodes;

/// Passes of pushing: what is drawn follows a vertex by half where its neighbours stay.
const PASSES: usize = 2;
/// So little an overlap counts as touching, mm: lips that meet at rest do not press.
const SLOP_MM: f32 = 0.02;
/// What is deeper than this in the other lip got there another way, mm.
const DEEPEST_MM: f32 = 4.0;
/// Facing columns are not followed farther than this to the side, mm.
const ASIDE_MM: f32 = 2.0;
/// What a row rises or falls at most on the way to the point beside it, mm, if the lips are not shifted sideways.
const AROUND_MM: f32 = 0.4;
/// Segments flatter than this in depth are passed over, mm.
const FLAT_MM: f32 = 1e-3;

/// Both lips.
#[derive(Clone, Debug)]
pub(super) struct Lips {
    /// Upper and lower; none where a vertex of them does not move.
    pair: Option<[Profile; 2]>,
    /// Blocks of columns that may touch, and those that did.
    near: Vec<bool>,
    touched: Vec<bool>,
}

impl Lips {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let (upper, lower) = (&head.lips.upper, &head.lips.lower);
        let pair = (upper.len() == lower.len() && upper.len() > 2)
            .then(|| Some([Profile::new(upper, limit)?, Profile::new(lower, limit)?]))
            .flatten();
        let blocks = pair.as_ref().map_or(0, |[upper, _]| upper.blocks());
        Self {
            pair,
            near: vec![false; blocks],
            touched: vec![false; blocks],
        }
    }

    pub(super) fn resolve(&mut self, skin: &mut Nodes) {
        let Some([upper, lower]) = &mut self.pair else {
            return;
        };
        if !find_near(&mut self.near, upper, lower, skin) {
            return;
        }
        for _ in 0..PASSES {
            draw(&self.near, upper, skin);
            draw(&self.near, lower, skin);
            for (block, near) in self.near.iter().enumerate() {
                self.touched[block] = *near && {
                    upper.lean(block);
                    press(upper, lower, block)
                };
            }
            if !self.touched.contains(&true) {
                return;
            }
            for (block, _) in self.touched.iter().enumerate().filter(|(_, t)| **t) {
                upper.carry(block, skin);
                lower.carry(block, skin);
            }
            // Only what touched, or what is beside it and was drawn along, can touch still.
            self.near.copy_from_slice(&self.touched);
        }
    }
}

/// Finds the blocks whose lips may touch; whether there is one.
fn find_near(near: &mut [bool], upper: &Profile, lower: &Profile, skin: &Nodes) -> bool {
    for (block, near) in near.iter_mut().enumerate() {
        *near = lower.heights(block, skin).high > upper.heights(block, skin).low;
    }
    near.contains(&true)
}

/// Draws the blocks that are near, and the columns beside them.
fn draw(near: &[bool], lip: &mut Profile, skin: &Nodes) {
    for (block, _) in near.iter().enumerate().filter(|(_, near)| **near) {
        for column in block * LANES..(block + 1) * LANES {
            lip.draw(column, skin);
        }
    }
    for (block, _) in near.iter().enumerate().filter(|(_, near)| !**near) {
        let beside = |other: Option<&bool>| other.copied().unwrap_or(false);
        if beside(block.checked_sub(1).and_then(|b| near.get(b))) {
            lip.draw(block * LANES, skin);
        }
        if beside(near.get(block + 1)) {
            lip.draw((block + 1) * LANES - 1, skin);
        }
    }
    for block in 0..near.len() {
        let beside = block > 0 && near[block - 1] || near.get(block + 1).is_some_and(|n| *n);
        if near[block] || beside {
            lip.bow(block);
        }
    }
}

/// Where a row of the upper lip is, roughly: its least height and its depths against the middle row.
#[derive(Clone, Copy, Default)]
struct Reach {
    low: f32,
    back: f32,
    front: f32,
}

/// Adds up what pushes the lower lip's points of a block out of the upper lip's segments; whether anything does.
fn press(upper: &mut Profile, lower: &mut Profile, block: usize) -> bool {
    let mut touched = false;
    let columns = upper.columns;
    // The corners are one: only what lies between them is pushed; lanes past the end neither.
    let own = Lane::from_array(std::array::from_fn(|lane| {
        let column = block * LANES + lane;
        f32::from(u8::from(column > 0 && column + 1 < columns))
    }));
    let base = upper.at.z[block][ROWS / 2];
    let aside = (upper.at.x[block][ROWS / 2] - lower.at.x[block][ROWS / 2]).abs();
    let around = AROUND_MM + aside.max_element().min(ASIDE_MM);
    let mut reaches = [Reach::default(); ROWS];
    for (r, reach) in reaches.iter_mut().enumerate() {
        let z = upper.at.z[block][r] - base;
        *reach = Reach {
            low: upper.at.y[block][r].min_element() - around,
            back: z.min_element() - around,
            front: z.max_element() + around,
        };
    }
    for r in 0..ROWS {
        let high = lower.at.y[block][r].max_element();
        let z = lower.at.z[block][r] - base;
        let (back, front) = (z.min_element(), z.max_element());
        for s in 0..ROWS - 1 {
            let (a, b) = (reaches[s], reaches[s + 1]);
            if high > a.low.min(b.low) && back < a.front.max(b.front) && front > a.back.min(b.back)
            {
                touched |= segment(upper, lower, block, [r, s], own);
            }
        }
    }
    touched
}

/// Adds up what pushes one row of points out of one row of segments; whether anything does.
fn segment(
    upper: &mut Profile,
    lower: &mut Profile,
    block: usize,
    [r, s]: [usize; 2],
    own: Lane,
) -> bool {
    let (px, py, pz) = (
        lower.at.x[block][r],
        lower.at.y[block][r],
        lower.at.z[block][r],
    );
    let (x, y, z) = (&upper.at.x[block], &upper.at.y[block], &upper.at.z[block]);
    let (rise, way) = (&upper.slope.y[block], &upper.slope.z[block]);
    // The segment's ends, moved along their rows to where the point is.
    let aside = |s: usize| (px - x[s]).clamp(Lane::splat(-ASIDE_MM), Lane::splat(ASIDE_MM));
    let (a, b) = (aside(s), aside(s + 1));
    let (qy, qz) = (y[s] + rise[s] * a, z[s] + way[s] * a);
    let (ey, ez) = (
        y[s + 1] + rise[s + 1] * b - qy,
        z[s + 1] + way[s + 1] * b - qz,
    );
    let deep = ez.abs().cmpgt(Lane::splat(FLAT_MM));
    let t = (pz - qz) / Lane::select(deep, ez, Lane::ONE);
    let over = py - qy - ey * t - Lane::splat(SLOP_MM);
    let inside = deep & t.cmpge(Lane::ZERO) & t.cmplt(Lane::ONE) & over.cmpgt(Lane::ZERO);
    if !inside.any() {
        return false;
    }
    let per = (ey * ey + ez * ez)
        .max(Lane::splat(FLAT_MM * FLAT_MM))
        .recip();
    let f = over * ez * per;
    let inside = inside & (over * f * ez).cmplt(Lane::splat(DEEPEST_MM * DEEPEST_MM));
    let m = Lane::select(inside, own, Lane::ZERO);
    // Speeds along the segment's normal, where they bring the lips together. No rebound: only the speed that made
    // the overlap goes, so that lips that press come to lie still.
    let speed = |v: &[Lane; ROWS]| v[s] + (v[s + 1] - v[s]) * t;
    let vy = lower.speed.y[block][r] - speed(&upper.speed.y[block]);
    let vz = lower.speed.z[block][r] - speed(&upper.speed.z[block]);
    let k = (vy * ez - vz * ey) * per;
    let limit = f.abs() * (1.0 / STEP_S);
    let k = Lane::select((k * ez).cmpgt(Lane::ZERO), k, Lane::ZERO).clamp(-limit, limit);
    let share = t * m;
    let half = 0.5 * m;
    let push = [half * f * ez, -half * f * ey];
    let brake = [half * k * ez, -half * k * ey];
    lower.push.y[block][r] -= push[0];
    lower.push.z[block][r] -= push[1];
    lower.brake.y[block][r] -= brake[0];
    lower.brake.z[block][r] -= brake[1];
    lower.weight[block][r] += m;
    for (s, share) in [(s, m - share), (s + 1, share)] {
        upper.push.y[block][s] += share * push[0];
        upper.push.z[block][s] += share * push[1];
        upper.brake.y[block][s] += share * brake[0];
        upper.brake.z[block][s] += share * brake[1];
        upper.weight[block][s] += share;
    }
    true
}
