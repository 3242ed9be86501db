//! Steps a head in time: controls in, skin out (HEADSHOP 4.2: Verlet leapfrog, damping per mass).
//!
//! Used by the simulation thread, by export, curves and calibration alike. Nothing is allocated per
//! step. Skin is moved by springs and contact only: no vertex is ever set from a control.

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, vec3};

use crate::contact::{Bodies, Contact};
use crate::key_frame::TICK_RATE;
use crate::muscle::{Merge, carried, merges};
use crate::tissue::Tissue;
use crate::{Control, Controls, Head, KeyFrame};

/// Length of a step in ticks: 600 steps a second.
pub const STEP_TICKS: i64 = 80;
const STEP_S: f32 = STEP_TICKS as f32 / TICK_RATE as f32;
/// Damping per mass, 1/s: a little over critical for a vertex on its muscle.
const DAMPING: f32 = 420.0;
/// How fast components follow their controls (critically damped), 1/s.
const MUSCLE_RATE: f32 = 170.0;
const JAW_RATE: f32 = 130.0;
const HEAD_RATE: f32 = 40.0;
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
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    rest: Vec<Vec3>,
    /// Sum over a vertex's springs to bone, muscle and lid: stiffness times where they pull to.
    pull: Vec<Vec3>,
    /// Sum of their stiffness.
    hold: Vec<f32>,
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
        let rest: Vec<Vec3> = tissue
            .vertices
            .iter()
            .map(|&v| head.skin.mesh.positions[v as usize])
            .collect();
        let mut number = vec![0; head.skin.mesh.positions.len()];
        for (new, &old) in tissue.vertices.iter().enumerate() {
            number[old as usize] = new as u32;
        }
        let contact = Contact::new(&head, |v| number[v as usize]);
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
            velocity: vec![Vec3::ZERO; rest.len()],
            pull: vec![Vec3::ZERO; tissue.movable],
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
        self.aim(&mandible);
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
            frame.skin[v as usize] = self.position[i];
            frame.velocity[v as usize] = self.velocity[i];
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
            self.position[i] = frame.skin[v as usize];
            self.velocity[i] = frame.velocity[v as usize];
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
        for (k, fibre) in self.head.fibres.iter().enumerate() {
            fibre.contracted(
                &self.state,
                mandible,
                &mut self.points[self.starts[k]..self.starts[k + 1]],
            );
        }
        for merge in &self.merges {
            let end = self.starts[merge.puller + 1] - 1;
            let puller = &self.head.fibres[merge.puller];
            let share = puller.mandible.last().copied().unwrap_or(0.0);
            let pull = self.points[end] - carried(self.rest_points[end], share, mandible);
            self.points[self.starts[merge.fibre] + merge.point] += pull * merge.share;
        }
    }

    /// Sums up where bone, muscles and lids pull each vertex to.
    fn aim(&mut self, mandible: &Affine3A) {
        for i in 0..self.tissue.movable {
            self.pull[i] =
                carried(self.rest[i], self.tissue.mandible[i], mandible) * self.tissue.bone[i];
        }
        for a in &self.tissue.attachments {
            let j = self.starts[a.fibre as usize] + a.point as usize;
            let before = self.points[j] - self.rest_points[j];
            let after = self.points[j + 1] - self.rest_points[j + 1];
            let i = a.vertex as usize;
            let target = self.rest[i] + before.lerp(after, a.share);
            self.pull[i] += target * (a.stiffness * self.muscle_stiffness);
        }
        let lids = &self.head.lids;
        for &(i, k, stiffness) in &self.tissue.lids {
            let lid = &lids[k as usize];
            let (side, closed) = if lid.left {
                (1.0, self.state[Control::LidL])
            } else {
                (-1.0, self.state[Control::LidR])
            };
            // The upper lid follows the gaze down and up.
            let gaze = if lid.turn < 0.0 {
                0.55 * self.state[Control::GazePitch] * lid.hold * (1.0 - closed)
            } else {
                0.0
            };
            let centre = self.head.eye_centre * vec3(side, 1.0, 1.0);
            let turn = Quat::from_rotation_x(-(lid.turn * closed * LID_OVERSHOOT + gaze));
            let target = centre + turn * (self.rest[i as usize] - centre);
            self.pull[i as usize] += target * stiffness;
        }
    }

    /// The stiffness that goes with [`Self::aim`]; it does not depend on controls.
    fn sum_holds(&mut self) {
        self.hold.copy_from_slice(&self.tissue.bone);
        for a in &self.tissue.attachments {
            self.hold[a.vertex as usize] += a.stiffness * self.muscle_stiffness;
        }
        for &(i, _, stiffness) in &self.tissue.lids {
            self.hold[i as usize] += stiffness;
        }
    }

    /// Forces, then velocities at the half step, then positions.
    fn integrate(&mut self) {
        let damp = (-DAMPING * STEP_S).exp();
        let stiffness = self.tissue.edge_stiffness;
        for i in 0..self.tissue.movable {
            let p = self.position[i];
            let mut force = self.pull[i] - p * self.hold[i];
            let range = self.tissue.starts[i] as usize..self.tissue.starts[i + 1] as usize;
            for edge in &self.tissue.edges[range] {
                let d = self.position[edge.other as usize] - p;
                let length = d.length_squared().max(1e-8).sqrt();
                force += d * (stiffness * (1.0 - edge.rest_mm / length));
            }
            self.velocity[i] = (self.velocity[i] + force * STEP_S) * damp;
        }
        for i in 0..self.tissue.movable {
            self.position[i] += self.velocity[i] * STEP_S;
        }
    }
}
