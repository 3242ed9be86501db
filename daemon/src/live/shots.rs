//! Pictures of the screen on request: from whoever asks to the main thread, and back.
//!
//! The main thread looks once per picture whether somebody asked; it has the picture copied by the card and goes on.

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;
use mouthpiece_render::Shot;
use tokio::sync::oneshot;

/// One at a time: who asks next takes the place of one that nobody answered.
const ASKED_MAX: usize = 1;

/// Both ends; clones are the same.
#[derive(Clone, Debug)]
pub struct Shots(Arc<ArrayQueue<oneshot::Sender<Shot>>>);

impl Default for Shots {
    fn default() -> Self {
        Self(Arc::new(ArrayQueue::new(ASKED_MAX)))
    }
}

impl Shots {
    /// Asks for the next picture. Nothing comes while none is shown.
    pub fn ask(&self) -> oneshot::Receiver<Shot> {
        let (answer, shot) = oneshot::channel();
        // Whose place it takes hears of it by its channel closing.
        let _ = self.0.force_push(answer);
        shot
    }

    /// Who wants the next picture, if anybody. For the main thread; never waits.
    pub fn asked(&self) -> Option<oneshot::Sender<Shot>> {
        self.0.pop().filter(|answer| !answer.is_closed())
    }
}
