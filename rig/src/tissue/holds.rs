//! Which fibres hold which skin, and how firmly.
//!
//! What holds a vertex is found by how near it lies to a fibre, and then spread over the mesh like heat, so
//! that neighbours are drawn to neighbouring places: a fibre that moves by a centimetre otherwise pulls the
//! skin that it holds through the skin that it does not. A stiffness that falls by a factor of e in so many
//! mm compresses skin by no more than the fibre's way over four times that length.

use glam::Vec3;

use super::Numbering;
use super::anatomy::{Side, sides};
use crate::mesh::ramp;
use crate::muscle::{Contraction, Fibre};
use crate::{Head, Muscle};

/// Of a spring to a muscle fibre right beside the vertex.
const FIBRE: f32 = 15_600.0;
/// A fibre holds vertices within this distance, mm; one of the thin sheets within the other.
const FIBRE_REACH_MM: f32 = 13.0;
const SHEET_REACH_MM: f32 = 19.0;
/// A vertex is held by at most this many fibres of each muscle's side.
const FIBRES_MAX: usize = 6;
/// What holds less firmly than this is left out.
const LEAST: f32 = 0.006;
/// Length by which holds are spread, mm: round the mouth, where the corner goes far, and elsewhere.
const SPREAD_MOUTH_MM: f32 = 4.0;
const SPREAD_MM: f32 = 1.0;
const ROUNDS: usize = 24;

/// A spring to a place on a fibre: between control points `point` and `point + 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attachment {
    pub vertex: u32,
    pub fibre: u32,
    pub point: u32,
    pub share: f32,
    pub stiffness: f32,
}

/// All springs between skin and fibres, by vertex.
pub(super) fn attachments(head: &Head, numbering: &Numbering) -> Vec<Attachment> {
    let rest = numbering.of(&head.skin.mesh.positions);
    let reference = numbering.of(&head.skin.reference);
    let side = numbering.of(&sides(head));
    let mut lid = vec![0.0_f32; head.skin.mesh.positions.len()];
    for margin in &head.lids {
        lid[margin.vertex as usize] = margin.hold;
    }
    let lid = numbering.of(&lid);
    let (count, fibres) = (numbering.movable, head.fibres.len());
    let mut places = vec![(0_u32, 0.0_f32); count * fibres];
    let mut hold = vec![0.0_f32; count * fibres];
    for i in 0..count {
        for (f, fibre) in head.fibres.iter().enumerate() {
            let (place, stiffness) = held(fibre, rest[i], side[i], lid[i]);
            places[i * fibres + f] = place;
            hold[i * fibres + f] = stiffness;
        }
    }
    let spread_mm: Vec<f32> = (0..count)
        .map(|i| spread(reference[i]) * (1.0 - lid[i]).max(0.0))
        .collect();
    let hold = spread_out(&hold, fibres, numbering, &rest, &spread_mm);
    let mut all = Vec::new();
    for i in 0..count {
        let mut found: Vec<(f32, usize)> = hold[i * fibres..][..fibres]
            .iter()
            .enumerate()
            .filter(|(_, k)| **k > LEAST * FIBRE)
            .map(|(f, k)| (*k, f))
            .collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        // The strongest, less the strongest that is left out: so that none comes or goes at once from one
        // vertex to the next; together as strong as before.
        let whole: f32 = found.iter().map(|(k, _)| k).sum();
        let least = found.get(FIBRES_MAX).map_or(LEAST * FIBRE, |(k, _)| *k);
        found.truncate(FIBRES_MAX);
        let kept: f32 = found.iter().map(|(k, _)| k - least).sum();
        for (k, f) in found {
            let (point, share) = places[i * fibres + f];
            let stiffness = (k - least) * (whole / kept.max(1e-3)).min(2.0);
            if stiffness > 0.3 * LEAST * FIBRE {
                all.push(Attachment {
                    vertex: i as u32,
                    fibre: f as u32,
                    point,
                    share,
                    stiffness,
                });
            }
        }
    }
    all
}

/// By which length holds are spread at a place on the reference head, mm.
fn spread(p: Vec3) -> f32 {
    let from_mouth = ((p.x / 1.65).powi(2) + (p.y + 30.0).powi(2)).sqrt();
    SPREAD_MM + (SPREAD_MOUTH_MM - SPREAD_MM) * ramp(40.0, 28.0, from_mouth) * ramp(0.0, -12.0, p.y)
}

/// Stiffnesses spread over the mesh: `(1 - l² laplacian) new = old`, by some rounds of Jacobi's iteration.
fn spread_out(
    old: &[f32],
    fibres: usize,
    numbering: &Numbering,
    rest: &[Vec3],
    spread_mm: &[f32],
) -> Vec<f32> {
    let mut neighbours: Vec<Vec<(usize, f32)>> = vec![Vec::new(); numbering.movable];
    for &[a, b] in &numbering.edges {
        let (a, b) = (a as usize, b as usize);
        if a < numbering.movable && b < numbering.movable {
            // A triangle mesh's laplacian, as if all its edges were alike: 2/3 over the square of the length.
            let weight = 2.0 / 3.0 / rest[a].distance_squared(rest[b]).max(0.01);
            neighbours[a].push((b, weight * spread_mm[a].powi(2)));
            neighbours[b].push((a, weight * spread_mm[b].powi(2)));
        }
    }
    let (mut now, mut next) = (old.to_vec(), old.to_vec());
    for _ in 0..ROUNDS {
        for (i, list) in neighbours.iter().enumerate() {
            let row = &mut next[i * fibres..][..fibres];
            row.copy_from_slice(&old[i * fibres..][..fibres]);
            let mut sum = 1.0;
            for &(j, weight) in list {
                sum += weight;
                for (value, other) in row.iter_mut().zip(&now[j * fibres..][..fibres]) {
                    *value += other * weight;
                }
            }
            row.iter_mut().for_each(|value| *value /= sum);
        }
        std::mem::swap(&mut now, &mut next);
    }
    now
}

/// The place on a fibre nearest to a vertex, and how firmly it holds that one before holds are spread.
fn held(fibre: &Fibre, p: Vec3, side: Side, lid: f32) -> ((u32, f32), f32) {
    let other_lip = match fibre.muscle {
        Muscle::OrbicularisOrisSuperior | Muscle::LevatorLabiiSuperioris => Side::Lower,
        Muscle::OrbicularisOrisInferior | Muscle::DepressorLabiiInferioris | Muscle::Mentalis => {
            Side::Upper
        }
        _ => Side::Neither,
    };
    let (mut best, mut place) = (f32::MAX, (0, 0.0));
    for (j, w) in fibre.points.windows(2).enumerate() {
        let d = w[1] - w[0];
        let share = ((p - w[0]).dot(d) / d.length_squared().max(1e-6)).clamp(0.0, 1.0);
        let distance = p.distance(w[0] + d * share);
        if distance < best {
            (best, place) = (distance, (j, share));
        }
    }
    let sheet = matches!(
        fibre.muscle,
        Muscle::FrontalisInner | Muscle::FrontalisOuter | Muscle::Masseter | Muscle::Temporalis
    );
    let reach = if sheet {
        SHEET_REACH_MM
    } else {
        FIBRE_REACH_MM
    };
    let place = (place.0 as u32, place.1);
    if best >= reach || (side == other_lip && side != Side::Neither) {
        return (place, 0.0);
    }
    let near = 1.0 - best / reach;
    // At its origin a linear muscle lies on bone and holds no skin.
    let along = (place.0 as f32 + place.1) / (fibre.points.len() - 1) as f32;
    let (hold, weight) = match fibre.contraction {
        // A sheet draws all the skin over it along.
        Contraction::Linear if sheet => (along.sqrt(), 0.6),
        // Those of the frown are short and end in the skin itself.
        Contraction::Linear if frowns(fibre.muscle) => (along.powi(2), 1.2),
        // What raises the corner of the mouth takes the cheek along.
        Contraction::Linear if carries_cheek(fibre.muscle) => (along.powi(2), 0.6),
        Contraction::Linear => (along.powi(3), 0.6),
        Contraction::Sphincter { .. } => (1.0, 1.0),
        Contraction::Belly { .. } => ((std::f32::consts::PI * along).sin(), 0.6),
    };
    // What a lid carries is the lid's: the muscles of the brow end over it.
    let hold = if fibre.muscle as usize >= Muscle::FrontalisInner as usize {
        hold * (1.0 - lid).powi(2)
    } else {
        hold
    };
    let stiffness = FIBRE * weight * hold * near * near;
    (place, stiffness)
}

/// Whether a muscle lies in the fat of the cheek and lifts it.
const fn carries_cheek(muscle: Muscle) -> bool {
    matches!(
        muscle,
        Muscle::ZygomaticusMajor | Muscle::ZygomaticusMinor | Muscle::LevatorAnguliOris
    )
}

/// Whether a muscle ends in the skin of the brow and draws it together or down.
const fn frowns(muscle: Muscle) -> bool {
    matches!(
        muscle,
        Muscle::CorrugatorSupercilii | Muscle::Procerus | Muscle::DepressorSupercilii
    )
}
