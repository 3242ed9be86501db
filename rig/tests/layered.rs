//! How the layered tissue moves, by numbers, as `motion` has it for the default one: it follows a fast lip, does not care
//! for the length of the step, and keeps the volume of the cheeks. What both must do besides is in `tissue`.

use mouthpiece_rig::{Control, TissueModel};

mod models;
mod moves;

use moves::{by_half_the_step, cheeks_keep_their_volume, lags};

#[test]
fn skin_lags_less_than_ten_milliseconds_behind_a_fast_lip() {
    for lag in lags(TissueModel::Layered) {
        assert!(lag.worst_ms < 10.0, "the skin lags: {lag:?}");
        let speech = lag.control != Control::Jaw || lag.fastest_mm_s > 300.0;
        assert!(speech, "the jaw moves the lip too slowly: {lag:?}");
    }
}

#[test]
fn a_sentence_does_not_depend_on_the_step() {
    // Where lips meet, this model need not close them, and a moment earlier or later is a step apart.
    let (tissue, most) = by_half_the_step(TissueModel::Layered, false);
    println!("half the step: {tissue:.3} mm; the skin moved {most:.1} mm");
    assert!(most > 8.0, "the sentence moves the face: {most} mm");
    assert!(tissue < 0.2, "half the step moves a vertex by {tissue} mm");
}

#[test]
fn cheeks_hold_their_volume() {
    cheeks_keep_their_volume(TissueModel::Layered);
}
