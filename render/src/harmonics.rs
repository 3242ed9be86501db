//! Light from all round as spherical harmonics of order 2, nine numbers a colour (Ramamoorthi and Hanrahan,
//! *An Efficient Representation for Irradiance Environment Maps*, 2001).
//!
//! Kept as moments instead of the usual Y_lm, which is the same space without a pole: the mean of the light, the
//! mean of light times direction, and the mean of light times `(3 d d^T - 1) / 2`. What a white matte surface facing `n` returns is then
//! `mean + 2 n . first + 5/4 n . second n` (their A_l over pi are 1, 2/3 and 1/4, times 2 l + 1). Says nothing of where the light comes
//! from; that is `environment` and `studio`.

use glam::{Mat3, Vec3, Vec4};

/// One colour's moments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moments {
    mean: f32,
    first: Vec3,
    /// Symmetric, without trace.
    second: Second,
}

/// A matrix that is zero by default, as a sum begins.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Second(Mat3);

impl Default for Second {
    fn default() -> Self {
        Self(Mat3::ZERO)
    }
}

/// Light from all round, linear RGB.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Harmonics([Moments; 3]);

impl Harmonics {
    /// The same light from everywhere.
    pub(crate) fn uniform(colour: Vec3) -> Self {
        let mut all = Self::default();
        for (moments, light) in all.0.iter_mut().zip(colour.to_array()) {
            moments.mean = light;
        }
        all
    }

    /// Adds light that comes from one direction (unit length); `share` is the part of the whole sphere that it fills.
    pub(crate) fn add(&mut self, direction: Vec3, light: Vec3, share: f32) {
        let second = (outer(direction) * 3.0 - Mat3::IDENTITY) * 0.5;
        for (moments, light) in self.0.iter_mut().zip((light * share).to_array()) {
            moments.mean += light;
            moments.first += direction * light;
            moments.second.0 += second * light;
        }
    }

    /// Adds another light.
    pub(crate) fn add_all(&mut self, other: &Self) {
        for (moments, more) in self.0.iter_mut().zip(&other.0) {
            moments.mean += more.mean;
            moments.first += more.first;
            moments.second.0 += more.second.0;
        }
    }

    /// Adds a disc of light round a direction, as far as `half_angle` (radians) from it.
    pub(crate) fn add_disc(&mut self, direction: Vec3, light: Vec3, half_angle: f32) {
        let c = half_angle.cos();
        let second = (outer(direction) * 3.0 - Mat3::IDENTITY) * 0.5;
        for (moments, light) in self.0.iter_mut().zip(light.to_array()) {
            moments.mean += light * (1.0 - c) / 2.0;
            moments.first += direction * (light * (1.0 - c * c) / 4.0);
            moments.second.0 += second * (light * (c - c * c * c) / 4.0);
        }
    }

    /// The mean over all directions, linear RGB.
    pub(crate) fn mean(&self) -> Vec3 {
        Vec3::from(self.0.map(|m| m.mean))
    }

    /// All of it times `factor`.
    pub(crate) fn scaled(mut self, factor: f32) -> Self {
        for moments in &mut self.0 {
            moments.mean *= factor;
            moments.first *= factor;
            moments.second.0 *= factor;
        }
        self
    }

    /// The room turned about the upright axis by `yaw`, radians, from front towards the subject's left.
    pub(crate) fn turned(mut self, yaw: f32) -> Self {
        let turn = Mat3::from_rotation_y(yaw);
        for moments in &mut self.0 {
            moments.first = turn * moments.first;
            moments.second.0 = turn * moments.second.0 * turn.transpose();
        }
        self
    }

    /// What a white matte surface that faces `n` (unit length) returns. The shader's `ambient_from`, on the processor.
    pub(crate) fn returned(&self, n: Vec3) -> Vec3 {
        let one = |m: &Moments| m.mean + 2.0 * n.dot(m.first) + 1.25 * n.dot(m.second.0 * n);
        Vec3::from([one(&self.0[0]), one(&self.0[1]), one(&self.0[2])])
    }

    /// As shaders/light.wgsl multiplies it: a row a colour for (x, y, z, 1), a row a colour for (xy, yz, zz, zx), and
    /// the three colours' factors of xx - yy.
    pub(crate) fn rows(&self) -> [[f32; 4]; 7] {
        let mut rows = [[0.0; 4]; 7];
        for (c, m) in self.0.iter().enumerate() {
            let q = m.second.0 * 1.25;
            let (xx, yy, zz) = (q.x_axis.x, q.y_axis.y, q.z_axis.z);
            // On the unit sphere xx + yy is 1 - zz, which leaves one number for the three squares' common part.
            let level = (xx + yy) * 0.5;
            rows[c] = (m.first * 2.0).extend(m.mean + level).to_array();
            let crossed = Vec4::new(
                2.0 * q.x_axis.y,
                2.0 * q.y_axis.z,
                zz - level,
                2.0 * q.x_axis.z,
            );
            rows[3 + c] = crossed.to_array();
            rows[6][c] = (xx - yy) * 0.5;
        }
        rows
    }
}

fn outer(d: Vec3) -> Mat3 {
    Mat3::from_cols(d * d.x, d * d.y, d * d.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// As the shader does it.
    fn shaded(rows: &[[f32; 4]; 7], n: Vec3) -> Vec3 {
        let v = n.extend(1.0);
        let q = Vec4::new(n.x * n.y, n.y * n.z, n.z * n.z, n.z * n.x);
        let one = |c: usize| {
            Vec4::from(rows[c]).dot(v)
                + Vec4::from(rows[3 + c]).dot(q)
                + rows[6][c] * (n.x * n.x - n.y * n.y)
        };
        Vec3::new(one(0), one(1), one(2))
    }

    fn unit() -> impl Strategy<Value = Vec3> {
        (-1.0_f32..1.0, 0.0_f32..std::f32::consts::TAU).prop_map(|(y, turn)| {
            let r = (1.0 - y * y).sqrt();
            Vec3::new(r * turn.cos(), y, r * turn.sin())
        })
    }

    /// A thousand directions, evenly spread (Fibonacci's spiral).
    fn directions() -> impl Iterator<Item = Vec3> {
        (0..1000).map(|i| {
            let y = 1.0 - (i as f32 + 0.5) / 500.0;
            let turn = i as f32 * 2.399_963;
            let r = (1.0 - y * y).sqrt();
            Vec3::new(r * turn.cos(), y, r * turn.sin())
        })
    }

    /// Of a hemisphere of light the nine numbers are exact: all, half and none of it.
    #[test]
    fn light_from_one_side_falls_to_half_across_and_to_none_behind() {
        let side = Vec3::new(0.48, 0.6, 0.64);
        let mut light = Harmonics::default();
        light.add_disc(side, Vec3::ONE, std::f32::consts::FRAC_PI_2);
        for (n, wanted) in [
            (side, 1.0),
            (side.any_orthonormal_vector(), 0.5),
            (-side, 0.0),
        ] {
            let got = light.returned(n);
            assert!(
                (got - Vec3::splat(wanted)).abs().max_element() < 1e-5,
                "{n}: {got}"
            );
        }
    }

    proptest! {
        /// Against the sum over all directions of light times cosine: order 2 is within a few hundredths (their paper: 9 % at most).
        #[test]
        fn what_a_surface_returns_is_near_the_whole_integral(from in unit(), n in unit(), half in 0.5_f32..2.5) {
            let mut light = Harmonics::default();
            light.add_disc(from, Vec3::new(1.0, 0.5, 0.25), half);
            let whole: f32 = directions()
                .map(|d| f32::from(u8::from(d.dot(from) > half.cos())) * d.dot(n).max(0.0))
                .sum::<f32>() * 4.0 / 1000.0;
            let got = light.returned(n);
            prop_assert!((got.x - whole).abs() < 0.07, "{} for {whole}", got.x);
            prop_assert!((got.y * 2.0 - got.x).abs() < 1e-5 && (got.z * 4.0 - got.x).abs() < 1e-5);
        }

        #[test]
        fn sums_of_directions_are_discs_and_rows_are_what_they_stand_for(from in unit(), n in unit(), half in 0.3_f32..3.0) {
            let (mut disc, mut sum) = (Harmonics::default(), Harmonics::default());
            disc.add_disc(from, Vec3::ONE, half);
            directions().filter(|d| d.dot(from) > half.cos()).for_each(|d| sum.add(d, Vec3::ONE, 1e-3));
            prop_assert!((disc.returned(n) - sum.returned(n)).abs().max_element() < 0.02);
            prop_assert!((disc.returned(n) - shaded(&disc.rows(), n)).abs().max_element() < 1e-5);
        }

        #[test]
        fn a_turned_room_lights_a_turned_surface_alike(from in unit(), n in unit(), yaw in -4.0_f32..4.0) {
            let mut light = Harmonics::uniform(Vec3::splat(0.1));
            light.add_disc(from, Vec3::ONE, 0.8);
            let turn = Mat3::from_rotation_y(yaw);
            let apart = light.returned(n) - light.turned(yaw).returned(turn * n);
            prop_assert!(apart.abs().max_element() < 1e-5);
        }
    }
}
