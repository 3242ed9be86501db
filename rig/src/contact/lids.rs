//! Lids slide over the eyeballs: what a lid carries is drawn outside the ball and its cornea, which turns with the
//! gaze.

use glam::{Quat, Vec3A, Vec4};

use super::drawn::{Drawn, Limit};
use super::four::{FOUR, Four, List, Places, bits};
use crate::tissue::Nodes;
use crate::{Control, Controls, Eye, Head};

/// Passes of pushing, until nothing is inside.
const PASSES: usize = 3;
/// Lids keep this far from the ball, mm: the surface between points that are looked at bows less.
const CLEARANCE_MM: f32 = 0.15;
/// What was no deeper than this, mm, is not looked at again in the same step.
const DONE_MM: f32 = 0.02;
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
    /// Squares of the distances within which a point may be nearer than [`NEAR_MM`]: over the cornea, and elsewhere.
    reach: [f32; 2],
    /// Points by their nodes, from the centre.
    fours: Vec<Four>,
    /// A row and a node a point.
    drawn: Drawn,
    nodes: Vec<u32>,
    /// Points that are near, then those that the pass before was not done with.
    near: List,
}

impl Lids {
    pub(super) fn new(head: &Head, limit: &Limit<'_>) -> Self {
        let ball = |left: bool| {
            let eye = head.eyes[usize::from(!left)];
            let (mut points, mut drawn) = (Vec::new(), Drawn::default());
            let rest = &head.skin.mesh.positions;
            for lid in head.lids.iter().filter(|lid| lid.left == left) {
                if let Some(node) = limit.numbering().moving(lid.vertex) {
                    let at = limit.at(lid.vertex, rest) - rest[lid.vertex as usize];
                    points.push((node, at - eye.centre));
                    drawn.push(limit, lid.vertex, node);
                }
            }
            let radius = form(head, eye, if left { "eye_l" } else { "eye_r" });
            let most = radius.iter().fold(0.0, |most: f32, r| most.max(*r));
            Ball {
                centre: eye.centre.into(),
                reach: [most, radius[0]].map(|r| (r + NEAR_MM) * (r + NEAR_MM)),
                radius,
                fours: Four::all(&points),
                near: List::with_room(points.len()),
                nodes: points.iter().map(|(node, _)| *node).collect(),
                drawn,
            }
        };
        Self {
            eyes: [ball(true), ball(false)],
        }
    }

    pub(super) fn resolve(&mut self, skin: &mut Nodes, state: &Controls, step_s: f32) {
        let gaze = Quat::from_rotation_y(state[Control::GazeYaw])
            * Quat::from_rotation_x(-state[Control::GazePitch]);
        let axis = gaze * Vec3A::Z;
        for ball in &mut self.eyes {
            ball.hold(skin, axis, step_s);
        }
    }
}

impl Ball {
    fn hold(&mut self, skin: &mut Nodes, axis: Vec3A, step_s: f32) {
        self.near.clear();
        for (i, four) in self.fours.iter().enumerate() {
            let at = four.at(&skin.place);
            for lane in bits(self.near(&at, axis) & four.some) {
                self.near.push(i * FOUR + lane);
            }
        }
        // All are pushed outwards: what was free stays free.
        let mut near = std::mem::take(&mut self.near);
        for _ in 0..PASSES {
            near.keep(|points, some| self.push(points, some, skin, axis, step_s));
        }
        self.near = near;
    }

    /// Bits of the points that may be near the ball, from its centre.
    #[inline]
    fn near(&self, at: &Places, axis: Vec3A) -> u32 {
        let square = at.x * at.x + at.y * at.y + at.z * at.z;
        let along = at.x * axis.x + at.y * axis.y + at.z * axis.z;
        let ahead = along.max(Vec4::ZERO);
        let ahead = (ahead * ahead).cmpge(square * (LEAST_COSINE * LEAST_COSINE));
        let [cornea, ball] = self.reach.map(Vec4::splat);
        let near = square.cmplt(Vec4::select(ahead, cornea, ball)).bitmask();
        if near == 0 {
            return 0;
        }
        let distance = square.to_array().map(f32::sqrt);
        let cosine = (along / Vec4::from_array(distance).max(Vec4::splat(CENTRE_MM))).to_array();
        bits(near).fold(0, |near, lane| {
            let close = distance[lane] - self.radius(cosine[lane]) < NEAR_MM;
            near | u32::from(close) << lane
        })
    }

    /// Pushes points out of the ball, each for itself; bits of those that were so deep that they are to be looked
    /// at again.
    #[inline]
    fn push(
        &self,
        points: [usize; FOUR],
        some: u32,
        skin: &mut Nodes,
        axis: Vec3A,
        step_s: f32,
    ) -> u32 {
        let drawn = points.map(|point| self.drawn.at(point, &skin.place) - self.centre);
        let out = Places::new(drawn);
        let square = out.x * out.x + out.y * out.y + out.z * out.z;
        let along = out.x * axis.x + out.y * axis.y + out.z * axis.z;
        let distance = Vec4::from_array(square.to_array().map(f32::sqrt));
        let per = distance.max(Vec4::splat(CENTRE_MM)).recip();
        let cosine = (along * per).to_array();
        let radius = Vec4::from_array(cosine.map(|cosine| self.radius(cosine)));
        let depth = radius + Vec4::splat(CLEARANCE_MM) - distance;
        let inside = depth.cmpgt(Vec4::ZERO) & distance.cmpgt(Vec4::splat(CENTRE_MM));
        let (per, depths) = (per.to_array(), depth.to_array());
        let inside = inside.bitmask() & some;
        for lane in bits(inside) {
            let (node, depth) = (self.nodes[points[lane]] as usize, depths[lane]);
            let normal = drawn[lane] * per[lane];
            skin.place[node] += normal * depth;
            // Only the speed that brought it there goes: no rebound, and what is pressed lies still.
            let inwards = skin.velocity[node].dot(normal).min(0.0);
            skin.velocity[node] -= normal * inwards.max(-depth / step_s);
        }
        inside & depth.cmpgt(Vec4::splat(DONE_MM)).bitmask()
    }

    /// The ball's radius, cornea included, by the cosine of the angle to the gaze.
    #[inline]
    fn radius(&self, cosine: f32) -> f32 {
        let step = (cosine - LEAST_COSINE) * (STEPS as f32 / (1.0 - LEAST_COSINE));
        let step = step.clamp(0.0, STEPS as f32);
        let i = (step as i32 as usize).min(STEPS - 1);
        let (a, b) = (self.radius[i], self.radius[i + 1]);
        a + (b - a) * (step - i as i32 as f32)
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
