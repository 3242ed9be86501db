//! How strongly each muscle pulls its fascia nodes at full contraction.
//!
//! LEE gives profiles and no magnitudes. These were found on the reference head: raised or lowered until the
//! muscle's deed (its landmark's way, as the tests of muscles have it) was about what the default model
//! does at the same contraction.

use crate::Muscle;

/// Of one muscle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strength {
    /// Per mass, mm/s².
    pub force: f32,
    /// Reach to each side of a fibre of those that LEE has no width for, mm.
    pub reach_mm: f32,
}

const fn strength(force: f32, reach_mm: f32) -> Strength {
    Strength { force, reach_mm }
}

/// What `muscle` has.
pub(super) const fn of(muscle: Muscle) -> Strength {
    match muscle {
        Muscle::OrbicularisOrisSuperior => strength(90_000.0, 9.0),
        Muscle::OrbicularisOrisInferior => strength(90_000.0, 9.0),
        Muscle::LevatorLabiiSuperioris => strength(90_000.0, 0.0),
        Muscle::LevatorLabiiSuperiorisAlaequeNasi => strength(90_000.0, 0.0),
        Muscle::LevatorAnguliOris => strength(90_000.0, 11.0),
        Muscle::ZygomaticusMajor => strength(90_000.0, 0.0),
        Muscle::ZygomaticusMinor => strength(90_000.0, 0.0),
        Muscle::Risorius => strength(90_000.0, 11.0),
        Muscle::Buccinator => strength(90_000.0, 0.0),
        Muscle::DepressorAnguliOris => strength(90_000.0, 0.0),
        Muscle::DepressorLabiiInferioris => strength(90_000.0, 0.0),
        Muscle::Mentalis => strength(90_000.0, 0.0),
        Muscle::FrontalisInner => strength(90_000.0, 0.0),
        Muscle::FrontalisOuter => strength(90_000.0, 0.0),
        Muscle::CorrugatorSupercilii => strength(90_000.0, 0.0),
        Muscle::Procerus => strength(90_000.0, 11.0),
        Muscle::DepressorSupercilii => strength(90_000.0, 9.0),
        Muscle::OrbicularisOculiOrbital => strength(60_000.0, 9.0),
        Muscle::OrbicularisOculiPalpebral => strength(10_000.0, 6.0),
        Muscle::Nasalis => strength(90_000.0, 8.0),
        Muscle::DilatorNaris => strength(90_000.0, 8.0),
        Muscle::DepressorSeptiNasi => strength(90_000.0, 7.0),
        Muscle::Platysma => strength(60_000.0, 18.0),
        Muscle::Masseter => strength(90_000.0, 18.0),
        Muscle::Temporalis => strength(90_000.0, 18.0),
    }
}
