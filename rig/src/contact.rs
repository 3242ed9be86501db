//! Contact: lips stop each other, lips stay in front of the teeth, lids stay outside the eyeballs.
//!
//! Resolved on positions after each step (and on velocities with them, without rebound), for the surface
//! as it is drawn: each vertex is taken to be drawn where it is at rest, beside itself. Lips are
//! compared column by column: both lips' columns were built over one another, and the muscles move
//! them sideways together.

use glam::{Affine3A, Vec3, Vec3A, vec3};

use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::CREST;
use crate::tissue::{Nodes, Numbering};
use crate::{Eye, Head, Placement};

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
    columns: Vec<[Column; 2]>,
    /// Vertices near each eye: left, right.
    lids: [Vec<u32>; 2],
    eyes: [Eye; 2],
    bite: Placement,
    /// Per vertex that moves: from it to where it is drawn at rest.
    drawn: Vec<Vec3A>,
}

/// What of a lip's column can touch, from the crest inwards: each vertex once, though levels may share it.
#[derive(Clone, Copy, Debug)]
struct Column {
    vertices: [u32; LIP_LEVELS],
    count: usize,
}

impl Column {
    /// Of the vertices that move; none where one does not.
    fn new(levels: &[u32; LIP_LEVELS], numbering: &Numbering) -> Option<Self> {
        let (mut vertices, mut count) = ([0; LIP_LEVELS], 0);
        for &vertex in &levels[CREST..] {
            let moving = numbering.moving(vertex)?;
            if count == 0 || vertices[count - 1] != moving {
                vertices[count] = moving;
                count += 1;
            }
        }
        Some(Self { vertices, count })
    }

    fn get(&self) -> &[u32] {
        &self.vertices[..self.count]
    }
}

/// A column's heights, depths and vertical speeds where it is drawn: what lips that press change and look at.
#[derive(Clone, Copy)]
struct Chain {
    y: [f32; LIP_LEVELS],
    z: [f32; LIP_LEVELS],
    speed: [f32; LIP_LEVELS],
    count: usize,
}

impl Contact {
    /// The contacts among the vertices of `head` that move.
    pub(crate) fn new(head: &Head, numbering: &Numbering) -> Self {
        let columns = head
            .lips
            .upper
            .iter()
            .zip(&head.lips.lower)
            .skip(1)
            .take(head.lips.upper.len().saturating_sub(2))
            .filter_map(|(upper, lower)| {
                Some([
                    Column::new(upper, numbering)?,
                    Column::new(lower, numbering)?,
                ])
            })
            .collect();
        let mut lids = [Vec::new(), Vec::new()];
        for lid in &head.lids {
            lids[usize::from(!lid.left)].extend(numbering.moving(lid.vertex));
        }
        let rest = &head.skin.mesh.positions;
        let drawn = head.drawn_rest();
        let drawn = numbering.vertices[..numbering.movable]
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
    pub(crate) fn resolve(&self, skin: &mut Nodes, mandible: &Affine3A, lips: bool) {
        if lips {
            self.lips(skin);
        }
        self.teeth(skin, mandible);
        self.eyeballs(skin);
    }

    fn lips(&self, skin: &mut Nodes) {
        for pass in 0..PASSES {
            for [upper, lower] in &self.columns {
                let (mut high, mut low) = (self.chain(skin, upper), self.chain(skin, lower));
                let least = high.y[..high.count]
                    .iter()
                    .copied()
                    .fold(f32::MAX, f32::min);
                let most = low.y[..low.count].iter().copied().fold(f32::MIN, f32::max);
                if least > most {
                    continue;
                }
                // Alternate who is tested against whom, so that neither lip wins.
                let mut touched = false;
                for turn in 0..2 {
                    touched |= if (turn + pass) % 2 == 0 {
                        press(&mut low, &mut high, 1.0)
                    } else {
                        press(&mut high, &mut low, -1.0)
                    };
                }
                if touched {
                    self.put(skin, upper, &high);
                    self.put(skin, lower, &low);
                }
            }
        }
    }

    fn chain(&self, skin: &Nodes, column: &Column) -> Chain {
        let mut chain = Chain {
            y: [0.0; LIP_LEVELS],
            z: [0.0; LIP_LEVELS],
            speed: [0.0; LIP_LEVELS],
            count: column.count,
        };
        for (i, &v) in column.get().iter().enumerate() {
            let v = v as usize;
            let place = skin.place[v] + self.drawn[v];
            (chain.y[i], chain.z[i], chain.speed[i]) = (place.y, place.z, skin.velocity[v].y);
        }
        chain
    }

    fn put(&self, skin: &mut Nodes, column: &Column, chain: &Chain) {
        for (i, &v) in column.get().iter().enumerate() {
            let v = v as usize;
            skin.place[v].y = chain.y[i] - self.drawn[v].y;
            skin.velocity[v].y = chain.speed[i];
        }
    }

    /// Keeps the inner side of the lips in front of both rows of teeth.
    fn teeth(&self, skin: &mut Nodes, mandible: &Affine3A) {
        let unjawed = mandible.inverse();
        for [upper, lower] in &self.columns {
            for &i in upper.get()[1..].iter().chain(&lower.get()[1..]) {
                let i = i as usize;
                let p = skin.place[i] + self.drawn[i];
                // The arches are described where they stand on the reference head.
                let q = self.bite.reference(p.into());
                let up = in_front(q, UPPER_EDGE_Y, 14.0, UPPER_FRONT_Z);
                let q = self.bite.reference(unjawed.transform_point3(p.into()));
                let low = in_front(q, LOWER_EDGE_Y - 14.0, 14.0, LOWER_FRONT_Z);
                let push = up.max(low) * self.bite.scale.z;
                if push > 0.0 {
                    skin.place[i].z += push;
                    skin.velocity[i].z = skin.velocity[i].z.max(0.0);
                }
            }
        }
    }

    fn eyeballs(&self, skin: &mut Nodes) {
        for (list, eye) in self.lids.iter().zip(&self.eyes) {
            let centre = Vec3A::from(eye.centre);
            let least = eye.radius + EYE_CLEARANCE_MM;
            for &i in list {
                let i = i as usize;
                let out = skin.place[i] + self.drawn[i] - centre;
                let distance = out.length();
                if distance < least && distance > 1.0 {
                    let normal = out / distance;
                    skin.place[i] = centre + normal * least - self.drawn[i];
                    let velocity = skin.velocity[i];
                    let inwards = velocity.dot(normal).min(0.0);
                    skin.velocity[i] = velocity - normal * inwards;
                }
            }
        }
    }
}

/// Pushes each vertex of `a` out of the chain `b`; `sense` is 1 where `a` lies below `b`. Says whether any was inside.
fn press(a: &mut Chain, b: &mut Chain, sense: f32) -> bool {
    let mut touched = false;
    for i in 0..a.count {
        for j in 0..b.count.saturating_sub(1) {
            let k = j + 1;
            let (high, low) = (b.z[j].max(b.z[k]), b.z[j].min(b.z[k]));
            if a.z[i] > high || a.z[i] < low || high - low < 1e-3 {
                continue;
            }
            let share = ((a.z[i] - b.z[j]) / (b.z[k] - b.z[j])).clamp(0.0, 1.0);
            let overlap = sense * (a.y[i] - (b.y[j] + (b.y[k] - b.y[j]) * share));
            if overlap <= SLOP_MM || overlap > 12.0 {
                continue;
            }
            touched = true;
            let shift = sense * (overlap - SLOP_MM) * PASS_SHARE;
            a.y[i] -= shift;
            b.y[j] += shift * (1.0 - share);
            b.y[k] += shift * share;
            // No rebound: both sides take the mean of their vertical speeds if they approach.
            let other = b.speed[j] * (1.0 - share) + b.speed[k] * share;
            let approach = sense * (a.speed[i] - other);
            if approach > 0.0 {
                let half = 0.5 * sense * approach;
                a.speed[i] -= half;
                b.speed[j] += half * (1.0 - share);
                b.speed[k] += half * share;
            }
        }
    }
    touched
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
