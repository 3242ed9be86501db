//! How good a fit is: distances both ways, landmarks, faces turned over. What `head fit --report` writes.
//!
//! A short distance from skin to scan proves nothing alone: a skin folded onto the scan has it too. So the way back is
//! measured as well, from places spread over the scan by area, and the faces turned over are counted.

use glam::Vec3;

use super::Fit;
use super::Template;
use super::align::Similarity;
use super::turned::{face_normals, turned};
use crate::closest::{Surface, SurfaceError};

/// Places on the scan from which the skin is looked for.
const SAMPLES: usize = 10_000;

/// A place of the scan farther from the skin than this shows something else than the head, mm.
const ELSEWHERE_MM: f32 = 15.0;

/// Mean, 95th percentile and maximum of distances, mm.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Nineteen in twenty are below this.
    pub p95: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// Of a list; zeros if it is empty.
    pub fn of(mut values: Vec<f32>) -> Self {
        values.sort_by(f32::total_cmp);
        let Some(&max) = values.last() else {
            return Self::default();
        };
        let sum: f64 = values.iter().map(|v| f64::from(*v)).sum();
        let p95 = values[(values.len() - 1) * 95 / 100];
        Self {
            mean: sum / values.len() as f64,
            p95: f64::from(p95),
            max: f64::from(max),
        }
    }
}

/// The judgement over a fit.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Report {
    /// From the template's landmarks, as fitted, to those of the scan.
    pub landmark_error_mm: Spread,
    /// From the skin's vertices on the face to the nearest point of the scan.
    pub skin_to_scan_mm: Spread,
    /// From the scan, evenly by area, to the nearest point of the skin, where that is on the face.
    pub scan_to_skin_mm: Spread,
    /// Share of all faces whose normal is more than 90 degrees off.
    pub turned_faces: f64,
    /// Those faces.
    #[serde(skip)]
    pub turned: Vec<usize>,
}

/// Measures a fit. `face` says which vertices are on the face: where the scan has a surface worth comparing with.
pub fn report(
    template: &Template,
    fit: &Fit,
    scan: &Surface,
    landmarks: &[(Vec3, Vec3)],
    face: &[bool],
) -> Result<Report, SurfaceError> {
    let skin = Surface::new(&fit.positions, template.triangles)?;
    let errors = fit
        .landmarks
        .iter()
        .zip(landmarks)
        .map(|(at, (_, to))| at.distance(*to))
        .collect();
    let there = (0..fit.positions.len())
        .filter(|&v| face.get(v).copied().unwrap_or(false))
        .filter_map(|v| {
            scan.closest(fit.positions[v], f32::INFINITY)
                .map(|hit| hit.distance)
        })
        .collect();
    let on_face = |t: u32| {
        template.triangles[t as usize]
            .iter()
            .all(|&v| face.get(v as usize).copied().unwrap_or(false))
    };
    let back = samples(scan, SAMPLES)
        .into_iter()
        .filter_map(|p| skin.closest(p, ELSEWHERE_MM))
        .filter(|hit| on_face(hit.triangle))
        .map(|hit| hit.distance)
        .collect();
    let turned = turned_faces(template, fit, landmarks);
    Ok(Report {
        landmark_error_mm: Spread::of(errors),
        skin_to_scan_mm: Spread::of(there),
        scan_to_skin_mm: Spread::of(back),
        turned_faces: turned.len() as f64 / template.triangles.len().max(1) as f64,
        turned,
    })
}

/// Faces over 90 degrees off what the landmarks alone make of them, or, where those have turned a face over
/// themselves, off the template as the best similarity turns it.
pub fn turned_faces(template: &Template, fit: &Fit, landmarks: &[(Vec3, Vec3)]) -> Vec<usize> {
    let (from, to): (Vec<Vec3>, Vec<Vec3>) = landmarks.iter().copied().unzip();
    let mut should = face_normals(&fit.by_landmarks, template.triangles);
    if let Some(similarity) = Similarity::between(&from, &to) {
        let rest = face_normals(template.positions, template.triangles);
        for (should, rest) in should.iter_mut().zip(rest) {
            let rest = similarity.rotation * rest;
            if should.dot(rest) <= 0.0 {
                *should = rest;
            }
        }
    }
    turned(&fit.positions, template.triangles, &should, 0.0)
}

/// Points spread evenly over a surface: as many in each triangle as its area is worth, at the places of a low-discrepancy
/// sequence. The same every time.
fn samples(surface: &Surface, count: usize) -> Vec<Vec3> {
    let corners = |t: &[u32; 3]| t.map(|v| surface.positions()[v as usize]);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        f64::from((b - a).cross(c - a).length())
    };
    let total: f64 = surface.triangles().iter().map(area).sum();
    let spacing = total / count as f64;
    let (mut due, mut points) = (0.5 * spacing, Vec::with_capacity(count));
    for t in surface.triangles() {
        due -= area(t);
        let [a, b, c] = corners(t);
        while due <= 0.0 && points.len() < count {
            due += spacing;
            // The two-dimensional golden sequence, folded into the triangle.
            let i = points.len() as f64 + 0.5;
            let (u, v) = (
                (i * 0.754_877_666_246_693).fract() as f32,
                (i * 0.569_840_290_998_053).fract() as f32,
            );
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            points.push(a + (b - a) * u + (c - a) * v);
        }
    }
    points
}
