//! Every muscle does what an anatomy text says of it: the skin at a landmark goes the right way.

use std::sync::{Arc, OnceLock};

use glam::{Vec3, vec3};
use mouthpiece_rig::{Control, Controls, Head, KeyFrame, Muscle, Simulation};

mod deeds;

use deeds::{DEEDS, vertex};

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

fn settled(controls: &Controls) -> KeyFrame {
    let mut simulation = Simulation::new(Arc::clone(head()));
    for _ in 0..480 {
        simulation.step(controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    frame
}

#[test]
fn every_muscle_does_what_anatomy_says() {
    let mut wrong = Vec::new();
    for (muscle, what, place, way, least) in DEEDS {
        let mut controls = Controls::default();
        controls[Control::contraction(muscle)] = 1.0;
        let frame = settled(&controls);
        for side in [vec3(1.0, 1.0, 1.0), vec3(-1.0, 1.0, 1.0)] {
            let v = vertex(head(), Vec3::from(place) * side);
            let moved = frame.skin[v] - head().skin.mesh.positions[v];
            let along = moved.dot((Vec3::from(way) * side).normalize());
            println!("{muscle:?}: {what} {along:.2} mm of {least}; moved {moved:.1}");
            if along < least {
                wrong.push(format!(
                    "{muscle:?}: {what} went {along:.2} mm, not {least}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    for muscle in Muscle::ALL {
        assert!(
            DEEDS.iter().any(|d| d.0 == muscle),
            "{muscle:?} has no deed"
        );
    }
}
