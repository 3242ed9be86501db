//! How the tissue is made, as functions of a place on the reference head: which skin moves, how fast it
//! is to the bone under it, what share of the mandible's motion it takes. Which fibres hold it: `holds`.
//!
//! All vertices have the same mass, but at the corners of the mouth: on a graded mesh, masses by area would force a step several times
//! shorter. Stiffness is therefore given per unit of mass, in 1/s².

use glam::Vec3;

use crate::Head;
use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::CONTACT;
use crate::mesh::ramp;
use crate::muscle::Space;

/// Stiffness per mass of a skin edge.
pub(super) const EDGE: f32 = 20_400.0;
/// Of the spring to the bone where the skin lies thin on it, and where it lies on soft tissue.
const BONE_THIN: f32 = 36_000.0;
const BONE_SOFT: f32 = 900.0;
/// What is left of that stiffness where the forehead's skin slides over the bone.
const FOREHEAD: f32 = 0.12;
/// Of a lid's hold on its margin.
pub(super) const LID: f32 = 60_000.0;
/// The mouth's left corner on the reference head, and how much heavier it is than other skin.
const CORNER: Vec3 = Vec3::new(20.0, -34.0, 103.0);
const KNOT: f32 = 0.8;
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

/// By how much a vertex there is heavier than others. The corners of the mouth are: under them lies the modiolus, the
/// knot of eight muscles. There the shortest edges are folded side by side, too, and what swings fastest sets the step.
pub(super) fn heavier(p: Vec3) -> f32 {
    let corner = Vec3::new(CORNER.x.copysign(p.x), CORNER.y, CORNER.z);
    KNOT * ramp(12.0, 5.0, p.distance(corner))
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
pub(crate) fn bone_depth(head: &Head, places: &[Vec3]) -> Vec<(Vec3, f32)> {
    let bones = ["skull", "mandible"].into_iter();
    let space = Space::new(bones.filter_map(|name| head.part(name)).map(|p| &p.mesh));
    places.iter().map(|p| space.under(*p)).collect()
}
