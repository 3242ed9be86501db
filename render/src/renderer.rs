//! Draws a head: owns its buffers, maps and pipelines, and writes one picture's commands.

use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use mouthpiece_rig::{Head, KeyFrame, Material, Skin};

use crate::bindings::{self, MapGroups};
use crate::error::RenderError;
use crate::frame;
use crate::geometry::PartGeometry;
use crate::gpu::Gpu;
use crate::gpu_data::{Frame, SkinMoving};
use crate::maps::Maps;
use crate::model::SkinModel;
use crate::openings::Openings;
use crate::picture::Picture;
use crate::pipelines::{Draw, Layouts, Pipelines};
use crate::surface::SkinGeometry;
use crate::targets::Targets;
use crate::tier::Tier;
use crate::upload;
use crate::view::{Background, Extent, Shown, View};

/// Buffers of one part material.
#[derive(Debug)]
struct PartBuffers {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

/// Two triangles a cell. Keep in step with shaders/background.wgsl.
const BACKDROP_VERTICES: u32 = 8 * 6 * 6;

/// The head on the card, ready to be drawn in one target format.
#[derive(Debug)]
pub struct Renderer {
    /// Only what [`Head::bodies`] needs.
    pose: Head,
    extent: Extent,
    openings: Openings,
    format: wgpu::TextureFormat,
    samples: u32,
    skin: SkinGeometry,
    skin_moving: wgpu::Buffer,
    skin_still: wgpu::Buffer,
    skin_indices: wgpu::Buffer,
    inside_indices: wgpu::Buffer,
    parts: Vec<(Material, PartBuffers)>,
    pipelines: Pipelines,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    shadow_map: wgpu::TextureView,
    shadow_group: wgpu::BindGroup,
    maps: MapGroups,
    layouts: Layouts,
    hung: Option<Hung>,
    targets: Option<Targets>,
}

/// The picture behind the head, on the card.
#[derive(Debug)]
struct Hung {
    picture: Arc<Picture>,
    group: wgpu::BindGroup,
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
        // Pipelines are made beside painting and meshing: nearly all of a start's work is one or the other.
        let next = AtomicUsize::new(0);
        let make = || pipelines.make_some(&Draw::FACE, &next);
        let (skin, painted) = std::thread::scope(|scope| {
            // Where no thread is to be had the work is done here.
            let _ = std::thread::Builder::new()
                .name("pipelines".into())
                .spawn_scoped(scope, make);
            let skin = SkinGeometry::of(head, detail.smoothness);
            let painted = Maps::paint(head, &detail);
            make();
            (skin, painted)
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
        let parts = DRAW_ORDER
            .into_iter()
            .filter_map(|material| {
                let geometry = PartGeometry::of(head, material);
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
        let (shadow_map, shadow_group) = bindings::shadow(gpu, &layouts, &detail);
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
            parts,
            pipelines,
            frame,
            frame_group,
            shadow_map,
            shadow_group,
            maps,
            layouts,
            hung: None,
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
        Ok(gpu.queue().submit([encoder.finish()]))
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
            self.hung = Some(Hung {
                picture: Arc::clone(picture),
                group: bindings::picture(gpu, &self.layouts, picture),
            });
        }
        self.skin.set(&key_frame.skin);
        gpu.queue().write_buffer(
            &self.skin_moving,
            0,
            bytemuck::cast_slice::<SkinMoving, u8>(&self.skin.moving),
        );
        let open = self.openings.measure(self.skin.points());
        let frame = frame::data(&self.pose, &self.extent, &open, key_frame, view, size);
        gpu.queue()
            .write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
        self.shadow_pass(encoder, view.shown);
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

    /// Depth from the key lamp: the skin casts shadows, or without it what lies beneath; the hair's would
    /// fall on the scalp.
    fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, shown: Shown) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(clear_depth(&self.shadow_map, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        match shown {
            Shown::Face => {
                self.draw_skin(&mut pass, Draw::SkinShadow, &self.skin_indices);
            }
            Shown::Anatomy => {
                pass.set_pipeline(self.pipelines.get(Draw::PartShadow));
                for (_, buffers) in self.parts.iter().filter(|(m, _)| under_skin(*m)) {
                    draw_part(&mut pass, buffers, 1);
                }
            }
        }
    }

    fn picture_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        target: &wgpu::TextureView,
        view: &View,
        mouth_open: bool,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: targets.colour.as_ref().unwrap_or(target),
                depth_slice: None,
                resolve_target: targets.colour.as_ref().map(|_| target),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: if targets.colour.is_some() {
                        wgpu::StoreOp::Discard
                    } else {
                        wgpu::StoreOp::Store
                    },
                },
            })],
            depth_stencil_attachment: Some(clear_depth(&targets.depth, wgpu::StoreOp::Discard)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, &self.shadow_group, &[]);
        match view.shown {
            Shown::Face => self.draw_face(&mut pass, view.skin, mouth_open),
            Shown::Anatomy => {
                for (material, buffers) in self.parts.iter().filter(|(m, _)| under_skin(*m)) {
                    self.draw_material(&mut pass, *material, buffers);
                }
            }
        }
        match &self.hung {
            Some(hung) if matches!(&view.background, Background::Picture(_)) => {
                pass.set_pipeline(self.pipelines.get(Draw::Picture));
                pass.set_bind_group(1, &hung.group, &[]);
                pass.draw(0..3, 0..1);
            }
            _ => {
                pass.set_pipeline(self.pipelines.get(Draw::Backdrop));
                pass.draw(0..BACKDROP_VERTICES, 0..1);
            }
        }
        if view.flash {
            pass.set_pipeline(self.pipelines.get(Draw::Flash));
            pass.draw(0..6, 0..1);
        }
    }

    fn draw_face(&self, pass: &mut wgpu::RenderPass<'_>, skin: SkinModel, mouth_open: bool) {
        for (material, buffers) in self.parts.iter().filter(|(m, _)| *m == Material::Hair) {
            self.draw_material(pass, *material, buffers);
        }
        pass.set_bind_group(2, &self.maps.skin, &[]);
        let model = match skin {
            SkinModel::Physical => Draw::Skin,
            SkinModel::BlinnPhong => Draw::SkinBlinnPhong,
        };
        self.draw_skin(pass, model, &self.skin_indices);
        let drawn = |m: Material| {
            !matches!(
                m,
                Material::Hair | Material::Bone | Material::Muscle | Material::Spring
            ) && (mouth_open || !in_mouth(m))
        };
        for (material, buffers) in self.parts.iter().filter(|(m, _)| drawn(*m)) {
            self.draw_material(pass, *material, buffers);
        }
        if mouth_open && !self.skin.inside.is_empty() {
            self.draw_skin(pass, Draw::Inside, &self.inside_indices);
        }
    }

    fn draw_skin(&self, pass: &mut wgpu::RenderPass<'_>, draw: Draw, indices: &wgpu::Buffer) {
        pass.set_pipeline(self.pipelines.get(draw));
        pass.set_vertex_buffer(0, self.skin_moving.slice(..));
        pass.set_vertex_buffer(1, self.skin_still.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..(indices.size() / 4) as u32, 0, 0..1);
    }

    fn draw_material(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        material: Material,
        buffers: &PartBuffers,
    ) {
        let (draw, maps, instances) = match material {
            Material::Hair => (Draw::Hair, Some(&self.maps.hair), 1),
            Material::Eye => (Draw::Eye, Some(&self.maps.eye), 1),
            Material::Teeth => (Draw::Teeth, None, 1),
            Material::Bone => (Draw::Bone, None, 1),
            Material::Muscle => (Draw::Muscle, None, 1),
            Material::Spring => (Draw::Spring, None, 1),
            Material::Gums => (Draw::Gums, None, 1),
            Material::Tongue => (Draw::Tongue, None, 1),
            Material::Cavity => (Draw::Cavity, None, 1),
            Material::Lash => (Draw::Lash, None, 1),
            Material::Cloth | Material::Skin => (Draw::Cloth, None, 1),
        };
        pass.set_pipeline(self.pipelines.get(draw));
        if let Some(maps) = maps {
            pass.set_bind_group(2, maps, &[]);
        }
        draw_part(pass, buffers, instances);
    }
}

/// Front to back as far as a head goes, so that what is hidden is not shaded. `Skin` is the head's
/// own mesh: parts of that material do not occur.
const DRAW_ORDER: [Material; 11] = [
    Material::Spring,
    Material::Muscle,
    Material::Bone,
    Material::Hair,
    Material::Cloth,
    Material::Lash,
    Material::Eye,
    Material::Teeth,
    Material::Gums,
    Material::Tongue,
    Material::Cavity,
];

/// Half a gap between the lips that is no gap, mm: nothing of the mouth's inside is drawn then.
const SHUT_MM: f32 = 0.02;

fn in_mouth(material: Material) -> bool {
    matches!(
        material,
        Material::Teeth | Material::Gums | Material::Tongue | Material::Cavity
    )
}

/// Whether a part is drawn where the skin is not.
fn under_skin(material: Material) -> bool {
    matches!(
        material,
        Material::Bone | Material::Muscle | Material::Spring | Material::Teeth | Material::Eye
    )
}

fn draw_part(pass: &mut wgpu::RenderPass<'_>, buffers: &PartBuffers, instances: u32) {
    pass.set_vertex_buffer(0, buffers.vertices.slice(..));
    pass.set_index_buffer(buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
    pass.draw_indexed(0..buffers.count, 0, 0..instances);
}

fn clear_depth(
    view: &wgpu::TextureView,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(1.0),
            store,
        }),
        stencil_ops: None,
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
