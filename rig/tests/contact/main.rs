//! Contact on the surface as it is drawn: lips stop each other and flatten, slide over the teeth, lids cover the
//! eyeballs.
#![allow(
    clippy::unwrap_used,
    reason = "helpers of tests; clippy sees only test functions"
)]

mod lids;
mod lips;
mod surface;
mod teeth;

use std::sync::{Arc, OnceLock};

use mouthpiece_rig::{Articulation, Control, Controls, Head, KeyFrame, Simulation};

/// The sentence's frames a second.
pub(crate) const SENTENCE_HZ: usize = 60;

pub(crate) fn head() -> &'static Arc<Head> {
    static HEAD: OnceLock<Arc<Head>> = OnceLock::new();
    HEAD.get_or_init(|| Arc::new(Head::reference().unwrap()))
}

/// The head after `steps` towards `controls`.
pub(crate) fn settled(simulation: &mut Simulation, controls: &Controls, steps: usize) -> KeyFrame {
    for _ in 0..steps {
        simulation.step(controls);
    }
    let mut frame = head().rest_frame();
    simulation.save(&mut frame);
    frame
}

/// The head at rest, settled in a posture.
pub(crate) fn posed(controls: &Controls) -> KeyFrame {
    settled(&mut Simulation::new(Arc::clone(head())), controls, 250)
}

/// The controls of a closed mouth that aims past contact.
pub(crate) fn pressed() -> Controls {
    head().calibration.controls(&Articulation {
        aperture_mm: -3.0,
        jaw_rad: 0.03,
        ..Articulation::REST
    })
}

/// The controls of the lower lip at the upper teeth, as for /f/.
pub(crate) fn lip_to_teeth() -> Controls {
    head().calibration.controls(&Articulation {
        aperture_mm: 2.0,
        lip_teeth_mm: Some(0.0),
        jaw_rad: 0.02,
        ..Articulation::REST
    })
}

/// Reproducible numbers in 0..1.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 24) as f32
    }

    pub(crate) fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }
}

/// Random mouths, a good part of them shut.
pub(crate) fn postures(count: usize) -> Vec<Controls> {
    let mut random = Random(7);
    (0..count)
        .map(|_| {
            head().calibration.controls(&Articulation {
                aperture_mm: random.within(-3.0, 8.0),
                width: random.within(0.8, 1.12),
                protrusion_mm: random.within(-1.0, 3.0),
                jaw_rad: random.within(0.0, 0.12),
                ..Articulation::REST
            })
        })
        .collect()
}

/// The muscles and jaw of a sentence full of lips, as speech gave them.
pub(crate) fn sentence() -> Vec<Controls> {
    const DRIVEN: [Control; 8] = [
        Control::OrbicularisOrisSuperior,
        Control::OrbicularisOrisInferior,
        Control::LevatorLabiiSuperioris,
        Control::Risorius,
        Control::DepressorLabiiInferioris,
        Control::ProtrusionSuperior,
        Control::ProtrusionInferior,
        Control::Jaw,
    ];
    include_str!("sentence.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let mut controls = Controls::default();
            for (control, value) in DRIVEN.into_iter().zip(line.split(',')) {
                controls[control] = value.parse().unwrap();
            }
            controls
        })
        .collect()
}
