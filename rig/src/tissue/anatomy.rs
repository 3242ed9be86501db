//! How the tissue is made, as functions of a place on the reference head: which skin moves, how fast it
//! is to the bone under it, what share of the mandible's motion it takes, which fibres hold it.
//!
//! All vertices have the same mass: on a graded mesh, masses by area would force a step several times
//! shorter. Stiffness is therefore given per unit of mass, in 1/s².

use glam::Vec3;

use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::CONTACT;
use crate::mesh::ramp;
use crate::muscle::{Contraction, Space};
use crate::{Head, Muscle};

/// Stiffness per mass of a skin edge.
pub(super) const EDGE: f32 = 34_000.0;
/// Of the spring to the bone where the skin lies thin on it, and where it lies on soft tissue.
const BONE_THIN: f32 = 60_000.0;
const BONE_SOFT: f32 = 1_500.0;
/// What is left of that stiffness where the forehead's skin slides over the bone.
const FOREHEAD: f32 = 0.12;
/// Of a spring to a muscle fibre right beside the vertex.
const FIBRE: f32 = 26_000.0;
/// Of a lid's hold on its margin.
pub(super) const LID: f32 = 150_000.0;
/// A fibre holds vertices within this distance, mm; one of the thin sheets within the other.
const FIBRE_REACH_MM: f32 = 13.0;
const SHEET_REACH_MM: f32 = 19.0;
/// A vertex is held by at most this many fibres of each muscle's side.
const FIBRES_MAX: usize = 6;

/// A spring to a place on a fibre: between control points `point` and `point + 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attachment {
    pub vertex: u32,
    pub fibre: u32,
    pub point: u32,
    pub share: f32,
    pub stiffness: f32,
}

/// Where on a lip or beside it a vertex lies: above the slit, below it, or neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Upper,
    Lower,
    Neither,
}

/// Whether the skin there moves at all: the face from the hairline to the throat, back to the ears.
pub(super) fn moves(p: Vec3) -> bool {
    let ahead = p.z > 8.0 + 0.35 * (p.y + 30.0).abs().min(60.0);
    let side = if p.y > 60.0 { 66.0 } else { 75.0 };
    ahead && (-98.0..110.0).contains(&p.y) && p.x.abs() < side
}

/// Whether the skin there lies over the soft tissue of a cheek: beside nose and mouth, below the eye, above
/// the jaw's edge, in front of the ear.
pub(super) fn cheek(p: Vec3) -> bool {
    let beside = p.x.abs() > 25.0 + 9.0 * ramp(-8.0, -24.0, p.y);
    beside && p.z > 38.0 && (-58.0..16.0).contains(&p.y)
}

/// Which lip a skin vertex belongs to; off the lips' columns, by the height of the slit there.
pub(super) fn sides(head: &Head) -> Vec<Side> {
    let rest = &head.skin.reference;
    let corner = head
        .lips
        .upper
        .last()
        .map_or(Vec3::ZERO, |c| rest[c[CONTACT] as usize]);
    let mut sides: Vec<Side> = rest
        .iter()
        .map(|p| match (p.x.abs() < corner.x, p.y > slit_height(p.x)) {
            (false, _) => Side::Neither,
            (true, true) => Side::Upper,
            (true, false) => Side::Lower,
        })
        .collect();
    for (columns, side) in [
        (&head.lips.upper, Side::Upper),
        (&head.lips.lower, Side::Lower),
    ] {
        for column in columns.iter().skip(1).take(columns.len().saturating_sub(2)) {
            for level in 0..LIP_LEVELS {
                sides[column[level] as usize] = side;
            }
        }
    }
    sides
}

/// Height of the line between upper and lower face: the slit, then from the corner up to the ear.
fn slit_height(x: f32) -> f32 {
    -34.0 - 1.0 * (x.abs() / 24.0).min(1.0) + (x.abs() - 26.0).max(0.0) * 0.55
}

/// How much of the mandible's motion the bone under a vertex takes part in.
pub(super) fn mandible_share(p: Vec3, side: Side) -> f32 {
    // Between the lips a step, beyond the corner a ramp that widens backwards over the cheek.
    let beyond = (p.x.abs() - 24.0).max(0.0);
    let half = 1.5 + 0.8 * beyond;
    let share = ramp(-half, half, slit_height(p.x) - p.y);
    let share = match side {
        Side::Upper => share.min(0.5) * (p.x.abs() / 24.0).powi(4).min(1.0),
        Side::Lower => 1.0 - (1.0 - share.max(0.5)) * (p.x.abs() / 24.0).powi(4).min(1.0),
        Side::Neither => share,
    };
    // Down the throat and back towards the ear the skin leaves the jaw again.
    let throat = ramp(-96.0, -70.0, p.y) * ramp(14.0, 66.0, p.z);
    share * throat
}

/// Stiff on forehead, nose and cheek bones, soft on cheeks and lips.
pub(super) fn bone_stiffness(p: Vec3, side: Side) -> f32 {
    let from_mouth = ((p.x / 1.25).powi(2) + (p.y + 36.0).powi(2)).sqrt();
    let near_mouth = 1.0 - ((from_mouth - 22.0) / 34.0).clamp(0.0, 1.0);
    let nose = (1.0 - (p.x.abs() - 9.0).max(0.0) / 10.0).clamp(0.0, 1.0)
        * ((p.y + 16.0) / 14.0).clamp(0.0, 1.0)
        * (1.0 - 0.8 * ramp(38.0, 54.0, p.y));
    // The scalp is fast to the bone at the hairline and on the temples; over the forehead and the
    // brows it slides.
    let brow = ramp(80.0, 106.0, p.y + 0.3 * (p.x.abs() - 30.0).max(0.0));
    let slides = ramp(40.0, 50.0, p.y) * ramp(62.0, 50.0, p.x.abs()) * (1.0 - brow);
    let chin =
        (1.0 - (p.x.abs() / 30.0).powi(2)).clamp(0.0, 1.0) * ((-p.y - 52.0) / 10.0).clamp(0.0, 1.0);
    let thin = (nose.max(brow) + 0.35 * chin).min(1.0);
    let far = (1.0 - near_mouth).powi(2) * 0.22;
    // Under the jaw the skin hangs free between jaw and throat.
    let free = ramp(-52.0, -66.0, p.y - 0.35 * (p.z - 90.0).min(0.0))
        * ramp(20.0, 45.0, p.z)
        * (1.0 - chin);
    let lip = if side == Side::Neither { 1.0 } else { 0.75 };
    let held = thin.max(far) * (1.0 - 0.85 * free);
    (BONE_SOFT * lip) + (BONE_THIN - BONE_SOFT) * held * (1.0 - (1.0 - FOREHEAD) * slides)
}

/// Which way the bone under each of these places of the skin lies, and how deep, mm.
pub(super) fn bone_depth(head: &Head, places: &[Vec3]) -> Vec<(Vec3, f32)> {
    let bones = ["skull", "mandible"].into_iter();
    let space = Space::new(bones.filter_map(|name| head.part(name)).map(|p| &p.mesh));
    places.iter().map(|p| space.under(*p)).collect()
}

/// The springs of one vertex to the fibres near it.
pub(super) fn attach(head: &Head, vertex: usize, p: Vec3, side: Side, lid: f32) -> Vec<Attachment> {
    let mut found: Vec<(f32, Attachment)> = Vec::new();
    for (f, fibre) in head.fibres.iter().enumerate() {
        let other_lip = match fibre.muscle {
            Muscle::OrbicularisOrisSuperior | Muscle::LevatorLabiiSuperioris => Side::Lower,
            Muscle::OrbicularisOrisInferior
            | Muscle::DepressorLabiiInferioris
            | Muscle::Mentalis => Side::Upper,
            _ => Side::Neither,
        };
        if side == other_lip && side != Side::Neither {
            continue;
        }
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
        if best >= reach {
            continue;
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
        let least = if fibre.muscle as usize >= Muscle::FrontalisInner as usize {
            0.015
        } else {
            0.004
        };
        // What a lid carries is the lid's: the muscles of the brow end over it.
        let hold = if fibre.muscle as usize >= Muscle::FrontalisInner as usize {
            hold * (1.0 - lid).powi(2)
        } else {
            hold
        };
        let stiffness = FIBRE * weight * hold * near * near;
        if stiffness > least * FIBRE {
            found.push((
                stiffness,
                Attachment {
                    vertex: vertex as u32,
                    fibre: f as u32,
                    point: place.0 as u32,
                    share: place.1,
                    stiffness,
                },
            ));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(FIBRES_MAX);
    found.into_iter().map(|(_, a)| a).collect()
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
