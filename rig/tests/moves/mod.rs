//! How a head moves, measured: how far skin lags behind a fast lip, what half the step changes in a sentence, by how
//! much a cheek's volume changes. The same for either model of tissue.
#![allow(
    clippy::unwrap_used,
    reason = "helpers of tests; clippy sees only test functions"
)]

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use mouthpiece_rig::lip_level::CREST;
use mouthpiece_rig::{Control, Controls, Muscle, STEP_TICKS, Simulation, TICK_RATE, TissueModel};

use crate::models::{head, settled};

/// Steps in a second.
pub(crate) const SECOND: usize = (TICK_RATE / STEP_TICKS) as usize;

/// A head that nothing but its tissue stops.
pub(crate) fn free(model: TissueModel) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(head(model)));
    simulation.set_contacts(false);
    simulation
}

pub(crate) fn told(settings: &[(Control, f32)]) -> Controls {
    let mut controls = Controls::default();
    for &(control, value) in settings {
        controls[control] = value;
    }
    controls
}

/// A lip that is drawn fast.
#[derive(Debug)]
pub(crate) struct Lag {
    pub control: Control,
    /// The most that the lip is behind where the muscles would hold it, ms, and the fastest that it moves, mm/s.
    pub worst_ms: f32,
    pub fastest_mm_s: f32,
}

/// How far the crests of the lips lag behind the jaw and the muscles that draw them.
pub(crate) fn lags(model: TissueModel) -> Vec<Lag> {
    let lips = &head(model).lips;
    let middle = lips.upper.len() / 2;
    let upper = lips.upper[middle][CREST] as usize;
    let lower = lips.lower[middle][CREST] as usize;
    // What draws the lip, how far, within which time (s).
    [
        (Control::Jaw, 0.35, 0.08, lower),
        (Control::DepressorLabiiInferioris, 1.0, 0.035, lower),
        (Control::LevatorLabiiSuperioris, 1.0, 0.035, upper),
        (Control::ProtrusionInferior, 1.0, 0.035, lower),
    ]
    .map(|(control, most, within_s, lip)| lag(model, control, [most, within_s], lip))
    .into()
}

fn lag(model: TissueModel, control: Control, [most, within_s]: [f32; 2], lip: usize) -> Lag {
    let mut simulation = free(model);
    let mut way: Vec<(Vec3, Controls)> = Vec::new();
    for i in 0..SECOND / 4 {
        let share = (i as f32 / SECOND as f32 / within_s).min(1.0);
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
        let held = settled(&mut free(model), &way[i].1, SECOND).skin[lip].dot(along);
        let arrived = (i..way.len() - 1).find(|&k| place(k + 1) >= held);
        let k = arrived.unwrap_or(way.len() - 2);
        let share = ((held - place(k)) / (place(k + 1) - place(k)).max(1e-6)).clamp(0.0, 1.0);
        worst = worst.max((k as f32 + share - i as f32) * 1000.0 / SECOND as f32);
    }
    println!("{}: {fastest:.0} mm/s, lag {worst:.1} ms", control.name());
    Lag {
        control,
        worst_ms: worst,
        fastest_mm_s: fastest,
    }
}

/// A sentence's controls at 60 a second (`contact/sentence.csv`), between them in a straight line.
fn sentence_at(step: usize) -> Option<Controls> {
    static ROWS: OnceLock<Vec<Controls>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| {
        let mut lines = include_str!("../contact/sentence.csv").lines();
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
pub(crate) fn by_half_the_step(model: TissueModel, lips: bool) -> (f32, f32) {
    let head = head(model);
    let (mut whole, mut half) = (
        Simulation::new(Arc::clone(head)),
        Simulation::new(Arc::clone(head)),
    );
    half.set_substeps(2);
    for simulation in [&mut whole, &mut half] {
        simulation.set_lip_contact(lips);
        // What contact moves at rest has come to rest when the sentence begins.
        settled(simulation, &Controls::default(), SECOND);
    }
    let (mut worst, mut most, mut step) = (0.0_f32, 0.0_f32, 0);
    let rest = &head.skin.mesh.positions;
    while let Some(controls) = sentence_at(step) {
        let a = settled(&mut whole, &controls, 1);
        let b = settled(&mut half, &controls, 1);
        for (i, (p, q)) in a.skin.iter().zip(&b.skin).enumerate() {
            // The inside of the mouth lies on the teeth: what is seen is judged.
            if head.skin.wet[i] < 0.5 {
                worst = worst.max(p.distance(*q));
                most = most.max(p.distance(rest[i]));
            }
        }
        step += 1;
    }
    (worst, most)
}

/// By which share a muscle's full contraction changes a cheek's volume, of the cheek that it changes more; `volume`
/// scales what keeps it.
fn cheek_change(model: TissueModel, muscle: Muscle, volume: f32) -> f32 {
    let mut simulation = free(model);
    simulation.set_volume_stiffness(volume);
    let rest = simulation.cheek_volumes();
    let controls = told(&[(Control::contraction(muscle), 1.0)]);
    settled(&mut simulation, &controls, SECOND / 2);
    let now = simulation.cheek_volumes();
    let change = |side: usize| (now[side] / rest[side] - 1.0).abs();
    change(0).max(change(1))
}

/// Each muscle's change of a cheek's volume under full contraction: less than 3 %, and much more where nothing keeps it.
pub(crate) fn cheeks_keep_their_volume(model: TissueModel) {
    let mut worse = 0;
    for muscle in Muscle::ALL {
        let (kept, free) = (
            cheek_change(model, muscle, 1.0),
            cheek_change(model, muscle, 0.0),
        );
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
