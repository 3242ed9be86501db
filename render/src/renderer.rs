//! Draws a head: owns its buffers, maps and pipelines, and writes one picture's commands.

use std::sync::Arc;
use std::time::Instant;

use mouthpiece_rig::{Head, KeyFrame, Material, Skin};

use crate::bindings::{self, MapGroups};
use crate::brows::{BrowMoving, Brows};
use crate::error::RenderError;
use crate::frame;
use crate::geometry::PartGeometry;
use crate::gpu::Gpu;
use crate::gpu_data::{Frame, SkinMoving};
use crate::layouts::Layouts;
use crate::maps::Maps;
use crate::openings::{Open, Openings};
use crate::passes::{DRAW_ORDER, SHUT_MM};
use crate::picture::Picture;
use crate::pipelines::Pipelines;
use crate::recipes::Draw;
use crate::surface::SkinGeometry;
use crate::targets::Targets;
use crate::tier::Tier;
use crate::upload;
use crate::view::{Background, Extent, Shown, View};
use crate::warm_up::WarmUp;

/// Buffers of one part material.
#[derive(Debug)]
pub(crate) struct PartBuffers {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) count: u32,
}

/// Buffers of the brows' hairs.
#[derive(Debug)]
pub(crate) struct BrowBuffers {
    pub(crate) moving: wgpu::Buffer,
    pub(crate) still: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
}

impl BrowBuffers {
    fn of(gpu: &Gpu, brows: &Brows) -> Self {
        let vertex = wgpu::BufferUsages::VERTEX;
        let moving = vertex | wgpu::BufferUsages::COPY_DST;
        let index = wgpu::BufferUsages::INDEX;
        Self {
            moving: upload::buffer(gpu, "brows, moving", &brows.moving, moving),
            still: upload::buffer(gpu, "brows, still", &brows.still, vertex),
            indices: upload::buffer(gpu, "brows", &brows.indices, index),
        }
    }
}

/// The head on the card, ready to be drawn in one target format.
#[derive(Debug)]
pub struct Renderer {
    /// Only what [`Head::bodies`] needs.
    pub(crate) pose: Head,
    pub(crate) extent: Extent,
    pub(crate) openings: Openings,
    pub(crate) format: wgpu::TextureFormat,
    pub(crate) samples: u32,
    pub(crate) skin: SkinGeometry,
    pub(crate) skin_moving: wgpu::Buffer,
    pub(crate) skin_still: wgpu::Buffer,
    pub(crate) skin_indices: wgpu::Buffer,
    pub(crate) inside_indices: wgpu::Buffer,
    pub(crate) casting_indices: wgpu::Buffer,
    pub(crate) parts: Vec<(Material, PartBuffers)>,
    pub(crate) brows: Brows,
    /// None where there are no hairs.
    pub(crate) brow_buffers: Option<BrowBuffers>,
    pub(crate) pipelines: Pipelines,
    pub(crate) frame: wgpu::Buffer,
    pub(crate) frame_group: wgpu::BindGroup,
    pub(crate) shadow_map: wgpu::TextureView,
    pub(crate) shadow_group: wgpu::BindGroup,
    pub(crate) maps: MapGroups,
    pub(crate) layouts: Layouts,
    pub(crate) hung: Option<Hung>,
    /// Pictures sent on their way.
    drawn: u32,
    /// Until the second.
    pub(crate) warm_up: Option<WarmUp>,
    pub(crate) targets: Option<Targets>,
}

/// The picture behind the head, on the card.
#[derive(Debug)]
pub(crate) struct Hung {
    pub(crate) picture: Arc<Picture>,
    pub(crate) group: wgpu::BindGroup,
}

impl Hung {
    /// Puts `picture` on the card; for a large one that takes longer than a picture may.
    pub(crate) fn new(gpu: &Gpu, maps: &wgpu::BindGroupLayout, picture: Arc<Picture>) -> Self {
        let group = bindings::picture(gpu, maps, &picture);
        Self { picture, group }
    }
}

impl Renderer {
    /// Puts `head` on the card, for targets of `format` (sRGB or not: the picture is the same).
    ///
    /// # Errors
    /// When a shader file is broken or the head's numbers do not fit together.
    pub fn new(
        gpu: &Gpu,
        head: &Head,
        format: wgpu::TextureFormat,
        tier: Tier,
    ) -> Result<Self, RenderError> {
        let device = gpu.device();
        let detail = tier.detail();
        let samples = gpu.samples(format, detail.samples);
        let layouts = Layouts::new(device);
        let pipelines = Pipelines::new(device, &layouts, format, samples, &detail)?;
        let (shadow_map, shadow_group) = bindings::shadow(gpu, &layouts, &detail);
        // Nearly all of a start's work is pipelines or painting: one goes beside the other.
        let (skin, painted, warm_up) = std::thread::scope(|scope| {
            let prepare = || {
                let target = (format, samples);
                let warm_up = WarmUp::new(gpu, &layouts, &shadow_group, target, &detail);
                warm_up.run(gpu, &pipelines, &Draw::FACE);
                if samples > 1 {
                    warm_up.run(gpu, &pipelines, &Draw::FINE);
                }
                warm_up
            };
            let beside = std::thread::Builder::new()
                .name("pipelines".into())
                .spawn_scoped(scope, prepare);
            let started = Instant::now();
            let skin = SkinGeometry::of(head, detail.smoothness);
            let meshed = started.elapsed();
            let painted = Maps::paint(head, &detail);
            let (mesh_ms, maps_ms) = (meshed.as_millis(), (started.elapsed() - meshed).as_millis());
            tracing::debug!(tier = tier.name(), mesh_ms, maps_ms, "a head is made ready");
            // Where no thread is to be had pipelines are made when they are needed.
            let warm_up = beside.ok().and_then(|thread| thread.join().ok());
            (skin, painted, warm_up)
        });
        let skin = skin?;
        let vertex = wgpu::BufferUsages::VERTEX;
        let skin_moving = upload::buffer(
            gpu,
            "skin, moving",
            &skin.moving,
            vertex | wgpu::BufferUsages::COPY_DST,
        );
        let skin_still = upload::buffer(gpu, "skin, still", &skin.still, vertex);
        let skin_indices = upload::buffer(gpu, "skin", &skin.indices, wgpu::BufferUsages::INDEX);
        let inside_indices = upload::buffer(gpu, "inside", &skin.inside, wgpu::BufferUsages::INDEX);
        let casting_indices =
            upload::buffer(gpu, "casting", &skin.casting, wgpu::BufferUsages::INDEX);
        // Where a pixel is one sample hairs are too thin to be seen.
        let brows = if samples > 1 {
            Brows::of(head, &skin)
        } else {
            Brows::default()
        };
        let brow_buffers = (!brows.indices.is_empty()).then(|| BrowBuffers::of(gpu, &brows));
        let parts = DRAW_ORDER
            .into_iter()
            .filter_map(|material| {
                let geometry = PartGeometry::of(head, material, samples);
                (!geometry.indices.is_empty()).then(|| {
                    let buffers = PartBuffers {
                        vertices: upload::buffer(gpu, "part", &geometry.vertices, vertex),
                        indices: upload::buffer(
                            gpu,
                            "part",
                            &geometry.indices,
                            wgpu::BufferUsages::INDEX,
                        ),
                        count: geometry.indices.len() as u32,
                    };
                    (material, buffers)
                })
            })
            .collect();

        let frame = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: size_of::<Frame>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame_group = bindings::group(device, &layouts.frame, &[frame.as_entire_binding()]);
        let maps = bindings::maps(gpu, &layouts, painted, &detail);

        let mut pose = head.clone();
        pose.skin = Skin::default();
        pose.parts.clear();
        pose.features.clear();
        if let Some(refused) = gpu.take_refused() {
            return Err(RenderError::Refused(refused));
        }
        Ok(Self {
            pose,
            extent: Extent::of(head),
            openings: Openings::of(head, skin.points()),
            format,
            samples,
            skin,
            skin_moving,
            skin_still,
            skin_indices,
            inside_indices,
            casting_indices,
            parts,
            brows,
            brow_buffers,
            pipelines,
            frame,
            frame_group,
            shadow_map,
            shadow_group,
            maps,
            layouts,
            hung: None,
            drawn: 0,
            warm_up,
            targets: None,
        })
    }

    /// The room the head takes up at rest.
    #[must_use]
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// Draws one picture to `target`, which has the renderer's format and `size` pixels.
    ///
    /// # Errors
    /// When the frame is of another head, the size cannot be drawn, or the device is gone.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        key_frame: &KeyFrame,
        view: &View,
        target: &wgpu::TextureView,
        size: (u32, u32),
    ) -> Result<wgpu::SubmissionIndex, RenderError> {
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("picture"),
            });
        self.encode(gpu, &mut encoder, key_frame, view, target, size)?;
        let submission = gpu.queue().submit([encoder.finish()]);
        self.submitted(gpu);
        Ok(submission)
    }

    /// After each submission: behind the second picture the mouth is made ready before it opens. Who wants one
    /// picture only does not wait for that.
    pub(crate) fn submitted(&mut self, gpu: &Gpu) {
        self.drawn = self.drawn.saturating_add(1);
        if self.drawn >= 2
            && let Some(warm_up) = self.warm_up.take()
        {
            warm_up.run(gpu, &self.pipelines, &Draw::MOUTH);
        }
    }

    /// Works out everything that a picture of this moment needs. Allocates nothing.
    pub(crate) fn prepare(
        &mut self,
        key_frame: &KeyFrame,
        view: &View,
        size: (u32, u32),
    ) -> (Frame, Open) {
        self.skin.set(&key_frame.skin);
        self.brows.set(&self.skin);
        let open = self.openings.measure(self.skin.points());
        let frame = frame::data(&self.pose, &self.extent, &open, key_frame, view, size);
        (frame, open)
    }

    /// Uploads what changed and writes the commands of one picture.
    pub(crate) fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        key_frame: &KeyFrame,
        view: &View,
        target: &wgpu::TextureView,
        size: (u32, u32),
    ) -> Result<(), RenderError> {
        if gpu.is_lost() {
            return Err(RenderError::DeviceLost);
        }
        let wanted = self.skin.vertex_count();
        if key_frame.skin.len() != wanted {
            return Err(RenderError::WrongHead {
                wanted,
                got: key_frame.skin.len(),
            });
        }
        check_size(gpu, size)?;
        if self.targets.as_ref().is_none_or(|t| t.size != size) {
            self.targets = Some(Targets::new(gpu.device(), size, self.format, self.samples));
        }
        if let Background::Picture(picture) = &view.background
            && self
                .hung
                .as_ref()
                .is_none_or(|h| !Arc::ptr_eq(&h.picture, picture))
        {
            self.hung = Some(Hung::new(gpu, &self.layouts.maps, Arc::clone(picture)));
        }
        let (frame, open) = self.prepare(key_frame, view, size);
        let moving = bytemuck::cast_slice::<SkinMoving, u8>(&self.skin.moving);
        gpu.queue().write_buffer(&self.skin_moving, 0, moving);
        if let Some(buffers) = &self.brow_buffers {
            let moving = bytemuck::cast_slice::<BrowMoving, u8>(&self.brows.moving);
            gpu.queue().write_buffer(&buffers.moving, 0, moving);
        }
        gpu.queue()
            .write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
        if view.shown != Shown::Yardstick {
            self.shadow_pass(encoder, view.shown);
        }
        if let Some(targets) = &self.targets {
            self.picture_pass(
                encoder,
                targets,
                target,
                view,
                open.mouth_half_height > SHUT_MM,
            );
        }
        Ok(())
    }
}

/// Whether the adapter can draw a picture of that size.
pub(crate) fn check_size(gpu: &Gpu, (width, height): (u32, u32)) -> Result<(), RenderError> {
    let max = gpu.device().limits().max_texture_dimension_2d;
    if width == 0 || height == 0 || width > max || height > max {
        return Err(RenderError::Size { width, height, max });
    }
    Ok(())
}
