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
        Muscle::OrbicularisOrisSuperior => strength(108_000.0, 9.0),
        Muscle::OrbicularisOrisInferior => strength(108_000.0, 9.0),
        Muscle::LevatorLabiiSuperioris => strength(216_000.0, 0.0),
        Muscle::LevatorLabiiSuperiorisAlaequeNasi => strength(137_000.0, 0.0),
        Muscle::LevatorAnguliOris => strength(170_000.0, 11.0),
        Muscle::ZygomaticusMajor => strength(242_000.0, 0.0),
        Muscle::ZygomaticusMinor => strength(216_000.0, 0.0),
        Muscle::Risorius => strength(225_000.0, 11.0),
        Muscle::Buccinator => strength(136_000.0, 0.0),
        Muscle::DepressorAnguliOris => strength(185_000.0, 0.0),
        Muscle::DepressorLabiiInferioris => strength(130_000.0, 0.0),
        Muscle::Mentalis => strength(20_000.0, 0.0),
        Muscle::FrontalisInner => strength(79_000.0, 0.0),
        Muscle::FrontalisOuter => strength(139_000.0, 0.0),
        Muscle::CorrugatorSupercilii => strength(67_000.0, 0.0),
        Muscle::Procerus => strength(83_000.0, 11.0),
        Muscle::DepressorSupercilii => strength(71_000.0, 9.0),
        Muscle::OrbicularisOculiOrbital => strength(61_000.0, 9.0),
        Muscle::OrbicularisOculiPalpebral => strength(4_000.0, 6.0),
        Muscle::Nasalis => strength(70_000.0, 8.0),
        Muscle::DilatorNaris => strength(10_000.0, 8.0),
        Muscle::DepressorSeptiNasi => strength(42_000.0, 7.0),
        Muscle::Platysma => strength(43_000.0, 18.0),
        Muscle::Masseter => strength(54_000.0, 18.0),
        Muscle::Temporalis => strength(30_000.0, 18.0),
    }
}
