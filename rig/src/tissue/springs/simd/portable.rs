//! Four lanes of glam's, on whatever the target has (SSE2, NEON, plain floats).

use glam::{Mat4, Vec3A, Vec4};

use super::lanes::Lanes;

#[derive(Clone, Copy)]
pub(super) struct Four(Vec4);

fn columns(a: Vec3A, b: Vec3A, c: Vec3A, d: Vec3A) -> [Four; 3] {
    let whole = |v: Vec3A| v.extend(0.0);
    let rows = Mat4::from_cols(whole(a), whole(b), whole(c), whole(d)).transpose();
    [Four(rows.x_axis), Four(rows.y_axis), Four(rows.z_axis)]
}

fn rows([x, y, z]: [Four; 3]) -> [Vec3A; 4] {
    let m = Mat4::from_cols(x.0, y.0, z.0, Vec4::ZERO).transpose();
    [m.x_axis, m.y_axis, m.z_axis, m.w_axis].map(Vec3A::from_vec4)
}

impl Lanes for Four {
    const N: usize = 4;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(Vec4::splat(value))
    }

    #[inline(always)]
    fn load(from: &[f32; 16], part: usize) -> Self {
        Self(Vec4::from_slice(&from[4 * part..4 * part + 4]))
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, other: Self) -> Self {
        // Not fused: without the instruction that would be a call per lane.
        Self(self.0 * factor.0 + other.0)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        Self(Vec4::from_array(self.0.to_array().map(|v| 1.0 / v.sqrt())))
    }

    #[inline(always)]
    fn where_positive(self, sign: Self) -> Self {
        Self(Vec4::select(sign.0.cmplt(Vec4::ZERO), Vec4::ZERO, self.0))
    }

    #[inline(always)]
    unsafe fn fetch(nodes: &[Vec3A], offset: &[u32; 16], part: usize) -> [Self; 3] {
        // SAFETY: the caller's offsets are those of nodes.
        let node = |k: usize| unsafe { *nodes.as_ptr().byte_add(offset[4 * part + k] as usize) };
        columns(node(0), node(1), node(2), node(3))
    }

    #[inline(always)]
    fn own(nodes: &[Vec3A], first: usize) -> [Self; 3] {
        let n = &nodes[first..first + 4];
        columns(n[0], n[1], n[2], n[3])
    }

    #[inline(always)]
    fn kick(nodes: &mut [Vec3A], first: usize, change: [Self; 3], step: f32, keep: f32) {
        let nodes = &mut nodes[first..first + 4];
        for (node, change) in nodes.iter_mut().zip(rows(change)) {
            *node = (*node + change * step) * keep;
        }
    }

    #[inline(always)]
    fn put(nodes: &mut [Vec3A], first: usize, value: [Self; 3]) {
        nodes[first..first + 4].copy_from_slice(&rows(value));
    }
}
