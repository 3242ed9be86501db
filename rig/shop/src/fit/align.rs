//! The similarity that takes one set of points best to another: what stands between a scan's frame and the head's.
//!
//! Closed form by unit quaternions (Horn 1987). It also tells when a mirror image would fit better than any turn, which
//! is what left and right landmarks look like when they were swapped.

use glam::{DMat3, DVec3, Mat4, Quat, Vec3};

use crate::mesh::similarity::horn;

/// How much better than the best turn a mirror image must explain the points to be blamed.
const MIRROR_MARGIN: f64 = 1.02;

/// A turn, a scale and a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Factor on lengths.
    pub scale: f32,
    /// The turn, of length one.
    pub rotation: Quat,
    /// The shift, after turn and scale.
    pub translation: Vec3,
    /// Whether the points are rather a mirror image of one another.
    pub mirrored: bool,
}

impl Similarity {
    /// The best map of `from` to `to` in the least-squares sense; `None` for fewer than three pairs, points on one
    /// spot, or coordinates that are not finite.
    pub fn between(from: &[Vec3], to: &[Vec3]) -> Option<Self> {
        let n = from.len().min(to.len());
        if n < 3 {
            return None;
        }
        let mean = |p: &[Vec3]| p[..n].iter().map(|p| p.as_dvec3()).sum::<DVec3>() / n as f64;
        let (a, b) = (mean(from), mean(to));
        let (mut cross, mut spread) = (DMat3::ZERO, [0.0; 2]);
        for (p, q) in from.iter().zip(to) {
            let (p, q) = (p.as_dvec3() - a, q.as_dvec3() - b);
            cross += DMat3::from_cols(p * q.x, p * q.y, p * q.z);
            spread[0] += p.length_squared();
            spread[1] += q.length_squared();
        }
        if !(spread[0] > 0.0 && spread[1] > 0.0 && spread[0].is_finite() && spread[1].is_finite()) {
            return None;
        }
        let (rotation, turn, mirror) = horn(cross);
        let scale = turn / spread[0];
        if !(scale > 0.0 && scale.is_finite() && rotation.is_finite()) {
            return None;
        }
        Some(Self {
            scale: scale as f32,
            rotation: rotation.as_quat(),
            translation: (b - rotation * a * scale).as_vec3(),
            mirrored: mirror > turn * MIRROR_MARGIN,
        })
    }

    /// Where a point goes.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.rotation * p * self.scale + self.translation
    }

    /// The map that undoes this one.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        let scale = 1.0 / self.scale;
        Self {
            scale,
            rotation,
            translation: -(rotation * self.translation * scale),
            mirrored: self.mirrored,
        }
    }

    /// As a matrix on column vectors.
    pub fn matrix(&self) -> Mat4 {
        Mat4::from_scale_rotation_translation(
            Vec3::splat(self.scale),
            self.rotation,
            self.translation,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> Vec<Vec3> {
        [
            [0.0, 0.0, 90.0],
            [20.0, 30.0, 70.0],
            [-20.0, 30.0, 70.0],
            [25.0, -35.0, 75.0],
            [-25.0, -35.0, 75.0],
            [0.0, 120.0, 0.0],
        ]
        .map(Vec3::from)
        .to_vec()
    }

    #[test]
    fn a_known_similarity_is_found_and_undone() {
        let truth = Similarity {
            scale: 0.001,
            rotation: Quat::from_euler(glam::EulerRot::XYZ, 2.0, 0.4, -1.1),
            translation: Vec3::new(3.0, 0.2, -7.0),
            mirrored: false,
        };
        let from = points();
        let to: Vec<Vec3> = from.iter().map(|p| truth.point(*p)).collect();
        let found = Similarity::between(&from, &to).unwrap();
        assert!(!found.mirrored);
        for (p, q) in from.iter().zip(&to) {
            assert!(found.point(*p).distance(*q) < 1e-6);
            assert!(found.inverse().point(*q).distance(*p) < 2e-3);
            assert!(found.matrix().transform_point3(*p).distance(*q) < 1e-6);
        }
    }

    #[test]
    fn swapped_sides_are_seen_as_a_mirror_image() {
        let from = points();
        let mut to = from.clone();
        to.swap(1, 2);
        to.swap(3, 4);
        assert!(Similarity::between(&from, &to).unwrap().mirrored);
        assert!(!Similarity::between(&from, &from).unwrap().mirrored);
    }

    #[test]
    fn one_spot_has_no_similarity() {
        assert_eq!(Similarity::between(&[Vec3::ONE; 5], &points()[..5]), None);
        assert_eq!(Similarity::between(&points()[..2], &points()[..2]), None);
    }
}
