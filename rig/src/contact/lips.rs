//! Lips that meet: points of the lower lip are pushed out of the upper one, both by halves.
//!
//! Both lips' columns were built over one another and the muscles move them sideways together; what is left of a
//! sideways shift is made up for along the rows, so that both are cut by one plane. There the upper lip is a line of
//! segments; a point inside is pushed square to its segment, so that a lip neither climbs nor sticks.
//!
//! A step does it twice: before lips move, of the speed that brings them together only so much is left as they are apart,
//! so that no step presses them into each other; after, what overlap is left goes.

use super::drawn::Limit;
use super::four::bits;
use super::profile::{Cut, LANES, Lane, Profile, ROWS};
use glam::Vec3A;

use crate::Head;
use crate::tissue::Nodes;

/// A point is pushed by so much of its way out, by more than all of it: what is drawn follows less than vertices do,
/// and one pass has to be enough.
const PUSH: f32 = 1.45;
/// So little an overlap counts as touching, mm: lips that meet at rest do not press.
const SLOP_MM: f32 = 0.02;
/// What is deeper than this in the other lip got there another way, mm.
const DEEPEST_MM: f32 = 4.0;
/// Lips are worked out as they are drawn where by their nodes they are nearer than this, mm.
const NEAR_MM: f32 = 0.5;
/// And farther than this above the one and below the other they are not, mm.
const AWAY_MM: f32 = 1.0;
/// Nothing lies between these heights.
const NOWHERE: [f32; 2] = [f32::MAX, f32::MIN];
/// The row whose columns are cut in the middle.
const MIDDLE: usize = ROWS / 2;
/// Segments flatter than this in depth are passed over, mm.
const FLAT_MM: f32 = 1e-3;

/// Both lips.
#[derive(Clone, Debug)]
pub(super) struct Lips {
    /// Upper and lower; none where a vertex of them does not move.
    pair: Option<[Profile; 2]>,
    /// Blocks of columns that may touch, then those that do.
    near: Vec<bool>,
    /// Per lane: between which heights they may touch.
    zones: Vec<[f32; 2]>,
}

impl Lips {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let (upper, lower) = (&head.lips.upper, &head.lips.lower);
        let rest = &head.skin.mesh.positions;
        let pair = (upper.len() == lower.len() && upper.len() > 2)
            .then(|| {
                Some([
                    Profile::new(upper, limit, rest)?,
                    Profile::new(lower, limit, rest)?,
                ])
            })
            .flatten();
        let blocks = pair.as_ref().map_or(0, |[upper, _]| upper.blocks());
        Self {
            pair,
            near: vec![false; blocks],
            zones: vec![NOWHERE; blocks * LANES],
        }
    }

    /// Slows lips that would overlap after `step_s`.
    pub(super) fn brake(&mut self, skin: &mut Nodes, step_s: f32) {
        if self.touch(skin, step_s) {
            self.carry(&mut skin.velocity);
        }
    }

    /// Pushes lips apart that overlap.
    pub(super) fn push(&mut self, skin: &mut Nodes) {
        if self.touch(skin, 0.0) {
            self.carry(&mut skin.place);
        }
    }

    /// Adds up what keeps lips apart: pushes, or, with a time that they are to move for, brakes; whether there is any.
    fn touch(&mut self, skin: &Nodes, step_s: f32) -> bool {
        let Some([upper, lower]) = &mut self.pair else {
            return false;
        };
        if !find_near(&mut self.near, &mut self.zones, upper, lower, skin, step_s) {
            return false;
        }
        draw(&self.near, &self.zones, upper, skin);
        draw(&self.near, &self.zones, lower, skin);
        for (block, near) in self.near.iter_mut().enumerate() {
            *near = *near && press(upper, lower, block, step_s);
        }
        self.near.contains(&true)
    }

    fn carry(&mut self, nodes: &mut [Vec3A]) {
        for lip in self.pair.iter_mut().flatten() {
            lip.carry(&self.near, nodes);
        }
    }
}

/// Finds the blocks whose lips may touch; whether there is one.
fn find_near(
    near: &mut [bool],
    zones: &mut [[f32; 2]],
    upper: &Profile,
    lower: &Profile,
    skin: &Nodes,
    step_s: f32,
) -> bool {
    near.fill(false);
    // The corners are one: only what lies between them is pushed.
    for column in 1..upper.columns - 1 {
        let [low, high] = upper.bounds(column, skin, step_s);
        let [lowest, highest] = lower.bounds(column, skin, step_s);
        zones[column] = [low.y - AWAY_MM, highest.y + AWAY_MM];
        if highest.y + NEAR_MM > low.y && highest.z + NEAR_MM > low.z && lowest.z < high.z + NEAR_MM
        {
            near[column / LANES] = true;
        }
    }
    near.contains(&true)
}

/// Draws the blocks that are near, and the columns beside them.
fn draw(near: &[bool], zones: &[[f32; 2]], lip: &mut Profile, skin: &Nodes) {
    for (block, _) in near.iter().enumerate().filter(|(_, near)| **near) {
        let first = block * LANES;
        for (lane, zone) in zones[first..first + LANES].iter().enumerate() {
            lip.draw(first + lane, *zone, skin);
        }
    }
    for (block, _) in near.iter().enumerate().filter(|(_, near)| !**near) {
        let beside = |other: Option<&bool>| other.copied().unwrap_or(false);
        if beside(block.checked_sub(1).and_then(|b| near.get(b))) {
            lip.draw(block * LANES, NOWHERE, skin);
        }
        if beside(near.get(block + 1)) {
            lip.draw((block + 1) * LANES - 1, NOWHERE, skin);
        }
    }
    for block in 0..near.len() {
        let beside = block > 0 && near[block - 1] || near.get(block + 1).is_some_and(|n| *n);
        if near[block] || beside {
            lip.bow(block);
        }
    }
}

/// Segments that are looked at together, and sets of them for all rows.
const TOGETHER: usize = 4;
const SETS: usize = (ROWS - 1).div_ceil(TOGETHER);

/// The upper lip's segments in a block, cut.
struct Segments {
    at: Cut,
    /// Time that the lips are to move for, s.
    step_s: f32,
    /// From one end to the other, and what is worked out of it once.
    ey: [Lane; ROWS - 1],
    ez: [Lane; ROWS - 1],
    per_ez: [Lane; ROWS - 1],
    per: [Lane; ROWS - 1],
    /// Of all four columns: least heights, least and greatest depths.
    low: [Lane; SETS],
    back: [Lane; SETS],
    front: [Lane; SETS],
}

impl Segments {
    fn new(at: Cut, speed: [[Lane; ROWS]; 2], step_s: f32) -> Self {
        let none = [Lane::ZERO; ROWS - 1];
        let far = [Lane::MAX; SETS];
        let mut all = Self {
            at,
            step_s,
            ey: none,
            ez: none,
            per_ez: none,
            per: none,
            low: far,
            back: far,
            front: [Lane::MIN; SETS],
        };
        let (y, z) = (&at.y, &at.z);
        for s in 0..ROWS - 1 {
            let (ey, ez) = (y[s + 1] - y[s], z[s + 1] - z[s]);
            let deep = ez.abs().cmpgt(Lane::splat(FLAT_MM));
            // Nothing lies over what is flat: no number is.
            all.per_ez[s] = Lane::select(deep, ez.recip(), Lane::NAN);
            all.per[s] = (ey * ey + ez * ez)
                .max(Lane::splat(FLAT_MM * FLAT_MM))
                .recip();
            (all.ey[s], all.ez[s]) = (ey, ez);
            let (set, i) = (s / TOGETHER, s % TOGETHER);
            let low = |s: usize| y[s].min(y[s] + speed[0][s] * step_s);
            all.low[set].as_mut()[i] = low(s).min(low(s + 1)).min_element();
            all.back[set].as_mut()[i] = z[s].min(z[s + 1]).min_element();
            all.front[set].as_mut()[i] = z[s].max(z[s + 1]).max_element();
        }
        all
    }

    /// Bits of the segments that points may lie over that are so high and between these depths.
    #[inline]
    fn near(&self, high: f32, back: f32, front: f32) -> u32 {
        let (high, back, front) = (Lane::splat(high), Lane::splat(back), Lane::splat(front));
        (0..SETS).fold(0, |bits, set| {
            let near = self.low[set].cmplt(high)
                & self.back[set].cmple(front)
                & self.front[set].cmpge(back);
            bits | near.bitmask() << (set * TOGETHER)
        })
    }
}

/// Adds up what pushes the lower lip's points of a block out of the upper lip's segments; whether anything
/// does.
fn press(upper: &mut Profile, lower: &mut Profile, block: usize, step_s: f32) -> bool {
    let mut touched = false;
    let columns = upper.columns;
    // The corners are one: only what lies between them is pushed; lanes past the end neither.
    let own = Lane::from_array(std::array::from_fn(|lane| {
        let column = block * LANES + lane;
        f32::from(u8::from(column > 0 && column + 1 < columns))
    }));
    let x = (upper.at.x[block][MIDDLE] + lower.at.x[block][MIDDLE]) * 0.5;
    let (mut above, mut below) = (upper.cut(block, x), lower.cut(block, x));
    // Columns lie behind each other along the arch: each against its own.
    let base = above.z[MIDDLE];
    for z in above.z.iter_mut().chain(&mut below.z) {
        *z -= base;
    }
    let segments = Segments::new(above, [upper.speed.y[block], upper.speed.z[block]], step_s);
    for r in 0..ROWS {
        let (y, z) = (below.y[r], below.z[r]);
        let high = y.max(y + lower.speed.y[block][r] * step_s);
        let near = segments.near(high.max_element(), z.min_element(), z.max_element());
        for s in bits(near) {
            touched |= segment(&segments, [y, z], upper, lower, block, [r, s], own);
        }
    }
    touched
}

/// Adds up what pushes one row of points out of one row of segments; whether anything does.
#[inline]
fn segment(
    segments: &Segments,
    [py, pz]: [Lane; 2],
    upper: &mut Profile,
    lower: &mut Profile,
    block: usize,
    [r, s]: [usize; 2],
    own: Lane,
) -> bool {
    let (ey, ez, per) = (segments.ey[s], segments.ez[s], segments.per[s]);
    let t = (pz - segments.at.z[s]) * segments.per_ez[s];
    let over = py - segments.at.y[s] - ey * t - Lane::splat(SLOP_MM);
    let over_it = t.cmpge(Lane::ZERO) & t.cmplt(Lane::ONE);
    let t = Lane::select(over_it, t, Lane::ZERO);
    let speed = |v: &[Lane; ROWS]| v[s] + (v[s + 1] - v[s]) * t;
    let vy = lower.speed.y[block][r] - speed(&upper.speed.y[block]);
    let vz = lower.speed.z[block][r] - speed(&upper.speed.z[block]);
    // Over the segment's length: the way out along its normal, and the speed that brings the lips together.
    let f = over * ez * per;
    let k = (vy * ez - vz * ey) * per;
    let step_s = segments.step_s;
    let meet = ((f + k * step_s) * ez).cmpgt(Lane::ZERO);
    let deepest = Lane::splat(DEEPEST_MM * DEEPEST_MM);
    let inside = over_it & meet & (over * f * ez).cmplt(deepest);
    if !inside.any() {
        return false;
    }
    // No rebound: a brake leaves the speed that brings them together, and none that takes them apart.
    let apart = over.cmple(Lane::ZERO);
    let change = if step_s > 0.0 {
        let brake = Lane::select(apart, k + f / step_s, k);
        Lane::select((brake * ez).cmpgt(Lane::ZERO), brake, Lane::ZERO)
    } else {
        f * PUSH
    };
    let m = Lane::select(inside, own, Lane::ZERO);
    let half = 0.5 * m * Lane::select(inside, change, Lane::ZERO);
    let change = [half * ez, -half * ey];
    lower.change.y[block][r] -= change[0];
    lower.change.z[block][r] -= change[1];
    lower.weight[block][r] += m;
    let share = t * m;
    for (s, share) in [(s, m - share), (s + 1, share)] {
        upper.change.y[block][s] += share * change[0];
        upper.change.z[block][s] += share * change[1];
        upper.weight[block][s] += share;
    }
    true
}
