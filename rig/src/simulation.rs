//! Steps a head in time: controls in, skin out (HEADSHOP 4.2: Verlet leapfrog, damping per mass).
//!
//! Used by the simulation thread, by export, curves and calibration alike. Nothing is allocated per
//! step. Skin is moved by springs and contact only: no vertex is ever set from a control.

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A};

use crate::contact::{Bodies, Contact};
use crate::key_frame::TICK_RATE;
use crate::muscle::{Merge, carried, merges};
use crate::tissue::{EDGE, Tissue};
use crate::{Control, Controls, Head, KeyFrame};

/// Length of a step in ticks: 480 steps a second.
pub const STEP_TICKS: i64 = 100;
const STEP_S: f32 = STEP_TICKS as f32 / TICK_RATE as f32;
/// Damping per mass, 1/s: a little over critical for a vertex on its muscle.
const DAMPING: f32 = 420.0;
/// Share of its stiffness that a skin edge keeps when it is pressed together: skin goes slack rather
/// than buckle.
const SLACK: f32 = 0.12;
/// How fast components follow their controls (critically damped), 1/s.
const MUSCLE_RATE: f32 = 170.0;
const JAW_RATE: f32 = 130.0;
const HEAD_RATE: f32 = 40.0;
/// A control nearer to 0 than this does nothing, and a fibre's point nearer to rest than so many mm.
const STILL: f32 = 1e-6;
const STILL_MM: f32 = 1e-5;
/// The lids aim past each other by this factor, since the skin round them holds them back.
const LID_OVERSHOOT: f32 = 1.22;

/// A head in motion.
#[derive(Clone, Debug)]
pub struct Simulation {
    head: Arc<Head>,
    tissue: Tissue,
    contact: Contact,
    time: i64,
    epoch: u32,
    state: Controls,
    rate: Controls,
    /// Simulated vertices: movable ones, then the fixed rim.
    position: Vec<Vec3A>,
    velocity: Vec<Vec3A>,
    rest: Vec<Vec3A>,
    force: Vec<Vec3A>,
    /// Stiffness of all a vertex's springs to bone, muscle and lid, and what they pull with at rest.
    hold: Vec<f32>,
    rest_pull: Vec<Vec3A>,
    /// Displacement of every control point of every fibre.
    shift: Vec<Vec3A>,
    /// All fibres' control points, displaced, and where each fibre starts among them.
    points: Vec<Vec3>,
    rest_points: Vec<Vec3>,
    starts: Vec<usize>,
    merges: Vec<Merge>,
    lip_contact: bool,
    muscle_stiffness: f32,
}

impl Simulation {
    /// The head at rest at time 0.
    #[must_use]
    pub fn new(head: Arc<Head>) -> Self {
        let tissue = Tissue::new(&head);
        let rest: Vec<Vec3A> = tissue
            .vertices
            .iter()
            .map(|&v| head.skin.mesh.positions[v as usize].into())
            .collect();
        let contact = Contact::new(&head, &tissue);
        let rest_points: Vec<Vec3> = head
            .fibres
            .iter()
            .flat_map(|f| f.points.iter().copied())
            .collect();
        let mut starts = vec![0];
        for fibre in &head.fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len());
        }
        let mut simulation = Self {
            time: 0,
            epoch: 0,
            state: Controls::default(),
            rate: Controls::default(),
            position: rest.clone(),
            velocity: vec![Vec3A::ZERO; rest.len()],
            force: vec![Vec3A::ZERO; rest.len()],
            rest_pull: vec![Vec3A::ZERO; tissue.movable],
            shift: vec![Vec3A::ZERO; rest_points.len()],
            hold: vec![0.0; tissue.movable],
            points: rest_points.clone(),
            rest_points,
            starts,
            merges: merges(&head.fibres),
            rest,
            contact,
            tissue,
            head,
            lip_contact: true,
            muscle_stiffness: 1.0,
        };
        simulation.sum_holds();
        simulation
    }

    /// The head that moves.
    #[must_use]
    pub fn head(&self) -> &Arc<Head> {
        &self.head
    }

    /// Now, in ticks.
    #[must_use]
    pub fn time(&self) -> i64 {
        self.time
    }

    /// Springs of all kinds.
    #[must_use]
    pub fn spring_count(&self) -> usize {
        self.tissue.spring_count()
    }

    /// Sets the clock; the state stays.
    pub fn set_time(&mut self, time: i64) {
        self.time = time;
    }

    /// Marks what follows as another past than what was saved so far.
    pub fn set_epoch(&mut self, epoch: u32) {
        self.epoch = epoch;
    }

    /// Whether lips stop each other: off while calibrating, so that targets past contact count.
    pub fn set_lip_contact(&mut self, on: bool) {
        self.lip_contact = on;
    }

    /// Scales all springs between skin and muscle; at 0 no contraction can move the skin.
    pub fn set_muscle_stiffness(&mut self, scale: f32) {
        self.muscle_stiffness = scale;
        self.sum_holds();
    }

    /// One step towards `controls`.
    pub fn step(&mut self, controls: &Controls) {
        self.follow(&controls.clamped());
        let mandible = self.head.mandible(self.state[Control::Jaw]);
        self.contract(&mandible);
        self.pull(&mandible);
        self.stretch();
        self.integrate();
        let mut skin = Bodies {
            position: &mut self.position,
            velocity: &mut self.velocity,
        };
        self.contact.resolve(&mut skin, &mandible, self.lip_contact);
        self.time += STEP_TICKS;
    }

    /// Copies the whole state into a frame, without allocating once its buffers have grown.
    pub fn save(&self, frame: &mut KeyFrame) {
        frame.time = self.time;
        frame.epoch = self.epoch;
        frame.state = self.state;
        frame.state_rate = self.rate;
        let skin = &self.head.skin.mesh.positions;
        if frame.skin.len() != skin.len() {
            frame.skin.clone_from(skin);
            frame.velocity.clear();
            frame.velocity.resize(skin.len(), Vec3::ZERO);
        }
        for (i, &v) in self.tissue.vertices[..self.tissue.movable]
            .iter()
            .enumerate()
        {
            frame.skin[v as usize] = self.position[i].into();
            frame.velocity[v as usize] = self.velocity[i].into();
        }
    }

    /// Goes back to a saved frame of the same head; a frame of another size is refused.
    pub fn restore(&mut self, frame: &KeyFrame) -> bool {
        if frame.skin.len() != self.head.skin.mesh.positions.len()
            || frame.velocity.len() != frame.skin.len()
        {
            return false;
        }
        self.time = frame.time;
        self.epoch = frame.epoch;
        self.state = frame.state;
        self.rate = frame.state_rate;
        for (i, &v) in self.tissue.vertices[..self.tissue.movable]
            .iter()
            .enumerate()
        {
            self.position[i] = frame.skin[v as usize].into();
            self.velocity[i] = frame.velocity[v as usize].into();
        }
        true
    }

    /// Muscles, jaw and the rest follow their controls with inertia: no joint moves at once.
    fn follow(&mut self, wanted: &Controls) {
        for &control in Control::ALL {
            let rate = match control {
                Control::Jaw => JAW_RATE,
                Control::HeadYaw | Control::HeadPitch | Control::HeadRoll => HEAD_RATE,
                _ => MUSCLE_RATE,
            };
            // Implicit in the velocity, so that it is stable at any rate.
            let (x, v) = (self.state[control], self.rate[control]);
            let gain = rate * STEP_S;
            let v = (v + rate * gain * (wanted[control] - x)) / ((1.0 + gain) * (1.0 + gain));
            self.rate[control] = v;
            self.state[control] = x + v * STEP_S;
        }
    }

    /// Displaces all fibres' control points.
    fn contract(&mut self, mandible: &Affine3A) {
        let jaw_still = self.state[Control::Jaw].abs() < STILL;
        for (k, fibre) in self.head.fibres.iter().enumerate() {
            let range = self.starts[k]..self.starts[k + 1];
            if fibre.rests(&self.state, jaw_still, STILL) {
                self.points[range.clone()].copy_from_slice(&self.rest_points[range]);
            } else {
                fibre.contracted(&self.state, mandible, &mut self.points[range]);
            }
        }
        for merge in &self.merges {
            let end = self.starts[merge.puller + 1] - 1;
            let puller = &self.head.fibres[merge.puller];
            let share = puller.mandible.last().copied().unwrap_or(0.0);
            let pull = self.points[end] - carried(self.rest_points[end], share, mandible);
            self.points[self.starts[merge.fibre] + merge.point] += pull * merge.share;
        }
        for ((shift, point), rest) in self
            .shift
            .iter_mut()
            .zip(&self.points)
            .zip(&self.rest_points)
        {
            *shift = (*point - *rest).into();
        }
    }

    /// Forces of the springs to bone, muscles and lids.
    fn pull(&mut self, mandible: &Affine3A) {
        for ((force, base), (position, hold)) in self
            .force
            .iter_mut()
            .zip(&self.rest_pull)
            .zip(self.position.iter().zip(&self.hold))
        {
            *force = *base - *position * *hold;
        }
        // The rim takes forces of its edges but does not move.
        self.force[self.tissue.movable..].fill(Vec3A::ZERO);
        for &(i, stiffness) in &self.tissue.jawed {
            let rest = self.rest[i as usize];
            self.force[i as usize] += (mandible.transform_point3a(rest) - rest) * stiffness;
        }
        let scale = self.muscle_stiffness;
        for (k, range) in self.tissue.fibres.windows(2).enumerate() {
            // Most muscles rest most of the time: nothing of theirs pulls.
            let moved = &self.shift[self.starts[k]..self.starts[k + 1]];
            if moved
                .iter()
                .all(|s| s.length_squared() < STILL_MM * STILL_MM)
            {
                continue;
            }
            for a in &self.tissue.attachments[range[0] as usize..range[1] as usize] {
                let j = a.point as usize;
                let shift = moved[j].lerp(moved[j + 1], a.share);
                self.force[a.vertex as usize] += shift * (a.stiffness * scale);
            }
        }
        for &(i, k, stiffness) in &self.tissue.lids {
            let lid = self.head.lids[k as usize];
            let (eye, closed) = if lid.left {
                (&self.head.eyes[0], self.state[Control::LidL])
            } else {
                (&self.head.eyes[1], self.state[Control::LidR])
            };
            // The orbicularis oculi's part in the lids closes what they have left open.
            let muscle = self.state[Control::OrbicularisOculiPalpebral] * scale.min(1.0);
            let closed = 1.0 - (1.0 - closed) * (1.0 - muscle);
            // The upper lid follows the gaze down and up.
            let follow = if lid.turn < 0.0 {
                0.55 * lid.hold * (1.0 - closed)
            } else {
                0.0
            };
            let gaze = follow * self.state[Control::GazePitch];
            let turn = Quat::from_rotation_x(-(lid.turn * closed * LID_OVERSHOOT + gaze));
            let out = self.rest[i as usize] - Vec3A::from(eye.centre);
            self.force[i as usize] += (turn.mul_vec3a(out) - out) * stiffness;
        }
    }

    /// What of [`Self::pull`] does not depend on controls.
    fn sum_holds(&mut self) {
        self.hold.copy_from_slice(&self.tissue.bone);
        for a in &self.tissue.attachments {
            self.hold[a.vertex as usize] += a.stiffness * self.muscle_stiffness;
        }
        for &(i, _, stiffness) in &self.tissue.lids {
            self.hold[i as usize] += stiffness;
        }
        for ((base, rest), hold) in self.rest_pull.iter_mut().zip(&self.rest).zip(&self.hold) {
            *base = *rest * *hold;
        }
    }

    /// Forces of the skin's own springs: each edge once, its first end's sum kept in a register.
    fn stretch(&mut self) {
        let mut edges = self.tissue.edges.iter();
        for (i, w) in self.tissue.starts.windows(2).enumerate() {
            let p = self.position[i];
            let mut sum = Vec3A::ZERO;
            for edge in edges.by_ref().take((w[1] - w[0]) as usize) {
                let other = edge.other as usize;
                let d = self.position[other] - p;
                let strain = 1.0 - edge.rest_mm / d.length_squared().max(1e-8).sqrt();
                let pull = d * (EDGE * strain.max(SLACK * strain));
                sum += pull;
                self.force[other] -= pull;
            }
            self.force[i] += sum;
        }
    }

    /// Leapfrog: velocities at the half step, then positions; the rim stays.
    fn integrate(&mut self) {
        let damp = (-DAMPING * STEP_S).exp();
        let movable = self.tissue.movable;
        for ((velocity, position), force) in self.velocity[..movable]
            .iter_mut()
            .zip(&mut self.position[..movable])
            .zip(&self.force)
        {
            *velocity = (*velocity + *force * STEP_S) * damp;
            *position += *velocity * STEP_S;
        }
    }
}
