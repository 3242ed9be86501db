//! What a user of the renderer would notice: pictures that show the head, the same every time, at any
//! size, with the mouth's inside dark when it is nearly shut. Needs a graphics adapter (a software one
//! will do) and says so where there is none.

use glam::Vec3;
use mouthpiece_render::{
    Background, Camera, Extent, FRAMES_IN_FLIGHT, Gpu, Offscreen, RenderError, Tier, View,
};
use mouthpiece_rig::lip_level::CONTACT;
use mouthpiece_rig::{Control, Head, KeyFrame, Material};
use mouthpiece_tests::or_skipped;

fn head() -> Head {
    match Head::reference() {
        Ok(head) => head,
        Err(error) => panic!("the reference head cannot be built: {error}"),
    }
}

/// The head with its jaw a little open and its lower lip that far below the upper one.
fn with_mouth_open(head: &Head, gap_mm: f32) -> KeyFrame {
    let mut frame = head.rest_frame();
    frame.state[Control::Jaw] = 0.05;
    for column in &head.lips.lower {
        for &vertex in column {
            frame.skin[vertex as usize].y -= gap_mm;
        }
    }
    frame
}

fn pixel(pixels: &[u8], width: u32, x: u32, y: u32) -> [i32; 3] {
    let at = ((y * width + x) * 4) as usize;
    [pixels[at], pixels[at + 1], pixels[at + 2]].map(i32::from)
}

#[test]
fn a_picture_shows_skin_before_a_backdrop_and_is_opaque() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (320, 240), Tier::Low).unwrap();
    let view = View {
        background: Background::Plain([10, 60, 200]),
        ..View::default()
    };
    let pixels = offscreen.render(&head.rest_frame(), &view).unwrap();
    assert_eq!(pixels.len(), 320 * 240 * 4);
    assert_eq!(
        pixel(pixels, 320, 2, 2),
        [10, 60, 200],
        "the backdrop is the colour that was asked for"
    );
    // A little under the middle is the nose.
    let [r, g, b] = pixel(pixels, 320, 160, 125);
    assert!(
        r > g && g > b && r > 90,
        "no skin in the middle: {r} {g} {b}"
    );
    assert!(
        pixels.chunks_exact(4).all(|p| p[3] == 255),
        "some pixels are not opaque"
    );
}

#[test]
fn the_same_frame_gives_the_same_bytes() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let frame = with_mouth_open(&head, 6.0);
    let view = View::default();
    let mut first = Offscreen::new(&gpu, &head, (160, 120), Tier::Medium).unwrap();
    let a = first.render(&frame, &view).unwrap().to_vec();
    first
        .render(
            &head.rest_frame(),
            &View {
                camera: Camera::Side,
                ..view.clone()
            },
        )
        .unwrap();
    let b = first.render(&frame, &view).unwrap().to_vec();
    let mut second = Offscreen::new(&gpu, &head, (160, 120), Tier::Medium).unwrap();
    let c = second.render(&frame, &view).unwrap().to_vec();
    assert!(a == b, "a picture depends on those before it");
    assert!(a == c, "a picture depends on which renderer drew it");
}

#[test]
fn a_batch_gives_its_pictures_in_order() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (96, 72), Tier::Low).unwrap();
    let frames: Vec<KeyFrame> = (0..5_u8)
        .map(|i| {
            let mut frame = head.rest_frame();
            frame.state[Control::HeadYaw] = 0.1 * f32::from(i);
            frame
        })
        .collect();
    let view = View::default();
    let alone: Vec<Vec<u8>> = frames
        .iter()
        .map(|f| offscreen.render(f, &view).unwrap().to_vec())
        .collect();
    let mut batch = Vec::new();
    for frame in &frames {
        if offscreen.in_flight() == FRAMES_IN_FLIGHT {
            batch.push(offscreen.take().unwrap().unwrap().to_vec());
        }
        offscreen.submit(frame, &view).unwrap();
    }
    while let Some(pixels) = offscreen.take().unwrap() {
        batch.push(pixels.to_vec());
    }
    assert!(
        alone == batch,
        "overlapped pictures differ from single ones"
    );
    assert!(alone[0] != alone[4], "the head does not turn");
}

#[test]
fn more_pictures_than_buffers_and_wrong_heads_and_sizes_are_errors() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (64, 48), Tier::Low).unwrap();
    let frame = head.rest_frame();
    let view = View::default();
    for _ in 0..FRAMES_IN_FLIGHT {
        offscreen.submit(&frame, &view).unwrap();
    }
    assert!(matches!(
        offscreen.submit(&frame, &view),
        Err(RenderError::Full(FRAMES_IN_FLIGHT))
    ));
    assert!(matches!(
        offscreen.render(&frame, &view),
        Err(RenderError::Full(_))
    ));
    while offscreen.take().unwrap().is_some() {}

    let mut short = head.rest_frame();
    short.skin.pop();
    assert!(matches!(
        offscreen.render(&short, &view),
        Err(RenderError::WrongHead { .. })
    ));
    offscreen
        .render(&frame, &view)
        .expect("goes on after an error");
    for size in [(0, 480), (640, 0), (1 << 20, 480)] {
        let error = Offscreen::new(&gpu, &head, size, Tier::Low).unwrap_err();
        assert!(
            matches!(error, RenderError::Size { .. }),
            "{size:?}: {error}"
        );
    }
}

#[test]
fn odd_sizes_are_drawn() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    for size in [(1, 1), (333, 77), (77, 333), (2, 500)] {
        let mut offscreen = Offscreen::new(&gpu, &head, size, Tier::Medium).unwrap();
        let pixels = offscreen
            .render(&head.rest_frame(), &View::default())
            .unwrap();
        assert_eq!(pixels.len(), (size.0 * size.1 * 4) as usize);
        assert!(
            pixels.iter().any(|&b| b != 0 && b != 255),
            "{size:?} is blank"
        );
    }
}

#[test]
fn a_broken_key_frame_does_not_take_the_renderer_with_it() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (64, 48), Tier::Low).unwrap();
    let good = offscreen
        .render(&head.rest_frame(), &View::default())
        .unwrap()
        .to_vec();
    let mut broken = head.rest_frame();
    broken
        .skin
        .iter_mut()
        .step_by(7)
        .for_each(|p| *p *= f32::NAN);
    broken.state[Control::HeadYaw] = f32::INFINITY;
    offscreen.render(&broken, &View::default()).unwrap();
    let again = offscreen
        .render(&head.rest_frame(), &View::default())
        .unwrap();
    assert!(good == again);
}

#[test]
fn the_flash_is_a_white_square_in_the_upper_left_corner_and_nowhere_else() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (320, 240), Tier::Medium).unwrap();
    let dark = offscreen
        .render(&head.rest_frame(), &View::default())
        .unwrap()
        .to_vec();
    let lit = offscreen
        .render(
            &head.rest_frame(),
            &View {
                flash: true,
                ..View::default()
            },
        )
        .unwrap();
    for (x, y) in [(1, 1), (50, 50), (58, 2)] {
        assert_eq!(pixel(lit, 320, x, y), [255; 3], "at {x}, {y}");
        assert!(
            pixel(&dark, 320, x, y)[0] < 160,
            "at {x}, {y} without flash"
        );
    }
    assert_eq!(pixel(lit, 320, 62, 20), pixel(&dark, 320, 62, 20));
}

/// HABER 4.1: teeth and tongue darken as the mouth closes.
#[test]
fn the_inside_of_the_mouth_is_darker_the_less_it_is_open() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let size = (400, 400);
    let mut offscreen = Offscreen::new(&gpu, &head, size, Tier::Low).unwrap();
    let framing = Extent::of(&head).frame(Camera::Front, size);
    let mut brightness = |gap_mm: f32| {
        let frame = with_mouth_open(&head, gap_mm);
        let pixels = offscreen.render(&frame, &View::default()).unwrap();
        // The same place behind the lips whatever their gap: only the light that they let in differs.
        let column = head.lips.upper[head.lips.upper.len() / 2];
        let mut place = frame.skin[column[CONTACT] as usize];
        place += Vec3::new(0.0, -2.4, 0.0);
        let clip = framing.clip_from_world.project_point3(place);
        let at = |v: f32, n: u32| ((v * 0.5 + 0.5) * n as f32) as u32;
        pixel(pixels, size.0, at(clip.x, size.0), at(-clip.y, size.1))
            .iter()
            .sum::<i32>()
    };
    let (narrow, wide) = (brightness(4.5), brightness(14.0));
    assert!(wide > narrow + 10, "{narrow} at 4.5 mm, {wide} at 14 mm");
}

#[test]
fn the_whole_head_is_in_the_frame_at_any_aspect() {
    let head = head();
    let extent = Extent::of(&head);
    for camera in Camera::ALL {
        for (width, height) in [(9, 16), (2, 3), (1, 1), (4, 3), (16, 9), (21, 9), (32, 9)] {
            let framing = extent.frame(camera, (width * 60, height * 60));
            let degrees = framing.fov_y_rad.to_degrees();
            assert!(
                (16.0..=24.1).contains(&degrees),
                "{degrees} degrees is no portrait lens"
            );
            let mut highest = 0.0_f32;
            let hair = head.parts.iter().filter(|p| p.material == Material::Hair);
            let hair = hair.flat_map(|part| &part.mesh.positions);
            for place in head.skin.mesh.positions.iter().chain(hair) {
                if place.y < extent.min.y {
                    continue;
                }
                let clip = framing.clip_from_world.project_point3(*place);
                assert!(
                    clip.x.abs() < 0.99 && clip.y.abs() < 0.99 && (0.0..1.0).contains(&clip.z),
                    "{camera:?} {width}:{height}: {place} is at {clip}"
                );
                highest = highest.max(clip.y.abs().max(clip.x.abs()));
            }
            assert!(
                highest > 0.55,
                "{camera:?} {width}:{height}: the head is lost in the frame"
            );
        }
    }
}
