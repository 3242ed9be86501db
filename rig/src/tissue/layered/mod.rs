//! Skin in layers (LEE 4 to 8): epidermis, fascia and skull in triangular prisms, muscles in the fascia.
//!
//! | module | holds |
//! |---|---|
//! | `layers` | where fascia and skull lie under the skin |
//! | `law` | how strongly a spring pulls: biphasic, with the penalty for compression |
//! | `springs` | the springs of all layers |
//! | `volume` | prisms that keep their volume |
//! | `vectors` | LEE's 26 muscle vectors and their profiles |
//! | `own` | muscles that he lacks: the orbicularis oris first of all |
//! | `strength` | how strongly each muscle pulls |
//!
//! What LEE leaves open, and what was chosen so that a face answers within some 50 ms and moves about as
//! far as with the default model:
//! - Masses: skin and fascia of a column have each a third of the head's mass per vertex (`TissueRecord`,
//!   [`LIGHTNESS`]); all stiffnesses are per mass. Where a node's springs are too stiff for the step, it counts as heavier,
//!   just so much that the step is stable ([`INERTIA`]): that slows only what vibrates faster than some 200 times a
//!   second, and changes nothing of where things come to rest. No controls can make it fly apart.
//! - Step: a part of the whole simulation's ([`PARTS`]). Semi-implicit Euler, half of the damping before
//!   the forces and half after. (LEE calls his explicit, but places take the new velocity there too, which is this;
//!   damping differs.)
//! - Damping: [`DAMPING`] for all nodes, on the velocity against the skull.
//! - Units: one of the stiffness table is 1500 mm/s² (`springs`); `k1`, `k2`: `volume`; forces: `strength`.
//!   The lightness multiplies them all.
//! - Cheeks: LEE's volume force, which acts on skin and prism by prism, lets a full smile change them by 5 %; each is
//!   held as a whole too, as in the default model ([`CHEEK`]).
//! - Restoring force `h`: fascia nodes to their places at rest on skull or mandible (by the default model's
//!   share), softly on cheeks and lips and firmly on nose and hairline, as that model's springs to bone; skin
//!   nodes to their place over the fascia, since springs alone would let thin columns stay upside down.
//! - The skull's constraint acts where the fascia has come near the bone; LEE's formula, which has no such
//!   condition, would keep fascia from ever being pressed.
//! - Crossed springs between skin and fascia: LEE leaves them out, his own source has them (`springs`).
//!
//! Lids are carried as in the default model: no layers of skin close an eye. Their columns are loose
//! (`springs`), for both of a lid's sides are skin and lie within a millimetre.

mod law;
mod layers;
mod own;
mod springs;
mod strength;
#[cfg(test)]
mod tests;
mod vectors;
mod volume;

use glam::{Quat, Vec3, Vec3A, Vec4};

use self::layers::Layers;
use self::own::Ring;
use self::springs::Springs;
use self::vectors::Actuator;
use self::volume::Prisms;
use super::anatomy::{LID, bone_depth, bone_stiffness, mandible_share, sides};
use super::cheeks::{Cheek, cheeks};
use super::{Drive, Nodes, Numbering, Tissue};
use crate::simulation::STEP_S;
use crate::{Control, Head, Muscle};

/// How much lighter than a vertex of the default model its skin and its fascia are. All that pulls is per mass: this
/// changes no place of rest, only how soon it is reached, and lets a lip be less than 10 ms behind its muscles.
const LIGHTNESS: f32 = 3.0;
/// Force per mass and velocity, 1/s: a third of what is critical for a column on its restoring force alone.
const DAMPING: f32 = 90.0;
/// What holds a cheek's volume, 1/s² and per mm².
const CHEEK: f32 = 120_000.0;
/// Restoring force of the fascia, 1/s²: everywhere, and its part of the default model's springs to bone.
const RESTORE_SOFT: f32 = 13_500.0;
const RESTORE_BONE: f32 = 0.6;
/// The same of the skin to its place over its fascia, 1/s².
const RESTORE_OVER: f32 = 10_000.0;
/// A lid's column is held at least so firmly, 1/s²: where the lid itself holds it less, at rest.
const LID_LEAST: f32 = 15_000.0;
/// A node counts as heavier by this share of its springs' stiffness times the square of a whole step's part. A quarter of
/// twice the sum (Gershgorin's bound of what vibrates) would do for springs; prisms want more, or the wings of the nose
/// never come to rest again. When steps are cut shorter, to see what that changes, masses stay: it is the same face.
const INERTIA: f32 = 0.6;
/// Nothing in a face is faster, mm/s: lips close with some 300.
const FASTEST_MM_S: f32 = 2_000.0;
/// Parts that a step of the simulation is cut into: 960 a second.
const PARTS: u32 = 4;
/// No node goes farther from where bones carry it, mm: full smiles move the cheek by 15.
const FARTHEST_MM: f32 = 17.0;
/// The fascia comes no nearer to the bone than this share of its distance at rest.
const CLEARANCE: f32 = 0.15;
/// The lids aim past each other by this factor, since the skin round them holds them back.
const LID_OVERSHOOT: f32 = 1.22;
/// Columns of lids and lips, more than this, turn with them: they have no upright of their own.
const TURNS: f32 = 0.15;

/// A column that a lid carries.
#[derive(Clone, Copy, Debug)]
struct LidHold {
    node: u32,
    /// Of `Head::lids`.
    lid: u32,
    /// Per mass, of skin and of fascia.
    stiffness: f32,
}

/// A column on bone that the mandible takes along.
#[derive(Clone, Copy, Debug)]
struct Jawed {
    node: u32,
    share: f32,
}

/// The layered tissue of a head.
#[derive(Clone, Debug)]
pub(crate) struct Layered {
    movable: usize,
    skin: Nodes,
    fascia: Nodes,
    /// Columns as the springs read them, the rim that stays included; the same at rest.
    place: Vec<[Vec4; 2]>,
    force: Vec<[Vec4; 2]>,
    rest: Vec<[Vec4; 2]>,
    /// Skull nodes and the fascia's home, at rest and now.
    skull_rest: Vec<Vec4>,
    skull: Vec<Vec4>,
    home: Vec<Vec4>,
    /// Outwards, and how far the fascia must stay away from its skull node; 0 on lids.
    out: Vec<Vec4>,
    clearance: Vec<f32>,
    restore: Vec<f32>,
    over: f32,
    jawed: Vec<Jawed>,
    lids: Vec<LidHold>,
    cheeks: [Cheek; 2],
    /// How a cheek's volume changes with the skin's nodes, mm².
    gradient: Vec<Vec3A>,
    /// What forces per mass are multiplied by.
    per_mass: f32,
    /// What share of its stiffness a node counts as heavier by, s².
    heavier: f32,
    springs: Springs,
    prisms: Prisms,
    actuators: Vec<Actuator>,
    rings: Vec<Ring>,
}

impl Layered {
    pub(crate) fn new(head: &Head, numbering: &Numbering) -> Self {
        let layers = Layers::new(head, numbering);
        let movable = numbering.movable;
        let scale = head.tissue.stiffness_scale() * LIGHTNESS;
        let depth = bone_depth(head, &layers.skin[..movable]);
        let reference = numbering.of(&head.skin.reference);
        let side = numbering.of(&sides(head));
        let mut hold = vec![0.0_f32; head.skin.mesh.positions.len()];
        for lid in &head.lids {
            hold[lid.vertex as usize] = lid.hold;
        }
        let hold = numbering.of(&hold);
        // The inner side of a lid is wet, as that of the lips, and above them.
        let wet = numbering.of(&head.skin.wet);
        let lidded: Vec<bool> = (0..hold.len())
            .map(|i| hold[i] > 0.0 || (wet[i] > 0.0 && reference[i].y > 0.0))
            .collect();

        let four = |p: &Vec3| p.extend(0.0);
        let columns = layers.skin.iter().zip(&layers.fascia);
        let rest: Vec<[Vec4; 2]> = columns.map(|(s, f)| [four(s), four(f)]).collect();
        let skull: Vec<Vec4> = layers.skull[..movable].iter().map(four).collect();
        let out: Vec<Vec4> = (0..movable)
            .map(|i| {
                if layers.tender[i] > TURNS {
                    Vec4::ZERO
                } else {
                    four(&layers.out[i])
                }
            })
            .collect();
        let clearance = (0..movable)
            .map(|i| (rest[i][1] - skull[i]).dot(out[i]) * CLEARANCE)
            .collect();
        let restore = (0..movable)
            .map(|i| (RESTORE_SOFT + RESTORE_BONE * bone_stiffness(reference[i], side[i])) * scale)
            .collect();
        let jawed = (0..movable)
            .map(|i| Jawed {
                node: i as u32,
                share: mandible_share(reference[i], side[i]),
            })
            .filter(|j| j.share > 0.0)
            .collect();
        let lids = (0..)
            .zip(&head.lids)
            .filter_map(|(k, lid)| {
                Some(LidHold {
                    node: numbering.moving(lid.vertex)?,
                    lid: k,
                    stiffness: LID * LIGHTNESS * lid.hold * lid.hold,
                })
            })
            .collect();
        let mut actuators = vectors::build(head, &layers, movable, &side, &hold);
        actuators.extend(own::linear(head, &layers, movable, &side, &hold));
        Self {
            movable,
            skin: Nodes::at(&layers.skin),
            fascia: Nodes::at(&layers.fascia[..movable]),
            springs: Springs::new(&numbering.edges, &rest, &skull, &lidded, scale),
            prisms: Prisms::new(&layers.triangles, &rest, scale),
            rings: own::rings(head, &layers, movable, &side, &hold),
            actuators,
            place: rest.clone(),
            force: vec![[Vec4::ZERO; 2]; rest.len()],
            home: rest[..movable].iter().map(|c| c[1]).collect(),
            rest,
            skull_rest: skull.clone(),
            skull,
            out,
            clearance,
            restore,
            over: RESTORE_OVER * scale,
            jawed,
            lids,
            cheeks: cheeks(head, numbering, &depth),
            gradient: vec![Vec3A::ZERO; movable],
            per_mass: scale,
            heavier: INERTIA * (STEP_S / PARTS as f32).powi(2),
        }
    }

    /// Moves bones and what hangs on them, and reads the nodes.
    fn read(&mut self, drive: &Drive<'_>) {
        for &Jawed { node, share } in &self.jawed {
            let i = node as usize;
            let carried = |p: Vec4| {
                let p = Vec3A::from_vec4(p);
                p.lerp(drive.mandible.transform_point3a(p), share)
                    .extend(0.0)
            };
            self.skull[i] = carried(self.skull_rest[i]);
            self.home[i] = carried(self.rest[i][1]);
        }
        for i in 0..self.movable {
            self.place[i] = [
                self.skin.place[i].extend(0.0),
                self.fascia.place[i].extend(0.0),
            ];
        }
    }

    /// Forces of the tissue itself; `volume` scales what keeps its volume.
    fn resist(&mut self, volume: f32) {
        self.force[self.movable..].fill([Vec4::ZERO; 2]);
        self.springs
            .down(&self.place, &self.skull, &self.out, &mut self.force);
        self.springs.along_layers(&self.place, &mut self.force);
        self.prisms.hold(&self.place, volume, &mut self.force);
        for i in 0..self.movable {
            let back = (self.home[i] - self.place[i][1]) * self.restore[i];
            self.force[i][1] += back.with_w(self.restore[i]);
            let over = (self.rest[i][0] - self.rest[i][1]) + self.place[i][1] - self.place[i][0];
            let over = (over * self.over).with_w(self.over);
            self.force[i][0] += over;
            self.force[i][1] += Vec4::new(-over.x, -over.y, -over.z, over.w);
        }
    }

    /// Forces that press the cheeks back to their volume.
    fn press(&mut self, drive: &Drive<'_>) {
        if drive.volume <= 0.0 {
            return;
        }
        let jaw = drive.state[Control::Jaw];
        for cheek in &self.cheeks {
            let volume = cheek.measure(&self.skin, &drive.mandible, jaw, &mut self.gradient);
            let excess = (volume - cheek.rest) / cheek.rest.max(1.0);
            let push = -CHEEK * self.per_mass * drive.volume * excess;
            for i in cheek.nodes.iter().map(|i| *i as usize) {
                self.force[i][0] += (self.gradient[i] * push).extend(0.0);
            }
        }
    }

    /// Forces of muscles and lids.
    fn pull(&mut self, drive: &Drive<'_>) {
        let scale = drive.muscle_stiffness * self.per_mass;
        for actuator in &self.actuators {
            let [a, b] = actuator
                .muscles
                .map(|m| drive.state.contraction(m, actuator.left));
            let contraction = 0.5 * (a + b) * scale;
            if contraction.abs() < 1e-6 {
                continue;
            }
            for (i, force) in &actuator.forces {
                self.force[*i as usize][1] += force.extend(0.0) * contraction;
            }
        }
        for ring in &self.rings {
            ring.pull(
                drive.state,
                &drive.mandible,
                scale,
                &self.place,
                &mut self.force,
            );
        }
        for hold in &self.lids {
            let lid = drive.head.lids[hold.lid as usize];
            let (eye, closed) = if lid.left {
                (&drive.head.eyes[0], drive.state[Control::LidL])
            } else {
                (&drive.head.eyes[1], drive.state[Control::LidR])
            };
            let muscle = drive
                .state
                .contraction(Muscle::OrbicularisOculiPalpebral, lid.left)
                * drive.muscle_stiffness.min(1.0);
            let closed = 1.0 - (1.0 - closed) * (1.0 - muscle);
            let follow = if lid.turn < 0.0 {
                0.55 * lid.hold * (1.0 - closed)
            } else {
                0.0
            };
            let gaze = follow * drive.state[Control::GazePitch];
            let turn = Quat::from_rotation_x(-(lid.turn * closed * LID_OVERSHOOT + gaze));
            let i = hold.node as usize;
            let centre = Vec3A::from(eye.centre);
            for layer in 0..2 {
                let home = Vec3A::from_vec4(self.rest[i][layer]);
                let target = centre + turn.mul_vec3a(home - centre);
                let least = (LID_LEAST * LIGHTNESS - hold.stiffness).max(0.0);
                let back = (target.extend(0.0) - self.place[i][layer]) * hold.stiffness
                    + (self.rest[i][layer] - self.place[i][layer]) * least;
                self.force[i][layer] += back.with_w(hold.stiffness + least);
            }
        }
    }

    /// Velocities half a step after the places; the rim stays.
    fn accelerate(&mut self, step_s: f32, damping: f32) {
        // Half of the damping before the forces, half after: then the step's length does not tell in how it damps.
        let half = 0.5 * damping * step_s;
        let heavier = self.heavier;
        let advance = |force: Vec4, velocity: &mut Vec3A| {
            let mass = (force.w * heavier).max(1.0);
            let force = Vec3A::from_vec4(force);
            *velocity = (*velocity * (mass - half) + force * step_s) / (mass + half);
            *velocity = velocity.clamp_length_max(FASTEST_MM_S);
        };
        for i in 0..self.movable {
            let [skin, fascia] = self.force[i];
            advance(skin, &mut self.skin.velocity[i]);
            // Nothing presses fascia on that has come near the bone: it slides.
            let inwards = if self.above_bone(i) <= 0.0 {
                self.out[i] * fascia.dot(self.out[i]).min(0.0)
            } else {
                Vec4::ZERO
            };
            advance(fascia - inwards, &mut self.fascia.velocity[i]);
        }
    }

    /// How far a node's fascia is from where bone stops it, mm.
    fn above_bone(&self, i: usize) -> f32 {
        let over = self.fascia.place[i] - Vec3A::from_vec4(self.skull[i]);
        over.dot(Vec3A::from_vec4(self.out[i])) - self.clearance[i]
    }

    /// Places after a step.
    fn drift(&mut self, step_s: f32) {
        for i in 0..self.movable {
            let home = Vec3A::from_vec4(self.home[i]);
            let over = home + Vec3A::from_vec4(self.rest[i][0] - self.rest[i][1]);
            for (nodes, home) in [(&mut self.skin, over), (&mut self.fascia, home)] {
                let place = nodes.place[i] + nodes.velocity[i] * step_s;
                nodes.place[i] = home + (place - home).clamp_length_max(FARTHEST_MM);
            }
            let deep = self.above_bone(i).min(0.0);
            if deep < 0.0 {
                let normal = Vec3A::from_vec4(self.out[i]);
                self.fascia.place[i] -= normal * deep;
                let velocity = &mut self.fascia.velocity[i];
                *velocity -= normal * velocity.dot(normal).min(0.0);
            }
        }
    }
}

impl Tissue for Layered {
    fn step(&mut self, drive: &Drive<'_>, meet: &mut dyn FnMut(&mut Nodes, f32)) {
        self.read(drive);
        self.resist(drive.volume);
        self.press(drive);
        self.pull(drive);
        self.accelerate(drive.step_s, DAMPING * drive.damping);
        meet(&mut self.skin, drive.step_s);
        self.drift(drive.step_s);
    }

    fn parts(&self) -> u32 {
        PARTS
    }

    fn skin(&self) -> &Nodes {
        &self.skin
    }

    fn skin_mut(&mut self) -> &mut Nodes {
        &mut self.skin
    }

    fn inner(&self) -> Option<&Nodes> {
        Some(&self.fascia)
    }

    fn inner_mut(&mut self) -> Option<&mut Nodes> {
        Some(&mut self.fascia)
    }

    fn reset_inner(&mut self) {
        for (i, place) in self.fascia.place.iter_mut().enumerate() {
            *place = Vec3A::from_vec4(self.rest[i][1]);
        }
        self.fascia.velocity.fill(Vec3A::ZERO);
    }

    fn bytes(&self) -> usize {
        2 * size_of_val(&*self.skin.place)
            + 2 * size_of_val(&*self.fascia.place)
            + 3 * size_of_val(&*self.place)
            + 4 * size_of_val(&*self.skull)
            + 2 * size_of_val(&*self.restore)
            + size_of_val(&*self.gradient)
            + self.springs.bytes()
            + self.prisms.bytes()
    }

    fn spring_count(&self) -> usize {
        self.springs.count() + self.restore.len() + self.lids.len()
    }
}
