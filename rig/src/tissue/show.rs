//! The default model's springs as lines, to be drawn (`still --show springs`): the skin's edges, and
//! where each node of the skin hangs on bone and on fibres. Made anew from what the model is made from, so
//! that its own layout in memory is nobody else's business.

use glam::Vec3;

use super::Numbering;
use super::anatomy::{bone_depth, mandible_share, sides};
use super::holds::attachments;
use crate::anatomy::{SpringKind, SpringLine};
use crate::muscle::{Muscles, carried};
use crate::{Control, Head, KeyFrame};

/// All springs of `head` in the pose of `frame`, but those to the lids.
pub(crate) fn spring_lines(head: &Head, frame: &KeyFrame) -> Vec<SpringLine> {
    if frame.skin.len() != head.skin.mesh.positions.len() {
        return Vec::new();
    }
    let numbering = Numbering::new(head);
    let rest = numbering.of(&head.skin.mesh.positions);
    let now = numbering.of(&frame.skin);
    let mut lines = Vec::new();
    let mut add = |kind, [a0, b0]: [Vec3; 2], [a, b]: [Vec3; 2]| {
        let strain = a.distance(b) / a0.distance(b0).max(0.1) - 1.0;
        lines.push(SpringLine { a, b, strain, kind });
    };
    for edge in &numbering.edges {
        let ends = edge.map(|i| i as usize);
        add(
            SpringKind::Skin,
            ends.map(|i| rest[i]),
            ends.map(|i| now[i]),
        );
    }

    let mandible = head.mandible(frame.state[Control::Jaw]);
    let mut muscles = Muscles::new(head);
    let fibres_rest = muscles.points().to_vec();
    muscles.contract(head, &frame.state, &mandible);
    let reference = numbering.of(&head.skin.reference);
    let side = numbering.of(&sides(head));
    let depth = bone_depth(head, &rest[..numbering.movable]);
    for (i, (inwards, depth)) in depth.into_iter().enumerate() {
        let bone = rest[i] + inwards * depth;
        let share = mandible_share(reference[i], side[i]);
        let at = carried(bone, share, &mandible);
        add(SpringKind::Bone, [rest[i], bone], [now[i], at]);
    }
    for hold in attachments(head, &numbering) {
        let i = hold.vertex as usize;
        let k = muscles.starts()[hold.fibre as usize] + hold.point as usize;
        let on = |points: &[Vec3]| points[k].lerp(points[k + 1], hold.share);
        let ends = [now[i], on(muscles.points())];
        add(SpringKind::Muscle, [rest[i], on(&fibres_rest)], ends);
    }
    lines
}
