//! The map from what a mouth should do to muscles: right on postures it never saw, smooth, bounded, and honest about
//! what a head cannot do.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

use std::sync::{Arc, OnceLock};

use mouthpiece_rig::{Articulation, Calibration, Control, Head, Measure, Tongue};
use proptest::prelude::*;

fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

/// Learnt here, so that it is of the physics as they are.
fn fitted() -> &'static Calibration {
    static FITTED: OnceLock<Calibration> = OnceLock::new();
    FITTED.get_or_init(|| Calibration::fit(head()))
}

#[test]
fn random_postures_come_out_as_wanted() {
    let report = fitted().verify(head(), 1);
    println!("{report:#?}");
    assert_eq!(report.postures, 60);
    for (error, (median, p90, worst)) in
        report
            .errors
            .iter()
            .zip([(0.7, 1.8, 3.0), (0.8, 2.0, 4.0), (0.4, 1.0, 2.0)])
    {
        assert!(error.median_mm < median, "{error:?}");
        assert!(error.p90_mm < p90, "{error:?}");
        assert!(error.worst_mm < worst, "{error:?}");
    }
    assert!(
        fitted().verify(head(), 1) == report,
        "the same seed, the same report"
    );
}

#[test]
fn a_head_that_cannot_reach_a_target_says_which_and_by_how_much() {
    let reached = fitted().reach(&Articulation::REST);
    assert_eq!(reached.misses().count(), 0, "{reached:?}");
    assert_eq!(reached.wanted_mm[3], None);
    // No mouth opens 30 mm with the jaw shut.
    let gaping = Articulation {
        aperture_mm: 30.0,
        ..Articulation::REST
    };
    let misses: Vec<_> = fitted().reach(&gaping).misses().collect();
    let aperture = misses.iter().find(|m| m.measure == Measure::Aperture);
    let aperture = aperture.unwrap();
    assert!(aperture.by_mm() < -10.0, "{aperture:?}");
    let said = aperture.to_string();
    assert!(
        said.contains("aperture") && said.contains("instead of 30.0"),
        "{said}"
    );
    // Past contact, only lips that stay apart are a miss.
    let pressed = Articulation {
        aperture_mm: -8.0,
        ..Articulation::REST
    };
    let misses: Vec<_> = fitted().reach(&pressed).misses().collect();
    assert!(
        misses.iter().all(|m| m.measure != Measure::Aperture),
        "{misses:?}"
    );
}

#[test]
fn a_head_that_was_never_calibrated_says_so_of_everything() {
    let open = Articulation {
        aperture_mm: 8.0,
        ..Articulation::REST
    };
    assert!(Calibration::default().reach(&open).misses().count() >= 2);
    assert_eq!(Calibration::default().verify(head(), 1).postures, 0);
}

/// Postures as speech asks for them and somewhat beyond: the jaw opens with the lips.
fn speech() -> impl Strategy<Value = Articulation> {
    let lips = (-4.0_f32..15.0, 0.7_f32..1.2, -1.5_f32..4.5);
    let teeth = proptest::option::weighted(0.2, 0.0_f32..6.0);
    (lips, teeth, 0.0_f32..1.0).prop_map(
        |((aperture_mm, width, protrusion_mm), lip_teeth_mm, jaw)| Articulation {
            aperture_mm,
            width,
            protrusion_mm,
            lip_teeth_mm: lip_teeth_mm.filter(|_| aperture_mm < 4.0),
            jaw_rad: jaw * (0.05 + 0.011 * aperture_mm.max(0.0)),
            tongue: Tongue::default(),
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// A hundredth of a millimetre more is a little more of the same muscles, a tenth is not much more: nothing leaps.
    #[test]
    fn it_is_smooth(a in speech(), way in prop::array::uniform4(-1.0_f32..1.0)) {
        let from = fitted().controls(&a);
        for (mm, most) in [(0.01, 0.05), (0.1, 0.3)] {
            let b = Articulation {
                aperture_mm: a.aperture_mm + mm * way[0],
                width: a.width + 0.02 * mm * way[1],
                protrusion_mm: a.protrusion_mm + mm * way[2],
                jaw_rad: (a.jaw_rad + 0.01 * mm * way[3]).max(0.0),
                ..a
            };
            let to = fitted().controls(&b);
            for &control in Control::ALL {
                let change = (to[control] - from[control]).abs();
                prop_assert!(change < most, "{mm} mm, {}: {} to {}", control.name(), from[control], to[control]);
            }
        }
    }

    /// Whatever comes in, numbers or none, the controls are ones that the head accepts.
    #[test]
    fn it_is_bounded(values in prop::array::uniform8(any::<f32>()), teeth in any::<bool>()) {
        let wild = Articulation {
            aperture_mm: values[0],
            width: values[1],
            protrusion_mm: values[2],
            lip_teeth_mm: teeth.then_some(values[3]),
            jaw_rad: values[4],
            tongue: Tongue { tip: values[5], out: values[6], body: values[7] },
        };
        let controls = fitted().controls(&wild);
        for &control in Control::ALL {
            let (low, high) = control.range();
            prop_assert!((low..=high).contains(&controls[control]), "{}: {}", control.name(), controls[control]);
        }
        prop_assert!(fitted().expected(&controls).iter().all(|mm| mm.is_finite()));
    }
}

#[test]
fn what_is_no_number_is_as_at_rest() {
    let rest = fitted().controls(&Articulation::REST);
    for wild in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let none = Articulation {
            aperture_mm: wild,
            width: wild,
            protrusion_mm: wild,
            lip_teeth_mm: Some(wild),
            jaw_rad: wild,
            tongue: Tongue {
                tip: wild,
                out: wild,
                body: wild,
            },
        };
        assert_eq!(fitted().controls(&none), rest);
    }
}
