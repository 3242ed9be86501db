//! Words drawn over the picture: at its foot, on a box or with an outline, wrapped, upright for the viewer
//! however the screen hangs.
//!
//! Laid out only when something changes; each picture then costs one more pass over some hundred triangles.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Color32, FontId, Galley, Pos2, Rect, Vec2, pos2, vec2};
use mouthpiece_render::{Gpu, Overlay};

use crate::config::{CaptionStyle, Captions};

/// Share of the picture's width that a line may take, and of its height that all of them may: the mouth is to be seen.
const WIDTH: f32 = 0.88;
const HEIGHT: f32 = 0.2;
/// Share of the picture's height left below.
const FOOT: f32 = 0.04;
/// Smaller letters than this are not read, pixels.
const LETTERS_MIN_PX: f32 = 11.0;
/// Room in the box, and width of the outline, in heights of the letters.
const ROOM: f32 = 0.45;
const OUTLINE: f32 = 0.07;
/// The box lets a little of the picture through.
const BOX: Color32 = Color32::from_black_alpha(190);

/// What is drawn, and how.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Words {
    pub text: Arc<str>,
    pub captions: Captions,
    /// Quarters of a turn, clockwise.
    pub quarters: u32,
    /// How far the picture has wandered, whole pixels to the right and down.
    pub wander: (i32, i32),
}

/// Draws captions to one target.
pub(super) struct Painter {
    context: egui::Context,
    renderer: egui_wgpu::Renderer,
    laid: Option<Laid>,
}

struct Laid {
    words: Words,
    size: (u32, u32),
    jobs: Vec<egui::ClippedPrimitive>,
}

impl Painter {
    pub(super) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        Self {
            context: egui::Context::default(),
            renderer: egui_wgpu::Renderer::new(
                gpu.device(),
                format,
                egui_wgpu::RendererOptions::default(),
            ),
            laid: None,
        }
    }

    /// The same, ready to be drawn over a picture.
    pub(super) fn over(&mut self, words: Words) -> Over<'_> {
        Over {
            painter: self,
            words,
        }
    }

    fn lay(&mut self, gpu: &Gpu, words: &Words, size: (u32, u32)) {
        let screen = vec2(size.0 as f32, size.1 as f32);
        let upright = if words.quarters % 2 == 1 {
            screen.yx()
        } else {
            screen
        };
        let input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, upright)),
            max_texture_side: Some(gpu.device().limits().max_texture_dimension_2d as usize),
            ..egui::RawInput::default()
        };
        let mut output = self.context.run_ui(input, |ui| write(ui, words, upright));
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                self.renderer
                    .update_texture(gpu.device(), gpu.queue(), *id, delta);
            }
        }
        for id in &output.textures_delta.free {
            self.renderer.free_texture(id);
        }
        output.textures_delta.clear();
        let mut jobs = self
            .context
            .tessellate(output.shapes, output.pixels_per_point);
        for job in &mut jobs {
            turn(job, words.quarters, screen);
        }
        self.laid = Some(Laid {
            words: words.clone(),
            size,
            jobs,
        });
    }
}

/// Words and who draws them.
pub(super) struct Over<'a> {
    painter: &'a mut Painter,
    words: Words,
}

impl Overlay for Over<'_> {
    fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        size: (u32, u32),
    ) -> Vec<wgpu::CommandBuffer> {
        let stands = |laid: &Laid| laid.words == self.words && laid.size == size;
        if !self.painter.laid.as_ref().is_some_and(stands) {
            self.painter.lay(gpu, &self.words, size);
        }
        let Painter { renderer, laid, .. } = &mut *self.painter;
        let Some(laid) = laid else {
            return Vec::new();
        };
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: size.into(),
            pixels_per_point: 1.0,
        };
        let first =
            renderer.update_buffers(gpu.device(), gpu.queue(), encoder, &laid.jobs, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("caption"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), &laid.jobs, &screen);
        first
    }
}

/// Puts the words at the foot of an upright picture of `size`.
fn write(ui: &egui::Ui, words: &Words, size: Vec2) {
    let painter = ui.ctx().layer_painter(egui::LayerId::background());
    let mut letters = (size.y * words.captions.size_percent.percent()).max(LETTERS_MIN_PX);
    let mut galley = lay_out(&painter, words, letters, size.x * WIDTH);
    while galley.size().y > size.y * HEIGHT && letters > LETTERS_MIN_PX {
        letters = (letters * 0.9).max(LETTERS_MIN_PX);
        galley = lay_out(&painter, words, letters, size.x * WIDTH);
    }
    let (across, down) = words.wander;
    // The galley's origin is the middle of its first line.
    let top = pos2(
        (size.x / 2.0).round() + across as f32,
        (size.y * (1.0 - FOOT) - letters * ROOM / 2.0 - galley.size().y).round() + down as f32,
    );
    match words.captions.style {
        CaptionStyle::Box => {
            let around = galley.rect.translate(top.to_vec2());
            let around = around.expand2(vec2(letters * ROOM, letters * ROOM / 2.0));
            painter.rect_filled(around, letters * 0.25, BOX);
        }
        CaptionStyle::Outline => {
            let width = (letters * OUTLINE).max(1.0);
            for step in 0..12 {
                let angle = step as f32 * std::f32::consts::TAU / 12.0;
                let at = top + Vec2::angled(angle) * width;
                let black = Arc::clone(&galley);
                painter.galley_with_override_text_color(at, black, Color32::BLACK);
            }
        }
        CaptionStyle::Off => return,
    }
    painter.galley(top, galley, Color32::WHITE);
}

fn lay_out(painter: &egui::Painter, words: &Words, letters: f32, width: f32) -> Arc<Galley> {
    let format = TextFormat {
        font_id: FontId::proportional(letters),
        color: Color32::WHITE,
        ..TextFormat::default()
    };
    let mut job = LayoutJob::single_section(words.text.to_string(), format);
    job.wrap.max_width = width;
    job.halign = Align::Center;
    painter.layout_job(job)
}

/// Turns what was laid out upright to where it is on the screen of that size.
fn turn(job: &mut egui::ClippedPrimitive, quarters: u32, screen: Vec2) {
    let place = |p: Pos2| match quarters % 4 {
        1 => pos2(screen.x - p.y, p.x),
        2 => pos2(screen.x - p.x, screen.y - p.y),
        3 => pos2(p.y, screen.y - p.x),
        _ => p,
    };
    if let egui::epaint::Primitive::Mesh(mesh) = &mut job.primitive {
        for vertex in &mut mesh.vertices {
            vertex.pos = place(vertex.pos);
        }
    }
    let clip = job.clip_rect;
    job.clip_rect = Rect::from_two_pos(place(clip.min), place(clip.max));
}
