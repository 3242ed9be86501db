//! Pictures without a window: drawn to an image and read back as RGBA rows.
//!
//! Two pictures can be in flight, so that a batch export encodes one while the next is drawn: call
//! `submit` for the next, then `take` for the last. `render` does both for a single picture.
//!
//! A device that is lost is opened again and what was in flight is drawn anew: the caller notices a pause.

use std::sync::mpsc;
use std::time::Duration;

use mouthpiece_rig::{Head, KeyFrame};

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::renderer::{Renderer, check_size};
use crate::shot::padded_row;
use crate::targets::texture;
use crate::tier::Tier;
use crate::view::{Extent, View};

/// Pictures that can be in flight: one being drawn, one being read. More only adds memory.
pub const FRAMES_IN_FLIGHT: usize = 2;
/// Plain bytes: the shaders' film curve ends in sRGB values.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Losses in a row, without a picture between them, after which the device is given up.
const LOSSES_MAX: u32 = 3;
/// A picture that takes longer than this will never come.
const PATIENCE: Duration = Duration::from_secs(60);

/// One picture on its way back, and what it is of, to draw it again.
#[derive(Debug)]
struct Slot {
    image: wgpu::Texture,
    target: wgpu::TextureView,
    rows: wgpu::Buffer,
    frame: KeyFrame,
    view: View,
}

impl Slot {
    fn new(gpu: &Gpu, size: (u32, u32)) -> Self {
        let copied = wgpu::TextureUsages::COPY_SRC;
        let image = texture(gpu.device(), "offscreen", size, FORMAT, 1, copied);
        Self {
            target: image.create_view(&wgpu::TextureViewDescriptor::default()),
            image,
            rows: gpu.device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: u64::from(padded_row(size.0)) * u64::from(size.1),
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
            frame: KeyFrame::default(),
            view: View::default(),
        }
    }
}

/// A picture that was submitted and not taken.
#[derive(Debug)]
struct Pending {
    slot: usize,
    submission: wgpu::SubmissionIndex,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Draws to images of one size and reads them back.
#[derive(Debug)]
pub struct Offscreen {
    gpu: Gpu,
    /// To begin anew with.
    head: Box<Head>,
    tier: Tier,
    losses: u32,
    renderer: Renderer,
    size: (u32, u32),
    slots: Vec<Slot>,
    /// Oldest first, at most [`FRAMES_IN_FLIGHT`].
    pending: std::collections::VecDeque<Pending>,
    next_slot: usize,
    pixels: Vec<u8>,
}

impl Offscreen {
    /// Ready to draw `head` at `size` pixels.
    ///
    /// # Errors
    /// When the adapter cannot draw that size.
    pub fn new(gpu: &Gpu, head: &Head, size: (u32, u32), tier: Tier) -> Result<Self, RenderError> {
        check_size(gpu, size)?;
        let renderer = Renderer::new(gpu, head, FORMAT, tier)?;
        let slots = (0..FRAMES_IN_FLIGHT).map(|_| Slot::new(gpu, size));
        Ok(Self {
            slots: slots.collect(),
            gpu: gpu.clone(),
            head: Box::new(head.clone()),
            tier,
            losses: 0,
            renderer,
            size,
            pending: std::collections::VecDeque::with_capacity(FRAMES_IN_FLIGHT),
            next_slot: 0,
            pixels: vec![0; size.0 as usize * size.1 as usize * 4],
        })
    }

    /// The device drawn with: another one after a loss.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The room the head takes up at rest.
    #[must_use]
    pub fn extent(&self) -> Extent {
        self.renderer.extent()
    }

    /// What draws.
    #[cfg(test)]
    pub(crate) fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Pictures submitted and not taken.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.pending.len()
    }

    /// Draws one picture and waits for it: rows from the top, RGBA, sRGB, no padding.
    ///
    /// # Errors
    /// When it cannot be drawn or read back, or pictures are in flight (take them first).
    pub fn render(&mut self, key_frame: &KeyFrame, view: &View) -> Result<&[u8], RenderError> {
        if !self.pending.is_empty() {
            return Err(RenderError::Full(self.pending.len()));
        }
        self.submit(key_frame, view)?;
        match self.take()? {
            Some(_) => Ok(&self.pixels),
            None => Err(RenderError::Readback("no picture was in flight".into())),
        }
    }

    /// Starts drawing a picture and returns at once.
    ///
    /// # Errors
    /// When [`FRAMES_IN_FLIGHT`] pictures wait to be taken, or it cannot be drawn.
    pub fn submit(&mut self, key_frame: &KeyFrame, view: &View) -> Result<(), RenderError> {
        if self.pending.len() >= FRAMES_IN_FLIGHT {
            return Err(RenderError::Full(self.pending.len()));
        }
        let slot = self.next_slot;
        self.slots[slot].frame.copy_from(key_frame);
        self.slots[slot].view.clone_from(view);
        let pending = match self.start(slot) {
            Err(RenderError::DeviceLost) => {
                self.recover()?;
                self.start(slot)?
            }
            other => other?,
        };
        self.pending.push_back(pending);
        self.next_slot = (self.next_slot + 1) % FRAMES_IN_FLIGHT;
        Ok(())
    }

    /// Sends the commands that draw what is in a slot and read it back.
    fn start(&mut self, slot: usize) -> Result<Pending, RenderError> {
        let mut encoder =
            self.gpu
                .device()
                .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                    label: Some("offscreen"),
                });
        let Slot {
            image,
            target,
            rows,
            frame,
            view,
        } = &self.slots[slot];
        self.renderer
            .encode(&self.gpu, &mut encoder, frame, view, target, self.size)?;
        encoder.copy_texture_to_buffer(
            image.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: rows,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row(self.size.0)),
                    rows_per_image: None,
                },
            },
            image.size(),
        );
        let (done, mapped) = mpsc::sync_channel(1);
        encoder.map_buffer_on_submit(rows, wgpu::MapMode::Read, .., move |result| {
            // Nobody waits any more when the offscreen was dropped.
            let _ = done.send(result);
        });
        let submission = self.gpu.queue().submit([encoder.finish()]);
        self.renderer.submitted(&self.gpu);
        Ok(Pending {
            slot,
            submission,
            mapped,
        })
    }

    /// Opens the device again, builds everything on it and draws anew what was in flight.
    fn recover(&mut self) -> Result<(), RenderError> {
        self.losses += 1;
        if self.losses > LOSSES_MAX {
            return Err(RenderError::DeviceLost);
        }
        tracing::warn!("the graphics device is opened again");
        self.gpu = Gpu::headless()?;
        self.renderer = Renderer::new(&self.gpu, &self.head, FORMAT, self.tier)?;
        for slot in &mut self.slots {
            let Slot { frame, view, .. } = std::mem::replace(slot, Slot::new(&self.gpu, self.size));
            (slot.frame, slot.view) = (frame, view);
        }
        for at in 0..self.pending.len() {
            self.pending[at] = self.start(self.pending[at].slot)?;
        }
        Ok(())
    }

    /// Waits for the oldest picture in flight; none when there is none. As [`render`](Self::render).
    ///
    /// # Errors
    /// When it cannot be read back.
    pub fn take(&mut self) -> Result<Option<&[u8]>, RenderError> {
        while let Some(pending) = self.pending.front() {
            let slot = pending.slot;
            match self.wait(pending) {
                Err(RenderError::DeviceLost) => self.recover()?,
                other => {
                    self.pending.pop_front();
                    other?;
                    self.losses = 0;
                    self.read(slot)?;
                    return Ok(Some(&self.pixels));
                }
            }
        }
        Ok(None)
    }

    /// Waits until a picture's rows can be read.
    fn wait(&self, pending: &Pending) -> Result<(), RenderError> {
        let wait = |submission_index| {
            self.gpu.device().poll(wgpu::PollType::Wait {
                submission_index,
                timeout: Some(PATIENCE),
            })
        };
        let waited = wait(Some(pending.submission.clone()));
        if waited.is_err() {
            // A lost device knows nothing of what was sent to it after, and says that it is lost once all before is done.
            let _ = wait(None);
        }
        if self.gpu.is_lost() {
            return Err(RenderError::DeviceLost);
        }
        if let Some(refused) = self.gpu.take_refused() {
            return Err(RenderError::Refused(refused));
        }
        waited.map_err(|e| unread(&e))?;
        let mapped = pending.mapped.recv_timeout(PATIENCE);
        mapped.map_err(|e| unread(&e))?.map_err(|e| unread(&e))
    }

    /// Copies a slot's rows without their padding; alpha becomes straight where there can be any.
    fn read(&mut self, slot: usize) -> Result<(), RenderError> {
        let Slot { rows, view, .. } = &self.slots[slot];
        {
            let bytes = rows.get_mapped_range(..).map_err(|e| unread(&e))?;
            let row = self.size.0 as usize * 4;
            let padded = padded_row(self.size.0) as usize;
            for (out, row_bytes) in self
                .pixels
                .chunks_exact_mut(row)
                .zip(bytes.chunks_exact(padded))
            {
                out.copy_from_slice(&row_bytes[..row]);
            }
        }
        rows.unmap();
        if !view.background.is_opaque() {
            straighten(&mut self.pixels);
        }
        Ok(())
    }
}

fn unread(why: &dyn std::fmt::Display) -> RenderError {
    RenderError::Readback(why.to_string())
}

/// Colours that were averaged with the black of nothing, as they are by themselves.
fn straighten(rgba: &mut [u8]) {
    for pixel in rgba.as_chunks_mut::<4>().0 {
        let alpha = u16::from(pixel[3]);
        if (1..255).contains(&alpha) {
            for colour in &mut pixel[..3] {
                *colour = ((u16::from(*colour) * 255 + alpha / 2) / alpha).min(255) as u8;
            }
        }
    }
}
