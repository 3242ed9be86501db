//! Shapes to write and read: a made-up head with landmarks, and its parts.

use glam::{DVec3, Vec3, vec3};
use mouthpiece_shop::landmarks::{Landmarks, Unit};
use mouthpiece_shop::mesh::{ReferencePoint, Scan};

const ROWS: u32 = 60;
const COLUMNS: u32 = 80;

/// The made-up head in the direction (longitude from the front to the left, latitude), mm: an egg
/// with a nose and a chin, mirror-symmetric.
pub(crate) fn head_at(longitude: f32, latitude: f32) -> Vec3 {
    let (sin_u, cos_u) = longitude.sin_cos();
    let (sin_v, cos_v) = latitude.sin_cos();
    let egg = vec3(72.0 * cos_v * sin_u, 115.0 * sin_v, 92.0 * cos_v * cos_u);
    let bump = |u: f32, v: f32, width: f32| {
        let square = (longitude - u).powi(2) + (latitude - v).powi(2);
        (-square / (width * width)).exp()
    };
    let face = egg
        + vec3(
            0.0,
            0.0,
            24.0 * bump(0.0, -0.1, 0.2) + 10.0 * bump(0.0, -0.75, 0.3),
        );
    face + vec3(0.0, 30.0, 10.0)
}

/// The head as a scan without its neck: open below.
pub(crate) fn head() -> Scan {
    patch(-0.9, 1.55, std::f32::consts::PI)
}

/// The face alone: no back of the head.
pub(crate) fn mask() -> Scan {
    patch(-0.9, 0.9, 1.3)
}

fn patch(low: f32, high: f32, side: f32) -> Scan {
    let closed = side > 3.0;
    let mut scan = Scan::default();
    for row in 0..=ROWS {
        let v = low + (high - low) * row as f32 / ROWS as f32;
        for column in 0..COLUMNS {
            let steps = if closed { COLUMNS } else { COLUMNS - 1 };
            let u = -side + 2.0 * side * column as f32 / steps as f32;
            scan.positions.push(head_at(u, v));
        }
    }
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            if column + 1 == COLUMNS && !closed {
                continue;
            }
            let right = (column + 1) % COLUMNS;
            let at = |r: u32, c: u32| r * COLUMNS + c;
            scan.triangles
                .push([at(row, column), at(row, right), at(row + 1, right)]);
            scan.triangles
                .push([at(row, column), at(row + 1, right), at(row + 1, column)]);
        }
    }
    scan
}

/// Names and directions of landmarks on the made-up head.
const PLACES: [(&str, f32, f32); 16] = [
    ("v", 0.0, 1.5),
    ("op", std::f32::consts::PI, 0.2),
    ("n", 0.0, 0.25),
    ("prn", 0.0, -0.1),
    ("sn", 0.0, -0.25),
    ("sto", 0.0, -0.45),
    ("gn", 0.0, -0.85),
    ("en_l", 0.2, 0.15),
    ("en_r", -0.2, 0.15),
    ("ex_l", 0.5, 0.15),
    ("ex_r", -0.5, 0.15),
    ("ch_l", 0.3, -0.45),
    ("ch_r", -0.3, -0.45),
    ("t_l", 1.5, -0.1),
    ("t_r", -1.5, -0.1),
    ("zy_l", 1.1, 0.0),
];

/// The landmarks of the reference head: like the scan's, a little larger, and narrower.
pub(crate) fn reference() -> Vec<ReferencePoint> {
    let point = |&(name, u, v): &(&str, f32, f32)| {
        let at = head_at(u, v);
        let step = 0.01;
        let along = head_at(u + step, v) - at;
        let up = head_at(u, v + step) - at;
        ReferencePoint {
            name: name.to_owned(),
            at: at * vec3(1.03, 1.06, 1.06),
            normal: along.cross(up).normalize(),
        }
    };
    let mut points: Vec<_> = PLACES.iter().map(point).collect();
    let mut right = points[PLACES.len() - 1].clone();
    right.name = "zy_r".to_owned();
    right.at.x = -right.at.x;
    right.normal.x = -right.normal.x;
    points.push(right);
    points
}

/// Landmarks on the scan itself, mm.
pub(crate) fn landmarks() -> Landmarks {
    let point = |&(name, u, v): &(&str, f32, f32)| (name.to_owned(), head_at(u, v).as_dvec3());
    Landmarks {
        unit: Unit::Millimetre,
        points: PLACES.iter().map(point).collect(),
    }
}

/// Some of them.
pub(crate) fn only(names: &[&str]) -> Landmarks {
    let mut all = landmarks();
    all.points.retain(|name, _| names.contains(&name.as_str()));
    all
}

/// `scan` and `landmarks` moved alike.
pub(crate) fn moved(
    scan: &Scan,
    landmarks: &Landmarks,
    by: impl Fn(DVec3) -> DVec3,
) -> (Scan, Landmarks) {
    let (mut scan, mut landmarks) = (scan.clone(), landmarks.clone());
    for p in &mut scan.positions {
        *p = by(p.as_dvec3()).as_vec3();
    }
    for p in landmarks.points.values_mut() {
        *p = by(*p);
    }
    (scan, landmarks)
}

/// Both in one.
pub(crate) fn joined(mut first: Scan, second: &Scan) -> Scan {
    let base = first.positions.len() as u32;
    first.positions.extend(&second.positions);
    first
        .triangles
        .extend(second.triangles.iter().map(|t| t.map(|i| i + base)));
    first.colour = None;
    first
}
