//! What LEE's volume force does for a cheek, and what holding it as a whole does.

use super::*;
use crate::muscle::Muscles;
use crate::tissue::anatomy::cheek;
use crate::{Controls, TissueModel};

/// By which share the left cheek's prisms have changed their volume with `muscle` fully contracted, in a model that
/// was `changed` before.
fn prisms_change(muscle: Muscle, changed: impl FnOnce(&mut Layered)) -> f32 {
    let mut head = Head::reference().unwrap();
    head.tissue.model = TissueModel::Layered;
    let numbering = Numbering::new(&head);
    let mut tissue = Layered::new(&head, &numbering);
    changed(&mut tissue);
    let reference = numbering.of(&head.skin.reference);
    let inside = |t: [u32; 3]| {
        t.iter()
            .all(|&i| reference[i as usize].x > 0.0 && cheek(reference[i as usize]))
    };
    let mut state = Controls::default();
    let rest = tissue.prisms.volume(&tissue.place, inside);
    state[Control::contraction(muscle)] = 1.0;
    let muscles = Muscles::new(&head);
    let drive = Drive {
        head: &head,
        state: &state,
        mandible: head.mandible(0.0),
        muscles: &muscles,
        muscle_stiffness: 1.0,
        damping: 1.0,
        volume: 1.0,
        step_s: STEP_S / PARTS as f32,
    };
    for _ in 0..240 {
        tissue.step(&drive, &mut |_, _| ());
    }
    (tissue.prisms.volume(&tissue.place, inside) / rest - 1.0).abs()
}

/// Holds no cheek as a whole.
fn let_go(tissue: &mut Layered) {
    tissue.cheeks.iter_mut().for_each(|c| c.nodes.clear());
}

#[test]
fn cheeks_keep_their_volume_by_the_forces_that_are_for_it() {
    for muscle in [
        Muscle::ZygomaticusMajor,
        Muscle::Risorius,
        Muscle::Buccinator,
    ] {
        let both = prisms_change(muscle, |_| ());
        let prisms = prisms_change(muscle, let_go);
        let neither = prisms_change(muscle, |tissue| {
            let_go(tissue);
            tissue.prisms.k1 = 0.0;
        });
        println!(
            "{muscle:?}: {:.2} % by both, {:.2} % by LEE's force, {:.2} % by neither",
            100.0 * both,
            100.0 * prisms,
            100.0 * neither
        );
        assert!(both < 0.03, "{muscle:?}: {both}");
        assert!(both < 0.5 * prisms, "{muscle:?}: {both}, {prisms}");
        assert!(prisms < 0.9 * neither, "{muscle:?}: {prisms}, {neither}");
    }
}
