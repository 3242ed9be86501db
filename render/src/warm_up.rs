//! Draws a triangle of nothing with each pipeline, beside the work of a start.
//!
//! A software driver turns shaders into machine code when they first draw, half a second of it for a face, on a thread of its own; a card's driver
//! often leaves some of its work until then, too. So that work is asked for as soon as the pipelines are there, while maps are
//! still painted. What it depends on (formats, samples, maps with smaller copies) is as in a picture; what it does not (sizes, contents) is next to nothing.

use crate::bindings::{self, MapGroups};
use crate::gpu::Gpu;
use crate::gpu_data::Frame;
use crate::layouts::Layouts;
use crate::maps::image::Image;
use crate::pipelines::Pipelines;
use crate::recipes::{Draw, Groups};
use crate::targets::{DEPTH, Targets, texture};
use crate::tier::Detail;
use crate::upload;

/// Side of the targets, pixels.
const SIDE: u32 = 4;
/// More than three vertices of any kind take, bytes.
const VERTEX_BYTES: usize = 512;

/// Everything a pipeline can be given to draw with.
#[derive(Debug)]
pub(crate) struct WarmUp {
    frame: wgpu::BindGroup,
    shadow: wgpu::BindGroup,
    maps: MapGroups,
    vertices: wgpu::Buffer,
    picture: wgpu::TextureView,
    targets: Targets,
    shadow_map: wgpu::TextureView,
}

impl WarmUp {
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        shadow: &wgpu::BindGroup,
        (format, samples): (wgpu::TextureFormat, u32),
        detail: &Detail,
    ) -> Self {
        let device = gpu.device();
        let size = (SIDE, SIDE);
        let none = wgpu::TextureUsages::empty();
        let view = |format| {
            texture(device, "warm-up", size, format, 1, none)
                .create_view(&wgpu::TextureViewDescriptor::default())
        };
        let zeros = [0_u8; size_of::<Frame>()];
        let frame = upload::buffer(gpu, "warm-up", &zeros, wgpu::BufferUsages::UNIFORM);
        let maps = bindings::stand_ins(gpu, layouts, detail, |side: u32| {
            // Drivers take a shorter way where sides are powers of two.
            let side = if side.is_power_of_two() { 4 } else { 6 };
            Image::new(side, side)
        });
        Self {
            frame: bindings::group(device, &layouts.frame, &[frame.as_entire_binding()]),
            shadow: shadow.clone(),
            maps,
            vertices: upload::buffer(
                gpu,
                "warm-up",
                &[0_u8; VERTEX_BYTES],
                wgpu::BufferUsages::VERTEX,
            ),
            picture: view(format),
            targets: Targets::new(device, size, format, samples),
            shadow_map: view(DEPTH),
        }
    }

    /// Sends the triangles on their way.
    pub(crate) fn run(&self, gpu: &Gpu, pipelines: &Pipelines, draws: &[Draw]) {
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("warm-up"),
            });
        let (shadows, pictures): (Vec<Draw>, Vec<Draw>) =
            draws.iter().partition(|draw| draw.is_shadow());
        let attachment = |view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        };
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("warm-up, shadow"),
                depth_stencil_attachment: Some(attachment(&self.shadow_map)),
                ..Default::default()
            });
            self.draw(&mut pass, pipelines, &shadows);
        }
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("warm-up, picture"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: self.targets.colour.as_ref().unwrap_or(&self.picture),
                    depth_slice: None,
                    resolve_target: self.targets.colour.as_ref().map(|_| &self.picture),
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Discard,
                    },
                })],
                depth_stencil_attachment: Some(attachment(&self.targets.depth)),
                ..Default::default()
            });
            self.draw(&mut pass, pipelines, &pictures);
        }
        gpu.queue().submit([encoder.finish()]);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: &Pipelines, draws: &[Draw]) {
        pass.set_bind_group(0, &self.frame, &[]);
        for slot in 0..2 {
            pass.set_vertex_buffer(slot, self.vertices.slice(..));
        }
        for draw in draws {
            let groups: &[&wgpu::BindGroup] = match draw.groups() {
                Groups::Bare => &[],
                Groups::Lit => &[&self.shadow],
                Groups::Mapped if *draw == Draw::Eye => &[&self.shadow, &self.maps.eye],
                Groups::Mapped => &[&self.shadow, &self.maps.hair],
                Groups::Skin => &[&self.shadow, &self.maps.skin],
                Groups::Hung => &[&self.maps.hair],
            };
            for (group, number) in groups.iter().zip(1..) {
                pass.set_bind_group(number, *group, &[]);
            }
            pass.set_pipeline(pipelines.get(*draw));
            pass.draw(0..3, 0..1);
        }
    }
}
