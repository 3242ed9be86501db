//! What is round the head, as a user would notice it: backdrops of every kind, straight alpha, the room's light, and
//! a device that goes away in the middle of the work. Needs a graphics adapter and says so where there is none.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

use std::sync::Arc;

use glam::Vec3;
use mouthpiece_render::{Background, Environment, Extent, Gpu, Offscreen, Picture, Tier, View};
use mouthpiece_rig::{Head, Material};
use mouthpiece_tests::or_skipped;
use proptest::prelude::*;

fn head() -> Head {
    Head::reference().unwrap()
}

fn before(background: Background) -> View {
    View {
        background,
        ..View::default()
    }
}

/// The four bytes at a place.
fn at(pixels: &[u8], width: u32, x: u32, y: u32) -> [u8; 4] {
    let at = ((y * width + x) * 4) as usize;
    [pixels[at], pixels[at + 1], pixels[at + 2], pixels[at + 3]]
}

#[test]
fn a_gradient_runs_from_its_first_colour_above_to_its_second_below() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (160, 120), Tier::Low).unwrap();
    let (top, bottom) = ([250, 20, 10], [10, 40, 200]);
    let view = before(Background::Gradient { top, bottom });
    let pixels = offscreen.render(&head.rest_frame(), &view).unwrap();
    for (y, share) in [(0, 0.0), (60, 0.5), (118, 0.99)] {
        for c in 0..3 {
            let wanted = f32::from(top[c]) * (1.0 - share) + f32::from(bottom[c]) * share;
            let got = f32::from(at(pixels, 160, 3, y)[c]);
            assert!(
                (got - wanted).abs() < 4.0,
                "row {y}, colour {c}: {got} for {wanted}"
            );
        }
    }
}

#[test]
fn a_picture_fills_the_frame_from_its_middle_and_keeps_its_colours() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    // Three times as wide as high: of it a square frame shows the middle third.
    let stripes = [[255, 0, 0, 255], [9, 130, 201, 255], [0, 0, 255, 255]];
    let texels = (0..60 * 180).map(|i| stripes[i % 180 / 60]).collect();
    let picture = Arc::new(Picture::from_rgba(180, 60, texels).unwrap());
    let mut offscreen = Offscreen::new(&gpu, &head, (120, 120), Tier::Medium).unwrap();
    let view = before(Background::Picture(Arc::clone(&picture)));
    let pixels = offscreen.render(&head.rest_frame(), &view).unwrap();
    for (x, y) in [(3, 3), (116, 3), (3, 80)] {
        assert_eq!(at(pixels, 120, x, y), stripes[1], "at {x}, {y}");
    }
    // As wide as it is, all of it is seen.
    let mut wide = Offscreen::new(&gpu, &head, (360, 120), Tier::Low).unwrap();
    let pixels = wide.render(&head.rest_frame(), &view).unwrap();
    assert_eq!(at(pixels, 360, 10, 10), stripes[0]);
    assert_eq!(at(pixels, 360, 350, 10), stripes[2]);
    // Another one takes its place, and so does a plain colour.
    let clear = Arc::new(Picture::from_rgba(1, 1, vec![[80, 90, 100, 64]]).unwrap());
    let pixels = wide
        .render(&head.rest_frame(), &before(Background::Picture(clear)))
        .unwrap();
    let [r, g, b, a] = at(pixels, 360, 10, 10);
    assert_eq!(a, 64);
    assert!(
        r.abs_diff(80) <= 2 && g.abs_diff(90) <= 2 && b.abs_diff(100) <= 2,
        "{r} {g} {b}"
    );
    let pixels = wide
        .render(&head.rest_frame(), &before(Background::Plain([1, 2, 3])))
        .unwrap();
    assert_eq!(at(pixels, 360, 10, 10), [1, 2, 3, 255]);
}

/// What stands before nothing, laid over a colour, is the picture drawn before that colour.
#[test]
fn straight_alpha_laid_over_a_colour_gives_the_picture_before_that_colour() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    for tier in [Tier::Low, Tier::Medium] {
        let mut offscreen = Offscreen::new(&gpu, &head, (240, 240), tier).unwrap();
        let frame = head.rest_frame();
        let clear = offscreen
            .render(&frame, &before(Background::Transparent))
            .unwrap()
            .to_vec();
        assert_eq!(at(&clear, 240, 2, 2), [0; 4]);
        assert_eq!(at(&clear, 240, 120, 120)[3], 255);
        let between = clear
            .chunks_exact(4)
            .filter(|p| (1..255).contains(&p[3]))
            .count();
        assert_eq!(
            between > 100,
            tier != Tier::Low,
            "{between} pixels of the edge"
        );
        let colour = [30, 220, 60];
        let over = offscreen
            .render(&frame, &before(Background::Plain(colour)))
            .unwrap();
        for (mine, drawn) in clear.chunks_exact(4).zip(over.chunks_exact(4)) {
            let alpha = f32::from(mine[3]) / 255.0;
            for c in 0..3 {
                let laid = f32::from(mine[c]) * alpha + f32::from(colour[c]) * (1.0 - alpha);
                assert!(
                    (laid - f32::from(drawn[c])).abs() < 2.5,
                    "{mine:?} over {colour:?} is not {drawn:?}"
                );
            }
            assert_eq!(drawn[3], 255);
        }
    }
}

/// Red light from the face's right only: that cheek is redder than the other.
#[test]
fn a_panorama_colours_the_face_from_its_side() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let path = std::env::temp_dir().join(format!("mouthpiece-side-{}.hdr", std::process::id()));
    let red = image::Rgb32FImage::from_fn(64, 32, |x, _| {
        image::Rgb(if x >= 32 {
            [3.0, 0.1, 0.1]
        } else {
            [0.1, 0.1, 3.0]
        })
    });
    red.save(&path).unwrap();
    let environment = Environment::load(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let mut offscreen = Offscreen::new(&gpu, &head, (200, 200), Tier::Low).unwrap();
    let mut redness = |environment| {
        let view = View {
            environment,
            ..View::default()
        };
        let pixels = offscreen.render(&head.rest_frame(), &view).unwrap();
        // The subject's right is the picture's left.
        [70, 130].map(|x| {
            let [r, _, b, _] = at(pixels, 200, x, 115).map(f32::from);
            r / b
        })
    };
    let (plain, lit) = (redness(Environment::default()), redness(environment));
    let (right, left) = (lit[0] / plain[0], lit[1] / plain[1]);
    assert!(right > 1.05 * left, "right {right}, left {left}");
}

#[test]
fn a_lost_device_costs_a_pause_and_no_picture() {
    let Some(gpu) = or_skipped(Gpu::headless()) else {
        return;
    };
    let head = head();
    let mut offscreen = Offscreen::new(&gpu, &head, (96, 72), Tier::Low).unwrap();
    let view = View::default();
    let frame = head.rest_frame();
    let sound = offscreen.render(&frame, &view).unwrap().to_vec();
    // With pictures in flight.
    offscreen.submit(&frame, &view).unwrap();
    offscreen.submit(&frame, &view).unwrap();
    offscreen.gpu().device().destroy();
    for _ in 0..2 {
        assert!(offscreen.take().unwrap().unwrap() == sound);
    }
    // And with none.
    for _ in 0..3 {
        offscreen.gpu().device().destroy();
        assert!(offscreen.render(&frame, &view).unwrap() == sound);
    }
}

proptest! {
    /// Whatever the frame between 9:16 and 32:9, the head and its hair are in it, and seen through a portrait lens.
    #[test]
    fn the_head_is_in_the_frame(width in 32_u32..4000, aspect in 9.0_f64/16.0..32.0/9.0, view in 0_usize..3) {
        static HEAD: std::sync::OnceLock<(Extent, Vec<Vec3>)> = std::sync::OnceLock::new();
        let (extent, places) = HEAD.get_or_init(|| {
            let head = head();
            let extent = Extent::of(&head);
            let hair = head.parts.iter().filter(|p| p.material == Material::Hair);
            let hair = hair.flat_map(|p| &p.mesh.positions);
            let all = head.skin.mesh.positions.iter().chain(hair);
            (extent, all.filter(|p| p.y >= extent.min.y).copied().collect())
        });
        let height = (f64::from(width) / aspect).round().max(1.0) as u32;
        let framing = extent.frame(mouthpiece_render::Camera::ALL[view], (width, height));
        // 85 mm before a frame whose longer side is 36 mm.
        prop_assert!((16.0..=24.1).contains(&framing.fov_y_rad.to_degrees()));
        let mut reach = 0.0_f32;
        for place in places {
            let clip = framing.clip_from_world.project_point3(*place);
            prop_assert!(clip.x.abs() < 0.99 && clip.y.abs() < 0.99 && (0.0..1.0).contains(&clip.z), "{place} is at {clip}");
            reach = reach.max(clip.x.abs().max(clip.y.abs()));
        }
        prop_assert!(reach > 0.55, "the head is lost in the frame");
    }
}
