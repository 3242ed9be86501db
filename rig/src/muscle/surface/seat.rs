//! How a sheet lies on bone and under its neighbours: worked out at rest by rays, once, and in a pose as far
//! as the skull would come through it.

use super::shape::{HIDDEN_MM, along};
use super::sheet::{Middle, Sheet};
use crate::anatomy::Rays;
use glam::Vec3;

/// Bone is looked for from this far over the sheet to that far under it, mm.
const OVER_MM: f32 = 6.0;
const UNDER_MM: f32 = 15.0;
/// The same over a sheet that has moved: a chord under tension cuts that deep into a forehead.
const OVER_MOVED_MM: f32 = 12.0;
/// Share of what it would take to be wholly clear of bone: the edges of a sheet may sink in.
const OVERCOME: f32 = 0.8;
/// Rounds of smoothing how a sheet lies on bone.
const SMOOTHING: usize = 12;
const SMOOTHING_MOVED: usize = 3;

impl Sheet {
    /// How far the grid comes out at rest: so far that its outer half is clear of bone, or, below 0, so deep
    /// as it is seated on bone or lies under its neighbours.
    pub(super) fn lifts(&self, middle: &Middle, bones: &Rays) -> Vec<f32> {
        let clear = self.over_bone(middle, bones, OVER_MM);
        let raw: Vec<f32> = (0..clear.len())
            .map(|k| {
                let u = self.end_place(k / self.across);
                let sink = along(self.shape.sink, u);
                match clear[k] {
                    Some(clear) if clear > -sink && sink < HIDDEN_MM => clear,
                    Some(clear) if clear < -sink => {
                        -sink + (clear + sink) * along(self.shape.seat, u)
                    }
                    _ => -sink,
                }
            })
            .collect();
        // Over the whole sheet smooth: bone has edges, muscle bridges them.
        let floor: Vec<f32> = raw
            .iter()
            .map(|r| if *r > 0.0 { OVERCOME * r } else { f32::MIN })
            .collect();
        let mut lift = raw;
        for _ in 0..SMOOTHING {
            lift = self.smoothed(&lift, &floor);
        }
        lift
    }

    /// The same in a pose: what tension has drawn straight still goes round the skull.
    pub(super) fn lifts_now(&self, points: &[Vec3], skull: &Rays) -> Vec<f32> {
        let middle = self.middle(points, 1.0);
        let mut lift: Vec<f32> = self
            .over_bone(&middle, skull, OVER_MOVED_MM)
            .into_iter()
            .zip(&self.lift)
            .enumerate()
            .map(|(k, (clear, at_rest))| {
                let hidden = along(self.shape.sink, self.end_place(k / self.across)) >= HIDDEN_MM;
                match clear {
                    Some(clear) if !hidden => at_rest.max(OVERCOME * clear),
                    _ => *at_rest,
                }
            })
            .collect();
        let floor = lift.clone();
        for _ in 0..SMOOTHING_MOVED {
            lift = self.smoothed(&lift, &floor);
        }
        lift
    }

    /// Each place of the grid drawn half-way to its neighbours, but not below a floor.
    fn smoothed(&self, lift: &[f32], floor: &[f32]) -> Vec<f32> {
        (0..lift.len())
            .map(|k| {
                let (ring, j) = (k / self.across, k % self.across);
                let (before, after) = self.neighbours(ring);
                let at = |ring: usize, j: usize| lift[ring * self.across + j];
                let sum = at(before, j)
                    + at(after, j)
                    + at(ring, j.saturating_sub(1))
                    + at(ring, (j + 1).min(self.across - 1));
                (0.5 * at(ring, j) + 0.125 * sum).max(floor[k])
            })
            .collect()
    }

    /// How far each place of the grid would have to move out to lie on the bone, less below it than half of
    /// the flesh; where there is no bone under it, as its neighbours do.
    fn over_bone(&self, middle: &Middle, bones: &Rays, over: f32) -> Vec<Option<f32>> {
        let mut clear: Vec<Option<f32>> = (0..middle.places.len())
            .map(|k| {
                let (p, n) = (middle.places[k], middle.normals[k]);
                let half = self.half_thickness(k / self.across, middle.across[k]);
                let free = bones.free(p + n * over, -n, over + UNDER_MM);
                (free < over + UNDER_MM).then_some(over - free + 0.4 * half)
            })
            .collect();
        for _ in 0..self.rings {
            if clear.iter().all(Option::is_some) {
                break;
            }
            clear = (0..clear.len())
                .map(|k| {
                    let (ring, j) = (k / self.across, k % self.across);
                    let (before, after) = self.neighbours(ring);
                    let beside = [
                        (before, j),
                        (after, j),
                        (ring, j.saturating_sub(1)),
                        (ring, (j + 1).min(self.across - 1)),
                    ];
                    let known = beside
                        .iter()
                        .filter_map(|(ring, j)| clear[ring * self.across + j]);
                    let (sum, count) = known.fold((0.0, 0), |(s, n), v| (s + v, n + 1));
                    // Bone that ends does not draw up what goes on beyond it.
                    clear[k].or((count > 0).then(|| (sum / count as f32).min(0.0)))
                })
                .collect();
        }
        clear
    }
}
