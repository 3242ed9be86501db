//! Meshes drawn into pictures that egui shows: one small pipeline, a depth buffer, several samples a pixel.
//!
//! A picture is drawn again only when something about it has changed, since scans are large and some machines draw in
//! software.

use std::borrow::Cow;

use glam::Vec3;
use mouthpiece_render::Gpu;
use mouthpiece_shop::marking::Camera;
use mouthpiece_shop::mesh::Image;
use wgpu::util::DeviceExt as _;

use super::shape::{Shape, Vertex, at_most};

/// What egui wants pictures in: finished sRGB values that the card does not convert.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Samples a pixel.
const SAMPLES: u32 = 4;

/// Sides of scans' textures: larger ones are halved, as no view shows more.
const TEXTURE_SIDE_MAX: u32 = 4096;

/// The view's backdrop, sRGB.
const BACKDROP: wgpu::Color = wgpu::Color {
    r: 0.145,
    g: 0.155,
    b: 0.17,
    a: 1.0,
};

/// The uniform block `Look` of mesh.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Look {
    clip_from_world: [[f32; 4]; 4],
    lamp: [f32; 4],
    eye: [f32; 4],
    colour: [f32; 4],
}

/// What draws meshes.
pub struct Painter {
    gpu: Gpu,
    pipeline: wgpu::RenderPipeline,
    samples: u32,
    sampler: wgpu::Sampler,
}

/// A mesh on the graphics card, and the picture it is drawn into.
pub struct Scene {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    look: wgpu::Buffer,
    look_group: wgpu::BindGroup,
    texture_group: wgpu::BindGroup,
    picture: Option<Picture>,
    drawn: Option<Look>,
    /// Whether the mesh has colour of its own.
    pub coloured: bool,
}

struct Picture {
    size: [u32; 2],
    shown: wgpu::TextureView,
    sampled: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    id: egui::TextureId,
}

impl Painter {
    /// For one device.
    pub fn new(gpu: &Gpu) -> Self {
        let device = gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("landmarks mesh"),
            source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(include_str!("mesh.wgsl"))),
        });
        let attributes =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Unorm8x4];
        let samples = gpu.samples(FORMAT, SAMPLES);
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("landmarks mesh"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &attributes,
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            gpu: gpu.clone(),
            pipeline,
            samples,
            sampler,
        }
    }

    /// Takes a mesh to the graphics card; an error where it is too large for it.
    pub fn scene(&self, shape: Shape) -> anyhow::Result<Scene> {
        let device = self.gpu.device();
        let room = device.limits().max_buffer_size;
        let vertices: &[u8] = bytemuck::cast_slice(&shape.vertices);
        let indices: &[u8] = bytemuck::cast_slice(&shape.indices);
        anyhow::ensure!(
            (vertices.len().max(indices.len()) as u64) <= room,
            "the scan has {} triangles, more than this machine's graphics can draw: decimate it to about 200,000",
            shape.indices.len() / 3
        );
        let buffer = |label, contents, usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let look = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("look"),
            size: size_of::<Look>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let look_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("look"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: look.as_entire_binding(),
            }],
        });
        Ok(Scene {
            vertices: buffer("vertices", vertices, wgpu::BufferUsages::VERTEX),
            indices: buffer("indices", indices, wgpu::BufferUsages::INDEX),
            count: shape.indices.len() as u32,
            look,
            look_group,
            texture_group: self.texture(shape.texture),
            picture: None,
            drawn: None,
            coloured: shape.coloured,
        })
    }

    fn texture(&self, image: Option<Image>) -> wgpu::BindGroup {
        let device = self.gpu.device();
        let side = TEXTURE_SIDE_MAX.min(device.limits().max_texture_dimension_2d);
        let whole = |i: &Image| {
            let texels = i.width as usize * i.height as usize;
            texels > 0 && i.rgb.len() == texels * 3
        };
        let image = image
            .filter(whole)
            .map_or_else(white, |image| at_most(image, side));
        let rgba: Vec<u8> = image
            .rgb
            .chunks_exact(3)
            .flat_map(|p| [p[0], p[1], p[2], 255])
            .collect();
        let texture = device.create_texture_with_data(
            self.gpu.queue(),
            &wgpu::TextureDescriptor {
                label: Some("scan colour"),
                size: extent([image.width, image.height]),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            &rgba,
        );
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scan colour"),
            layout: &self.pipeline.get_bind_group_layout(1),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&view),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        })
    }

    /// The scene's picture of `size` pixels as `camera` sees it, drawn if it has to be.
    pub fn paint(
        &self,
        scene: &mut Scene,
        egui: &mut egui_wgpu::Renderer,
        camera: &Camera,
        coloured: bool,
        size: [u32; 2],
    ) -> egui::TextureId {
        let most = self.gpu.device().limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, most));
        let eye = camera.back();
        // From the upper left, as drawings are lit.
        let lamp = (camera.turn * Vec3::new(-0.45, 0.55, 0.8)).normalize();
        let look = Look {
            clip_from_world: camera
                .clip_from_world(size[0] as f32 / size[1] as f32)
                .to_cols_array_2d(),
            lamp: lamp.extend(0.0).to_array(),
            eye: eye.extend(0.0).to_array(),
            colour: [f32::from(u8::from(coloured)), 0.0, 0.0, 0.0],
        };
        let fits = scene.picture.as_ref().filter(|p| p.size == size).is_some();
        if !fits {
            let old = scene.picture.take().map(|p| p.id);
            scene.picture = Some(self.picture(egui, size, old));
            scene.drawn = None;
        }
        if scene.drawn != Some(look) {
            self.draw(scene, &look);
            scene.drawn = Some(look);
        }
        scene.picture.as_ref().map(|p| p.id).unwrap_or_default()
    }

    fn picture(
        &self,
        egui: &mut egui_wgpu::Renderer,
        size: [u32; 2],
        old: Option<egui::TextureId>,
    ) -> Picture {
        let device = self.gpu.device();
        let texture = |label, format, sample_count, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: extent(size),
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let none = wgpu::TextureUsages::empty();
        let shown = texture("view", FORMAT, 1, wgpu::TextureUsages::TEXTURE_BINDING);
        let filter = wgpu::FilterMode::Linear;
        let id = match old {
            Some(id) => {
                egui.update_egui_texture_from_wgpu_texture(device, &shown, filter, id);
                id
            }
            None => egui.register_native_texture(device, &shown, filter),
        };
        Picture {
            size,
            shown,
            sampled: (self.samples > 1).then(|| texture("samples", FORMAT, self.samples, none)),
            depth: texture("depth", DEPTH, self.samples, none),
            id,
        }
    }

    fn draw(&self, scene: &Scene, look: &Look) {
        let Some(picture) = &scene.picture else {
            return;
        };
        let queue = self.gpu.queue();
        queue.write_buffer(&scene.look, 0, bytemuck::bytes_of(look));
        let mut encoder = self
            .gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let (view, resolve_target) = match &picture.sampled {
                Some(sampled) => (sampled, Some(&picture.shown)),
                None => (&picture.shown, None),
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("landmarks mesh"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(BACKDROP),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &picture.depth,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(1.0),
                        store: wgpu::StoreOp::Discard,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &scene.look_group, &[]);
            pass.set_bind_group(1, &scene.texture_group, &[]);
            pass.set_vertex_buffer(0, scene.vertices.slice(..));
            pass.set_index_buffer(scene.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..scene.count, 0, 0..1);
        }
        queue.submit([encoder.finish()]);
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

/// Stands in where there is no texture.
fn white() -> Image {
    Image {
        width: 1,
        height: 1,
        rgb: vec![255; 3],
    }
}
