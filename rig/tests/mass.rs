//! Every mass that a head may give its vertices is one that the simulation can step.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

use std::sync::Arc;

use mouthpiece_rig::{Control, Controls, Head, KeyFrame, Simulation, TissueRecord};

/// Three seconds of full-range steps of all controls, 60 a second; then two seconds at rest.
fn shaken(vertex_mass_g: f32) -> (f32, f32) {
    let mut head = Head::reference().unwrap();
    head.tissue.vertex_mass_g = vertex_mass_g;
    let head = Arc::new(head);
    let mut simulation = Simulation::new(Arc::clone(&head));
    let mut frame = KeyFrame::default();
    let farthest = |frame: &KeyFrame| {
        let moved = frame.skin.iter().zip(&head.skin.mesh.positions);
        // What is no number is farther than anything.
        moved
            .map(|(p, rest)| p.distance(*rest))
            .fold(
                0.0,
                |most, d: f32| if d <= most { most } else { d.min(f32::MAX) },
            )
    };
    let (mut seed, mut most) = (3_u64, 0.0_f32);
    for _ in 0..180 {
        let mut controls = Controls::default();
        for &control in Control::ALL {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let (low, high) = control.range();
            controls[control] = if seed >> 63 == 0 { low } else { high };
        }
        for _ in 0..8 {
            simulation.step(&controls);
        }
        simulation.save(&mut frame);
        most = most.max(farthest(&frame));
    }
    for _ in 0..960 {
        simulation.step(&Controls::default());
    }
    simulation.save(&mut frame);
    (most, farthest(&frame))
}

#[test]
fn the_lightest_and_the_heaviest_skin_stay_on_the_head() {
    let masses = [
        TissueRecord::MASS_MIN_G,
        TissueRecord::MASS_G,
        TissueRecord::MASS_MAX_G,
    ];
    let shaken = masses.map(|mass| (mass, shaken(mass)));
    for (mass, (most, left)) in shaken {
        println!("{mass} g: {most:.1} mm at most, {left:.3} mm left after 2 s");
    }
    // How far it comes back is the tissue's affair; the mass must not matter to it.
    let (_, (_, usual)) = shaken[1];
    for (mass, (most, left)) in shaken {
        assert!(most < 60.0, "{mass} g: a vertex went {most} mm away");
        assert!(
            (left - usual).abs() < 0.05,
            "{mass} g: {left} mm from rest after 2 s"
        );
    }
}
