//! How the layered tissue moves, by numbers, as `motion` has it for the default one; what both must do is in `tissue`.

use mouthpiece_rig::TissueModel;

mod moves;

use moves::by_half_the_step;

#[test]
fn a_sentence_does_not_depend_on_the_step() {
    let (tissue, most) = by_half_the_step(TissueModel::Layered, false);
    let (lips, _) = by_half_the_step(TissueModel::Layered, true);
    println!(
        "half the step: {tissue:.3} mm, {lips:.3} mm where lips meet; the skin moved {most:.1} mm"
    );
    assert!(most > 8.0, "the sentence moves the face: {most} mm");
    assert!(tissue < 0.2, "half the step moves a vertex by {tissue} mm");
}
