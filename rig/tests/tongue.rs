//! The tongue stays in the mouth, and in front of it only where the teeth let it pass.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

mod mouth;

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use mouth::{Mouth, Worst, posed};
use mouthpiece_rig::{Control, Controls, Head, KeyFrame, STEP_TICKS, Simulation};

/// As deep as a tongue may be drawn in a tooth or the palate, mm: nobody sees it.
const DEEPEST_MM: f32 = 0.5;

fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

fn told(tip: f32, out: f32, body: f32, jaw: f32) -> Controls {
    let mut controls = Controls::default();
    controls[Control::TongueTip] = tip;
    controls[Control::TongueOut] = out;
    controls[Control::TongueBody] = body;
    controls[Control::Jaw] = jaw;
    controls
}

fn steps(simulation: &mut Simulation, controls: &Controls, count: usize) -> KeyFrame {
    for _ in 0..count {
        simulation.step(controls);
    }
    let mut frame = KeyFrame::default();
    simulation.save(&mut frame);
    frame
}

/// The most forward place of the drawn tongue, mm.
fn front(state: &Controls) -> Vec3 {
    let tongue = head().part("tongue").unwrap();
    let places = posed(tongue, &head().bodies(state));
    places
        .into_iter()
        .max_by(|a, b| a.z.total_cmp(&b.z))
        .unwrap()
}

#[test]
fn it_stays_inside_wherever_it_is_told_to_go() {
    let mouth = Mouth::of(head());
    let mut simulation = Simulation::new(Arc::clone(head()));
    let mut worst = Worst::default();
    for jaw in [0.0, 0.015, 0.035, 0.08, 0.3] {
        for tip in [0.0, 0.6, 1.0] {
            for out in [-1.0, 0.0, 0.1, 0.3, 0.6, 1.0] {
                for body in [0.0, 0.5, 1.0] {
                    let frame = steps(&mut simulation, &told(tip, out, body, jaw), 70);
                    let here = mouth.worst(head(), &frame.state);
                    if here.most() > DEEPEST_MM {
                        println!("tip {tip} out {out} body {body} jaw {jaw}: {here:?}");
                    }
                    worst = worst.with(here);
                }
            }
        }
    }
    println!("at rest anywhere: {worst:?}");
    assert!(worst.most() < DEEPEST_MM, "{worst:?}");
}

#[test]
fn it_stays_inside_in_motion() {
    let mouth = Mouth::of(head());
    let mut simulation = Simulation::new(Arc::clone(head()));
    let mut worst = Worst::default();
    // Full-range steps of all four controls, 15 a second, and the state looked at every 6 ms.
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f32 / (1_u64 << 24) as f32
    };
    for _ in 0..200 {
        let jaw = if random() < 0.4 {
            0.0
        } else {
            0.3 * random() * random()
        };
        let target = told(random(), 2.0 * random() - 1.0, random(), jaw);
        for _ in 0..11 {
            let frame = steps(&mut simulation, &target, 3);
            let here = mouth.worst(head(), &frame.state);
            if here.most() > DEEPEST_MM {
                println!("on the way to {:?}: {here:?}", frame.state);
            }
            worst = worst.with(here);
        }
    }
    println!("in motion: {worst:?}");
    assert!(worst.most() < DEEPEST_MM, "{worst:?}");
}

#[test]
fn it_comes_out_only_where_the_teeth_let_it() {
    let mut simulation = Simulation::new(Arc::clone(head()));
    let shut = steps(&mut simulation, &told(0.5, 1.0, 0.2, 0.0), 100);
    let behind = front(&shut.state);
    assert!(behind.z < 101.0, "behind the teeth, not at {behind}");
    // As for th: the incisors 1.3 mm apart.
    let ajar = steps(&mut simulation, &told(0.55, 0.95, 0.2, 0.035), 100);
    let between = front(&ajar.state);
    assert!(between.z > 103.0, "between the teeth, not at {between}");
    // Bitten: the jaw shuts, and pushes it back in.
    let bitten = steps(&mut simulation, &told(0.55, 0.95, 0.2, 0.0), 100);
    assert!(front(&bitten.state).z < 101.0);
}

#[test]
fn each_of_its_controls_does_what_its_name_says() {
    let mut simulation = Simulation::new(Arc::clone(head()));
    let at = |simulation: &mut Simulation, tip, out, body| {
        let frame = steps(simulation, &told(tip, out, body, 0.06), 100);
        let tongue = head().part("tongue").unwrap();
        let places = posed(tongue, &head().bodies(&frame.state));
        let highest = places.iter().filter(|p| p.z < 70.0).map(|p| p.y);
        (front(&frame.state), highest.fold(f32::MIN, f32::max))
    };
    let (rest, dorsum) = at(&mut simulation, 0.0, 0.0, 0.0);
    let (raised, _) = at(&mut simulation, 1.0, 0.0, 0.0);
    assert!(raised.y > rest.y + 8.0, "the tip rises: {rest} {raised}");
    let (back, _) = at(&mut simulation, 0.0, -1.0, 0.0);
    assert!(back.z < rest.z - 6.0, "it is drawn back: {rest} {back}");
    let (_, arched) = at(&mut simulation, 0.0, 0.0, 1.0);
    assert!(arched > dorsum + 5.0, "its back rises: {dorsum} {arched}");
}

#[test]
fn a_rewind_brings_it_back_to_the_bit() {
    let mut simulation = Simulation::new(Arc::clone(head()));
    // In contact with the palate and on its way.
    let then = steps(&mut simulation, &told(1.0, 0.5, 1.0, 0.05), 17);
    let first = steps(&mut simulation, &told(0.2, 1.0, 0.3, 0.0), 40);
    steps(&mut simulation, &told(0.0, -1.0, 0.0, 0.2), 100);
    assert!(simulation.restore(&then));
    let again = steps(&mut simulation, &told(0.2, 1.0, 0.3, 0.0), 40);
    assert_eq!(first.time, then.time + 40 * STEP_TICKS);
    assert!(first.state == again.state && first.state_rate == again.state_rate);
}

/// The other tests measure by it: it must see what contact prevents.
#[test]
fn a_tongue_that_nothing_stops_is_seen_in_teeth_and_palate() {
    let mouth = Mouth::of(head());
    let poked = mouth.worst(head(), &told(0.0, 1.0, 0.0, 0.0));
    assert!(
        poked.upper_teeth > 1.0 || poked.lower_teeth > 1.0,
        "{poked:?}"
    );
    let pressed = mouth.worst(head(), &told(0.0, 0.0, 2.0, 0.0));
    assert!(pressed.palate > 1.0, "{pressed:?}");
}
