//! Lips stop each other, look closed when they are, flatten when pressed, and lie still.

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use mouthpiece_rig::lip_level::{BORDER, CONTACT};
use mouthpiece_rig::{Articulation, Controls, STEP_TICKS, Simulation, TICK_RATE, measure};

use super::surface::Drawn;
use super::{SENTENCE_HZ, head, posed, postures, pressed, sentence, settled};

const DEEPEST_MM: f32 = 0.2;

fn drawn(levels: usize) -> &'static Drawn {
    static DRAWN: [OnceLock<Drawn>; 3] = [const { OnceLock::new() }; 3];
    DRAWN[levels].get_or_init(|| Drawn::new(head(), levels))
}

#[test]
fn without_contact_the_lips_would_pass_each_other() {
    let mut free = Simulation::new(Arc::clone(head()));
    free.set_lip_contact(false);
    let frame = settled(&mut free, &pressed(), 250);
    let overlap = measure(head(), &frame).aperture_mm;
    assert!(overlap < -0.8, "{overlap} mm");
    assert!(drawn(1).lips_overlap(&frame.skin).0 > 0.5);
}

#[test]
fn lips_at_rest_and_pressed_do_not_pass_each_other() {
    for (what, controls) in [("rest", Controls::default()), ("pressed", pressed())] {
        let frame = posed(&controls);
        let (depth, at) = drawn(2).lips_overlap(&frame.skin);
        assert!(depth < DEEPEST_MM, "{what}: {depth} mm deep at {at}");
    }
}

#[test]
fn random_mouths_do_not_pass_their_lips() {
    for (i, controls) in postures(60).into_iter().enumerate() {
        let frame = posed(&controls);
        let (depth, at) = drawn(1).lips_overlap(&frame.skin);
        assert!(depth < DEEPEST_MM, "mouth {i}: {depth} mm deep at {at}");
    }
}

#[test]
fn a_spoken_sentence_does_not_pass_its_lips() {
    const STEPS: usize = (TICK_RATE / STEP_TICKS) as usize / SENTENCE_HZ;
    let mut simulation = Simulation::new(Arc::clone(head()));
    let (mut worst, mut shut) = ((0.0_f32, Vec3::ZERO, 0), 0);
    for (i, controls) in sentence().iter().enumerate() {
        let frame = settled(&mut simulation, controls, STEPS);
        let closed = measure(head(), &frame).aperture_mm < 0.3;
        shut += usize::from(closed);
        if closed || i % 6 == 0 {
            let (depth, at) = drawn(1).lips_overlap(&frame.skin);
            if depth > worst.0 {
                worst = (depth, at, i);
            }
        }
    }
    assert!(shut > 20, "the sentence's lips met in {shut} frames only");
    assert!(worst.0 < DEEPEST_MM, "{worst:?}");
}

#[test]
fn pressed_lips_are_closed_from_corner_to_corner() {
    for controls in [
        pressed(),
        head().calibration.controls(&Articulation {
            aperture_mm: -1.0,
            ..Articulation::REST
        }),
    ] {
        let frame = posed(&controls);
        let got = measure(head(), &frame);
        assert!(got.aperture_mm < 0.05, "{got:?}");
        // Lines of sight into the slit meet a lip everywhere.
        let through = drawn(2).see_through(&frame.skin);
        assert!(through.is_empty(), "light through the lips at {through:?}");
    }
}

#[test]
fn pressed_lips_flatten_and_meet_in_a_band() {
    let (rest, press) = (head().rest_frame(), posed(&pressed()));
    let limit = head().skin_limit().unwrap();
    let heights = |skin: &[Vec3]| {
        let mut points = skin.to_vec();
        limit.apply(skin, &mut points);
        let middle = head().lips.upper.len() / 2;
        let of = |columns: &[[u32; 11]]| {
            let at = |level: usize| points[columns[middle][level] as usize];
            (at(BORDER).y - at(CONTACT).y).abs()
        };
        (of(&head().lips.upper), of(&head().lips.lower))
    };
    let (before, after) = (heights(&rest.skin), heights(&press.skin));
    let (band, pressed_band) = (drawn(2).band(&rest.skin), drawn(2).band(&press.skin));
    assert!(
        after.0 < 0.9 * before.0 && after.1 < 0.93 * before.1,
        "{before:?} {after:?}"
    );
    assert!(pressed_band > band + 1.0, "{band} {pressed_band}");
}

#[test]
fn a_hard_press_lies_still() {
    let mut simulation = Simulation::new(Arc::clone(head()));
    let mut last = settled(&mut simulation, &pressed(), 960);
    let mut most = 0.0_f32;
    for _ in 0..60 {
        let next = settled(&mut simulation, &pressed(), 1);
        let moved = next
            .skin
            .iter()
            .zip(&last.skin)
            .map(|(a, b)| a.distance(*b));
        most = moved.fold(most, f32::max);
        last = next;
    }
    assert!(most < 0.05, "{most} mm from step to step");
}
