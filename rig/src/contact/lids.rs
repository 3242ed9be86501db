//! Lids slide over the eyeballs: what a lid carries is drawn outside the ball and its cornea, which turns with the
//! gaze.

use glam::{Quat, Vec3A};

use super::drawn::{Drawn, Limit};
use crate::simulation::STEP_S;
use crate::tissue::Nodes;
use crate::{Control, Controls, Eye, Head};

/// Passes of pushing, until nothing is inside.
const PASSES: usize = 3;
/// Lids keep this far from the ball, mm: the surface between points that are looked at bows less.
const CLEARANCE_MM: f32 = 0.15;
/// A point nearer than this by its rest is worked out as it is drawn, mm.
const NEAR_MM: f32 = 0.4;
/// The cornea's form is kept where the cosine of the angle to the gaze is at least this, in so many steps.
const LEAST_COSINE: f32 = 0.8;
const STEPS: usize = 64;
/// Nearer to the centre than this, mm, nothing has a direction.
const CENTRE_MM: f32 = 1.0;

/// Both eyes, left first.
#[derive(Clone, Debug)]
pub(super) struct Lids {
    eyes: [Ball; 2],
}

/// One eyeball and the vertices near it.
#[derive(Clone, Debug)]
struct Ball {
    centre: Vec3A,
    /// Radius by the cosine of the angle to the gaze, from [`LEAST_COSINE`] to 1.
    radius: [f32; STEPS + 1],
    /// Node, and from there to where it is drawn at rest.
    points: Vec<(u32, Vec3A)>,
    drawn: Drawn,
}

impl Lids {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let ball = |left: bool| {
            let eye = head.eyes[usize::from(!left)];
            let mut ball = Ball {
                centre: eye.centre.into(),
                radius: form(head, eye, if left { "eye_l" } else { "eye_r" }),
                points: Vec::new(),
                drawn: Drawn::default(),
            };
            let rest = &head.skin.mesh.positions;
            for lid in head.lids.iter().filter(|lid| lid.left == left) {
                if let Some(node) = limit.numbering().moving(lid.vertex) {
                    let drawn = limit.at(lid.vertex, rest) - rest[lid.vertex as usize];
                    ball.points.push((node, drawn.into()));
                    ball.drawn.push(limit, lid.vertex, node);
                }
            }
            ball
        };
        Self {
            eyes: [ball(true), ball(false)],
        }
    }

    pub(super) fn resolve(&self, skin: &mut Nodes, state: &Controls) {
        let gaze = Quat::from_rotation_y(state[Control::GazeYaw])
            * Quat::from_rotation_x(-state[Control::GazePitch]);
        let axis = gaze * Vec3A::Z;
        for ball in &self.eyes {
            ball.hold(skin, axis);
        }
    }
}

impl Ball {
    fn hold(&self, skin: &mut Nodes, axis: Vec3A) {
        for _ in 0..PASSES {
            let mut touched = false;
            for (i, &(node, drawn)) in self.points.iter().enumerate() {
                let node = node as usize;
                let about = skin.place[node] + drawn - self.centre;
                if self.depth(about, axis) < -NEAR_MM {
                    continue;
                }
                let out = self.drawn.at(i, &skin.place) - self.centre;
                let depth = self.depth(out, axis) + CLEARANCE_MM;
                let distance = out.length();
                if depth <= 0.0 || distance < CENTRE_MM {
                    continue;
                }
                touched = true;
                let normal = out / distance;
                skin.place[node] += normal * depth;
                // Only the speed that brought it there goes: no rebound, and what is pressed lies still.
                let inwards = skin.velocity[node].dot(normal).min(0.0);
                let inwards = inwards.max(-depth / STEP_S);
                skin.velocity[node] -= normal * inwards;
            }
            if !touched {
                break;
            }
        }
    }

    /// How deep a point lies in the ball, from its centre; below 0 outside.
    #[inline]
    fn depth(&self, out: Vec3A, axis: Vec3A) -> f32 {
        let distance = out.length();
        let cosine = out.dot(axis) / distance.max(CENTRE_MM);
        let step = (cosine - LEAST_COSINE) * (STEPS as f32 / (1.0 - LEAST_COSINE));
        let step = step.clamp(0.0, STEPS as f32);
        let i = (step as usize).min(STEPS - 1);
        let (a, b) = (self.radius[i], self.radius[i + 1]);
        a + (b - a) * (step - i as f32) - distance
    }
}

/// An eyeball's radius by the cosine of the angle to its gaze, as the part has it.
fn form(head: &Head, eye: Eye, name: &str) -> [f32; STEPS + 1] {
    let positions = head.part(name).map_or(&[][..], |p| &p.mesh.positions);
    let mut places: Vec<(f32, f32)> = positions
        .iter()
        .map(|p| *p - eye.centre)
        .map(|out| (out.z / out.length().max(CENTRE_MM), out.length()))
        .filter(|(cosine, _)| *cosine > 0.5)
        .collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    std::array::from_fn(|i| {
        let cosine = LEAST_COSINE + (1.0 - LEAST_COSINE) * i as f32 / STEPS as f32;
        let next = places.partition_point(|p| p.0 < cosine);
        let ends = (
            next.checked_sub(1).and_then(|i| places.get(i)),
            places.get(next),
        );
        let radius = match ends {
            (Some(a), Some(b)) => {
                let share = (cosine - a.0) / (b.0 - a.0).max(1e-6);
                a.1 + (b.1 - a.1) * share
            }
            (Some(one), None) | (None, Some(one)) => one.1,
            (None, None) => eye.radius,
        };
        radius.max(eye.radius)
    })
}
