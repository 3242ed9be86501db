//! How the default tissue moves, by numbers: it keeps its energy when nothing takes any, follows a fast lip,
//! does not care for the length of the step, and keeps the volume of the cheeks.

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use mouthpiece_rig::lip_level::CREST;
use mouthpiece_rig::{
    Control, Controls, Head, KeyFrame, Muscle, STEP_TICKS, Simulation, TICK_RATE,
};

/// Steps in a second.
const SECOND: usize = (TICK_RATE / STEP_TICKS) as usize;

#[allow(
    clippy::unwrap_used,
    reason = "a helper of tests; clippy sees only test functions"
)]
fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

/// A head that nothing but its tissue stops.
fn free() -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(head()));
    simulation.set_contacts(false);
    simulation
}

fn settled(simulation: &mut Simulation, controls: &Controls, steps: usize) -> KeyFrame {
    for _ in 0..steps {
        simulation.step(controls);
    }
    let mut frame = head().rest_frame();
    simulation.save(&mut frame);
    frame
}

fn told(settings: &[(Control, f32)]) -> Controls {
    let mut controls = Controls::default();
    for &(control, value) in settings {
        controls[control] = value;
    }
    controls
}

#[test]
fn left_alone_and_undamped_it_keeps_its_energy() {
    let smile = told(&[
        (Control::ZygomaticusMajor, 0.1),
        (Control::FrontalisInner, 0.1),
    ]);
    // Let go of at once, a second for it to spread over all modes: the skin is where the muscles had it, they are at rest.
    let mut let_go = settled(&mut free(), &smile, SECOND);
    let_go.state = Controls::default();
    let_go.state_rate = Controls::default();
    let mut simulation = free();
    simulation.set_damping(0.0);
    assert!(simulation.restore(&let_go));
    settled(&mut simulation, &Controls::default(), SECOND);
    let mut means = Vec::new();
    for _ in 0..100 {
        let mut sum = 0.0;
        for _ in 0..SECOND / 10 {
            simulation.step(&Controls::default());
            sum += simulation.energy().unwrap();
        }
        means.push(10.0 * sum / SECOND as f64);
    }
    let worst = means
        .iter()
        .map(|m| (m / means[0] - 1.0).abs())
        .fold(0.0, f64::max);
    println!("energy of 10 s: within {:.3} %", 100.0 * worst);
    assert!(worst < 0.01, "it drifts by {:.2} %", 100.0 * worst);
}

#[test]
fn skin_lags_less_than_ten_milliseconds_behind_a_fast_lip() {
    let middle = head().lips.upper.len() / 2;
    let upper = head().lips.upper[middle][CREST] as usize;
    let lower = head().lips.lower[middle][CREST] as usize;
    // What draws the lip, how far, within which time (s).
    for (control, most, within, lip) in [
        (Control::Jaw, 0.35, 0.08, lower),
        (Control::DepressorLabiiInferioris, 1.0, 0.035, lower),
        (Control::LevatorLabiiSuperioris, 1.0, 0.035, upper),
        (Control::ProtrusionInferior, 1.0, 0.035, lower),
    ] {
        let mut simulation = free();
        let mut way: Vec<(Vec3, Controls)> = Vec::new();
        for i in 0..SECOND / 4 {
            let share = (i as f32 / SECOND as f32 / within).min(1.0);
            let frame = settled(&mut simulation, &told(&[(control, most * share)]), 1);
            way.push((frame.skin[lip], frame.state));
        }
        let along = (way[way.len() - 1].0 - way[0].0).normalize();
        let place = |i: usize| way[i].0.dot(along);
        let speed = |i: usize| (place(i + 1) - place(i - 1)) * 0.5 * SECOND as f32;
        let (mut worst, mut fastest) = (0.0_f32, 0.0_f32);
        for i in (4..way.len() / 2).step_by(4) {
            fastest = fastest.max(speed(i));
            if speed(i) < 40.0 {
                continue;
            }
            // Where the muscles as they are at this moment would hold it, had it the time.
            let held = settled(&mut free(), &way[i].1, SECOND).skin[lip].dot(along);
            let arrived = (i..way.len() - 1).find(|&k| place(k + 1) >= held);
            let k = arrived.unwrap_or(way.len() - 2);
            let share = ((held - place(k)) / (place(k + 1) - place(k)).max(1e-6)).clamp(0.0, 1.0);
            worst = worst.max((k as f32 + share - i as f32) * 1000.0 / SECOND as f32);
        }
        println!("{}: {fastest:.0} mm/s, lag {worst:.1} ms", control.name());
        assert!(worst < 10.0, "{}: the skin lags {worst} ms", control.name());
        let speech = control != Control::Jaw || fastest > 300.0;
        assert!(speech, "the jaw moves the lip at {fastest} mm/s only");
    }
}

/// A sentence's controls at 60 a second (`contact/sentence.csv`), between them in a straight line.
fn sentence_at(step: usize) -> Option<Controls> {
    static ROWS: OnceLock<Vec<Controls>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| {
        let mut lines = include_str!("contact/sentence.csv").lines();
        let names: Vec<Control> = lines
            .next()
            .unwrap_or_default()
            .split(',')
            .filter_map(Control::from_name)
            .collect();
        lines
            .map(|line| {
                let values = line.split(',').filter_map(|v| v.parse().ok());
                told(&names.iter().copied().zip(values).collect::<Vec<_>>())
            })
            .collect()
    });
    let (row, share) = (
        step * 60 / SECOND,
        (step * 60 % SECOND) as f32 / SECOND as f32,
    );
    Some(rows.get(row)?.lerp(rows.get(row + 1)?, share))
}

/// The farthest that half the step moves a vertex during a sentence, mm, and how far the sentence moves any.
fn by_half_the_step(lips: bool) -> (f32, f32) {
    let (mut whole, mut half) = (
        Simulation::new(Arc::clone(head())),
        Simulation::new(Arc::clone(head())),
    );
    half.set_substeps(2);
    for simulation in [&mut whole, &mut half] {
        simulation.set_lip_contact(lips);
    }
    let (mut worst, mut most, mut step) = (0.0_f32, 0.0_f32, 0);
    let rest = &head().skin.mesh.positions;
    while let Some(controls) = sentence_at(step) {
        let a = settled(&mut whole, &controls, 1);
        let b = settled(&mut half, &controls, 1);
        for (i, (p, q)) in a.skin.iter().zip(&b.skin).enumerate() {
            // The inside of the mouth lies on the teeth: what is seen is judged.
            if head().skin.wet[i] < 0.5 {
                worst = worst.max(p.distance(*q));
                most = most.max(p.distance(rest[i]));
            }
        }
        step += 1;
    }
    (worst, most)
}

#[test]
fn a_sentence_does_not_depend_on_the_step() {
    let (tissue, most) = by_half_the_step(false);
    let (lips, _) = by_half_the_step(true);
    println!(
        "half the step: {tissue:.3} mm, {lips:.3} mm where lips meet; the skin moved {most:.1} mm"
    );
    assert!(most > 8.0, "the sentence moves the face: {most} mm");
    assert!(tissue < 0.1, "half the step moves a vertex by {tissue} mm");
    // Lips that close are stopped at the end of a step: a moment earlier or later is a step apart.
    assert!(lips < 0.6, "half the step moves a lip by {lips} mm");
}

#[test]
fn cheeks_keep_their_volume() {
    let change = |muscle: Muscle, volume: f32| {
        let mut simulation = free();
        simulation.set_volume_stiffness(volume);
        let rest = simulation.cheek_volumes();
        let controls = told(&[(Control::contraction(muscle), 1.0)]);
        settled(&mut simulation, &controls, SECOND);
        let now = simulation.cheek_volumes();
        let change = |side: usize| (now[side] / rest[side] - 1.0).abs();
        change(0).max(change(1))
    };
    let mut worse = 0;
    for muscle in Muscle::ALL {
        let (kept, free) = (change(muscle, 1.0), change(muscle, 0.0));
        println!(
            "{muscle:?}: {:.2} % kept, {:.2} % free",
            100.0 * kept,
            100.0 * free
        );
        assert!(
            kept < 0.03,
            "{muscle:?} changes a cheek by {:.1} %",
            100.0 * kept
        );
        if free > 0.01 {
            assert!(
                kept < 0.2 * free,
                "{muscle:?}: {kept} kept against {free} free"
            );
            worse += 1;
        }
    }
    assert!(
        worse >= 3,
        "only {worse} muscles change a cheek that nothing keeps"
    );
}

#[test]
fn a_head_at_work_takes_less_than_four_megabytes() {
    let bytes = Simulation::new(Arc::clone(head())).tissue_bytes();
    assert!(bytes < 4 << 20, "{bytes} bytes");
}
