//! Skin as a mass-spring mesh on muscles and skull (HEADSHOP 4.2, HABER 5.3): the default model.
//!
//! - Edges of the skin mesh are springs. Pressed together they go slack rather than buckle.
//! - Every node has a spring to the bone under it (skull or mandible, by a share), in two phases as LEE 4
//!   has its dermal-fatty springs, and the bone stops it; a node near muscles has springs to their fibres, one
//!   on a lid a spring to the lid.
//! - The cheeks keep their volume (see `cheeks`).
//!
//! All of it are forces in one set of equations of motion, integrated by Verlet leapfrog with damping
//! per mass. All nodes have the same mass, but at the mouth's corners: on a mesh graded to 1 mm at the lips, masses by
//! area would force steps five times shorter. Nodes outside the face are fixed (`anatomy::moves`).
//!
//! | module | holds |
//! |---|---|
//! | `ring` | neighbours in their order round a node |
//! | `lids` | what turns the lids |
//! | `energy` | the energy of it all, for tests |
//! | `places` | the places on fibres that skin is held at |
//! | `pass` | the edges alone, for measuring |
//! | `simd` | the passes over all springs |

mod energy;
mod lids;
mod pass;
mod places;
mod ring;
mod simd;

use glam::{Affine3A, Vec3A};

use super::anatomy::{EDGE, bone_depth, bone_stiffness, heavier, mandible_share, sides};
use super::cheeks::{Cheek, cheeks};
use super::holds::{Attachment, attachments};
use super::{Drive, Nodes, Numbering, Tissue};
use crate::{Control, Head};
use lids::Lids;
pub use pass::SpringPass;
use places::Places;
pub use simd::Isa;
use simd::{Ground, Hold, Kick, Mesh};

/// Damping per mass, 1/s: what lets skin lag less than 10 ms behind a fast lip, and still not ring.
const DAMPING: f32 = 125.0;
/// Share of its stiffness that a skin edge keeps when it is pressed together.
const SLACK: f32 = 0.12;
/// Strain within which it goes from the one to the other. A kink there would feed energy into the
/// fastest modes, step by step: all edges are at it at rest.
const BLEND: f32 = 0.1;
/// What the spring to the bone gains in its second phase, and where that begins: at a share of the
/// tissue's depth over a least way, mm.
const FIRM: f32 = 2_400.0;
const SLIP_MM: f32 = 9.0;
const SLIP_PER_DEPTH: f32 = 0.5;
/// Of the bone that stops a node, and the share of the tissue's depth that it may be pressed by.
const STOP: f32 = 36_000.0;
const YIELD: f32 = 0.85;
/// Of a cheek's volume, 1/s² and per mm².
const VOLUME: f32 = 30_000.0;

/// The springs of a head, and the skin's nodes.
#[derive(Clone, Debug)]
pub(crate) struct Springs {
    isa: Isa,
    movable: usize,
    /// Padded to whole blocks by nodes that nothing moves.
    nodes: Nodes,
    mesh: Mesh,
    places: Places,
    lids: Lids,
    cheeks: [Cheek; 2],
    /// How a cheek's volume changes with its nodes.
    gradient: Vec<Vec3A>,
    /// Which of them is whose, by cheek.
    gradients: [Vec<u32>; 2],
    /// What the stiffnesses are multiplied by: they are given for the default mass.
    per_mass: f32,
    springs: usize,
}

impl Springs {
    pub(crate) fn new(head: &Head, numbering: &Numbering) -> Self {
        let rest = numbering.of(&head.skin.mesh.positions);
        let reference = numbering.of(&head.skin.reference);
        let side = numbering.of(&sides(head));
        let depth = bone_depth(head, &rest[..numbering.movable]);
        let ground: Vec<Ground> = (0..numbering.movable)
            .map(|i| {
                let (inwards, depth_mm) = depth[i];
                Ground {
                    heavier: heavier(reference[i]),
                    rest: rest[i],
                    soft: bone_stiffness(reference[i], side[i]),
                    firm: FIRM,
                    slip_mm: SLIP_MM + SLIP_PER_DEPTH * depth_mm,
                    normal: -inwards,
                    gap_mm: YIELD * depth_mm,
                    share: mandible_share(reference[i], side[i]),
                }
            })
            .collect();
        let mut starts = vec![0];
        for fibre in &head.fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len() as u32);
        }
        let attachments = attachments(head, numbering);
        let at = |a: &Attachment| (starts[a.fibre as usize] + a.point, a.share);
        let places = Places::new(attachments.iter().map(at), &starts);
        let holds: Vec<Hold> = attachments
            .iter()
            .map(|a| {
                let (point, share) = at(a);
                Hold {
                    node: a.vertex,
                    fibre: a.fibre,
                    place: places.number(point, share),
                    stiffness: a.stiffness,
                }
            })
            .collect();
        let cheeks = cheeks(head, numbering, &depth);
        let mut counted: Vec<[u32; 3]> = cheeks
            .iter()
            .flat_map(|c| c.triangles.iter().copied())
            .collect();
        counted.sort_unstable();
        let length = |a: u32, b: u32| rest[a as usize].distance(rest[b as usize]);
        let neighbours = ring::rings(numbering, length, &counted);
        let mesh = Mesh::new(&ground, &neighbours, &holds, rest.len(), places.len());
        let lids = Lids::new(head, numbering);
        let mut nodes = Nodes::at(&rest);
        nodes.place.resize(mesh.nodes(), Vec3A::ZERO);
        nodes.velocity.resize(mesh.nodes(), Vec3A::ZERO);
        Self {
            isa: Isa::best(),
            movable: numbering.movable,
            gradient: vec![Vec3A::ZERO; mesh.gradients()],
            gradients: cheeks.each_ref().map(|cheek| {
                let of = |i: &u32| mesh.gradient_of(*i as usize).map(|g| g as u32);
                cheek.nodes.iter().filter_map(of).collect()
            }),
            springs: numbering.edges.len() + ground.len() + holds.len() + lids.len(),
            per_mass: head.tissue.stiffness_scale(),
            nodes,
            mesh,
            places,
            lids,
            cheeks,
        }
    }

    fn kick(&self, drive: &Drive<'_>) -> Kick {
        let mut carry = drive.mandible;
        carry.matrix3 -= Affine3A::IDENTITY.matrix3;
        // Half of the damping before the forces, half after: then the step's length does not tell in how it damps.
        let half = 0.5 * DAMPING * drive.damping * drive.step_s;
        Kick {
            step: drive.step_s * self.per_mass / (1.0 - half),
            keep: (1.0 - half) / (1.0 + half),
            edge: EDGE,
            slack: SLACK,
            blend: BLEND,
            bone: STOP,
            muscle: drive.muscle_stiffness,
            carry,
            moved: drive.muscles.moved_bits(),
        }
    }

    /// Velocities half a step after the places: the first half of a step.
    fn accelerate(&mut self, drive: &Drive<'_>) {
        let kick = self.kick(drive);
        self.places.follow(drive.muscles);
        simd::kick(
            self.isa,
            &self.mesh,
            &mut self.nodes,
            self.places.shift(),
            &mut self.gradient,
            &kick,
        );
        let Nodes { place, velocity } = &mut self.nodes;
        let mesh = &self.mesh;
        self.lids.pull(drive, |i, target, stiffness| {
            let speed = stiffness * kick.step * kick.keep * mesh.light(i);
            velocity[i] += (target - place[i]) * speed;
        });
        if drive.volume > 0.0 {
            self.press(drive, &kick);
        }
    }

    /// Presses the cheeks back to their volume.
    fn press(&mut self, drive: &Drive<'_>, kick: &Kick) {
        let jaw = drive.state[Control::Jaw];
        for (cheek, at) in self.cheeks.iter().zip(&self.gradients) {
            // Three times the cones over the skin: each triangle is met at its three corners.
            let mut skin = 0.0;
            for (&i, &g) in cheek.nodes.iter().zip(at) {
                skin += self.nodes.place[i as usize].dot(self.gradient[g as usize]);
            }
            let (mesh, gradient) = (&self.mesh, &mut self.gradient);
            let walls = cheek.walls(&self.nodes, &drive.mandible, |node, change| {
                if let Some(g) = mesh.gradient_of(node as usize) {
                    gradient[g] += change;
                }
            });
            let volume = skin / 3.0 + walls + cheek.of_bone(jaw);
            let excess = (volume - cheek.rest) / cheek.rest.max(1.0);
            let push = -VOLUME * drive.volume * excess * kick.step * kick.keep;
            for (&i, &g) in cheek.nodes.iter().zip(at) {
                let i = i as usize;
                self.nodes.velocity[i] += self.gradient[g as usize] * (push * self.mesh.light(i));
            }
        }
    }
}

impl Tissue for Springs {
    fn step(&mut self, drive: &Drive<'_>, meet: &mut dyn FnMut(&mut Nodes, f32)) {
        self.accelerate(drive);
        meet(&mut self.nodes, drive.step_s);
        simd::drift(self.isa, &mut self.nodes, drive.step_s);
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
        self.springs
    }

    fn energy(&self, drive: &Drive<'_>) -> Option<f64> {
        Some(self.energy_now(drive))
    }

    fn bytes(&self) -> usize {
        2 * size_of_val(&*self.nodes.place) + self.mesh.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_is_seen_from_both_its_ends() {
        let head = Head::reference().unwrap();
        let numbering = Numbering::new(&head);
        let springs = Springs::new(&head, &numbering);
        let mut seen = Vec::new();
        springs.mesh.each_node(|i, node| {
            seen.extend(node.edges.iter().map(|(j, rest)| (i, *j, rest.to_bits())));
        });
        seen.sort_unstable();
        let count = seen.len();
        seen.dedup();
        assert_eq!(seen.len(), count, "no edge counts twice");
        for &(i, j, rest) in &seen {
            let back = seen.binary_search(&(j, i, rest)).is_ok();
            assert!(
                back || j >= numbering.movable,
                "{i} to {j} is not seen from there"
            );
        }
        let within = numbering
            .edges
            .iter()
            .filter(|e| (e[1] as usize) < numbering.movable);
        let within = within.count();
        assert_eq!(count, numbering.edges.len() + within, "all edges are there");
    }
}
