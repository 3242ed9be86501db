//! LEE's 26 muscle vectors with their force profiles (LEE 5), built from this head's own fibres.
//!
//! Thirteen a side. A vector's fixed end is the mean of its fibres' origins, its attached end the mean of
//! their insertions; widths are those of the paper's table, in proportion. Forces act on fascia nodes, along the
//! vector, and are worked out once: `Θ1` rises from the fixed to the attached end, `Θ2` falls to the sides.
//! The paper's mesh is a face without a back or an inside; on a whole head two things must be said: a
//! muscle's reach in depth is bounded, and raisers of the upper lip leave the lower one alone.

use std::f32::consts::PI;

use glam::Vec3;

use super::layers::Layers;
use super::strength::{self, Strength};
use crate::tissue::anatomy::Side;
use crate::{Fibre, Head, Muscle};

/// LEE's exponent of the length ratio.
const KAPPA: f32 = 0.48;
/// Of the width ratio.
const WIDTH_EXPONENT: f32 = 1.8;
/// One unit of the paper's widths, mm: its frontalis then covers a brow as far as anatomy's does.
const WIDTH_MM: f32 = 26.0;
/// A muscle reaches so far to each side at least, mm: less would be single nodes.
const WIDTH_LEAST_MM: f32 = 12.0;
/// And so far out of the plane that its vector and its normal span, mm.
const REACH_MM: f32 = 16.0;
/// Behind its attached end the force fades over this share of its width (LEE ends it at once; on a fine
/// mesh that would cut the skin along a line).
const FADE: f32 = 0.5;

/// LEE's thirteen: name, muscles of ours (two: the mean of both), which fibres of theirs, width.
struct Vector {
    muscles: [Muscle; 2],
    fibres: Fibres,
    width: f32,
}

/// Which of a muscle's fibres a vector is made of.
#[derive(Clone, Copy, PartialEq)]
enum Fibres {
    All,
    /// The lateral part of the corrugator starts where the medial one is half way.
    OuterHalf,
    /// The one that goes on to the lip; the other ends in the wing of the nose, beside it.
    Longest,
}

const fn vector(muscle: Muscle, width: f32) -> Vector {
    Vector {
        muscles: [muscle, muscle],
        fibres: Fibres::All,
        width,
    }
}

/// In the order of the paper's table.
const VECTORS: [Vector; 13] = [
    vector(Muscle::ZygomaticusMajor, 0.6),
    vector(Muscle::DepressorAnguliOris, 0.8),
    vector(Muscle::FrontalisInner, 1.2),
    // Our frontalis has two parts; LEE's major one lies between them.
    Vector {
        muscles: [Muscle::FrontalisInner, Muscle::FrontalisOuter],
        fibres: Fibres::All,
        width: 1.0,
    },
    vector(Muscle::FrontalisOuter, 1.0),
    vector(Muscle::LevatorLabiiSuperioris, 0.3),
    Vector {
        muscles: [Muscle::LevatorLabiiSuperiorisAlaequeNasi; 2],
        fibres: Fibres::Longest,
        width: 0.2,
    },
    Vector {
        muscles: [Muscle::CorrugatorSupercilii; 2],
        fibres: Fibres::OuterHalf,
        width: 0.2,
    },
    vector(Muscle::CorrugatorSupercilii, 0.4),
    vector(Muscle::DepressorLabiiInferioris, 0.7),
    vector(Muscle::ZygomaticusMinor, 0.4),
    vector(Muscle::Buccinator, 0.8),
    vector(Muscle::Mentalis, 0.6),
];

/// Whether one of LEE's vectors is of this muscle.
pub(super) fn is_vector(muscle: Muscle) -> bool {
    VECTORS.iter().any(|v| v.muscles.contains(&muscle))
}

/// A muscle of one side: what it does to fascia nodes at full contraction, per mass, mm/s².
#[derive(Clone, Debug)]
pub(super) struct Actuator {
    /// Its contraction is the mean of these two's.
    pub muscles: [Muscle; 2],
    pub left: bool,
    pub forces: Vec<(u32, Vec3)>,
}

/// LEE's force along a muscle: nothing at its fixed end, all at the attached one.
pub(super) fn along(ratio: f32) -> f32 {
    let e = ratio.clamp(0.0, 1.0).powf(KAPPA);
    (0.5 * PI * e).sin() + 0.125 * ((2.0 * PI * e - 0.5 * PI).sin() + 1.0)
}

/// LEE's force across a muscle: all in the middle, nothing at its width.
pub(super) fn across(ratio: f32) -> f32 {
    0.5 * ((PI * ratio.abs().min(1.0).powf(WIDTH_EXPONENT)).cos() + 1.0)
}

/// Whether a muscle has no say over that lip.
pub(super) fn other_lip(muscle: Muscle, side: Side) -> bool {
    match muscle {
        Muscle::OrbicularisOrisSuperior
        | Muscle::LevatorLabiiSuperioris
        | Muscle::LevatorLabiiSuperiorisAlaequeNasi
        | Muscle::ZygomaticusMinor
        | Muscle::DepressorSeptiNasi => side == Side::Lower,
        Muscle::OrbicularisOrisInferior
        | Muscle::DepressorLabiiInferioris
        | Muscle::Platysma
        | Muscle::Mentalis => side == Side::Upper,
        _ => false,
    }
}

/// What of a pull does not press the fascia to the bone: LEE's constraint (7), taken into the muscle's force.
pub(super) fn over_bone(pull: Vec3, out: Vec3) -> Vec3 {
    pull - out * pull.dot(out).min(0.0)
}

/// The vectors of both sides. `side` and `lids` are per node: which lip, and how firmly a lid holds it.
pub(super) fn build(
    head: &Head,
    layers: &Layers,
    movable: usize,
    side: &[Side],
    lids: &[f32],
) -> Vec<Actuator> {
    let mut actuators = Vec::new();
    for vector in &VECTORS {
        for left in [true, false] {
            let Some([fixed, attached]) = ends(&head.fibres, vector, left) else {
                continue;
            };
            let length = fixed.distance(attached).max(1.0);
            let pull = (fixed - attached) / length;
            let normal =
                (normal_at(layers, fixed) + normal_at(layers, attached)).normalize_or(Vec3::Z);
            let width = (vector.width * WIDTH_MM).max(WIDTH_LEAST_MM);
            let Strength { force, .. } = strength::of(vector.muscles[0]);
            // Where two vectors make one muscle, or one lies between two, they share the force.
            let shared = vector.muscles[0] != vector.muscles[1]
                || vector.muscles[0] == Muscle::CorrugatorSupercilii;
            let share = if shared { 0.5 } else { 1.0 };
            let mut forces = Vec::new();
            for i in 0..movable {
                if other_lip(vector.muscles[0], side[i]) {
                    continue;
                }
                let from = layers.fascia[i] - fixed;
                let range = -from.dot(pull);
                let off = from + pull * range;
                let deep = off.dot(normal);
                let beyond = (range - length).max(0.0) / (FADE * width);
                let weight = along(range / length)
                    * across((off - normal * deep).length() / width)
                    * across(deep / REACH_MM)
                    * across(beyond)
                    * (1.0 - lids[i]).powi(2);
                if weight > 1e-3 {
                    forces.push((
                        i as u32,
                        over_bone(pull, layers.out[i]) * (weight * force * share),
                    ));
                }
            }
            actuators.push(Actuator {
                muscles: vector.muscles,
                left,
                forces,
            });
        }
    }
    actuators
}

/// Fixed and attached end of a vector.
fn ends(fibres: &[Fibre], vector: &Vector, left: bool) -> Option<[Vec3; 2]> {
    let mut sums = [Vec3::ZERO; 2];
    let (mut count, mut longest) = (0.0, 0.0);
    for fibre in fibres {
        let (Some(&first), Some(&last)) = (fibre.points.first(), fibre.points.last()) else {
            continue;
        };
        if !vector.muscles.contains(&fibre.muscle) || (last.x > 0.0) != left {
            continue;
        }
        let start = match vector.fibres {
            Fibres::All => first,
            Fibres::OuterHalf => first.lerp(last, 0.5),
            Fibres::Longest if first.distance(last) < longest => continue,
            Fibres::Longest => {
                longest = first.distance(last);
                (sums, count) = ([Vec3::ZERO; 2], 0.0);
                first
            }
        };
        sums[0] += start;
        sums[1] += last;
        count += 1.0;
    }
    (count > 0.0).then(|| sums.map(|s| s / count))
}

/// The skin's normal over a place.
fn normal_at(layers: &Layers, place: Vec3) -> Vec3 {
    let near = |p: &Vec3| p.distance_squared(place);
    let nearest = layers
        .skin
        .iter()
        .zip(&layers.out)
        .min_by(|a, b| near(a.0).total_cmp(&near(b.0)));
    nearest.map_or(Vec3::Z, |(_, n)| *n)
}
