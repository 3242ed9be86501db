//! Control points whose limit are given points: Loop's surface lies inside its control mesh, most at
//! noses and ears, so a mesh that was fitted to a scan is pushed out until it is drawn where it was
//! fitted. Used when a head is built or fitted, not per frame.

use glam::Vec3;

use super::Stencils;

/// Rounds; each leaves at most two thirds of the distance (far less where the mesh is smooth).
const ROUNDS: usize = 24;
/// Share of the distance that a round goes past the control point's own: the limit answers to a change
/// by a quarter (at the spikiest) to all of it.
const STRIDE: f32 = 1.4;

/// Control positions whose limit is `targets`, by damped Jacobi rounds: mirrored and coincident creases
/// stay so. `limit` is what [`limit_stencils`](super::limit_stencils) gives.
#[must_use]
pub fn fit_control(limit: &Stencils, targets: &[Vec3]) -> Vec<Vec3> {
    let mut control = targets.to_vec();
    let mut drawn = vec![Vec3::ZERO; limit.len()];
    for _ in 0..ROUNDS {
        limit.apply(&control, &mut drawn);
        for ((c, drawn), target) in control.iter_mut().zip(&drawn).zip(targets) {
            *c += (*target - *drawn) * STRIDE;
        }
    }
    control
}
