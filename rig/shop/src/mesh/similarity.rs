//! The rotation, scale and shift that bring one set of points nearest to another in the sense of
//! least squares: Horn, "Closed-form solution of absolute orientation using unit quaternions" (1987).

use glam::{DMat3, DQuat, DVec3};

/// `scale * rotation * p + shift`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Similarity {
    pub(crate) scale: f64,
    pub(crate) rotation: DQuat,
    pub(crate) shift: DVec3,
}

impl Similarity {
    /// Brings `from` to `to`, entry by entry; at least three points that are not on a line.
    pub(crate) fn fit(from: &[DVec3], to: &[DVec3]) -> Self {
        let (middle_from, middle_to) = (mean(from), mean(to));
        let mut cross = DMat3::ZERO;
        let mut spread = 0.0;
        for (&a, &b) in from.iter().zip(to) {
            let (a, b) = (a - middle_from, b - middle_to);
            cross += DMat3::from_cols(a * b.x, a * b.y, a * b.z);
            spread += a.length_squared();
        }
        let (rotation, ..) = horn(cross);
        // Least squares for the scale once the rotation stands.
        let turned: f64 = from
            .iter()
            .zip(to)
            .map(|(&a, &b)| (rotation * (a - middle_from)).dot(b - middle_to))
            .sum();
        let scale = if spread > 0.0 { turned / spread } else { 1.0 };
        Self {
            scale,
            rotation,
            shift: middle_to - rotation * middle_from * scale,
        }
    }

    pub(crate) fn apply(&self, p: DVec3) -> DVec3 {
        self.rotation * p * self.scale + self.shift
    }

    /// Root of the mean square of what is left between `from`, moved, and `to`.
    pub(crate) fn rms(&self, from: &[DVec3], to: &[DVec3]) -> f64 {
        let sum: f64 = from
            .iter()
            .zip(to)
            .map(|(&a, &b)| self.apply(a).distance_squared(b))
            .sum();
        (sum / from.len() as f64).sqrt()
    }
}

pub(crate) fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len().max(1) as f64
}

/// The rotation that makes the most of `sum of a b^T` (its columns: sums of a times b's coordinates), with what it makes of it
/// and what the best mirror image would: the extreme eigenvalues of Horn's 4 x 4 matrix and the eigenvector of the largest.
pub(crate) fn horn(s: DMat3) -> (DQuat, f64, f64) {
    // s.col(j)[i] = sum of a_i b_j.
    let s = |i: usize, j: usize| s.col(j)[i];
    let (x, y, z) = (0, 1, 2);
    let (yz, zx, xy) = (s(y, z) - s(z, y), s(z, x) - s(x, z), s(x, y) - s(y, x));
    let (xx, yy, zz) = (s(x, x), s(y, y), s(z, z));
    let (a, b, c) = (s(x, y) + s(y, x), s(z, x) + s(x, z), s(y, z) + s(z, y));
    let n = [
        [xx + yy + zz, yz, zx, xy],
        [yz, xx - yy - zz, a, b],
        [zx, a, yy - xx - zz, c],
        [xy, b, c, zz - xx - yy],
    ];
    let (values, vectors) = eigen(n);
    let best = (0..4)
        .max_by(|&i, &j| values[i].total_cmp(&values[j]))
        .unwrap_or(0);
    let least = values.into_iter().fold(f64::INFINITY, f64::min);
    let [w, x, y, z] = vectors.map(|row| row[best]);
    let rotation = DQuat::from_xyzw(x, y, z, w).normalize();
    (rotation, values[best], -least)
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as columns, by Jacobi's rotations.
pub(crate) fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    const SWEEPS: usize = 30;
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..SWEEPS {
        for p in 0..N {
            for q in p + 1..N {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = a.split_at_mut(q);
                for (x, y) in upper[p].iter_mut().zip(&mut lower[0]) {
                    (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                }
                for row in &mut v {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}

/// Widths of a cloud of points along its own axes (roots of the mean squares), largest first.
pub(crate) fn widths(points: &[DVec3]) -> [f64; 3] {
    let middle = mean(points);
    let mut covariance = [[0.0; 3]; 3];
    for &p in points {
        let d = p - middle;
        for (i, row) in covariance.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += d[i] * d[j];
            }
        }
    }
    let (mut values, _) = eigen(covariance);
    values.sort_by(|a, b| b.total_cmp(a));
    values.map(|v| (v.max(0.0) / points.len().max(1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use glam::dvec3;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn finds_the_similarity_that_moved_the_points(
            points in prop::collection::vec(prop::array::uniform3(-100.0..100.0f64), 4..40),
            axis in prop::array::uniform3(-1.0..1.0f64),
            angle in -3.1..3.1f64,
            scale in 0.01..100.0f64,
            shift in prop::array::uniform3(-1e3..1e3f64),
        ) {
            let from: Vec<DVec3> = points.into_iter().map(DVec3::from_array).collect();
            let [_, second, third] = widths(&from);
            prop_assume!(second > 1.0 && third > 1.0);
            let axis = DVec3::from_array(axis).normalize_or(DVec3::Y);
            let true_one = Similarity {
                scale,
                rotation: DQuat::from_axis_angle(axis, angle),
                shift: DVec3::from_array(shift),
            };
            let to: Vec<DVec3> = from.iter().map(|&p| true_one.apply(p)).collect();
            let found = Similarity::fit(&from, &to);
            prop_assert!(found.rms(&from, &to) < 1e-8 * scale * 100.0);
            prop_assert!((found.scale / scale - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_mirror_image_is_not_made_a_rotation() {
        let from = [
            dvec3(0.0, 0.0, 0.0),
            dvec3(50.0, 0.0, 0.0),
            dvec3(0.0, 60.0, 0.0),
            dvec3(0.0, 0.0, 70.0),
        ];
        let to = from.map(|p| dvec3(-p.x, p.y, p.z));
        assert!(Similarity::fit(&from, &to).rms(&from, &to) > 10.0);
    }
}
