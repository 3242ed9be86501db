//! Reads a mouth off a key frame: one piece of code for curves, calibration and tests.

use glam::Vec3;

use crate::contact::upper_edge;
use crate::mesh::LIP_LEVELS;
use crate::mesh::lip_level::{BORDER, CONTACT, CREST, INNER};
use crate::{Control, Head, KeyFrame};

/// What a mouth does, measured on the skin as it is drawn: on the limit of its subdivision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Largest free gap between the lips over the middle 80 % of the mouth's width, mm; below 0
    /// where they overlap (only with lip contact off).
    pub aperture_mm: f32,
    /// Distance between the corners of the mouth, mm.
    pub width_mm: f32,
    /// How far the lips stand forward of their place at rest, mean of both crests, mm.
    pub protrusion_mm: f32,
    /// Jaw rotation, radians.
    pub jaw_rad: f32,
    /// Least distance from the lower lip to the edge of the upper front teeth, mm.
    pub lip_teeth_mm: f32,
}

/// Stations across the mouth at which the gap is read.
const STATIONS: usize = 33;
/// The middle of the mouth's width that counts, as a share.
const MIDDLE: f32 = 0.8;
/// Columns within this distance of the mid line touch the front teeth, mm.
const FRONT_TEETH_MM: f32 = 8.0;

/// Measures the mouth of `frame`, which is a frame of `head`.
#[must_use]
pub fn measure(head: &Head, frame: &KeyFrame) -> Measures {
    let lips = head.lip_stencils.of(head);
    let (upper, lower) = (&lips.upper, &lips.lower);
    let skin = &lips.at(&frame.skin);
    let (Some(first), Some(last)) = (upper.first(), upper.last()) else {
        return Measures::default();
    };
    let (right, left) = (skin[first[BORDER] as usize], skin[last[BORDER] as usize]);
    let slit = (
        skin[first[CONTACT] as usize].x,
        skin[last[CONTACT] as usize].x,
    );

    let lowest = |x: f32| edge_at(skin, upper, x, f32::min);
    let highest = |x: f32| edge_at(skin, lower, x, f32::max);
    let aperture_mm = (0..STATIONS)
        .map(|i| {
            let share = 0.5 + MIDDLE * (i as f32 / (STATIONS - 1) as f32 - 0.5);
            let x = slit.0 + (slit.1 - slit.0) * share;
            lowest(x) - highest(x)
        })
        .fold(f32::MIN, f32::max);

    let middle = upper.len() / 2;
    let rest = lips.at(&head.skin.mesh.positions);
    let forward = |columns: &[[u32; LIP_LEVELS]]| {
        let v = columns[middle][CREST] as usize;
        skin[v].z - rest[v].z
    };
    // The jaw carries the lower lip back as it opens: that is no drawing in of the lip.
    let jaw = head.mandible(frame.state[Control::Jaw]);
    let crest = rest[lower[middle][CREST] as usize];
    let carried = jaw.transform_point3(crest).z - crest.z;
    let lip_teeth_mm = lower
        .iter()
        .flat_map(|column| &column[CREST..=INNER])
        .map(|&v| skin[v as usize])
        .filter(|p| head.bite.reference(*p).x.abs() < FRONT_TEETH_MM)
        .map(|p| p.distance(head.bite.place(upper_edge(head.bite.reference(p).x))))
        .fold(f32::MAX, f32::min);
    Measures {
        aperture_mm,
        width_mm: left.distance(right),
        protrusion_mm: 0.5 * (forward(upper) + forward(lower) - carried),
        jaw_rad: frame.state[Control::Jaw],
        lip_teeth_mm,
    }
}

/// The lip's edge at `x`: the extreme height of its columns (from the crest inwards), interpolated.
fn edge_at(
    skin: &[Vec3],
    columns: &[[u32; LIP_LEVELS]],
    x: f32,
    extreme: fn(f32, f32) -> f32,
) -> f32 {
    let of = |column: &[u32; LIP_LEVELS]| {
        let points = column[CREST..].iter().map(|&v| skin[v as usize]);
        let height = points.clone().map(|p| p.y).reduce(extreme).unwrap_or(0.0);
        (skin[column[CONTACT] as usize].x, height)
    };
    for w in columns.windows(2) {
        let ((xa, ya), (xb, yb)) = (of(&w[0]), of(&w[1]));
        if x <= xb {
            let share = ((x - xa) / (xb - xa).max(1e-4)).clamp(0.0, 1.0);
            return ya + (yb - ya) * share;
        }
    }
    columns.last().map_or(0.0, |c| of(c).1)
}
