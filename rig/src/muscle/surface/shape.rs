//! How wide and thick each muscle is beyond what its fibres say, how much of it is tendon, and how it lies
//! on bone: what anatomical plates and descriptions give (Gray's Anatomy, "The muscles of the head"), in
//! millimetres by judgement. Muscles that end in skin have no tendon there.

use crate::Muscle;

/// The build of a muscle. Triples are at the origin, in the belly and at the insertion, pairs at the two ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// How far the flesh goes on beyond the outermost fibres on each side, mm.
    pub beside: [f32; 3],
    /// Thickness in its middle, mm.
    pub thick: [f32; 3],
    /// Share of the length that is tendon.
    pub tendon: [f32; 2],
    /// How closely it follows the bone under it, 0 (as its fibres lie) to 1.
    pub seat: [f32; 3],
    /// How far it lies deeper than its fibres, under its neighbours, mm; below 0: over them. From
    /// [`HIDDEN_MM`] on it may pass under bone.
    pub sink: [f32; 3],
    /// How far it goes on beyond its fibres' ends, mm.
    pub beyond: [f32; 2],
    /// How much farther than at its edges it begins in its middle, mm: fans have a round edge.
    pub round: f32,
    /// How much of `beside` is on the side of the last fibre rather than of the first, -1 to 1.
    pub lean: f32,
    /// Whether each fibre is a slip of its own rather than part of a sheet.
    pub slips: bool,
}

const PLAIN: Shape = Shape {
    beside: [3.0; 3],
    thick: [2.0; 3],
    tendon: [0.0; 2],
    seat: [0.0; 3],
    sink: [0.0; 3],
    beyond: [0.0; 2],
    round: 0.0,
    lean: 0.0,
    slips: false,
};

/// Muscles that lie so much deeper than their fibres pass under bone.
pub(super) const HIDDEN_MM: f32 = 2.0;

/// From bone into skin or into another muscle.
const fn from_bone(beside: [f32; 3], thick: [f32; 3], tendon: f32) -> Shape {
    Shape {
        beside,
        thick,
        tendon: [tendon, 0.0],
        seat: [1.0, 0.15, 0.0],
        sink: [0.0, 0.0, 0.8],
        ..PLAIN
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
        OrbicularisOrisSuperior | OrbicularisOrisInferior => Shape {
            beside: [1.8, 2.6, 1.8],
            thick: [2.4, 4.0, 2.4],
            lean: 0.6,
            ..PLAIN
        },
        LevatorLabiiSuperioris => from_bone([3.0, 3.0, 2.6], [1.6, 3.0, 1.6], 0.10),
        LevatorLabiiSuperiorisAlaequeNasi => Shape {
            slips: true,
            ..from_bone([1.6, 2.3, 2.0], [1.4, 2.4, 1.4], 0.10)
        },
        LevatorAnguliOris => from_bone([5.0, 4.4, 3.2], [1.8, 3.4, 2.4], 0.08),
        ZygomaticusMajor => from_bone([3.6, 4.3, 3.4], [2.0, 4.6, 2.6], 0.10),
        ZygomaticusMinor => from_bone([2.4, 2.9, 2.4], [1.6, 3.0, 1.6], 0.10),
        Risorius => Shape {
            seat: [0.0; 3],
            ..from_bone([6.5, 3.8, 2.2], [1.0, 2.2, 1.8], 0.14)
        },
        Buccinator => Shape {
            seat: [0.3, 0.0, 0.0],
            ..from_bone([10.0, 9.0, 5.0], [1.8, 3.4, 2.6], 0.12)
        },
        DepressorAnguliOris => Shape {
            sink: [-2.2, -2.6, -0.8],
            round: 2.0,
            ..from_bone([9.0, 5.4, 2.8], [1.2, 3.2, 2.2], 0.06)
        },
        DepressorLabiiInferioris => from_bone([3.4, 3.4, 3.4], [1.4, 2.8, 1.4], 0.07),
        Mentalis => Shape {
            sink: [3.0, 0.0, 1.0],
            ..from_bone([2.2, 4.0, 5.6], [2.0, 4.6, 0.8], 0.06)
        },
        FrontalisInner | FrontalisOuter => Shape {
            beside: [4.35, 4.35, 4.2],
            thick: [0.8, 2.4, 1.4],
            tendon: [0.26, 0.0],
            seat: [0.9, 0.7, 0.4],
            sink: [0.0, 0.0, 1.4],
            beyond: [12.0, 1.0],
            ..PLAIN
        },
        CorrugatorSupercilii => Shape {
            seat: [1.0, 0.4, 0.0],
            sink: [0.0, 1.2, 1.9],
            ..from_bone([2.6, 3.6, 3.0], [2.0, 3.4, 0.6], 0.08)
        },
        Procerus => Shape {
            seat: [1.0, 0.5, 0.2],
            sink: [0.0, 0.0, 1.9],
            // Its lowest fibres lie on cartilage, which the skull lacks.
            beyond: [-5.0, 0.0],
            ..from_bone([2.0, 3.0, 3.8], [1.0, 2.4, 0.4], 0.20)
        },
        DepressorSupercilii => Shape {
            sink: [0.0, 0.5, 1.9],
            ..from_bone([1.8, 2.4, 2.6], [1.4, 2.0, 0.4], 0.10)
        },
        OrbicularisOculiOrbital => Shape {
            beside: [2.6, 3.6, 2.6],
            thick: [1.6, 2.4, 1.6],
            tendon: [0.045, 0.0],
            seat: [0.5, 0.3, 0.5],
            ..PLAIN
        },
        OrbicularisOculiPalpebral => Shape {
            beside: [1.6, 4.7, 1.6],
            thick: [1.0, 1.2, 1.0],
            tendon: [0.10, 0.0],
            ..PLAIN
        },
        Nasalis => Shape {
            seat: [0.0; 3],
            beyond: [2.8, 0.0],
            ..from_bone([3.4, 4.4, 3.6], [0.8, 1.8, 1.6], 0.30)
        },
        DilatorNaris => from_bone([2.0, 3.0, 2.6], [1.2, 1.8, 1.2], 0.0),
        DepressorSeptiNasi => from_bone([1.6, 2.2, 1.8], [1.4, 2.2, 1.4], 0.0),
        Platysma => Shape {
            beside: [9.0, 8.0, 4.5],
            thick: [1.0, 1.7, 0.5],
            tendon: [0.06, 0.0],
            sink: [0.0, 0.5, 1.6],
            ..PLAIN
        },
        Masseter => Shape {
            beside: [7.5, 9.0, 7.0],
            thick: [2.6, 8.0, 3.0],
            tendon: [0.32, 0.08],
            seat: [0.9, 0.5, 0.9],
            ..PLAIN
        },
        Temporalis => Shape {
            beside: [21.0, 13.0, 3.0],
            thick: [1.2, 4.5, 3.0],
            tendon: [0.05, 0.36],
            seat: [1.0, 0.95, 0.9],
            sink: [0.0, 0.0, 5.0],
            beyond: [3.0, 3.0],
            round: 17.0,
            lean: 0.72,
            ..PLAIN
        },
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
