//! The two passes of a picture: depth as the key lamp sees it, and the picture itself.

use mouthpiece_rig::Material;

use crate::model::SkinModel;
use crate::recipes::Draw;
use crate::renderer::{PartBuffers, Renderer};
use crate::targets::Targets;
use crate::view::{Background, Shown, View};

/// Two triangles a cell. Keep in step with shaders/background.wgsl.
const BACKDROP_VERTICES: u32 = 8 * 6 * 6;

impl Renderer {
    /// Depth from the key lamp: the skin casts shadows, or without it what lies beneath; the hair's would
    /// fall on the scalp.
    pub(crate) fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, shown: Shown) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(clear_depth(&self.shadow_map, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        match shown {
            Shown::Face | Shown::Yardstick => {
                self.draw_skin(&mut pass, Draw::SkinShadow, &self.casting_indices);
            }
            Shown::Anatomy => {
                pass.set_pipeline(self.pipelines.get(Draw::PartShadow));
                for (_, buffers) in self.parts.iter().filter(|(m, _)| under_skin(*m)) {
                    draw_part(&mut pass, buffers);
                }
            }
        }
    }

    pub(crate) fn picture_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        target: &wgpu::TextureView,
        view: &View,
        mouth_open: bool,
    ) {
        // One colour needs no drawing, where the target takes it as it is.
        let plain = match view.background {
            Background::Plain(colour) if !self.format.is_srgb() => Some(colour),
            _ => None,
        };
        let [r, g, b] = plain.unwrap_or_default().map(|c| f64::from(c) / 255.0);
        let clear = wgpu::Color { r, g, b, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: targets.colour.as_ref().unwrap_or(target),
                depth_slice: None,
                resolve_target: targets.colour.as_ref().map(|_| target),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear),
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
            Shown::Yardstick => {
                pass.set_bind_group(2, &self.maps.skin, &[]);
                return self.draw_skin(&mut pass, Draw::Yardstick, &self.skin_indices);
            }
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
            _ if plain.is_some() => {}
            _ => {
                pass.set_pipeline(self.pipelines.get(Draw::Backdrop));
                pass.draw(0..BACKDROP_VERTICES, 0..1);
            }
        }
        if self.samples == 1 && view.shown == Shown::Face {
            // What is blended comes after all that it lets show.
            pass.set_bind_group(1, &self.shadow_group, &[]);
            for (material, buffers) in self.parts.iter().filter(|(m, _)| *m == Material::Lash) {
                self.draw_material(&mut pass, *material, buffers);
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
        if let Some(brows) = &self.brow_buffers {
            pass.set_pipeline(self.pipelines.get(Draw::Brow));
            pass.set_vertex_buffer(0, brows.moving.slice(..));
            pass.set_vertex_buffer(1, brows.still.slice(..));
            pass.set_index_buffer(brows.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.brows.indices.len() as u32, 0, 0..1);
        }
        let drawn = |m: Material| {
            !matches!(
                m,
                Material::Hair | Material::Bone | Material::Muscle | Material::Spring
            ) && (mouth_open || !in_mouth(m))
                && (self.samples > 1 || m != Material::Lash)
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
        let (draw, maps) = match material {
            Material::Hair => (Draw::Hair, Some(&self.maps.hair)),
            Material::Eye => (Draw::Eye, Some(&self.maps.eye)),
            Material::Teeth => (Draw::Teeth, None),
            Material::Bone => (Draw::Bone, None),
            Material::Muscle => (Draw::Muscle, None),
            Material::Spring => (Draw::Spring, None),
            Material::Gums => (Draw::Gums, None),
            Material::Tongue => (Draw::Tongue, None),
            Material::Cavity => (Draw::Cavity, None),
            Material::Lash => (Draw::Lash, None),
            Material::Cloth | Material::Skin => (Draw::Cloth, None),
        };
        pass.set_pipeline(self.pipelines.get(draw));
        if let Some(maps) = maps {
            pass.set_bind_group(2, maps, &[]);
        }
        draw_part(pass, buffers);
    }
}

/// Front to back as far as a head goes, so that what is hidden is not shaded. `Skin` is the head's
/// own mesh: parts of that material do not occur.
pub(crate) const DRAW_ORDER: [Material; 11] = [
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
pub(crate) const SHUT_MM: f32 = 0.02;

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

fn draw_part(pass: &mut wgpu::RenderPass<'_>, buffers: &PartBuffers) {
    pass.set_vertex_buffer(0, buffers.vertices.slice(..));
    pass.set_index_buffer(buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
    pass.draw_indexed(0..buffers.count, 0, 0..1);
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
