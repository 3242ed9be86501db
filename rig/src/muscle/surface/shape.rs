//! How wide and thick each muscle is beyond what its fibres say, and how much of it is tendon: what
//! anatomical plates and descriptions give (Gray's Anatomy, "The muscles of the head"), in millimetres by
//! judgement. Muscles that end in skin have no tendon there.

use crate::Muscle;

/// The build of a muscle. Triples are at the origin, in the belly and at the insertion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// How far the flesh goes on beyond the outermost fibres on each side, mm.
    pub beside: [f32; 3],
    /// Thickness in its middle, mm.
    pub thick: [f32; 3],
    /// Share of the length that is tendon at the origin and at the insertion.
    pub tendon: [f32; 2],
    /// Whether each fibre is a slip of its own rather than part of a sheet.
    pub slips: bool,
}

const fn shape(beside: [f32; 3], thick: [f32; 3], tendon: [f32; 2]) -> Shape {
    Shape {
        beside,
        thick,
        tendon,
        slips: false,
    }
}

const fn slips(beside: [f32; 3], thick: [f32; 3], tendon: [f32; 2]) -> Shape {
    Shape {
        slips: true,
        ..shape(beside, thick, tendon)
    }
}

pub(super) const fn of(muscle: Muscle) -> Shape {
    use Muscle::{
        Buccinator, CorrugatorSupercilii, DepressorAnguliOris, DepressorLabiiInferioris,
        DepressorSeptiNasi, DepressorSupercilii, DilatorNaris, FrontalisInner, FrontalisOuter,
        LevatorAnguliOris, LevatorLabiiSuperioris, LevatorLabiiSuperiorisAlaequeNasi, Masseter,
        Mentalis, Nasalis, OrbicularisOculiOrbital, OrbicularisOculiPalpebral,
        OrbicularisOrisInferior, OrbicularisOrisSuperior, Platysma, Procerus, Risorius, Temporalis,
        ZygomaticusMajor, ZygomaticusMinor,
    };
    match muscle {
        OrbicularisOrisSuperior | OrbicularisOrisInferior => {
            shape([1.5, 3.0, 1.5], [2.5, 4.0, 2.5], [0.0, 0.0])
        }
        LevatorLabiiSuperioris => shape([3.0, 3.0, 2.6], [1.8, 3.0, 1.8], [0.09, 0.0]),
        LevatorLabiiSuperiorisAlaequeNasi => slips([1.6, 2.3, 2.0], [1.4, 2.4, 1.5], [0.10, 0.0]),
        LevatorAnguliOris => shape([5.0, 4.4, 3.2], [1.8, 3.4, 2.6], [0.08, 0.0]),
        ZygomaticusMajor => shape([3.8, 4.4, 3.6], [2.2, 4.6, 2.8], [0.10, 0.0]),
        ZygomaticusMinor => shape([2.4, 2.9, 2.4], [1.6, 3.0, 1.8], [0.10, 0.0]),
        Risorius => shape([6.5, 3.8, 2.2], [1.0, 2.2, 1.8], [0.10, 0.0]),
        Buccinator => shape([10.0, 9.0, 5.0], [1.8, 3.4, 2.6], [0.10, 0.0]),
        DepressorAnguliOris => shape([10.0, 5.6, 2.8], [1.2, 3.2, 2.4], [0.06, 0.0]),
        DepressorLabiiInferioris => shape([3.4, 3.4, 3.4], [1.6, 2.8, 1.6], [0.07, 0.0]),
        Mentalis => shape([2.6, 4.0, 4.6], [2.4, 5.0, 2.4], [0.06, 0.0]),
        FrontalisInner | FrontalisOuter => shape([4.6, 4.7, 4.4], [0.9, 2.2, 1.6], [0.16, 0.0]),
        CorrugatorSupercilii => shape([2.6, 3.6, 3.4], [2.2, 4.0, 2.0], [0.08, 0.0]),
        Procerus => shape([2.2, 3.0, 4.4], [1.0, 2.4, 1.4], [0.20, 0.0]),
        DepressorSupercilii => shape([1.8, 2.4, 3.0], [1.4, 2.2, 1.4], [0.10, 0.0]),
        OrbicularisOculiOrbital => shape([2.6, 3.6, 2.6], [1.6, 2.4, 1.6], [0.045, 0.0]),
        OrbicularisOculiPalpebral => shape([1.6, 4.2, 1.6], [1.0, 1.2, 1.0], [0.10, 0.0]),
        Nasalis => shape([3.2, 4.4, 3.6], [0.8, 1.8, 1.6], [0.28, 0.0]),
        DilatorNaris => shape([2.0, 3.0, 2.6], [1.2, 1.8, 1.2], [0.0, 0.0]),
        DepressorSeptiNasi => shape([1.6, 2.2, 1.8], [1.4, 2.2, 1.4], [0.0, 0.0]),
        Platysma => shape([9.0, 8.5, 6.0], [1.2, 1.7, 1.3], [0.0, 0.0]),
        Masseter => shape([5.0, 6.5, 5.0], [3.0, 9.0, 3.5], [0.30, 0.07]),
        Temporalis => shape([9.0, 7.0, 3.0], [1.6, 5.0, 3.0], [0.05, 0.30]),
    }
}

/// A triple's value at a place along the muscle, 0..1: the belly swells smoothly out of both ends.
pub(super) fn along([origin, belly, insertion]: [f32; 3], place: f32) -> f32 {
    let (end, share) = if place < BELLY {
        (origin, place / BELLY)
    } else {
        (insertion, (1.0 - place) / (1.0 - BELLY))
    };
    let share = share.clamp(0.0, 1.0);
    end + (belly - end) * share * share * (3.0 - 2.0 * share)
}

/// Where a belly is thickest.
const BELLY: f32 = 0.48;
