//! What prisms do for the cheeks.

use super::*;
use crate::muscle::Muscles;
use crate::tissue::anatomy::cheek;
use crate::{Controls, TissueModel};

/// Volume of the left cheek's prisms, mm³, at rest and with `muscle` fully contracted.
fn cheek_prisms(muscle: Muscle, volume: f32) -> [f32; 2] {
    let mut head = Head::reference().unwrap();
    head.tissue.model = TissueModel::Layered;
    let numbering = Numbering::new(&head);
    let mut tissue = Layered::new(&head, &numbering);
    let reference = numbering.of(&head.skin.reference);
    let inside = |t: [u32; 3]| {
        t.iter()
            .all(|&i| reference[i as usize].x > 0.0 && cheek(reference[i as usize]))
    };
    let mut state = Controls::default();
    let rest = tissue.prisms.volume(&tissue.place, inside);
    state[Control::contraction(muscle)] = 1.0;
    let muscles = Muscles::new(&head);
    for _ in 0..240 {
        tissue.step(&Drive {
            head: &head,
            state: &state,
            mandible: head.mandible(0.0),
            muscles: &muscles,
            muscle_stiffness: 1.0,
            damping: 1.0,
            volume,
            step_s: crate::simulation::STEP_S,
        });
    }
    [rest, tissue.prisms.volume(&tissue.place, inside)]
}

#[test]
fn cheeks_keep_their_volume_by_the_force_that_is_for_it() {
    for muscle in [
        Muscle::ZygomaticusMajor,
        Muscle::Risorius,
        Muscle::Buccinator,
    ] {
        let change = |volume| {
            let [rest, full] = cheek_prisms(muscle, volume);
            (full / rest - 1.0).abs()
        };
        let (with, without) = (change(1.0), change(0.0));
        println!(
            "{muscle:?}: {:.2} % with, {:.2} % without",
            100.0 * with,
            100.0 * without
        );
        assert!(with < without, "{muscle:?}: {with} with, {without} without");
        assert!(with < 0.07, "{muscle:?}: {with}");
    }
}
