//! Contact: lips stop each other, lips stay in front of the teeth, lids stay outside the eyeballs.
//!
//! Resolved on positions after each step (and on velocities with them, without rebound), for the surface
//! as it is drawn: each vertex is taken to be drawn where it is at rest, beside itself. Lips are
//! compared column by column: both lips' columns were built over one another, and the muscles move
//! them sideways together.

use glam::{Affine3A, Vec3, Vec3A, vec3};

use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::CREST;
use crate::tissue::Tissue;
use crate::{Eye, Head, Placement};

/// Levels of a lip's column that can touch the other lip.
const TOUCHING: std::ops::RangeInclusive<usize> = CREST..=LIP_LEVELS - 1;
/// Passes over all columns, and the share of an overlap that one removes.
const PASSES: usize = 2;
const PASS_SHARE: f32 = 0.5;
/// So little an overlap counts as touching, mm: lips that meet at rest do not press.
const SLOP_MM: f32 = 0.02;
/// Skin keeps this far from the teeth, and lids from the eyeballs, mm.
const TEETH_CLEARANCE_MM: f32 = 0.4;
const EYE_CLEARANCE_MM: f32 = 0.05;

/// The contacts of one head, by simulated vertex numbers.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    /// Pairs of columns: upper and lower lip.
    columns: Vec<([u32; LIP_LEVELS], [u32; LIP_LEVELS])>,
    /// Vertices near each eye: left, right.
    lids: [Vec<u32>; 2],
    eyes: [Eye; 2],
    bite: Placement,
    /// Per vertex that moves: from it to where it is drawn at rest.
    drawn: Vec<Vec3A>,
}

/// The skin's state that contact corrects.
pub(crate) struct Bodies<'a> {
    pub position: &'a mut [Vec3A],
    pub velocity: &'a mut [Vec3A],
}

impl Contact {
    /// The contacts among the vertices of `head` that move.
    pub(crate) fn new(head: &Head, tissue: &Tissue) -> Self {
        let column = |skin: &[u32; LIP_LEVELS]| {
            let mut moving = [0; LIP_LEVELS];
            for (number, &vertex) in moving.iter_mut().zip(skin) {
                *number = tissue.moving(vertex)?;
            }
            Some(moving)
        };
        let columns = head
            .lips
            .upper
            .iter()
            .zip(&head.lips.lower)
            .skip(1)
            .take(head.lips.upper.len().saturating_sub(2))
            .filter_map(|(upper, lower)| Some((column(upper)?, column(lower)?)))
            .collect();
        let mut lids = [Vec::new(), Vec::new()];
        for lid in &head.lids {
            lids[usize::from(!lid.left)].extend(tissue.moving(lid.vertex));
        }
        let rest = &head.skin.mesh.positions;
        let drawn = head.drawn_rest();
        let drawn = tissue.vertices[..tissue.movable]
            .iter()
            .map(|&v| Vec3A::from(drawn[v as usize] - rest[v as usize]))
            .collect();
        Self {
            drawn,
            columns,
            lids,
            eyes: head.eyes,
            bite: head.bite,
        }
    }

    /// Resolves everything; `lips` is false while calibrating, where targets past contact count.
    pub(crate) fn resolve(&self, skin: &mut Bodies<'_>, mandible: &Affine3A, lips: bool) {
        if lips {
            self.lips(skin);
        }
        self.teeth(skin, mandible);
        self.eyeballs(skin);
    }

    fn lips(&self, skin: &mut Bodies<'_>) {
        for pass in 0..PASSES {
            for (upper, lower) in &self.columns {
                // Alternate who is tested against whom, so that neither lip wins.
                for turn in 0..2 {
                    if (turn + pass) % 2 == 0 {
                        self.press(skin, lower, upper, 1.0);
                    } else {
                        self.press(skin, upper, lower, -1.0);
                    }
                }
            }
        }
    }

    /// Keeps the inner side of the lips in front of both rows of teeth.
    fn teeth(&self, skin: &mut Bodies<'_>, mandible: &Affine3A) {
        let unjawed = mandible.inverse();
        for (upper, lower) in &self.columns {
            for &i in upper[CREST + 1..].iter().chain(&lower[CREST + 1..]) {
                let i = i as usize;
                let p = skin.position[i] + self.drawn[i];
                // The arches are described where they stand on the reference head.
                let q = self.bite.reference(p.into());
                let up = in_front(q, UPPER_EDGE_Y, 14.0, UPPER_FRONT_Z);
                let q = self.bite.reference(unjawed.transform_point3(p.into()));
                let low = in_front(q, LOWER_EDGE_Y - 14.0, 14.0, LOWER_FRONT_Z);
                let push = up.max(low) * self.bite.scale.z;
                if push > 0.0 {
                    skin.position[i].z += push;
                    skin.velocity[i].z = skin.velocity[i].z.max(0.0);
                }
            }
        }
    }

    fn eyeballs(&self, skin: &mut Bodies<'_>) {
        for (list, eye) in self.lids.iter().zip(&self.eyes) {
            let centre = Vec3A::from(eye.centre);
            let least = eye.radius + EYE_CLEARANCE_MM;
            for &i in list {
                let i = i as usize;
                let out = skin.position[i] + self.drawn[i] - centre;
                let distance = out.length();
                if distance < least && distance > 1.0 {
                    let normal = out / distance;
                    skin.position[i] = centre + normal * least - self.drawn[i];
                    let inwards = skin.velocity[i].dot(normal).min(0.0);
                    skin.velocity[i] -= normal * inwards;
                }
            }
        }
    }

    /// Pushes each touching vertex of `a` out of the chain `b`; `sense` is 1 where `a` lies below `b`.
    fn press(
        &self,
        skin: &mut Bodies<'_>,
        a: &[u32; LIP_LEVELS],
        b: &[u32; LIP_LEVELS],
        sense: f32,
    ) {
        for &i in &a[TOUCHING] {
            let i = i as usize;
            for w in b[TOUCHING].windows(2) {
                let (j, k) = (w[0] as usize, w[1] as usize);
                let [p, q, r] = [i, j, k].map(|v| skin.position[v] + self.drawn[v]);
                let (high, low) = (q.z.max(r.z), q.z.min(r.z));
                if p.z > high || p.z < low || high - low < 1e-3 {
                    continue;
                }
                let share = ((p.z - q.z) / (r.z - q.z)).clamp(0.0, 1.0);
                let overlap = sense * (p.y - (q.y + (r.y - q.y) * share));
                if overlap <= SLOP_MM || overlap > 12.0 {
                    continue;
                }
                let shift = sense * (overlap - SLOP_MM) * PASS_SHARE;
                skin.position[i].y -= shift;
                skin.position[j].y += shift * (1.0 - share);
                skin.position[k].y += shift * share;
                // No rebound: both sides take the mean of their vertical speeds if they approach.
                let other = skin.velocity[j].y * (1.0 - share) + skin.velocity[k].y * share;
                let approach = sense * (skin.velocity[i].y - other);
                if approach > 0.0 {
                    let half = 0.5 * sense * approach;
                    skin.velocity[i].y -= half;
                    skin.velocity[j].y += half * (1.0 - share);
                    skin.velocity[k].y += half * share;
                }
            }
        }
    }
}

/// Heights of the biting edges and how far forward the incisors' fronts stand, mm at rest.
pub(crate) const UPPER_EDGE_Y: f32 = -35.3;
const LOWER_EDGE_Y: f32 = -34.0;
const UPPER_FRONT_Z: f32 = 106.6;
const LOWER_FRONT_Z: f32 = 103.6;

/// Front of the upper incisors' biting edge at `x`.
pub(crate) fn upper_edge(x: f32) -> Vec3 {
    vec3(x, UPPER_EDGE_Y, UPPER_FRONT_Z - setback(x))
}

/// How far the arch recedes at `x` from the mid line.
fn setback(x: f32) -> f32 {
    8.5 * (x / 17.0).powi(2)
}

/// How deep a point lies behind the front of a row of teeth that starts at `bottom`.
fn in_front(p: Vec3, bottom: f32, height: f32, front: f32) -> f32 {
    // Only the front teeth: further back the cheek lies well outside the arch.
    let inside = p.x.abs() < 18.0 && (0.0..height).contains(&(p.y - bottom));
    if inside {
        front + TEETH_CLEARANCE_MM - setback(p.x) - p.z
    } else {
        0.0
    }
}
