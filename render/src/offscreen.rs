//! Pictures without a window: drawn to an image and read back as RGBA rows.
//!
//! Two pictures can be in flight, so that a batch export encodes one while the next is drawn: call
//! `submit` for the next, then `take` for the last. `render` does both for a single picture.

use std::sync::mpsc;
use std::time::Duration;

use mouthpiece_rig::{Head, KeyFrame};

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::renderer::{Renderer, check_size};
use crate::targets::texture;
use crate::tier::Tier;
use crate::view::{Extent, View};

/// Pictures that can be in flight: one being drawn, one being read. More only adds memory.
pub const FRAMES_IN_FLIGHT: usize = 2;
/// Plain bytes: the shaders' film curve ends in sRGB values.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// A picture that takes longer than this will never come.
const PATIENCE: Duration = Duration::from_secs(60);

/// One picture on its way back.
#[derive(Debug)]
struct Slot {
    image: wgpu::Texture,
    view: wgpu::TextureView,
    rows: wgpu::Buffer,
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
        let slots = (0..FRAMES_IN_FLIGHT)
            .map(|_| {
                let image = texture(
                    gpu.device(),
                    "offscreen",
                    size,
                    FORMAT,
                    1,
                    wgpu::TextureUsages::COPY_SRC,
                );
                Slot {
                    view: image.create_view(&wgpu::TextureViewDescriptor::default()),
                    image,
                    rows: gpu.device().create_buffer(&wgpu::BufferDescriptor {
                        label: Some("readback"),
                        size: u64::from(padded_row(size.0)) * u64::from(size.1),
                        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                        mapped_at_creation: false,
                    }),
                }
            })
            .collect();
        Ok(Self {
            gpu: gpu.clone(),
            renderer,
            size,
            slots,
            pending: std::collections::VecDeque::with_capacity(FRAMES_IN_FLIGHT),
            next_slot: 0,
            pixels: vec![0; size.0 as usize * size.1 as usize * 4],
        })
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
        let mut encoder =
            self.gpu
                .device()
                .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                    label: Some("offscreen"),
                });
        let slot = &self.slots[self.next_slot];
        self.renderer.encode(
            &self.gpu,
            &mut encoder,
            key_frame,
            view,
            &slot.view,
            self.size,
        )?;
        encoder.copy_texture_to_buffer(
            slot.image.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &slot.rows,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row(self.size.0)),
                    rows_per_image: None,
                },
            },
            slot.image.size(),
        );
        let (done, mapped) = mpsc::sync_channel(1);
        encoder.map_buffer_on_submit(&slot.rows, wgpu::MapMode::Read, .., move |result| {
            // Nobody waits any more when the offscreen was dropped.
            let _ = done.send(result);
        });
        let submission = self.gpu.queue().submit([encoder.finish()]);
        self.pending.push_back(Pending {
            slot: self.next_slot,
            submission,
            mapped,
        });
        self.next_slot = (self.next_slot + 1) % FRAMES_IN_FLIGHT;
        Ok(())
    }

    /// Waits for the oldest picture in flight; none when there is none. As [`render`](Self::render).
    ///
    /// # Errors
    /// When it cannot be read back.
    pub fn take(&mut self) -> Result<Option<&[u8]>, RenderError> {
        let Some(pending) = self.pending.pop_front() else {
            return Ok(None);
        };
        let failed = |what: &dyn std::fmt::Display| RenderError::Readback(what.to_string());
        if let Some(refused) = self.gpu.take_refused() {
            return Err(RenderError::Refused(refused));
        }
        let waited = self.gpu.device().poll(wgpu::PollType::Wait {
            submission_index: Some(pending.submission),
            timeout: Some(PATIENCE),
        });
        if self.gpu.is_lost() {
            return Err(RenderError::DeviceLost);
        }
        waited.map_err(|e| failed(&e))?;
        pending
            .mapped
            .recv_timeout(PATIENCE)
            .map_err(|e| failed(&e))?
            .map_err(|e| failed(&e))?;
        let rows = &self.slots[pending.slot].rows;
        {
            let bytes = rows.get_mapped_range(..).map_err(|e| failed(&e))?;
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
        Ok(Some(&self.pixels))
    }
}

/// Bytes of a row in a readback buffer.
fn padded_row(width: u32) -> u32 {
    (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}
