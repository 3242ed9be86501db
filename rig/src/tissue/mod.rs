//! Soft tissue: what lets skin follow muscles and bones, in one of two models behind one trait.
//!
//! | module | holds |
//! |---|---|
//! | `nodes` | places and velocities, and which skin vertices they are |
//! | `anatomy` | how thick and fast the tissue is, as functions of a place on the reference head |
//! | `holds` | which fibres hold which skin |
//! | `show` | the default model's springs as lines, for pictures |
//! | `cheeks` | the volume of each cheek |
//! | `layered` | LEE 4 to 8: epidermis, fascia and skull in prisms |
//! | `springs` | HEADSHOP 4.2: skin edges, springs to bone and muscle (the default) |
//!
//! Contact is not here: it corrects the skin's nodes after each step, whatever the model.

mod anatomy;
mod cheeks;
mod holds;
mod layered;
mod nodes;
mod show;
mod springs;

use std::fmt::Debug;

use glam::Affine3A;

pub(crate) use anatomy::bone_depth;
pub(crate) use cheeks::cheeks;
pub(crate) use layered::Layered;
pub(crate) use nodes::{Nodes, Numbering};
pub(crate) use show::spring_lines;
pub(crate) use springs::Springs;
pub use springs::{Isa, SpringPass};

use crate::muscle::Muscles;
use crate::{Controls, Head};

/// What moves tissue during one step.
pub(crate) struct Drive<'a> {
    /// The head that moves.
    pub head: &'a Head,
    /// Muscles, jaw, lids, gaze as they are now.
    pub state: &'a Controls,
    /// The mandible's pose in the skull's frame.
    pub mandible: Affine3A,
    /// Its fibres, contracted.
    pub muscles: &'a Muscles,
    /// Scales everything that muscles do to tissue; at 0 no contraction moves skin.
    pub muscle_stiffness: f32,
    /// Scales the damping; at 0 energy stays.
    pub damping: f32,
    /// Scales what keeps the tissue's volume.
    pub volume: f32,
    /// Length of the step, s.
    pub step_s: f32,
}

/// A model of soft tissue. Its nodes begin with those of the skin that move, in the order of the
/// [`Numbering`] that it was made with; what it has inside comes apart from them.
pub(crate) trait Tissue: Debug {
    /// One step under `drive`. Between the new velocities and the places that they lead to, `meet` may change the
    /// skin; it is told how long, s, they lead there. Allocates nothing.
    fn step(&mut self, drive: &Drive<'_>, meet: &mut dyn FnMut(&mut Nodes, f32));
    /// Parts that a step of the simulation has to be cut into for this model, muscles and contact with it.
    fn parts(&self) -> u32 {
        1
    }
    /// The skin's nodes.
    fn skin(&self) -> &Nodes;
    /// The same, for contact and for a rewind.
    fn skin_mut(&mut self) -> &mut Nodes;
    /// Nodes below the skin, if the model has any: they are part of the state that a key frame holds.
    fn inner(&self) -> Option<&Nodes>;
    /// The same, for a rewind.
    fn inner_mut(&mut self) -> Option<&mut Nodes>;
    /// Puts what is below the skin to rest, for a frame that holds nothing of it.
    fn reset_inner(&mut self);
    /// Springs of all kinds.
    fn spring_count(&self) -> usize;
    /// Energy per mass, mm²/s², of a model that conserves it.
    fn energy(&self, _drive: &Drive<'_>) -> Option<f64> {
        None
    }
    /// Bytes of what a step reads and writes.
    fn bytes(&self) -> usize;
}
