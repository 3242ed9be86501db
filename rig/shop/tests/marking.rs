//! What a person does when marking a scan, driven without a window: pixels in, landmarks out.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on is over")]

#[path = "scans/shapes.rs"]
#[allow(dead_code, reason = "the scan tests use the rest")]
mod shapes;

use glam::{DVec3, Quat, Vec2, Vec3, vec2};
use mouthpiece_shop::closest::{Facing, Surface};
use mouthpiece_shop::landmarks::{LandmarkFault, Landmarks, Unit};
use mouthpiece_shop::marking::{Marking, Placed, State, View, Warning};
use mouthpiece_shop::mesh::Scan;

const SIZE: Vec2 = vec2(900.0, 700.0);

fn marking(scan: &Scan) -> Marking {
    let surface = Surface::new(&scan.positions, &scan.triangles).unwrap();
    Marking::new(surface, shapes::reference(), None).unwrap()
}

/// Where the landmark truly is on the made-up head.
fn truth(name: &str) -> Vec3 {
    shapes::landmarks().points[name].as_vec3()
}

/// Clicks on the pixel on which the landmark truly is.
fn click(marking: &mut Marking, name: &str) {
    marking.select(marking.find(name).unwrap());
    let pixel = marking.camera.pixel_of(truth(name), SIZE).unwrap();
    assert_eq!(marking.click(pixel, SIZE, false), Placed::OnScan, "{name}");
}

fn put(marking: &mut Marking, names: &[&str]) {
    for name in names {
        marking.set(marking.find(name).unwrap(), truth(name));
    }
}

#[test]
fn a_click_puts_the_selected_landmark_on_the_surface_under_the_pixel() {
    let mut marking = marking(&shapes::head());
    assert_eq!(marking.name(marking.selected()), "prn");
    click(&mut marking, "prn");
    let placed = marking.place(marking.selected()).unwrap();
    assert!(placed.distance(truth("prn")) < 1.5, "{placed}");
    assert_eq!(marking.state(marking.selected()), State::Set);
    // A pixel beside the head has nothing under it, and nothing yet tells how deep the point would be.
    marking.select(marking.find("t_l").unwrap());
    assert_eq!(marking.click(Vec2::ZERO, SIZE, false), Placed::Nowhere);
    assert_eq!(marking.set_count(), 1);
}

/// Rays exactly along the edges of a symmetric scan went through it.
#[test]
fn rays_along_the_sides_of_triangles_hit() {
    const SIDE: u32 = 40;
    let mut scan = Scan::default();
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let x = column as f32 - SIDE as f32 / 2.0;
            let y = row as f32 - SIDE as f32 / 2.0;
            scan.positions.push(Vec3::new(x, y, 30.0 - x * x / 20.0));
        }
    }
    for row in 0..SIDE {
        for column in 0..SIDE {
            let [a, b] = [row, row + 1].map(|r| r * (SIDE + 1) + column);
            scan.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    // As scans in metres stand, where coordinates are not round.
    for (scale, shift) in [(1.0, 0.0), (0.001, 1.2), (0.001, 0.7), (0.01, -7.3)] {
        let place = |p: Vec3| p * scale + shift;
        let positions: Vec<Vec3> = scan.positions.iter().map(|p| place(*p)).collect();
        let surface = Surface::new(&positions, &scan.triangles).unwrap();
        for column in 1..SIDE {
            let x = column as f32 - SIDE as f32 / 2.0;
            for tilt in -30..30 {
                let way = Vec3::new(0.0, tilt as f32 * 0.005, -1.0).normalize();
                let origin = place(Vec3::new(x, 0.3, 90.0));
                let hit = surface.ray(origin, way, 500.0, Facing::ANY);
                assert!(hit.is_some(), "{scale} {shift} {x} {tilt}");
            }
        }
    }
}

#[test]
fn after_three_clicks_the_others_are_about_where_they_belong() {
    let mut marking = marking(&shapes::head());
    for name in ["prn", "ex_l", "ex_r"] {
        assert_eq!(marking.state(marking.find("ch_l").unwrap()), State::Unknown);
        click(&mut marking, name);
    }
    for name in ["n", "sn", "en_l", "ch_l", "ch_r"] {
        let landmark = marking.find(name).unwrap();
        assert_eq!(marking.state(landmark), State::Estimated, "{name}");
        let off = marking.place(landmark).unwrap().distance(truth(name));
        assert!(off < 14.0, "{name}: {off}");
    }
    // Another one betters them.
    let before = marking
        .place(marking.find("ch_r").unwrap())
        .unwrap()
        .distance(truth("ch_r"));
    click(&mut marking, "ch_l");
    let after = marking
        .place(marking.find("ch_r").unwrap())
        .unwrap()
        .distance(truth("ch_r"));
    assert!(after < before, "{after} {before}");
}

#[test]
fn three_on_one_line_do_not_say_how_the_head_is_turned() {
    let mut marking = marking(&shapes::head());
    let line = [0.0, 20.0, 40.0].map(|y| Vec3::new(0.0, y, 100.0));
    for (name, at) in ["gn", "sn", "n"].into_iter().zip(line) {
        marking.set(marking.find(name).unwrap(), at);
    }
    assert_eq!(marking.state(marking.find("prn").unwrap()), State::Unknown);
    assert_eq!(marking.warnings(), &[Warning::Line]);
    put(&mut marking, &["ex_l"]);
    assert_ne!(marking.state(marking.find("prn").unwrap()), State::Unknown);
}

#[test]
fn what_lies_beyond_the_scan_stays_in_mid_air_and_moves_in_the_plane_of_the_view() {
    let mut marking = marking(&shapes::mask());
    put(&mut marking, &["prn", "ex_l", "ex_r", "gn", "n"]);
    let back = marking.find("op").unwrap();
    assert_eq!(marking.state(back), State::MidAir);
    let estimated = marking.place(back).unwrap();
    // The mask ends at the temples; from the side there is nothing behind them.
    marking.look(View::Left);
    marking.select(back);
    let pixel = marking.camera.pixel_of(estimated, SIZE).unwrap() + vec2(30.0, -20.0);
    assert_eq!(marking.click(pixel, SIZE, false), Placed::MidAir);
    let placed = marking.place(back).unwrap();
    let view = marking.camera.back();
    assert!((placed - estimated).dot(view).abs() < 1e-2);
    assert!(placed.distance(estimated) > 5.0);
    // In the air on purpose, though the scan lies under the pixel.
    marking.look(View::Front);
    let tip = marking.find("prn").unwrap();
    marking.select(tip);
    let pixel = marking.camera.pixel_of(truth("n"), SIZE).unwrap();
    assert_eq!(marking.click(pixel, SIZE, true), Placed::MidAir);
    let depth = (marking.place(tip).unwrap() - truth("prn")).dot(marking.camera.back());
    assert!(depth.abs() < 1e-2, "{depth}");
}

#[test]
fn a_drag_is_one_deed_that_undo_takes_back_and_redo_does_again() {
    let mut marking = marking(&shapes::head());
    put(&mut marking, &["prn", "ex_l", "ex_r"]);
    let chin = marking.find("gn").unwrap();
    let estimated = marking.place(chin).unwrap();
    let from = marking.camera.pixel_of(estimated, SIZE).unwrap();
    assert!(marking.press(from + vec2(3.0, 0.0), SIZE, 8.0));
    assert_eq!(marking.selected(), chin);
    for step in 1..=5 {
        let by = vec2(3.0 + step as f32 * 4.0, -step as f32);
        marking.drag(from + by, SIZE, false);
    }
    assert!(marking.release());
    let dragged = marking.place(chin).unwrap();
    assert_eq!(marking.state(chin), State::Set);
    let pixel = marking.camera.pixel_of(dragged, SIZE).unwrap();
    assert!(pixel.distance(from + vec2(20.0, -5.0)) < 1.0, "it jumped");

    assert!(marking.undo());
    assert_eq!(marking.state(chin), State::Estimated);
    assert!(marking.place(chin).unwrap().distance(estimated) < 1e-3);
    assert!(marking.redo());
    assert_eq!(marking.place(chin), Some(dragged));
    assert!(!marking.redo());
    marking.clear(chin);
    assert_eq!(marking.state(chin), State::Estimated);
    for _ in 0..5 {
        assert!(marking.undo());
    }
    assert_eq!(marking.set_count(), 0);
    assert!(!marking.undo());
}

#[test]
fn pressing_a_dot_without_moving_it_changes_nothing() {
    let mut marking = marking(&shapes::head());
    put(&mut marking, &["prn", "ex_l", "ex_r"]);
    marking.mark_saved();
    let pixel = marking.camera.pixel_of(truth("ex_l"), SIZE).unwrap();
    assert!(marking.press(pixel, SIZE, 8.0));
    assert!(!marking.release());
    assert!(!marking.is_dirty());
    // The ear on the far side is no target for a click on the near one.
    marking.look(View::Right);
    let far = marking.camera.pixel_of(truth("ex_l"), SIZE).unwrap();
    assert_eq!(marking.dot_at(far, SIZE, 4.0), None);
}

#[test]
fn next_goes_through_what_is_not_set_and_ends() {
    let mut marking = marking(&shapes::head());
    put(&mut marking, &["prn", "en_r"]);
    let mut order = vec![];
    marking.select(0);
    for _ in 0..4 {
        assert!(marking.next_unset());
        order.push(marking.name(marking.selected()).to_owned());
    }
    assert_eq!(order, ["en_l", "ex_l", "ex_r", "ch_l"]);
    put(&mut marking, &["ex_l", "ex_r"]);
    for landmark in 0..marking.count() {
        let known = marking.state(landmark) == State::Set;
        assert_eq!(marking.accept(landmark), !known);
    }
    assert_eq!(marking.set_count(), marking.count());
    assert!(!marking.next_unset());
}

#[test]
fn exchanged_sides_are_seen_and_mended_in_one_step() {
    for names in [
        &["prn", "en_l", "en_r"][..],
        &["prn", "ex_l", "ex_r", "gn", "n"],
    ] {
        let mut marking = marking(&shapes::head());
        put(&mut marking, names);
        assert_eq!(marking.warnings(), &[], "{names:?}");
        marking.exchange_sides();
        assert_eq!(marking.warnings(), &[Warning::Swapped], "{names:?}");
        let said = marking.words(&marking.warnings()[0]);
        assert!(said.contains("swapped"), "{said}");
        marking.exchange_sides();
        assert_eq!(marking.warnings(), &[]);
    }
}

#[test]
fn one_exchanged_pair_and_one_stray_are_named() {
    let mut marking = marking(&shapes::head());
    put(
        &mut marking,
        &[
            "prn", "en_l", "en_r", "ex_l", "ex_r", "ch_l", "ch_r", "n", "gn",
        ],
    );
    assert_eq!(marking.warnings(), &[]);
    let (left, right) = (marking.find("ch_l").unwrap(), marking.find("ch_r").unwrap());
    marking.exchange(left, right);
    assert_eq!(marking.warnings(), &[Warning::Pair(left, right)]);
    assert!(
        marking
            .words(&Warning::Pair(left, right))
            .starts_with("ch_l and ch_r")
    );
    marking.undo();
    let chin = marking.find("gn").unwrap();
    marking.set(chin, truth("v"));
    let [Warning::Stray { landmark, mm }] = marking.warnings() else {
        panic!("{:?}", marking.warnings());
    };
    assert_eq!(*landmark, chin);
    assert!(*mm > 80.0, "{mm}");
}

#[test]
fn what_was_saved_comes_back_with_its_unit() {
    // In metres, on its side, as a scanner's axes may be.
    let turn = Quat::from_rotation_x(1.5);
    let by = |p: DVec3| turn.as_dquat() * p / 1000.0 + DVec3::new(0.3, -1.2, 0.1);
    let (scan, placed) = shapes::moved(&shapes::head(), &shapes::landmarks(), by);
    let mut first = marking(&scan);
    for name in ["prn", "ex_l", "ex_r", "gn"] {
        first.set(first.find(name).unwrap(), placed.points[name].as_vec3());
    }
    assert!(first.is_dirty());
    assert_eq!(first.unit(), Unit::Metre);
    let file = first.landmarks();
    first.mark_saved();
    assert!(!first.is_dirty());
    assert_eq!(file.points.len(), 4);

    let read = Landmarks::parse(file.json().unwrap().as_bytes()).unwrap();
    let mut second = marking(&scan);
    second.load(&read).unwrap();
    assert_eq!(second.landmarks(), file);
    assert!(!second.is_dirty());
    assert_eq!(second.name(second.selected()), "en_l");
    let chin = second.place(second.find("ch_l").unwrap()).unwrap();
    assert!(chin.distance(placed.points["ch_l"].as_vec3()) < 0.012);
    // The front view is the face's front, whatever the scan's axes are.
    second.look(View::Front);
    let front = turn * Vec3::Z;
    assert!(second.camera.back().dot(front) > 0.97);

    // The same points in mm are brought to the scan's metres.
    let mut millimetres = read.clone();
    millimetres.unit = Unit::Millimetre;
    for at in millimetres.points.values_mut() {
        *at *= 1000.0;
    }
    let mut third = marking(&scan);
    third.load(&millimetres).unwrap();
    let tip = third.place(third.find("prn").unwrap()).unwrap();
    assert!(tip.distance(placed.points["prn"].as_vec3()) < 1e-5);
}

#[test]
fn a_file_of_another_scan_or_with_wrong_names_is_refused_and_changes_nothing() {
    let mut marking = marking(&shapes::head());
    let mut file = shapes::only(&["prn", "gn", "ex_l"]);
    for at in file.points.values_mut() {
        at.x += 900.0;
    }
    let error = marking.load(&file).unwrap_err();
    assert!(matches!(error, LandmarkFault::AllOutside { .. }), "{error}");
    let mut file = shapes::only(&["prn", "gn"]);
    file.points.insert("nose".to_owned(), DVec3::ZERO);
    let error = marking.load(&file).unwrap_err();
    assert!(
        matches!(error, LandmarkFault::UnknownName { .. }),
        "{error}"
    );
    assert_eq!(marking.set_count(), 0);
    assert!(!marking.is_dirty());
}

#[test]
fn the_camera_keeps_what_it_promises() {
    let mut marking = marking(&shapes::head());
    put(&mut marking, &["prn", "ex_l", "ex_r"]);
    marking.look(View::Front);
    // Zooming keeps the skin under the pointer where it is, and grows it by as much as asked.
    let pixel = vec2(500.0, 260.0);
    let under = marking.pick(pixel, SIZE).unwrap();
    let beside = under + marking.camera.turn * Vec3::X;
    let before = marking.camera.pixel_of(beside, SIZE).unwrap();
    marking.zoom(2.0, pixel, SIZE);
    let camera = &mut marking.camera;
    assert!(camera.pixel_of(under, SIZE).unwrap().distance(pixel) < 0.1);
    let grown = camera.pixel_of(beside, SIZE).unwrap().distance(pixel) / before.distance(pixel);
    assert!((grown - 2.0).abs() < 0.02, "{grown}");
    // What is turned about is what one looks at when near; nothing jumps when that is chosen.
    marking.zoom(3.0, pixel, SIZE);
    marking.begin_turn(SIZE);
    let camera = &mut marking.camera;
    assert!(camera.pixel_of(under, SIZE).unwrap().distance(pixel) < 0.1);
    let eye = camera.eye();
    camera.orbit(vec2(5.0, 0.0), SIZE);
    assert!(camera.eye().distance(eye) < 10.0);
    let target = camera.target;
    let pixel = camera.pixel_of(target, SIZE).unwrap();
    camera.pan(vec2(40.0, -10.0), SIZE);
    let moved = camera.pixel_of(target, SIZE).unwrap();
    assert!(moved.distance(pixel + vec2(40.0, -10.0)) < 0.5, "{moved}");
    // What is seen through a pixel is drawn on it.
    let clip = camera.clip_from_world(SIZE.x / SIZE.y) * under.extend(1.0);
    let drawn = (vec2(clip.x, -clip.y) / clip.w + Vec2::ONE) / 2.0 * SIZE;
    assert!(drawn.distance(camera.pixel_of(under, SIZE).unwrap()) < 0.1);
    assert!((0.0..clip.w).contains(&clip.z));
    // However long one turns, up stays up.
    for _ in 0..100 {
        camera.orbit(vec2(37.0, 61.0), SIZE);
    }
    let up = camera.up.unwrap();
    assert!((camera.turn * Vec3::X).dot(up).abs() < 0.05);
    assert!((camera.turn * Vec3::Y).dot(up) > 0.0);
}
