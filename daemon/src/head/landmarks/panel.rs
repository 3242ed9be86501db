//! Beside the scan: what to place now, with a picture of where; the list of all; buttons, keys, and the question at
//! the end.

use egui::{Color32, Key, Modifiers, Rect, RichText, Sense, Stroke, Ui};
use glam::{Mat3, Quat, Vec3, vec2};
use mouthpiece_shop::marking::names::words;
use mouthpiece_shop::marking::{Camera, Marking, State, View, Warning};

use super::mesh::{Painter, Scene};
use super::session::Session;
use super::view::colour;

/// Height of the reference picture, points of the screen.
const PICTURE: f32 = 250.0;

/// The row of buttons above the scan.
pub fn bar(ui: &mut Ui, session: &mut Session, coloured: bool) {
    ui.horizontal_wrapped(|ui| {
        for view in View::ALL {
            let key = match view {
                View::Front => " (F)",
                View::Left => " (L)",
                View::Right => " (R)",
                _ => "",
            };
            if ui.button(format!("{}{key}", view.name())).clicked() {
                session.marking.look(view);
            }
        }
        if ui
            .button("Turn by a quarter")
            .on_hover_text("for scans that lie on their side")
            .clicked()
        {
            session.marking.quarter_turn(1);
        }
        if coloured {
            ui.checkbox(&mut session.coloured, "Colour")
                .on_hover_text("the scan's own, or clay, which shows its shape");
        }
        ui.separator();
        if ui.button("Undo").on_hover_text("Ctrl+Z").clicked() {
            session.undo();
        }
        if ui.button("Redo").on_hover_text("Ctrl+Y").clicked() {
            session.redo();
        }
        let save = egui::Button::new("Save");
        if ui
            .add_enabled(session.can_save(), save)
            .on_hover_text(format!("Ctrl+S: {}", session.output.display()))
            .clicked()
        {
            session.save();
        }
    });
}

/// The line below the scan.
pub fn status(ui: &mut Ui, session: &Session) {
    ui.horizontal_wrapped(|ui| {
        let marking = &session.marking;
        ui.label(format!("{} of {} set", marking.set_count(), marking.count()));
        ui.separator();
        if session.said.is_empty() {
            ui.weak("Drag: turn · Shift+drag: shift · wheel: zoom · click: place · drag a dot: move it · Alt: in mid-air");
        } else if session.bad {
            ui.colored_label(ui.visuals().error_fg_color, &session.said);
        } else {
            ui.label(&session.said);
        }
    });
}

/// What to place now.
pub fn current(
    ui: &mut Ui,
    session: &mut Session,
    painter: &Painter,
    reference: &mut Scene,
    camera: &Camera,
    egui: &mut egui_wgpu::Renderer,
) {
    let selected = session.marking.selected();
    let name = session.marking.name(selected).to_owned();
    let said = words(&name);
    ui.horizontal(|ui| {
        ui.label(RichText::new(&name).heading().strong());
        ui.label(RichText::new(&said.title).heading());
    });
    ui.label(format!("Here: {}.", said.place));
    let size = egui::vec2(ui.available_width(), PICTURE);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    if let Some(point) = session.marking.reference().get(selected) {
        let camera = portrait(camera, point.at);
        let pixels = ui.ctx().pixels_per_point();
        let side = [size.x, size.y].map(|s| (s * pixels).round() as u32);
        let picture = painter.paint(reference, egui, &camera, true, side);
        let whole = Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        ui.painter().image(picture, rect, whole, Color32::WHITE);
        if let Some(at) = camera.pixel_of(point.at, vec2(size.x, size.y)) {
            let at = rect.min + egui::vec2(at.x, at.y);
            let mark = ui.painter_at(rect);
            mark.circle_filled(at, 4.5, Color32::from_rgb(235, 60, 70));
            mark.circle_stroke(at, 9.0, Stroke::new(1.8, Color32::WHITE));
        }
    }
    ui.horizontal_wrapped(|ui| {
        if ui.button("Next (Enter)").clicked() {
            session.next();
        }
        let state = session.marking.state(selected);
        let estimated = matches!(state, State::Estimated | State::MidAir);
        if ui
            .add_enabled(estimated, egui::Button::new("Accept (Space)"))
            .on_hover_text("the estimate is right: keep it where it is")
            .clicked()
        {
            session.accept();
        }
        let set = state == State::Set;
        if ui
            .add_enabled(set, egui::Button::new("Clear (Backspace)"))
            .clicked()
        {
            session.clear();
        }
        ui.checkbox(&mut session.go_on, "Go on after a click");
    });
}

/// What looks wrong, with the mend.
pub fn warnings(ui: &mut Ui, marking: &mut Marking) {
    for warning in marking.warnings().to_vec() {
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(ui.visuals().warn_fg_color, marking.words(&warning));
            match warning {
                Warning::Line => {}
                Warning::Swapped => {
                    if ui.button("Exchange left and right").clicked() {
                        marking.exchange_sides();
                    }
                }
                Warning::Pair(left, right) => {
                    if ui.button("Exchange the two").clicked() {
                        marking.exchange(left, right);
                    }
                }
                Warning::Stray { landmark, .. } => {
                    if ui.button("Show it").clicked() {
                        marking.select(landmark);
                    }
                }
            }
        });
    }
}

/// All landmarks; a click selects.
pub fn list(ui: &mut Ui, marking: &mut Marking) {
    let last = ui.scope_id().with("selected");
    let before: Option<usize> = ui.data(|data| data.get_temp(last));
    let selected = marking.selected();
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show(ui, |ui| {
            for landmark in 0..marking.count() {
                let said = words(marking.name(landmark));
                let state = marking.state(landmark);
                let row = ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), Sense::hover());
                    if state == State::Set {
                        ui.painter()
                            .circle_filled(rect.center(), 4.5, colour(state));
                    } else {
                        let line = Stroke::new(1.6, colour(state));
                        ui.painter().circle_stroke(rect.center(), 4.0, line);
                    }
                    let text = format!("{}  {}", marking.name(landmark), said.title);
                    let stated = match state {
                        State::Set => "set",
                        State::Estimated => "estimated",
                        State::MidAir => "estimated, in mid-air",
                        State::Unknown => "not set",
                    };
                    ui.selectable_label(landmark == selected, text)
                        .on_hover_text(format!("{stated}: {}", said.place))
                });
                if landmark == selected && before != Some(selected) {
                    row.inner.scroll_to_me(None);
                }
                if row.inner.clicked() {
                    marking.select(landmark);
                }
            }
        });
    ui.data_mut(|data| data.insert_temp(last, selected));
}

/// Keys, where no question is open.
pub fn keys(ui: &Ui, session: &mut Session) {
    let pressed = |modifiers: Modifiers, key: Key| ui.input_mut(|i| i.consume_key(modifiers, key));
    let control = Modifiers::COMMAND;
    if pressed(control | Modifiers::SHIFT, Key::Z) || pressed(control, Key::Y) {
        session.redo();
    }
    if pressed(control, Key::Z) {
        session.undo();
    }
    if pressed(control, Key::S) {
        session.save();
    }
    if pressed(control, Key::Q) || pressed(control, Key::W) {
        session.close();
    }
    for (key, view) in [
        (Key::F, View::Front),
        (Key::L, View::Left),
        (Key::R, View::Right),
    ] {
        if pressed(Modifiers::NONE, key) {
            session.marking.look(view);
        }
    }
    if pressed(Modifiers::NONE, Key::Enter) {
        session.next();
    }
    if pressed(Modifiers::NONE, Key::Backspace) || pressed(Modifiers::NONE, Key::Delete) {
        session.clear();
    }
    if pressed(Modifiers::NONE, Key::Space) {
        session.accept();
    }
}

/// The question at the end.
pub fn question(ui: &Ui, session: &mut Session) {
    egui::Modal::new(egui::Id::unique("unsaved")).show(ui.ctx(), |ui| {
        ui.set_max_width(380.0);
        ui.heading("Save the landmarks?");
        ui.label(format!(
            "What you changed is not in {} yet.",
            session.output.display()
        ));
        if session.bad {
            ui.colored_label(ui.visuals().error_fg_color, &session.said);
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if ui.button("Save").clicked() {
                session.done = session.save();
            }
            if ui.button("Throw away").clicked() {
                session.done = true;
            }
            let escape = ui.input(|i| i.key_pressed(Key::Escape));
            if ui.button("Go back").clicked() || escape {
                session.asking = false;
            }
        });
    });
}

/// The reference head so that a landmark is well in sight: from the front where that shows it, else from its side.
/// Its place tells the side: the skin's normal is of no use where lids and lips turn inwards.
fn portrait(whole: &Camera, at: Vec3) -> Camera {
    /// How much the front is preferred to the landmark's own side.
    const FRONT: f32 = 0.5;
    /// Up and down count less than left and right: heads are looked at from their own height.
    const LEVEL: f32 = 0.45;
    /// How far the camera goes from the head's middle to the landmark, and how near it gets.
    const TOWARDS: f32 = 0.6;
    const NEARER: f32 = 0.6;
    let outward = (at - whole.target) * Vec3::new(1.0, LEVEL, 1.0);
    let back = (outward.normalize_or_zero() + Vec3::Z * FRONT).normalize_or(Vec3::Z);
    let right = Vec3::Y.cross(back).normalize_or(Vec3::X);
    let mut camera = *whole;
    camera.turn = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
    camera.target = whole.target.lerp(at, TOWARDS);
    camera.distance = whole.distance * NEARER;
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_picture_looks_at_the_landmark_and_stands_upright() {
        let whole = Camera::at(&[Vec3::splat(-100.0), Vec3::splat(100.0)]);
        let size = vec2(300.0, 250.0);
        for at in [
            Vec3::Z * 90.0,
            Vec3::Z * -90.0,
            Vec3::X * 80.0,
            Vec3::Y * 90.0,
            Vec3::new(-40.0, 30.0, 80.0),
        ] {
            let camera = portrait(&whole, at);
            assert!(camera.back().dot(at.normalize()) > 0.3, "{at}");
            assert!((camera.turn * Vec3::Y).y > 0.3, "{at}");
            let pixel = camera.pixel_of(at, size).unwrap();
            assert!(pixel.distance(size / 2.0) < 110.0, "{at}: {pixel}");
        }
    }
}
