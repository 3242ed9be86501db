//! What a user may rely on of a head in motion (contact apart): only physics moves skin, a
//! rewind repeats itself, nothing flies apart, nothing is allocated per step.

use std::sync::{Arc, OnceLock};

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use glam::Vec3;
use mouthpiece_rig::{
    Articulation, Calibration, Control, Controls, Head, KeyFrame, Muscle, Simulation, Tongue,
    measure,
};
use proptest::prelude::*;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

/// The head after `steps` towards `controls`.
fn settled(simulation: &mut Simulation, controls: &Controls, steps: usize) -> KeyFrame {
    for _ in 0..steps {
        simulation.step(controls);
    }
    let mut frame = head().rest_frame();
    simulation.save(&mut frame);
    frame
}

fn farthest(frame: &KeyFrame) -> f32 {
    let rest = &head().skin.mesh.positions;
    frame
        .skin
        .iter()
        .zip(rest)
        .map(|(p, q)| p.distance(*q))
        .fold(0.0, f32::max)
}

#[test]
fn without_springs_to_the_muscles_no_contraction_moves_the_skin() {
    for muscle in Muscle::ALL {
        let mut controls = Controls::default();
        controls[Control::contraction(muscle)] = 1.0;
        controls[Control::ProtrusionSuperior] = 1.0;
        controls[Control::ProtrusionInferior] = -1.0;
        let mut cut = Simulation::new(Arc::clone(head()));
        // Contact settles the head by itself: what is asked for here is what the muscles do.
        cut.set_contacts(false);
        cut.set_muscle_stiffness(0.0);
        let moved = farthest(&settled(&mut cut, &controls, 120));
        assert!(
            moved < 0.01,
            "{muscle:?} moved the skin by {moved} mm without a spring"
        );
        let mut whole = Simulation::new(Arc::clone(head()));
        let moved = farthest(&settled(&mut whole, &controls, 120));
        assert!(moved > 1.0, "{muscle:?} moves nothing: {moved} mm");
    }
}

#[test]
fn every_muscle_moves_the_skin_it_should() {
    let corner = head().lips.upper.last().unwrap()[0] as usize;
    let rest = head().skin.mesh.positions[corner];
    let shift = |control: Control| {
        let mut controls = Controls::default();
        controls[control] = 0.7;
        settled(&mut Simulation::new(Arc::clone(head())), &controls, 150).skin[corner] - rest
    };
    let smile = shift(Control::ZygomaticusMajor);
    assert!(
        smile.y > 2.0 && smile.x > 1.0,
        "zygomaticus lifts the corner out and up: {smile}"
    );
    let frown = shift(Control::DepressorAnguliOris);
    assert!(
        frown.y < -2.0,
        "depressor anguli oris draws the corner down: {frown}"
    );
    let spread = shift(Control::Risorius);
    assert!(
        spread.x > 3.0 && spread.y.abs() < 3.0,
        "risorius draws the corner sideways: {spread}"
    );
    let purse = shift(Control::OrbicularisOrisSuperior);
    assert!(purse.x < -2.0, "the sphincter draws the corner in: {purse}");
}

#[test]
fn a_rewind_repeats_itself_to_the_bit() {
    let mut open = Controls::default();
    open[Control::Jaw] = 0.15;
    open[Control::Risorius] = 0.3;
    let mut simulation = Simulation::new(Arc::clone(head()));
    let kept = settled(&mut simulation, &open, 50);
    let first = settled(&mut simulation, &Controls::default(), 70);
    assert!(simulation.restore(&kept));
    let second = settled(&mut simulation, &Controls::default(), 70);
    assert_eq!(first, second);
}

#[test]
fn a_step_allocates_nothing() {
    let mut simulation = Simulation::new(Arc::clone(head()));
    let mut frame = head().rest_frame();
    let mut controls = Controls::default();
    controls[Control::Jaw] = 0.2;
    assert_no_alloc(|| {
        for _ in 0..20 {
            simulation.step(&controls);
        }
        simulation.save(&mut frame);
    });
}

#[test]
fn the_head_is_its_own_mirror_image() {
    let mut controls = Controls::default();
    controls[Control::Jaw] = 0.12;
    controls[Control::ZygomaticusMajor] = 0.4;
    let frame = settled(&mut Simulation::new(Arc::clone(head())), &controls, 150);
    let columns = &head().lips.upper;
    for (right, left) in columns.iter().zip(columns.iter().rev()) {
        let (r, l) = (frame.skin[right[1] as usize], frame.skin[left[1] as usize]);
        assert!(
            (r * Vec3::new(-1.0, 1.0, 1.0)).distance(l) < 0.05,
            "{r} is no mirror image of {l}"
        );
    }
}

#[test]
fn the_calibration_is_met_on_postures_it_was_not_fitted_on() {
    let calibration = &head().calibration;
    // (aperture, width, protrusion, jaw): the range of speech, none of it a fitting sample.
    for (aperture_mm, width, protrusion_mm, jaw_rad) in [
        (13.0, 1.0, 0.0, 0.13),
        (5.0, 1.12, -0.5, 0.03),
        (3.5, 0.80, 3.0, 0.04),
        (8.0, 1.0, 0.0, 0.07),
        (6.0, 0.87, 2.5, 0.06),
    ] {
        let wanted = Articulation {
            aperture_mm,
            width,
            protrusion_mm,
            lip_teeth_mm: None,
            jaw_rad,
            tongue: Tongue::default(),
        };
        let controls = calibration.controls(&wanted);
        let frame = settled(&mut Simulation::new(Arc::clone(head())), &controls, 250);
        let got = measure(head(), &frame);
        let rest = measure(head(), &head().rest_frame());
        assert!(
            (got.aperture_mm - aperture_mm).abs() < 0.8,
            "{wanted:?} gave {got:?}"
        );
        assert!(
            (got.width_mm / rest.width_mm - width).abs() < 0.05,
            "{wanted:?} gave {got:?}"
        );
        assert!(
            (got.protrusion_mm - protrusion_mm).abs() < 1.0,
            "{wanted:?} gave {got:?}"
        );
    }
}

#[test]
fn the_carried_calibration_is_what_the_head_yields() {
    let (carried, fitted) = (&head().calibration, Calibration::fit(head()));
    let posture = Articulation {
        aperture_mm: 9.0,
        width: 0.95,
        protrusion_mm: 1.0,
        jaw_rad: 0.08,
        ..Articulation::REST
    };
    let (a, b) = (carried.controls(&posture), fitted.controls(&posture));
    for &control in Control::ALL {
        assert!(
            (a[control] - b[control]).abs() < 0.02,
            "{}: {} carried, {} fitted; run the calibrate example again",
            control.name(),
            a[control],
            b[control]
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn no_controls_make_it_fly_apart(values in prop::collection::vec(-2.0_f32..2.0, Control::COUNT), wild in any::<u8>()) {
        let mut controls = Controls::default();
        controls.0.copy_from_slice(&values);
        controls.0[wild as usize % Control::COUNT] = f32::NAN;
        let mut simulation = Simulation::new(Arc::clone(head()));
        settled(&mut simulation, &controls, 60);
        let frame = settled(&mut simulation, &Controls::default(), 60);
        prop_assert!(frame.skin.iter().all(|p| p.is_finite()));
        let farthest = farthest(&frame);
        prop_assert!(farthest < 60.0, "a vertex went {} mm away", farthest);
    }
}
