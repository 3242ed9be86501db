//! What the tongue touches: palate and both rows of teeth, and which of its places may touch them.
//!
//! In figures of the reference head, where every head's teeth stand by its [`Placement`], as in
//! [`contact`](crate::contact). Each row's inner wall is an ellipse seen from above, the palate a vault
//! over the upper one; both lie within the drawn teeth and gums by some tenths of a millimetre, which a
//! test measures on the meshes.

use glam::{Affine3A, Vec3, vec3};

use crate::{Head, Mesh, Placement};

/// Middle of both arches along z, and their inner half axes across and forward, mm.
const MIDDLE_Z: f32 = 70.0;
const UPPER_HALF: [f32; 2] = [19.4, 31.2];
const LOWER_HALF: [f32; 2] = [18.2, 30.2];
/// Heights of the edges of the front teeth, mm; of the lower ones with the mandible shut.
pub(super) const UPPER_EDGE_Y: f32 = -35.1;
pub(super) const LOWER_EDGE_Y: f32 = -33.6;
/// Back from here the lower teeth's edges rise, by so much per mm.
const EDGE_RISES_Z: f32 = 92.0;
const EDGE_RISE: f32 = 0.1;
/// A place of the lower incisors' edge, by which the gap is told.
const INCISOR: Vec3 = vec3(0.0, LOWER_EDGE_Y, 101.5);
/// Height of the vault's middle; how much lower it is at the teeth; how it falls towards the throat, per mm.
const VAULT_Y: f32 = -15.5;
const VAULT_MM: f32 = 8.0;
const VELUM: f32 = 0.008;

/// Places along the tongue and round it that may touch.
const ALONG: usize = 7;

/// Which body something belongs to: the skull or the mandible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Upper,
    Lower,
}

/// How far the incisors' edges are apart in height, mm of the reference head; below 0 they overlap.
pub(super) fn gap_mm(head: &Head, jaw: f32) -> f32 {
    let bite = head.bite;
    let edge = head.mandible(jaw).transform_point3(bite.place(INCISOR));
    UPPER_EDGE_Y - bite.reference(edge).y
}

/// What frees a place of the tongue, given in the mandible's frame, that lies within teeth or palate: a
/// vector, mm, and whose frame it is in. Nothing where it is free, or in by less than `slop`.
pub(super) fn overlap(
    head: &Head,
    mandible: &Affine3A,
    p: Vec3,
    slop: f32,
) -> Option<(Vec3, Side)> {
    let bite = head.bite;
    let above = bite.reference(mandible.transform_point3(p));
    let below = bite.reference(p);
    let told = |out: Vec3, side: Side| {
        let out = out * bite.scale;
        (out.length() > slop).then_some((out, side))
    };
    upper(above)
        .and_then(|out| told(out, Side::Upper))
        .or_else(|| lower(below).and_then(|out| told(out, Side::Lower)))
}

/// Out of the upper teeth, or down from the palate.
fn upper(p: Vec3) -> Option<Vec3> {
    let wall = into(p, UPPER_HALF);
    let over = p.y - UPPER_EDGE_Y;
    match wall {
        // Beyond the wall and above the edge: back, or down and out below it.
        Some(back) if over > 0.0 => Some(shorter(back, vec3(0.0, -over, 0.0))),
        Some(_) => None,
        None => {
            let [across, forward] = UPPER_HALF;
            let (x, z) = (p.x / across, (p.z - MIDDLE_Z).max(0.0) / forward);
            let behind = (MIDDLE_Z - p.z).max(0.0);
            let vault = VAULT_Y - VAULT_MM * (x * x + z * z) - VELUM * behind * behind;
            (p.y > vault).then(|| vec3(0.0, vault - p.y, 0.0))
        }
    }
}

/// Out of the lower teeth.
fn lower(p: Vec3) -> Option<Vec3> {
    let back = into(p, LOWER_HALF)?;
    let under = LOWER_EDGE_Y + EDGE_RISE * (EDGE_RISES_Z - p.z).max(0.0) - p.y;
    (under > 0.0).then(|| shorter(back, vec3(0.0, under, 0.0)))
}

/// From beyond an arch's inner wall to it, on the level; nothing inside it or behind the arch.
fn into(p: Vec3, [across, forward]: [f32; 2]) -> Option<Vec3> {
    let ahead = p.z - MIDDLE_Z;
    if ahead <= 0.0 {
        return None;
    }
    let (x, z) = (p.x / across, ahead / forward);
    let square = x * x + z * z;
    if square <= 1.0 {
        return None;
    }
    // One step of Newton's to the ellipse, along its slope: exact enough near it.
    let slope = vec3(x / across, 0.0, z / forward);
    let root = square.sqrt();
    Some(slope * (-(root - 1.0) * root / slope.length_squared().max(1e-9)))
}

fn shorter(a: Vec3, b: Vec3) -> Vec3 {
    if a.length_squared() < b.length_squared() {
        a
    } else {
        b
    }
}

/// Vertices of a tongue that stand out: at stations along it the highest, the lowest and the outermost, and the tip.
pub(super) fn feelers(mesh: &Mesh, bite: Placement) -> Vec<usize> {
    let places: Vec<Vec3> = mesh.positions.iter().map(|p| bite.reference(*p)).collect();
    let ends = places.iter().map(|p| p.z);
    let (back, tip) = (
        ends.clone().fold(f32::MAX, f32::min),
        ends.fold(f32::MIN, f32::max),
    );
    let mut chosen = Vec::new();
    for station in 0..ALONG {
        // Denser towards the tip, which moves most.
        let share = 1.0 - (station as f32 / (ALONG - 1) as f32).powf(1.6);
        let z = back + (tip - back) * share;
        let reach = (tip - back) / ALONG as f32 * 0.6;
        for sense in SENSES {
            let here = (0..places.len()).filter(|&v| (places[v].z - z).abs() <= reach);
            let farther = |v: &usize| sense.dot(places[*v]) - 0.5 * (places[*v].z - z).abs();
            chosen.extend(here.max_by(|a, b| farther(a).total_cmp(&farther(b))));
        }
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// Where a tongue's section can touch: at top and sides and between, and at its underside.
const SENSES: [Vec3; 7] = [
    vec3(0.0, 1.0, 0.0),
    vec3(0.6, 0.8, 0.0),
    vec3(-0.6, 0.8, 0.0),
    vec3(1.0, 0.2, 0.0),
    vec3(-1.0, 0.2, 0.0),
    vec3(0.3, -1.0, 0.0),
    vec3(-0.3, -1.0, 0.0),
];
