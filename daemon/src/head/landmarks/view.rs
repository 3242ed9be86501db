//! The scan in the middle of the window: what the pointing device does there, and the dots.

use egui::{Align2, Color32, FontId, PointerButton, Pos2, Rect, Sense, Stroke, Ui};
use glam::{Vec2, vec2};
use mouthpiece_shop::marking::{Dot, State};

use super::mesh::{Painter, Scene};
use super::session::Session;

/// How near to a dot the pointer takes hold of it, points of the screen.
const REACH: f32 = 7.0;
/// How near a click selects another landmark instead of placing: nearer, since features lie close together.
const TOUCH: f32 = 4.5;
/// Zoom of one point of scrolling.
const ZOOM: f32 = 0.004;

/// Colours of dots by what is known of a landmark.
pub fn colour(state: State) -> Color32 {
    match state {
        State::Set => Color32::from_rgb(70, 215, 110),
        State::Estimated => Color32::from_rgb(255, 190, 60),
        State::MidAir => Color32::from_rgb(110, 185, 255),
        State::Unknown => Color32::from_rgb(130, 130, 130),
    }
}

/// Shows the scan and takes what the hand does to it.
pub fn show(
    ui: &mut Ui,
    session: &mut Session,
    painter: &Painter,
    scene: &mut Scene,
    egui: &mut egui_wgpu::Renderer,
) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let size = vec2(rect.width(), rect.height());
    if !session.asking {
        interact(ui, &response, rect, session);
    }
    let pixels = ui.ctx().pixels_per_point();
    let coloured = session.coloured && scene.coloured;
    let picture = painter.paint(
        scene,
        egui,
        &session.marking.camera,
        coloured,
        [rect.width() * pixels, rect.height() * pixels].map(|side| side.round() as u32),
    );
    let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
    ui.painter().image(picture, rect, whole, Color32::WHITE);

    let selected = session.marking.selected();
    let dots = session.marking.dots(size);
    // The selected one last, on top.
    for dot in dots.iter().filter(|d| d.landmark != selected) {
        draw_dot(ui, rect, dot, None);
    }
    if let Some(dot) = dots.iter().find(|d| d.landmark == selected) {
        draw_dot(ui, rect, dot, Some(session.marking.name(selected)));
    }
    let under = response
        .hover_pos()
        .filter(|_| !session.marking.is_dragging())
        .and_then(|at| session.marking.dot_at(local(rect, at), size, REACH));
    if let Some(landmark) = under {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        if let Some(dot) = dots.iter().find(|d| d.landmark == landmark) {
            label(ui, rect, dot, session.marking.name(landmark));
        }
    } else if response.hovered() {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
    }
}

fn interact(ui: &Ui, response: &egui::Response, rect: Rect, session: &mut Session) {
    let size = vec2(rect.width(), rect.height());
    let (modifiers, scroll, delta, origin) = ui.input(|i| {
        (
            i.modifiers,
            i.smooth_scroll_delta(),
            i.pointer.delta(),
            i.pointer.press_origin(),
        )
    });
    let in_air = modifiers.alt;
    let delta = vec2(delta.x, delta.y);
    let marking = &mut session.marking;
    if response.drag_started_by(PointerButton::Primary)
        && !modifiers.shift
        && let Some(at) = origin
    {
        marking.press(local(rect, at), size, REACH);
    }
    if response.drag_started() && !marking.is_dragging() {
        marking.begin_turn(size);
    }
    if let Some(at) = response.interact_pointer_pos()
        && marking.is_dragging()
    {
        marking.drag(local(rect, at), size, in_air);
    } else if response.dragged_by(PointerButton::Middle)
        || (modifiers.shift && response.dragged_by(PointerButton::Primary))
    {
        marking.camera.pan(delta, size);
    } else if response.dragged_by(PointerButton::Primary)
        || response.dragged_by(PointerButton::Secondary)
    {
        marking.camera.orbit(delta, size);
    }
    if response.drag_stopped() {
        marking.release();
    }
    if let Some(at) = response.hover_pos()
        && scroll.y != 0.0
    {
        marking.zoom((scroll.y * ZOOM).exp(), local(rect, at), size);
    }
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        let at = local(rect, at);
        let selected = marking.selected();
        let other = marking
            .dot_at(at, size, TOUCH)
            .filter(|dot| *dot != selected && !modifiers.ctrl);
        if let Some(other) = other {
            marking.select(other);
            session.selected();
        } else {
            let before = marking.state(selected);
            let placed = marking.click(at, size, in_air);
            session.placed(placed, before);
        }
    }
}

fn local(rect: Rect, at: Pos2) -> Vec2 {
    vec2(at.x - rect.min.x, at.y - rect.min.y)
}

fn draw_dot(ui: &Ui, rect: Rect, dot: &Dot, selected: Option<&str>) {
    let at = rect.min + egui::vec2(dot.at.x, dot.at.y);
    if !rect.contains(at) {
        return;
    }
    let painter = ui.painter_at(rect);
    let fade = |c: Color32| if dot.hidden { c.gamma_multiply(0.3) } else { c };
    let colour = fade(colour(dot.state));
    let dark = fade(Color32::from_black_alpha(200));
    let radius = if selected.is_some() { 5.5 } else { 4.0 };
    if dot.state == State::Set {
        painter.circle(at, radius, colour, Stroke::new(1.2, dark));
    } else {
        // Hollow: nobody has looked at it yet.
        painter.circle_stroke(at, radius, Stroke::new(3.4, dark));
        painter.circle_stroke(at, radius, Stroke::new(1.8, colour));
    }
    if let Some(name) = selected {
        painter.circle_stroke(at, radius + 4.0, Stroke::new(1.6, fade(Color32::WHITE)));
        label(ui, rect, dot, name);
    }
}

fn label(ui: &Ui, rect: Rect, dot: &Dot, name: &str) {
    let painter = ui.painter_at(rect);
    let at = rect.min + egui::vec2(dot.at.x + 12.0, dot.at.y - 10.0);
    let text = painter.layout_no_wrap(name.to_owned(), FontId::proportional(14.0), Color32::WHITE);
    let place = Align2::LEFT_CENTER.anchor_size(at, text.size());
    painter.rect_filled(place.expand(3.0), 3.0, Color32::from_black_alpha(190));
    painter.galley(place.min, text, Color32::WHITE);
}
