//! The skin of the cheapest tier with fewer triangles: which vertices stay, and how far off what is drawn may be.
//! `collapse` leaves the others out; `fans` says which triangles lie round a vertex.

mod collapse;
mod fans;

use glam::Vec3;
use mouthpiece_rig::{Head, Subdivision};

use crate::gpu_data::SkinStill;
use crate::maps::landmarks::Landmarks;
use collapse::{Fine, TRAITS, Traits, coarse};

/// How far coarse triangles may be off the skin, mm: half a pixel of 640 x 480, and less round mouth and eyes, where
/// the skin moves most and everybody looks.
const OFF_MM: f32 = 0.30;
const OFF_NEAR_MM: f32 = 0.12;
/// How far round the middle of the mouth and round the eyes that is, in a face of mean size, mm.
const MOUTH_MM: f32 = 34.0;
const EYE_MM: f32 = 22.0;
/// How far between vertices other things may be off: a normal, a share, the chart in its whole, a zone of wrinkles.
const NORMAL_OFF: f32 = 0.10;
const SHARE_OFF: f32 = 0.08;
const CHART_OFF: f32 = 0.0015;
const ZONE_OFF: f32 = 0.15;

/// Fewer triangles of the drawn vertices; lids' margins and creases keep theirs.
pub(crate) fn triangles(
    head: &Head,
    surface: &Subdivision,
    sources: &[u32],
    still: &[SkinStill],
    marks: &Landmarks,
) -> Vec<[u32; 3]> {
    let mut points = vec![Vec3::ZERO; surface.point_count()];
    surface.apply(&head.skin.mesh.positions, &mut points);
    let mut normals = points.clone();
    surface.normals(&points, &mut normals);
    let of = |list: &[Vec3]| {
        sources
            .iter()
            .map(|&i| list[i as usize])
            .collect::<Vec<_>>()
    };
    let (points, normals) = (of(&points), of(&normals));
    let normals: Vec<Vec3> = normals.iter().map(|n| n.normalize_or(Vec3::Z)).collect();
    let traits: Vec<Traits> = still
        .iter()
        .zip(&normals)
        .map(|(s, n)| traits(s, *n))
        .collect();
    let eyes = head.eyes.map(|eye| eye.centre);
    let close = |p: Vec3| {
        p.distance(marks.mouth) < MOUTH_MM * marks.scale
            || eyes
                .iter()
                .any(|eye| p.distance(*eye) < EYE_MM * marks.scale)
    };
    let tolerance = |p: &Vec3| if close(*p) { OFF_NEAR_MM } else { OFF_MM };
    let mut tolerance_mm: Vec<f32> = points.iter().map(tolerance).collect();
    let creases = head.skin.creases.as_flattened().iter().copied();
    let lids = head.lids.iter().filter(|l| l.hold > 0.99).map(|l| l.vertex);
    for kept in creases.chain(lids) {
        if let Some(tolerance) = tolerance_mm.get_mut(kept as usize) {
            *tolerance = 0.0;
        }
    }
    coarse(&Fine {
        triangles: surface.triangles(),
        points: &points,
        normals: &normals,
        traits: &traits,
        tolerance_mm: &tolerance_mm,
    })
}

/// What a vertex is drawn with, in units of what may be off.
fn traits(still: &SkinStill, normal: Vec3) -> Traits {
    let normal = normal.to_array().map(|v| v / NORMAL_OFF);
    let share = |v: &u8| f32::from(*v) / 255.0;
    let shares = still.shares.iter().map(|v| share(v) / SHARE_OFF);
    let chart = still.uv.iter().map(|v| v / CHART_OFF);
    let zones = still
        .zones
        .as_flattened()
        .iter()
        .map(|v| share(v) / ZONE_OFF);
    let mut out = [0.0; TRAITS];
    let all = normal.into_iter().chain(shares).chain(chart).chain(zones);
    out.iter_mut().zip(all).for_each(|(out, v)| *out = v);
    out
}

/// Numbers the vertices that triangles use in the order of their use: their sources and what does not move.
pub(crate) fn used(
    triangles: &mut [[u32; 3]],
    sources: &[u32],
    still: &[SkinStill],
) -> (Vec<u32>, Vec<SkinStill>) {
    let mut numbers = vec![u32::MAX; sources.len()];
    let mut order = Vec::new();
    for i in triangles.as_flattened_mut() {
        let number = &mut numbers[*i as usize];
        if *number == u32::MAX {
            *number = order.len() as u32;
            order.push(*i as usize);
        }
        *i = *number;
    }
    order.iter().map(|&i| (sources[i], still[i])).unzip()
}
