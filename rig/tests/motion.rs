//! How the default tissue moves, by numbers: it keeps its energy when nothing takes any, follows a fast lip,
//! does not care for the length of the step, and keeps the volume of the cheeks.

use std::sync::Arc;

use mouthpiece_rig::{Control, Controls, Simulation, TissueModel};

mod models;
mod moves;

use models::{head, settled};
use moves::{SECOND, by_half_the_step, free, lags, told};

#[test]
fn left_alone_and_undamped_it_keeps_its_energy() {
    let smile = told(&[
        (Control::ZygomaticusMajor, 0.1),
        (Control::FrontalisInner, 0.1),
    ]);
    // Let go of at once, three seconds for it to spread over all modes: the skin is where the muscles had it, they are at
    // rest.
    let mut let_go = settled(&mut free(TissueModel::Springs), &smile, SECOND);
    let_go.state = Controls::default();
    let_go.state_rate = Controls::default();
    let mut simulation = free(TissueModel::Springs);
    simulation.set_damping(0.0);
    assert!(simulation.restore(&let_go));
    settled(&mut simulation, &Controls::default(), 3 * SECOND);
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
    for lag in lags(TissueModel::Springs) {
        assert!(lag.worst_ms < 10.0, "the skin lags: {lag:?}");
        let speech = lag.control != Control::Jaw || lag.fastest_mm_s > 300.0;
        assert!(speech, "the jaw moves the lip too slowly: {lag:?}");
    }
}

#[test]
fn a_sentence_does_not_depend_on_the_step() {
    let (tissue, most) = by_half_the_step(TissueModel::Springs, false);
    let (lips, _) = by_half_the_step(TissueModel::Springs, true);
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
    moves::cheeks_keep_their_volume(TissueModel::Springs);
}

#[test]
fn a_head_at_work_takes_less_than_four_megabytes() {
    let bytes = Simulation::new(Arc::clone(head(TissueModel::Springs))).tissue_bytes();
    assert!(bytes < 4 << 20, "{bytes} bytes");
}
