//! What a user would notice of the skin: a muscle wrinkles its part of the face and nothing else, on its own side;
//! both reflection models draw. Needs a graphics adapter (a software one will do) and says so where there is none.

use mouthpiece_render::{Camera, Extent, Gpu, Offscreen, SkinModel, Tier, View};
use mouthpiece_rig::{Control, Head, KeyFrame, Layer};
use mouthpiece_tests::or_skipped;

const SIZE: (u32, u32) = (480, 480);

fn ready() -> Option<(Head, Offscreen)> {
    let gpu = or_skipped(Gpu::headless())?;
    let ready = || -> Result<_, Box<dyn std::error::Error>> {
        let head = Head::reference()?;
        let offscreen = Offscreen::new(&gpu, &head, SIZE, Tier::Medium)?;
        Ok((head, offscreen))
    };
    match ready() {
        Ok(ready) => Some(ready),
        Err(error) => panic!("the reference head cannot be drawn: {error}"),
    }
}

/// The head at rest whose muscles say that they pull: the wrinkles alone differ.
fn pulled(head: &Head, pulls: &[(Control, f32)]) -> KeyFrame {
    let mut frame = head.rest_frame();
    for (control, value) in pulls {
        frame.state[*control] = *value;
    }
    frame
}

/// The picture of a frame from the front.
fn drawn(offscreen: &mut Offscreen, frame: &KeyFrame) -> Vec<u8> {
    match offscreen.render(frame, &View::default()) {
        Ok(pixels) => pixels.to_vec(),
        Err(error) => panic!("the head cannot be drawn: {error}"),
    }
}

/// Mean difference of two pictures, of 255, within some pixels of a landmark moved by mm.
fn change(head: &Head, a: &[u8], b: &[u8], name: &str, off: glam::Vec3) -> f32 {
    const REACH: i32 = 12;
    let Some(number) = head
        .landmarks
        .iter()
        .position(|l| l.layer == Layer::Skin && l.name == name)
    else {
        panic!("the reference head has no landmark {name}");
    };
    let place = head.landmark_places()[number] + off;
    let framing = Extent::of(head).frame(Camera::Front, SIZE);
    let clip = framing.clip_from_world.project_point3(place);
    let at = |v: f32, n: u32| ((v * 0.5 + 0.5) * n as f32) as i32;
    let (cx, cy) = (at(clip.x, SIZE.0), at(-clip.y, SIZE.1));
    let (mut sum, mut count) = (0.0, 0.0);
    for y in cy - REACH..cy + REACH {
        for x in cx - REACH..cx + REACH {
            for c in 0..3 {
                let i = ((y * SIZE.0 as i32 + x) * 4 + c) as usize;
                sum += f32::from(a[i].abs_diff(b[i]));
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn a_raised_brow_wrinkles_its_side_of_the_forehead() {
    let Some((head, mut offscreen)) = ready() else {
        return;
    };
    let rest = drawn(&mut offscreen, &head.rest_frame());
    let raised = pulled(
        &head,
        &[
            (Control::FrontalisOuter, 0.5),
            (Control::FrontalisOuterSide, 0.5),
        ],
    );
    let raised = drawn(&mut offscreen, &raised);
    // Above the middle of either brow.
    let above = |name| change(&head, &rest, &raised, name, glam::vec3(0.0, 24.0, 0.0));
    let (left, right) = (above("ps_l"), above("ps_r"));
    assert!(left > 0.7, "the left forehead changes by {left}");
    assert!(right < 0.3, "the right forehead changes by {right}");
    let chin = change(&head, &rest, &raised, "pg", glam::Vec3::ZERO);
    assert!(chin < 0.05, "the chin changes by {chin}");
}

#[test]
fn a_frown_wrinkles_between_the_brows() {
    let Some((head, mut offscreen)) = ready() else {
        return;
    };
    let rest = drawn(&mut offscreen, &head.rest_frame());
    let frown = pulled(&head, &[(Control::CorrugatorSupercilii, 1.0)]);
    let frown = drawn(&mut offscreen, &frown);
    let between = change(&head, &rest, &frown, "g", glam::Vec3::ZERO);
    assert!(between > 1.5, "{between}");
    let cheek = change(&head, &rest, &frown, "ch_l", glam::vec3(14.0, 22.0, 0.0));
    assert!(cheek < 0.05, "the cheek changes by {cheek}");
}

#[test]
fn the_papers_model_draws_the_same_face_by_another_light() {
    let Some((head, mut offscreen)) = ready() else {
        return;
    };
    let frame = head.rest_frame();
    let physical = drawn(&mut offscreen, &frame);
    let view = View {
        skin: SkinModel::BlinnPhong,
        ..View::default()
    };
    let papers = offscreen.render(&frame, &view).unwrap();
    let forehead = change(&head, &physical, papers, "g", glam::Vec3::ZERO);
    assert!(forehead > 0.5, "no other model: {forehead}");
    assert!(forehead < 60.0, "no skin any more: {forehead}");
    assert_eq!(physical[..4], papers[..4], "the backdrop stays");
    assert!("blinn-phong".parse() == Ok(SkinModel::BlinnPhong));
    assert!("phong".parse::<SkinModel>().is_err());
}
