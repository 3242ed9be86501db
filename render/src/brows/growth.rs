//! How a brow's hairs lie on the skin's chart: where each has its root and which way it runs. At the nose they stand
//! up and are few; in the body those below rise and those above are combed down until they meet in a line; the tail
//! lies along the arch and thins out. The head shop paints the same brow beneath them (`rig/shop/src/colour/brows.rs`).

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use crate::maps::hairline::line;
use crate::maps::noise::Dice;
use crate::maps::ramp;

/// Tries at a hair in one brow: some fall where a brow is sparse. As few as look like a brow over the painted one.
const TRIES: usize = 320;

/// A hair on the chart, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hair {
    /// Root, middle and tip.
    pub(super) places: [Vec2; 3],
    /// How thick it is against others.
    pub(super) thick: f32,
    /// How far its tip stands off the skin, mm.
    pub(super) off: f32,
    /// Dark or pale, and what its cover is rounded with: 0..1.
    pub(super) tone: f32,
    pub(super) chance: f32,
}

/// The lines between which a brow grows, from the nose outwards, mm.
#[derive(Clone, Debug)]
pub(super) struct Bed {
    lower: Vec<Vec2>,
    upper: Vec<Vec2>,
}

impl Bed {
    /// That of a side (`l`, `r`); none where the head has no such lines.
    pub(super) fn of(head: &Head, side: &str) -> Option<Self> {
        let named = |which| line(head, &format!("brow_{which}_{side}"));
        Some(Self {
            lower: named("lower")?,
            upper: named("upper")?,
        })
    }

    /// The place `along` 0 at the nose .. 1 at the temple, `across` 0 at the lower .. 1 at the upper line.
    pub(super) fn at(&self, along: f32, across: f32) -> Vec2 {
        at_share(&self.lower, along).lerp(at_share(&self.upper, along), across)
    }

    /// The hairs of this brow where `grows(along, root)` lets them, 0..1.
    pub(super) fn hairs(&self, seed: u64, grows: impl Fn(f32, Vec2) -> f32) -> Vec<Hair> {
        let mut dice = Dice::new(seed);
        (0..TRIES)
            .filter_map(|i| self.hair((i as f32 + dice.roll()) / TRIES as f32, &mut dice, &grows))
            .collect()
    }

    fn hair(&self, along: f32, dice: &mut Dice, grows: impl Fn(f32, Vec2) -> f32) -> Option<Hair> {
        let along = 0.97 * along;
        // Dense in the middle, some strays; tips reach beyond the roots.
        let stray = if dice.roll() < 0.06 { 1.0 } else { 0.74 };
        let across = 0.44 + 0.60 * stray * dice.spread();
        // The head of the brow fades in, the tail out.
        let dense = ramp(-0.06, 0.16, along) * ramp(1.06, 0.62, along);
        let root = self.at(along, across);
        let wanted = (0.25 + 0.75 * dense) * grows(along, root);
        let [kept, length, wild, bow, thick, off, tone, chance] =
            std::array::from_fn(|_| dice.roll());
        if kept > wanted {
            return None;
        }
        let step = (along + 0.05).min(1.0);
        let ahead = (self.at(step, across) - root).normalize_or_zero();
        if ahead == Vec2::ZERO {
            return None;
        }
        // Up is -y. What stands at the nose leans outwards a little and bends over.
        let standing = ramp(0.30, 0.0, along);
        let meeting = 1.15 * (0.50 - across) * ramp(0.02, 0.22, along) * ramp(1.0, 0.5, along);
        let rise = 2.2 * standing + meeting + 0.36 * (wild - 0.5) + 0.10;
        let from = (ahead + vec2(0.0, -rise)).normalize_or(ahead);
        let bent = rise * (0.25 + 0.15 * standing) - 0.12 - 0.2 * (bow - 0.5);
        let to = (ahead + vec2(0.0, -bent)).normalize_or(ahead);
        let length = (5.0 + 4.0 * length)
            * (0.62 + 0.38 * dense)
            * (1.0 - 0.30 * standing)
            * (0.6 + 0.4 * ramp(1.0, 0.8, along));
        let middle = root + from * (0.48 * length);
        let tip = middle + (from * 0.35 + to * 0.65).normalize_or(to) * (0.52 * length);
        Some(Hair {
            places: [root, middle, tip],
            thick: (0.75 + 0.5 * thick) * (0.8 + 0.2 * dense),
            off: 0.35 + 0.75 * off + 0.5 * standing,
            tone,
            chance,
        })
    }
}

/// The point at a share of a line's length.
fn at_share(points: &[Vec2], share: f32) -> Vec2 {
    let total: f32 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = total * share.clamp(0.0, 1.0);
    for w in points.windows(2) {
        let step = w[0].distance(w[1]);
        if left <= step {
            return w[0].lerp(w[1], left / step.max(1e-9));
        }
        left -= step;
    }
    points.last().copied().unwrap_or(Vec2::ZERO)
}
