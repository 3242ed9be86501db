//! Skin as a mass-spring mesh on muscles and skull (HEADSHOP 4.2, HABER 5.3): the default model.
//!
//! Edges of the skin mesh are springs; every vertex has springs to the bone under it (skull or
//! mandible, by a share), those near a muscle have springs to its fibres, those at the lids to the
//! lids. Integrated by Verlet leapfrog with damping per mass.

use glam::{Quat, Vec3A};

use super::anatomy::{Attachment, EDGE, LID, attach, bone_stiffness, mandible_share, sides};
use super::{Drive, Nodes, Numbering, Tissue};
use crate::simulation::STEP_S;
use crate::{Control, Head, Muscle};

/// Damping per mass, 1/s: a little over critical for a vertex on its muscle.
const DAMPING: f32 = 420.0;
/// Share of its stiffness that a skin edge keeps when it is pressed together: skin goes slack rather
/// than buckle.
const SLACK: f32 = 0.12;
/// The lids aim past each other by this factor, since the skin round them holds them back.
const LID_OVERSHOOT: f32 = 1.22;

/// The springs of a head, and the skin's nodes.
#[derive(Clone, Debug)]
pub(crate) struct Springs {
    movable: usize,
    nodes: Nodes,
    rest: Vec<Vec3A>,
    force: Vec<Vec3A>,
    edges: Vec<[u32; 2]>,
    rest_mm: Vec<f32>,
    /// Per movable vertex: stiffness to the bone, skull and mandible together.
    bone: Vec<f32>,
    /// Vertices that the mandible takes along, with its share of that stiffness.
    jawed: Vec<(u32, f32)>,
    /// By fibre, and where each fibre's start among them.
    attachments: Vec<Attachment>,
    fibres: Vec<u32>,
    /// `(simulated vertex, index into Head::lids, stiffness)`.
    lids: Vec<(u32, u32, f32)>,
}

impl Springs {
    pub(crate) fn new(head: &Head, numbering: &Numbering) -> Self {
        let rest = numbering.of(&head.skin.mesh.positions);
        let reference = numbering.of(&head.skin.reference);
        let side = numbering.of(&sides(head));
        let movable = numbering.movable;
        let mut lid_hold = vec![0.0_f32; head.skin.mesh.positions.len()];
        for lid in &head.lids {
            lid_hold[lid.vertex as usize] = lid.hold;
        }
        let lid_hold = numbering.of(&lid_hold);
        let mut attachments: Vec<Attachment> = (0..movable)
            .flat_map(|i| attach(head, i, rest[i], side[i], lid_hold[i]))
            .collect();
        attachments.sort_by_key(|a| a.fibre);
        let fibres = (0..=head.fibres.len() as u32)
            .map(|k| attachments.partition_point(|a| a.fibre < k) as u32)
            .collect();
        let lids = (0..)
            .zip(&head.lids)
            .filter_map(|(k, lid)| {
                let node = numbering.moving(lid.vertex)?;
                Some((node, k, LID * lid.hold * lid.hold))
            })
            .collect();
        let bone: Vec<f32> = (0..movable)
            .map(|i| bone_stiffness(reference[i], side[i]))
            .collect();
        let jawed = (0..movable)
            .map(|i| (i as u32, bone[i] * mandible_share(reference[i], side[i])))
            .filter(|(_, stiffness)| *stiffness > 0.0)
            .collect();
        Self {
            movable,
            nodes: Nodes::at(&rest),
            force: vec![Vec3A::ZERO; rest.len()],
            rest_mm: numbering
                .edges
                .iter()
                .map(|[a, b]| rest[*a as usize].distance(rest[*b as usize]))
                .collect(),
            rest: rest.into_iter().map(Vec3A::from).collect(),
            edges: numbering.edges.clone(),
            bone,
            jawed,
            attachments,
            fibres,
            lids,
        }
    }

    /// Forces of the springs to bone, muscles and lids.
    fn pull(&mut self, drive: &Drive<'_>) {
        self.force.fill(Vec3A::ZERO);
        for i in 0..self.movable {
            self.force[i] = (self.rest[i] - self.nodes.place[i]) * self.bone[i];
        }
        for &(i, stiffness) in &self.jawed {
            let rest = self.rest[i as usize];
            self.force[i as usize] += (drive.mandible.transform_point3a(rest) - rest) * stiffness;
        }
        let scale = drive.muscle_stiffness;
        for (k, range) in self.fibres.windows(2).enumerate() {
            if !drive.muscles.moved(k) && scale == 1.0 {
                for a in &self.attachments[range[0] as usize..range[1] as usize] {
                    let i = a.vertex as usize;
                    self.force[i] += (self.rest[i] - self.nodes.place[i]) * a.stiffness;
                }
                continue;
            }
            let start = drive.muscles.starts()[k];
            for a in &self.attachments[range[0] as usize..range[1] as usize] {
                let i = a.vertex as usize;
                let j = start + a.point as usize;
                let shift = drive.muscles.shift()[j].lerp(drive.muscles.shift()[j + 1], a.share);
                self.force[i] +=
                    (self.rest[i] + shift - self.nodes.place[i]) * (a.stiffness * scale);
            }
        }
        for &(i, k, stiffness) in &self.lids {
            let lid = drive.head.lids[k as usize];
            let (eye, closed) = if lid.left {
                (&drive.head.eyes[0], drive.state[Control::LidL])
            } else {
                (&drive.head.eyes[1], drive.state[Control::LidR])
            };
            // The orbicularis oculi's part in the lids closes what they have left open.
            let muscle = drive
                .state
                .contraction(Muscle::OrbicularisOculiPalpebral, lid.left)
                * scale.min(1.0);
            let closed = 1.0 - (1.0 - closed) * (1.0 - muscle);
            // The upper lid follows the gaze down and up.
            let follow = if lid.turn < 0.0 {
                0.55 * lid.hold * (1.0 - closed)
            } else {
                0.0
            };
            let gaze = follow * drive.state[Control::GazePitch];
            let turn = Quat::from_rotation_x(-(lid.turn * closed * LID_OVERSHOOT + gaze));
            let i = i as usize;
            let centre = Vec3A::from(eye.centre);
            let target = centre + turn.mul_vec3a(self.rest[i] - centre);
            self.force[i] += (target - self.nodes.place[i]) * stiffness;
        }
    }

    /// Forces of the skin's own springs.
    fn stretch(&mut self) {
        for ([a, b], rest_mm) in self.edges.iter().zip(&self.rest_mm) {
            let (a, b) = (*a as usize, *b as usize);
            let d = self.nodes.place[b] - self.nodes.place[a];
            let strain = 1.0 - rest_mm / d.length_squared().max(1e-8).sqrt();
            let pull = d * (EDGE * strain.max(SLACK * strain));
            self.force[a] += pull;
            self.force[b] -= pull;
        }
    }

    /// Leapfrog: velocities at the half step, then positions; the rim stays.
    fn integrate(&mut self) {
        let damp = (-DAMPING * STEP_S).exp();
        for i in 0..self.movable {
            let velocity = (self.nodes.velocity[i] + self.force[i] * STEP_S) * damp;
            self.nodes.velocity[i] = velocity;
            self.nodes.place[i] += velocity * STEP_S;
        }
    }
}

impl Tissue for Springs {
    fn step(&mut self, drive: &Drive<'_>) {
        self.pull(drive);
        self.stretch();
        self.integrate();
    }

    fn skin(&self) -> &Nodes {
        &self.nodes
    }

    fn skin_mut(&mut self) -> &mut Nodes {
        &mut self.nodes
    }

    fn inner(&self) -> Option<&Nodes> {
        None
    }

    fn inner_mut(&mut self) -> Option<&mut Nodes> {
        None
    }

    fn reset_inner(&mut self) {}

    fn spring_count(&self) -> usize {
        self.edges.len() + self.movable + self.attachments.len() + self.lids.len()
    }
}
