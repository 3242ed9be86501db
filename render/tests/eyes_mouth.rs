//! What a user would notice at eyes and mouth: a catch-light in every open eye wherever it looks, eyes that darken under
//! lowered lids, teeth that darken as the mouth closes (HABER 4.1). Needs a graphics adapter (a software one will do)
//! and says so where there is none.

use std::sync::Arc;

use glam::{Vec3, vec3};
use mouthpiece_render::{Camera, Extent, Gpu, Offscreen, Tier, View};
use mouthpiece_rig::{Body, Control, Controls, Head, KeyFrame, STEP_TICKS, Simulation, TICK_RATE};
use mouthpiece_tests::or_skipped;

const SIZE: (u32, u32) = (640, 640);

/// The head after a third of a second of holding.
fn held(head: &Arc<Head>, pulls: &[(Control, f32)]) -> KeyFrame {
    let mut controls = Controls::default();
    for &(control, value) in pulls {
        controls[control] = value;
    }
    let mut simulation = Simulation::new(Arc::clone(head));
    for _ in 0..TICK_RATE / 3 / STEP_TICKS {
        simulation.step(&controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    frame
}

/// Brightness (0..765) of the pixels within `reach` of where `place` (trunk's frame, mm) is drawn.
fn around(pixels: &[u8], extent: &Extent, place: Vec3, reach: i32) -> Vec<i32> {
    let clip = extent
        .frame(Camera::Front, SIZE)
        .clip_from_world
        .project_point3(place);
    let x = ((clip.x * 0.5 + 0.5) * SIZE.0 as f32) as i32;
    let y = ((0.5 - clip.y * 0.5) * SIZE.1 as f32) as i32;
    let mut found = Vec::new();
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let at = (((y + dy) * SIZE.0 as i32 + x + dx) * 4) as usize;
            found.push(pixels[at..at + 3].iter().map(|b| i32::from(*b)).sum());
        }
    }
    found
}

#[test]
fn a_catch_light_stands_beside_a_dark_pupil_wherever_the_eyes_look() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = Arc::new(Head::reference().unwrap());
    let extent = Extent::of(&head);
    let mut offscreen = Offscreen::new(&gpu, &head, SIZE, Tier::Medium).unwrap();
    for pulls in [
        &[][..],
        &[(Control::GazeYaw, 0.35)],
        &[(Control::GazeYaw, -0.35)],
        &[(Control::GazePitch, 0.25)],
        &[(Control::GazePitch, -0.3)],
        &[(Control::LidL, 0.45), (Control::LidR, 0.45)],
        &[(Control::HeadYaw, 0.4), (Control::GazeYaw, -0.4)],
        &[(Control::HeadPitch, -0.3)],
    ] {
        let frame = held(&head, pulls);
        let pixels = offscreen.render(&frame, &View::default()).unwrap();
        let bodies = head.bodies(&frame.state);
        for (eye, body) in head.eyes.iter().zip([Body::EyeL, Body::EyeR]) {
            let apex = eye.centre + vec3(0.0, 0.0, eye.radius);
            let apex = bodies[body as usize].transform_point3(apex);
            // An iris is about 16 pixels wide.
            let seen = around(pixels, &extent, apex, 8);
            let bright = seen.iter().filter(|b| **b > 540).count();
            let darkest = seen.iter().min().copied().unwrap_or_default();
            assert!(bright >= 3, "{pulls:?} {body:?}: no catch-light");
            assert!(darkest < 150, "{pulls:?} {body:?}: no pupil, {darkest}");
        }
    }
}

#[test]
fn teeth_are_darker_behind_a_small_opening_than_behind_a_large_one() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = Arc::new(Head::reference().unwrap());
    let extent = Extent::of(&head);
    let mut offscreen = Offscreen::new(&gpu, &head, SIZE, Tier::Medium).unwrap();
    let upper = head.parts.iter().find(|p| p.name == "teeth_upper").unwrap();
    // The front of a first incisor, low on its crown.
    let tooth = upper
        .mesh
        .positions
        .iter()
        .filter(|p| p.x > 2.5 && p.x < 6.0)
        .copied()
        .reduce(|a, b| {
            if b.z - 0.6 * b.y > a.z - 0.6 * a.y {
                b
            } else {
                a
            }
        })
        .unwrap();
    let mut brightness = |gap_mm: f32| {
        // The lower lip alone differs, so that the same tooth is seen below an upper lip that is drawn up.
        let mut frame = head.rest_frame();
        frame.state[Control::Jaw] = 0.08;
        for (lip, up) in [(&head.lips.upper, 2.0), (&head.lips.lower, -gap_mm)] {
            for &vertex in lip.iter().flatten() {
                frame.skin[vertex as usize].y += up;
            }
        }
        let pixels = offscreen.render(&frame, &View::default()).unwrap();
        let place = head.bodies(&frame.state)[Body::Skull as usize].transform_point3(tooth);
        let seen = around(pixels, &extent, place, 1);
        seen.iter().sum::<i32>() / seen.len() as i32
    };
    let [slit, small, large] = [0.5, 4.0, 14.0].map(&mut brightness);
    println!("a tooth behind a slit {slit}, a small opening {small}, a large one {large}");
    assert!(slit + 40 < small && small + 20 < large);
    assert!(
        (240..690).contains(&large),
        "no tooth is seen, or it glares"
    );
}
