//! Contact: lips stop each other, lips stay in front of the teeth, lids stay outside the eyeballs.
//!
//! | module | holds |
//! |---|---|
//! | `drawn` | where vertices are drawn, as sums of nodes |
//! | `four` | four nodes side by side, to find what may touch |
//! | `lips` | lips that meet: the profiles of facing columns |
//! | `profile` | a lip's columns in rows, and which of them are near the other lip |
//! | `teeth` | lips in front of both rows of teeth and their gums |
//! | `field` | a row of teeth as a height field |
//! | `lids` | lids outside the eyeballs and their corneas |
//!
//! HABER and HEADSHOP leave contact out; here it is what makes /m/ and /p/ look pressed. It is resolved for the
//! surface as it is drawn: on positions after each step and on velocities, without rebound; lips, which are pressed hard,
//! are slowed before they move. Everything slides: only what points into the other is taken away. Nothing is remembered
//! from step to step, so a rewind repeats itself.

mod drawn;
mod field;
mod four;
mod lids;
mod lips;
mod profile;
mod teeth;

use glam::Affine3A;

pub(crate) use teeth::upper_edge;

use crate::tissue::{Nodes, Numbering};
use crate::{Controls, Head};
use drawn::Limit;
use lids::Lids;
use lips::Lips;
use teeth::Teeth;

/// The contacts of one head.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    lips: Lips,
    teeth: Teeth,
    lids: Lids,
}

impl Contact {
    /// The contacts among the vertices of `head` that move.
    pub(crate) fn new(head: &Head, numbering: &Numbering) -> Self {
        let limit = Limit::new(head, numbering);
        Self {
            lips: Lips::new(head, &limit),
            teeth: Teeth::new(head, &limit),
            lids: Lids::new(head, &limit),
        }
    }

    /// Slows lips that are about to meet, before a step's velocities lead to its end.
    pub(crate) fn brake(&mut self, skin: &mut Nodes, step_s: f32) {
        self.lips.brake(skin, step_s);
    }

    /// Keeps lips, teeth, lids and eyeballs out of each other at the end of a step; `lips` is false while calibrating,
    /// where targets past contact count.
    pub(crate) fn resolve(
        &mut self,
        skin: &mut Nodes,
        mandible: &Affine3A,
        state: &Controls,
        lips: bool,
        step_s: f32,
    ) {
        if lips {
            self.lips.push(skin);
        }
        self.teeth.resolve(skin, mandible, step_s);
        self.lids.resolve(skin, state, step_s);
    }
}
