//! Pictures for a batch export, in order, by as many devices as keep the machine busy.
//!
//! A graphics card draws one picture while the next is sent: one [`Offscreen`] does. Drawing in software, a device
//! works on vertices with one thread and only then on pixels with all, and a queue takes one picture at a time: half a
//! picture's time the other cores wait. So a second device draws every other picture there. It is made beside the first
//! pictures, which do not wait for it; its picture of a moment is the same to the bit.

use std::collections::VecDeque;
use std::thread::JoinHandle;

use mouthpiece_rig::{Head, KeyFrame};

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::offscreen::{FRAMES_IN_FLIGHT, Offscreen};
use crate::tier::Tier;
use crate::view::View;

/// Draws one picture after another and gives them back in that order.
#[derive(Debug)]
pub struct Batch {
    drawers: Vec<Offscreen>,
    /// Being made; then one of the others.
    coming: Option<JoinHandle<Result<Offscreen, RenderError>>>,
    /// Which drawer has each picture in flight, oldest first.
    order: VecDeque<usize>,
}

impl Batch {
    /// Ready to draw `head` at `size` pixels.
    ///
    /// # Errors
    /// When the adapter cannot draw that size.
    pub fn new(gpu: &Gpu, head: &Head, size: (u32, u32), tier: Tier) -> Result<Self, RenderError> {
        let first = Offscreen::new(gpu, head, size, tier)?;
        let coming = gpu.is_software().then(|| {
            let (gpu, head) = (gpu.clone(), head.clone());
            let make = move || Offscreen::new(&gpu.another()?, &head, size, tier);
            std::thread::Builder::new()
                .name("second device".into())
                .spawn(make)
        });
        Ok(Self {
            drawers: vec![first],
            // Without a thread one device draws them all.
            coming: coming.and_then(Result::ok),
            order: VecDeque::with_capacity(2 * FRAMES_IN_FLIGHT),
        })
    }

    /// Whether pictures must be taken before the next can be submitted.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.order.len() >= self.drawers.len() * FRAMES_IN_FLIGHT
    }

    /// Whether nothing waits to be taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Starts drawing a picture and returns at once.
    ///
    /// # Errors
    /// When the batch is full, or it cannot be drawn.
    pub fn submit(&mut self, key_frame: &KeyFrame, view: &View) -> Result<(), RenderError> {
        self.welcome();
        let least = (0..self.drawers.len()).min_by_key(|&i| self.drawers[i].in_flight());
        let at = least.unwrap_or(0);
        self.drawers[at].submit(key_frame, view)?;
        self.order.push_back(at);
        Ok(())
    }

    /// Waits for the oldest picture in flight: rows from the top, RGBA, sRGB, no padding. None when there is none.
    ///
    /// # Errors
    /// When it cannot be read back.
    pub fn take(&mut self) -> Result<Option<&[u8]>, RenderError> {
        match self.order.pop_front() {
            Some(at) => self.drawers[at].take(),
            None => Ok(None),
        }
    }

    /// The second device, once it is there.
    fn welcome(&mut self) {
        let Some(thread) = self.coming.take_if(|thread| thread.is_finished()) else {
            return;
        };
        match thread.join() {
            Ok(Ok(offscreen)) => self.drawers.push(offscreen),
            Ok(Err(error)) => tracing::warn!(%error, "there is no second device: one draws all"),
            Err(_) => tracing::warn!("making a second device broke down: one draws all"),
        }
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // A device that is being made would outlive the process's wish to end.
        if let Some(thread) = self.coming.take() {
            let _ = thread.join();
        }
    }
}
