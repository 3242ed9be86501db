//! The thin-plate warp of HEADSHOP 5.1: a smooth map of space that takes points to points, for the skin, the skull,
//! the muscles and everything else of a head.
//!
//! `f(p) = sum c_i |p - p_i| + R p + t`. The kernel `r` is the biharmonic one in three dimensions: of all maps through
//! the points it bends least. Solved by LU with pivoting in double precision, in coordinates scaled to about one;
//! evaluated in single precision, eight points at a time, in loops that the compiler turns into vector instructions.
//! It does not know meshes: what is between the points follows them, folded or not (`fit` looks after that).

use faer::Mat;
use faer::linalg::solvers::Solve as _;
use glam::{DVec3, Vec3};

/// Points evaluated together: two SSE registers or one of AVX.
const LANES: usize = 8;

/// Sources nearer to each other than this share of their spread are one point.
const COINCIDENT: f64 = 1e-6;

/// Sources whose thinnest extent is below this share of their widest lie in a plane.
const FLAT: f64 = 1e-4;

/// Why points define no warp.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WarpError {
    /// The two lists differ in length.
    #[error("{sources} source points but {targets} target points: every point needs its partner")]
    Lengths {
        /// Length of the source list.
        sources: usize,
        /// Length of the target list.
        targets: usize,
    },
    /// Fewer than four pairs.
    #[error("{0} point pairs define no warp: give at least four that do not lie in one plane")]
    TooFew(usize),
    /// A coordinate is not a number.
    #[error("point pair {0} has a coordinate that is not finite: correct or remove it")]
    NotFinite(usize),
    /// Two sources are one.
    #[error("source points {0} and {1} lie on one spot: remove one of them")]
    Coincident(usize, usize),
    /// The sources lie in a plane or on a line.
    #[error("all source points lie in one plane: add one in front of or behind it")]
    Flat,
    /// All sources, or all targets, are one spot.
    #[error("the points of one side lie all on one spot: place them where the landmarks are")]
    OneSpot,
    /// The linear system has no finite solution.
    #[error("the point pairs define no finite warp: check for points that lie almost on one spot")]
    Singular,
}

/// A smooth map of space that takes source points to target points.
#[derive(Debug, Clone)]
pub struct Warp {
    /// Evaluation happens relative to this point, where single precision is best.
    middle: Vec3,
    /// Sources relative to `middle`, and their weights, one after the other for streaming.
    centres: Vec<[f32; 6]>,
    /// Columns of R, then the place to which `middle` goes without the weighted sum.
    affine: [Vec3; 4],
}

impl Warp {
    /// The warp that takes each point of `from` exactly to its partner in `to`.
    pub fn new(from: &[Vec3], to: &[Vec3]) -> Result<Self, WarpError> {
        Self::smoothed(from, to, &[])
    }

    /// The same, but point `i` may miss its partner so that the warp bends less: `give[i]` (mm) is the ridge on the
    /// system's diagonal, 0 for exact; an empty slice stands for zeros.
    pub fn smoothed(from: &[Vec3], to: &[Vec3], give: &[f32]) -> Result<Self, WarpError> {
        let n = from.len();
        check(from, to)?;
        let middle = from.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / n as f64;
        let local: Vec<DVec3> = from.iter().map(|p| p.as_dvec3() - middle).collect();
        let spread = local.iter().map(|p| p.length()).fold(0.0, f64::max);
        distinct(&local, spread)?;
        if is_flat(&local) {
            return Err(WarpError::Flat);
        }
        let points: Vec<DVec3> = local.iter().map(|p| *p / spread).collect();

        let mut a = Mat::<f64>::zeros(n + 4, n + 4);
        for (j, q) in points.iter().enumerate() {
            let column = a.col_as_slice_mut(j);
            for (entry, p) in column.iter_mut().zip(&points) {
                *entry = p.distance(*q);
            }
            // With this kernel the quadratic form is negative on admissible weights, hence the minus.
            column[j] = -f64::from(give.get(j).copied().unwrap_or(0.0)) / spread;
            column[n..].copy_from_slice(&[q.x, q.y, q.z, 1.0]);
        }
        for (j, p) in points.iter().enumerate() {
            for (k, value) in [p.x, p.y, p.z, 1.0].into_iter().enumerate() {
                a[(j, n + k)] = value;
            }
        }
        let mut b = Mat::<f64>::zeros(n + 4, 3);
        for (i, q) in to.iter().enumerate() {
            let q = q.as_dvec3() - middle;
            for k in 0..3 {
                b[(i, k)] = q[k];
            }
        }
        let x = a.partial_piv_lu().solve(&b);
        let row =
            |i: usize, scale: f64| (DVec3::new(x[(i, 0)], x[(i, 1)], x[(i, 2)]) * scale).as_vec3();
        let centres: Vec<[f32; 6]> = (0..n)
            .map(|i| {
                let (p, c) = (local[i].as_vec3(), row(i, 1.0 / spread));
                [p.x, p.y, p.z, c.x, c.y, c.z]
            })
            .collect();
        let origin = (middle + row(n + 3, 1.0).as_dvec3()).as_vec3();
        let affine = [
            row(n, 1.0 / spread),
            row(n + 1, 1.0 / spread),
            row(n + 2, 1.0 / spread),
            origin,
        ];
        let finite =
            centres.iter().flatten().all(|v| v.is_finite()) && affine.iter().all(|v| v.is_finite());
        if !finite {
            return Err(WarpError::Singular);
        }
        Ok(Self {
            middle: middle.as_vec3(),
            centres,
            affine,
        })
    }

    /// Where the warp takes each of `points`; both slices have one length, the shorter one counts.
    pub fn apply(&self, points: &[Vec3], out: &mut [Vec3]) {
        for (points, out) in points.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let mut at = [[0.0_f32; LANES]; 3];
            for (lane, p) in points.iter().enumerate() {
                let p = *p - self.middle;
                (at[0][lane], at[1][lane], at[2][lane]) = (p.x, p.y, p.z);
            }
            let sum = self.eight(&at);
            for (lane, out) in out.iter_mut().enumerate() {
                *out = Vec3::new(sum[0][lane], sum[1][lane], sum[2][lane]);
            }
        }
    }

    /// Where the warp takes one point.
    pub fn point(&self, point: Vec3) -> Vec3 {
        let mut out = [Vec3::ZERO];
        self.apply(&[point], &mut out);
        out[0]
    }

    /// How many point pairs define it.
    pub fn pairs(&self) -> usize {
        self.centres.len()
    }

    fn eight(&self, at: &[[f32; LANES]; 3]) -> [[f32; LANES]; 3] {
        let [rx, ry, rz, t] = self.affine;
        let mut sum = [[0.0_f32; LANES]; 3];
        for lane in 0..LANES {
            let p = rx * at[0][lane] + ry * at[1][lane] + rz * at[2][lane] + t;
            (sum[0][lane], sum[1][lane], sum[2][lane]) = (p.x, p.y, p.z);
        }
        for &[px, py, pz, cx, cy, cz] in &self.centres {
            for lane in 0..LANES {
                let (dx, dy, dz) = (at[0][lane] - px, at[1][lane] - py, at[2][lane] - pz);
                let r = (dx * dx + dy * dy + dz * dz).sqrt();
                sum[0][lane] += cx * r;
                sum[1][lane] += cy * r;
                sum[2][lane] += cz * r;
            }
        }
        sum
    }
}

fn check(from: &[Vec3], to: &[Vec3]) -> Result<(), WarpError> {
    if from.len() != to.len() {
        return Err(WarpError::Lengths {
            sources: from.len(),
            targets: to.len(),
        });
    }
    if from.len() < 4 {
        return Err(WarpError::TooFew(from.len()));
    }
    match from
        .iter()
        .zip(to)
        .position(|(p, q)| !p.is_finite() || !q.is_finite())
    {
        Some(bad) => Err(WarpError::NotFinite(bad)),
        None => Ok(()),
    }
}

/// Sorted along one axis, only neighbours need comparing.
fn distinct(points: &[DVec3], spread: f64) -> Result<(), WarpError> {
    let near = spread * COINCIDENT;
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].x.total_cmp(&points[b].x));
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..]
            .iter()
            .take_while(|&&j| points[j].x - points[i].x <= near)
        {
            if points[i].distance(points[j]) <= near {
                return Err(WarpError::Coincident(i.min(j), i.max(j)));
            }
        }
    }
    Ok(())
}

/// Whether the smallest principal extent of centred points vanishes beside the largest.
fn is_flat(points: &[DVec3]) -> bool {
    let covariance = Mat::from_fn(3, 3, |i, j| points.iter().map(|p| p[i] * p[j]).sum::<f64>());
    match covariance.self_adjoint_eigenvalues(faer::Side::Lower) {
        Ok(values) => values[0].max(0.0).sqrt() <= FLAT * values[2].max(0.0).sqrt(),
        Err(_) => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cloud(n: usize, seed: f32) -> Vec<Vec3> {
        (0..n)
            .map(|i| {
                let t = i as f32 + seed;
                Vec3::new(
                    (t * 1.7).sin() * 80.0,
                    (t * 2.9).sin() * 110.0,
                    (t * 4.3).cos() * 95.0,
                )
            })
            .collect()
    }

    #[test]
    fn it_takes_every_source_to_its_target() {
        let from = cloud(300, 0.0);
        let to: Vec<Vec3> = from
            .iter()
            .zip(cloud(300, 9.0))
            .map(|(p, q)| *p * 1.1 + q * 0.05)
            .collect();
        let warp = Warp::new(&from, &to).unwrap();
        let mut out = vec![Vec3::ZERO; from.len()];
        warp.apply(&from, &mut out);
        for (a, b) in out.iter().zip(&to) {
            assert!(a.distance(*b) < 2e-3, "{a} {b}");
        }
    }

    #[test]
    fn an_affine_map_of_the_points_is_the_same_map_of_all_space() {
        let map = glam::Affine3A::from_mat3_translation(
            glam::Mat3::from_cols(
                Vec3::new(0.9, 0.1, 0.0),
                Vec3::new(-0.2, 1.2, 0.1),
                Vec3::new(0.0, 0.3, 0.8),
            ),
            Vec3::new(10.0, -500.0, 3.0),
        );
        let from = cloud(40, 0.0);
        let to: Vec<Vec3> = from.iter().map(|p| map.transform_point3(*p)).collect();
        let warp = Warp::new(&from, &to).unwrap();
        let far = Vec3::new(300.0, -200.0, 150.0);
        assert!(warp.point(far).distance(map.transform_point3(far)) < 0.01);
    }

    #[test]
    fn give_trades_exactness_for_smoothness() {
        let from = cloud(60, 0.0);
        let mut to = from.clone();
        to[7] += Vec3::new(0.0, 8.0, 0.0);
        let exact = Warp::new(&from, &to)
            .unwrap()
            .point(from[7])
            .distance(to[7]);
        let soft = Warp::smoothed(&from, &to, &[40.0; 60])
            .unwrap()
            .point(from[7])
            .distance(to[7]);
        assert!(exact < 1e-3);
        assert!(soft > 1.0 && soft < 8.0, "{soft}");
    }

    #[test]
    fn what_defines_no_warp_is_refused_with_the_reason() {
        let from = cloud(6, 0.0);
        assert_eq!(
            Warp::new(&from[..3], &from[..3]).unwrap_err(),
            WarpError::TooFew(3)
        );
        assert_eq!(
            Warp::new(&from, &from[..4]).unwrap_err(),
            WarpError::Lengths {
                sources: 6,
                targets: 4
            }
        );
        let mut twice = from.clone();
        twice[4] = twice[1];
        assert_eq!(
            Warp::new(&twice, &from).unwrap_err(),
            WarpError::Coincident(1, 4)
        );
        let plane: Vec<Vec3> = from.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
        assert_eq!(Warp::new(&plane, &from).unwrap_err(), WarpError::Flat);
        let mut nan = from.clone();
        nan[2].y = f32::NAN;
        assert_eq!(Warp::new(&from, &nan).unwrap_err(), WarpError::NotFinite(2));
        assert_eq!(
            Warp::new(&[Vec3::ONE; 5], &from[..5]).unwrap_err(),
            WarpError::Coincident(0, 1)
        );
    }

    proptest! {
        #[test]
        fn every_lane_is_evaluated_alike(n in 1_usize..40, seed in 0.0_f32..100.0) {
            let from = cloud(20, 0.0);
            let to: Vec<Vec3> = cloud(20, 3.0);
            let warp = Warp::new(&from, &to).unwrap();
            let points = cloud(n, seed);
            let mut out = vec![Vec3::ZERO; n];
            warp.apply(&points, &mut out);
            for (p, q) in points.iter().zip(&out) {
                prop_assert_eq!(warp.point(*p), *q);
            }
        }
    }
}
