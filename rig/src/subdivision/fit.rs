//! Control points whose limit are given points: Loop's surface lies inside its control mesh, most at
//! noses and ears, so a mesh that was fitted to a scan is pushed out until it is drawn where it was
//! fitted. Used when a head is built or fitted, not per frame.

use glam::Vec3;

use super::Stencils;

/// Rounds. A bump as wide as many triangles is found in the first; a spike of one vertex, which needs
/// four times its height of control point and would ring, keeps four tenths of its distance.
const ROUNDS: usize = 3;

/// Control positions whose limit is `targets` as nearly as is smooth, by Jacobi rounds: what is mirrored or
/// coincides (creases) stays so. `limit` is what [`limit_stencils`](super::limit_stencils) gives.
#[must_use]
pub fn fit_control(limit: &Stencils, targets: &[Vec3]) -> Vec<Vec3> {
    let mut control = targets.to_vec();
    let mut drawn = vec![Vec3::ZERO; limit.len()];
    for _ in 0..ROUNDS {
        limit.apply(&control, &mut drawn);
        for ((c, drawn), target) in control.iter_mut().zip(&drawn).zip(targets) {
            *c += *target - *drawn;
        }
    }
    control
}
