//! Steps a head in time: controls in, skin out (HEADSHOP 4.2: Verlet leapfrog, damping per mass).
//!
//! Used by the simulation thread, by export, curves and calibration alike. Nothing is allocated per
//! step. Skin is moved by springs and contact only: no vertex is ever set from a control.

use std::sync::Arc;

use glam::{Affine3A, Vec3};

use crate::contact::Contact;
use crate::follow::Follow;
use crate::key_frame::TICK_RATE;
use crate::muscle::Muscles;
use crate::tissue::{Drive, Layered, Numbering, Springs, Tissue, bone_depth, cheeks};
use crate::tongue::Tongue;
use crate::{Control, Controls, Head, KeyFrame, TissueModel, jaw};

/// Length of a step in ticks: 240 steps a second.
pub const STEP_TICKS: i64 = 200;
/// The same in seconds.
pub(crate) const STEP_S: f32 = STEP_TICKS as f32 / TICK_RATE as f32;
/// How fast components follow their controls (critically damped), 1/s.
const MUSCLE_RATE: f32 = 145.0;
const HEAD_RATE: f32 = 38.0;

/// The tissue's model that a head asks for.
#[derive(Clone, Debug)]
enum Model {
    Springs(Box<Springs>),
    Layered(Box<Layered>),
}

impl Model {
    fn new(head: &Head, numbering: &Numbering) -> Self {
        match head.tissue.model {
            TissueModel::Springs => Self::Springs(Box::new(Springs::new(head, numbering))),
            TissueModel::Layered => Self::Layered(Box::new(Layered::new(head, numbering))),
        }
    }

    fn tissue(&self) -> &dyn Tissue {
        match self {
            Self::Springs(springs) => springs.as_ref(),
            Self::Layered(layered) => layered.as_ref(),
        }
    }

    fn tissue_mut(&mut self) -> &mut dyn Tissue {
        match self {
            Self::Springs(springs) => springs.as_mut(),
            Self::Layered(layered) => layered.as_mut(),
        }
    }
}

/// A head in motion.
#[derive(Clone, Debug)]
pub struct Simulation {
    head: Arc<Head>,
    numbering: Numbering,
    model: Model,
    muscles: Muscles,
    contact: Contact,
    tongue: Tongue,
    time: i64,
    epoch: u32,
    state: Controls,
    rate: Controls,
    mandible: Affine3A,
    contacts: bool,
    lip_contact: bool,
    muscle_stiffness: f32,
    damping: f32,
    volume: f32,
    substeps: u32,
}

impl Simulation {
    /// The head at rest at time 0.
    #[must_use]
    pub fn new(head: Arc<Head>) -> Self {
        let numbering = Numbering::new(&head);
        Self {
            time: 0,
            epoch: 0,
            state: Controls::default(),
            rate: Controls::default(),
            mandible: head.mandible(0.0),
            model: Model::new(&head, &numbering),
            muscles: Muscles::new(&head),
            contact: Contact::new(&head, &numbering),
            tongue: Tongue::new(&head),
            numbering,
            head,
            contacts: true,
            lip_contact: true,
            muscle_stiffness: 1.0,
            damping: 1.0,
            volume: 1.0,
            substeps: 1,
        }
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
        self.model.tissue().spring_count()
    }

    /// Where the control points of all fibres are, mm, one fibre of [`Head::fibres`] after the other.
    #[must_use]
    pub fn fibre_points(&self) -> &[Vec3] {
        self.muscles.points()
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
    }

    /// Scales the tissue's damping: at 0 what it is given stays in it.
    pub fn set_damping(&mut self, scale: f32) {
        self.damping = scale;
    }

    /// Scales what keeps the tissue's volume: at 0 nothing does.
    pub fn set_volume_stiffness(&mut self, scale: f32) {
        self.volume = scale;
    }

    /// Cuts each step into `count` shorter ones (1 at least), to see whether the step is short enough.
    pub fn set_substeps(&mut self, count: u32) {
        self.substeps = count.max(1);
    }

    /// Whether lips, teeth, lids and eyeballs stop each other at all.
    pub fn set_contacts(&mut self, on: bool) {
        self.contacts = on;
    }

    /// The tissue's energy per mass of a node, mm²/s², in a model that conserves it.
    #[must_use]
    pub fn energy(&self) -> Option<f64> {
        self.model.tissue().energy(&self.drive())
    }

    /// Volumes of the soft tissue in the left and the right cheek, mm³. Works the regions out anew: for judging.
    #[must_use]
    pub fn cheek_volumes(&self) -> [f32; 2] {
        let (jaw, nodes) = (self.state[Control::Jaw], self.model.tissue().skin());
        let rest = self.numbering.of(&self.head.skin.mesh.positions);
        let depth = bone_depth(&self.head, &rest[..self.numbering.movable]);
        cheeks(&self.head, &self.numbering, &depth)
            .map(|cheek| cheek.volume(nodes, &self.mandible, jaw))
    }

    /// Bytes that a step reads and writes, but for muscles and contact.
    #[must_use]
    pub fn tissue_bytes(&self) -> usize {
        self.model.tissue().bytes()
    }

    /// One step towards `controls`.
    pub fn step(&mut self, controls: &Controls) {
        let wanted = controls.clamped();
        let step_s = self.part_s();
        for _ in 0..self.substeps * self.model.tissue().parts() {
            // Forces of this moment move the tissue to the end of the step; there the rest meets it.
            let drive = Drive {
                head: &self.head,
                state: &self.state,
                mandible: self.mandible,
                muscles: &self.muscles,
                muscle_stiffness: self.muscle_stiffness,
                damping: self.damping,
                volume: self.volume,
                step_s,
            };
            let (contact, lips) = (&mut self.contact, self.contacts && self.lip_contact);
            self.model.tissue_mut().step(&drive, &mut |skin, step_s| {
                if lips {
                    contact.brake(skin, step_s);
                }
            });
            self.follow(&wanted, step_s);
            self.pose();
            if self.contacts {
                self.contact.resolve(
                    self.model.tissue_mut().skin_mut(),
                    &self.mandible,
                    &self.state,
                    self.lip_contact,
                    step_s,
                );
            }
        }
        self.time += STEP_TICKS;
    }

    /// Length of the parts that a step is cut into, s.
    fn part_s(&self) -> f32 {
        STEP_S / (self.substeps * self.model.tissue().parts()) as f32
    }

    fn drive(&self) -> Drive<'_> {
        Drive {
            head: &self.head,
            state: &self.state,
            mandible: self.mandible,
            muscles: &self.muscles,
            muscle_stiffness: self.muscle_stiffness,
            damping: self.damping,
            volume: self.volume,
            step_s: self.part_s(),
        }
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
        let nodes = self.model.tissue().skin();
        for (i, &v) in self.numbering.moving_vertices().iter().enumerate() {
            frame.skin[v as usize] = nodes.place[i].into();
            frame.velocity[v as usize] = nodes.velocity[i].into();
        }
        frame.inner.clear();
        if let Some(inner) = self.model.tissue().inner() {
            let both = inner.place.iter().chain(&inner.velocity);
            frame.inner.extend(both.map(|p| Vec3::from(*p)));
        }
    }

    /// Goes back to a saved frame of the same head; a frame of another size is refused. One without
    /// anything below the skin, as [`Head::rest_frame`], leaves that at rest.
    pub fn restore(&mut self, frame: &KeyFrame) -> bool {
        let tissue = self.model.tissue_mut();
        let inner = tissue.inner().map_or(0, |inner| inner.place.len());
        if frame.skin.len() != self.head.skin.mesh.positions.len()
            || frame.velocity.len() != frame.skin.len()
            || !(frame.inner.is_empty() || frame.inner.len() == 2 * inner)
        {
            return false;
        }
        self.time = frame.time;
        self.epoch = frame.epoch;
        self.state = frame.state;
        self.rate = frame.state_rate;
        self.pose();
        let tissue = self.model.tissue_mut();
        let nodes = tissue.skin_mut();
        for (i, &v) in self.numbering.moving_vertices().iter().enumerate() {
            nodes.place[i] = frame.skin[v as usize].into();
            nodes.velocity[i] = frame.velocity[v as usize].into();
        }
        if frame.inner.is_empty() {
            tissue.reset_inner();
        } else if let Some(nodes) = tissue.inner_mut() {
            let (places, velocities) = frame.inner.split_at(inner);
            for (i, (place, velocity)) in places.iter().zip(velocities).enumerate() {
                nodes.place[i] = (*place).into();
                nodes.velocity[i] = (*velocity).into();
            }
        }
        true
    }

    /// Puts mandible and fibres where the state has them.
    fn pose(&mut self) {
        self.mandible = self.head.mandible(self.state[Control::Jaw]);
        self.muscles
            .contract(&self.head, &self.state, &self.mandible);
    }

    /// Muscles, jaw and the rest follow their controls with inertia: no joint moves at once.
    fn follow(&mut self, wanted: &Controls, step_s: f32) {
        let (muscle, head) = (
            Follow::new(MUSCLE_RATE, step_s),
            Follow::new(HEAD_RATE, step_s),
        );
        for &control in Control::ALL {
            let follow = match control {
                // Those have limits and contacts of their own.
                Control::Jaw | Control::TongueTip | Control::TongueOut | Control::TongueBody => {
                    continue;
                }
                Control::HeadYaw | Control::HeadPitch | Control::HeadRoll => head,
                _ => muscle,
            };
            (self.state[control], self.rate[control]) =
                follow.step(self.state[control], self.rate[control], wanted[control]);
        }
        let jaw = Control::Jaw;
        (self.state[jaw], self.rate[jaw]) =
            jaw::step(self.state[jaw], self.rate[jaw], wanted[jaw], step_s);
        self.tongue
            .step(&self.head, wanted, &mut self.state, &mut self.rate, step_s);
    }
}
