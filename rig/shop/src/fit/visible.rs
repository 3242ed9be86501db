//! Which vertices of a head a scanner can see: those from which enough of the sky is.

use glam::Vec3;

use crate::closest::{Facing, Surface, smooth_normals};

/// Directions tried from each vertex.
const RAYS: usize = 32;

/// Shares of the sky seen between which a vertex counts more and more.
const SEEN: (f32, f32) = (0.2, 0.4);

/// How far a ray must get to be outside, mm: across a mouth or a nostril, not across a room.
const FREE_MM: f32 = 40.0;

/// A template's `freedom` by shape alone: 0 in the folds of lips, lids and nostrils and behind them, 1 in the open.
/// For the template's file, once: it casts a few hundred thousand rays.
pub fn visible(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<f32> {
    let Ok(surface) = Surface::new(positions, triangles) else {
        return vec![0.0; positions.len()];
    };
    let normals = smooth_normals(positions, triangles);
    positions
        .iter()
        .zip(&normals)
        .map(|(p, n)| {
            let open = (0..RAYS)
                .filter(|&i| {
                    let way = (*n + spiral(i)).normalize_or(*n);
                    surface
                        .ray(*p + *n * 0.05, way, FREE_MM, Facing::ANY)
                        .is_none()
                })
                .count();
            let share = (open as f32 / RAYS as f32 - SEEN.0) / (SEEN.1 - SEEN.0);
            share.clamp(0.0, 1.0)
        })
        .collect()
}

/// Evenly over the unit ball's surface; added to a normal, by the cosine.
fn spiral(i: usize) -> Vec3 {
    let y = 1.0 - 2.0 * (i as f32 + 0.5) / RAYS as f32;
    let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
    Vec3::new(sin, 0.0, cos) * (1.0 - y * y).sqrt() + Vec3::Y * y
}
