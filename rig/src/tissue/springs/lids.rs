//! What turns the lids over the eyes: springs from their nodes to where the lid's control puts them.

use glam::{Vec3A, vec3a};

use crate::tissue::anatomy::LID;
use crate::tissue::{Drive, Numbering};
use crate::{Control, Head, Muscle};

/// The lids aim past each other by this factor, since the skin round them holds them back.
const OVERSHOOT: f32 = 1.22;
/// A lid's hold less than this holds nothing to speak of (it counts with its square).
const LEAST: f32 = 0.05;
/// How much of the gaze's turn the upper lid follows.
const FOLLOW: f32 = 0.55;

/// A node of a lid.
#[derive(Clone, Copy, Debug)]
struct Margin {
    node: u32,
    left: bool,
    /// From the eye's centre to the node at rest, mm.
    out: Vec3A,
    /// The same, a quarter turn about the x axis on, and with what of it turns.
    on: Vec3A,
    turning: Vec3A,
    /// The eye's centre, mm.
    centre: Vec3A,
    stiffness: f32,
    /// By how much it turns to close, rad, and with the gaze, per rad.
    turn: f32,
    follow: f32,
}

/// All lids of a head.
#[derive(Clone, Debug)]
pub(super) struct Lids(Vec<Margin>);

impl Lids {
    pub(super) fn new(head: &Head, numbering: &Numbering) -> Self {
        let margin = |lid: &crate::Lid| {
            let eye = &head.eyes[usize::from(!lid.left)];
            let rest = head.skin.mesh.positions[lid.vertex as usize];
            let out = Vec3A::from(rest - eye.centre);
            Some(Margin {
                node: numbering.moving(lid.vertex)?,
                left: lid.left,
                out,
                on: vec3a(0.0, -out.z, out.y),
                turning: vec3a(0.0, out.y, out.z),
                centre: eye.centre.into(),
                stiffness: LID * lid.hold * lid.hold,
                turn: lid.turn * OVERSHOOT,
                // Only the upper lid follows the gaze.
                follow: if lid.turn < 0.0 {
                    FOLLOW * lid.hold
                } else {
                    0.0
                },
            })
        };
        let held = |lid: &&crate::Lid| lid.hold > LEAST;
        Self(head.lids.iter().filter(held).filter_map(margin).collect())
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Each node's place to go to and the stiffness with which, told to `pull` by node.
    pub(super) fn pull(&self, drive: &Drive<'_>, mut pull: impl FnMut(usize, Vec3A, f32)) {
        let gaze = drive.state[Control::GazePitch];
        let closed = |left: bool| {
            let lid = drive.state[if left { Control::LidL } else { Control::LidR }];
            // The orbicularis oculi's part in the lids closes what they have left open.
            let muscle = drive
                .state
                .contraction(Muscle::OrbicularisOculiPalpebral, left)
                * drive.muscle_stiffness.min(1.0);
            1.0 - (1.0 - lid) * (1.0 - muscle)
        };
        let closed = [closed(false), closed(true)];
        for margin in &self.0 {
            let closed = closed[usize::from(margin.left)];
            let turn = margin.turn * closed + margin.follow * (1.0 - closed) * gaze;
            let (s, c) = sin_cos(-turn);
            let target = margin.centre + margin.out + margin.turning * (c - 1.0) + margin.on * s;
            pull(margin.node as usize, target, margin.stiffness);
        }
    }
}

/// Sine and cosine of what a lid turns by (within 1.4 rad, to 1e-6): their series, which needs no call.
fn sin_cos(x: f32) -> (f32, f32) {
    let q = x * x;
    let s = x * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
    let c =
        1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
    (s, c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_close_enough() {
        for i in -140..=140 {
            let x = i as f32 / 100.0;
            let (s, c) = sin_cos(x);
            assert!(
                (s - x.sin()).abs() < 2e-6 && (c - x.cos()).abs() < 2e-6,
                "{x}"
            );
        }
    }
}
