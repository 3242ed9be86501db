//! Nothing but physics moves the skin: what speech says reaches it through muscles and jaw or not at all.

use std::sync::Arc;

use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::{Control, Head, STEP_TICKS, Simulation};
use mouthpiece_speech::Speech;

/// How far any vertex gets from rest while all 61 phones are spoken, mm.
#[allow(
    clippy::expect_used,
    reason = "a helper of a test; clippy sees only test functions"
)]
fn farthest(muscle_stiffness: f32, jaw: bool) -> f32 {
    const PHONE_TICKS: i64 = 4_800;
    let head = Arc::new(Head::reference().expect("the crate's own data"));
    let speech = Speech::new(&head.calibration).expect("the crate's own tables");
    let segments: Vec<Segment> = (0..)
        .zip(Phone::ALL)
        .map(|(i, phone)| Segment::new(phone, i * PHONE_TICKS, (i + 1) * PHONE_TICKS))
        .collect();
    let track = speech.track(&segments);

    let mut simulation = Simulation::new(Arc::clone(&head));
    simulation.set_muscle_stiffness(muscle_stiffness);
    // Contact settles lips and teeth even at rest; what is asked for here is what speech moves.
    simulation.set_contacts(false);
    let mut frame = head.rest_frame();
    let mut farthest = 0.0_f32;
    while simulation.time() < track.end() {
        for _ in 0..30 {
            let mut controls = track.controls_at(simulation.time() + STEP_TICKS);
            if !jaw {
                controls[Control::Jaw] = 0.0;
            }
            simulation.step(&controls);
        }
        simulation.save(&mut frame);
        let rest = &head.skin.mesh.positions;
        let moved = frame
            .skin
            .iter()
            .zip(rest)
            .map(|(p, q)| p.distance(*q))
            .fold(0.0, f32::max);
        farthest = farthest.max(moved);
    }
    farthest
}

#[test]
fn no_phone_sets_a_vertex() {
    let cut = farthest(0.0, false);
    assert!(
        cut < 1e-3,
        "with muscles cut and the jaw held, speech moved the skin {cut} mm"
    );
    let whole = farthest(1.0, true);
    assert!(whole > 8.0, "speech moves the face {whole} mm at most");
}
