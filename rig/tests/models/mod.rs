//! The reference head with either model of tissue, and how it comes to stand.
#![allow(
    clippy::unwrap_used,
    reason = "helpers of tests; clippy sees only test functions"
)]

use std::sync::{Arc, OnceLock};

use mouthpiece_rig::{Controls, Head, KeyFrame, Simulation, TissueModel};

/// The reference head with that tissue.
pub(crate) fn head(model: TissueModel) -> &'static Arc<Head> {
    static HEADS: OnceLock<[Arc<Head>; 2]> = OnceLock::new();
    let heads = HEADS.get_or_init(|| {
        [TissueModel::Springs, TissueModel::Layered].map(|model| {
            let mut head = Head::reference().unwrap();
            head.tissue.model = model;
            Arc::new(head)
        })
    });
    &heads[usize::from(model == TissueModel::Layered)]
}

/// The head after `steps` towards `controls`.
pub(crate) fn settled(simulation: &mut Simulation, controls: &Controls, steps: usize) -> KeyFrame {
    for _ in 0..steps {
        simulation.step(controls);
    }
    let mut frame = simulation.head().rest_frame();
    simulation.save(&mut frame);
    frame
}
