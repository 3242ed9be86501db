//! Sixteen lanes of AVX-512F.
//!
//! A node is four floats, so a neighbour comes in one load of 128 bits, and four loads of four neighbours
//! are turned within their lanes into x, y and z. On processors whose gather is microcode (AMD Zen) that is
//! twice as fast as three gathers; elsewhere no slower.

use std::arch::x86_64::{
    __m128, __m512, _CMP_GE_OQ, _mm_load_ps, _mm_store_ps, _mm512_abs_ps, _mm512_castpd_ps,
    _mm512_castps_pd, _mm512_castps128_ps512, _mm512_castps512_ps128, _mm512_cmp_ps_mask,
    _mm512_extractf32x4_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps, _mm512_insertf32x4, _mm512_loadu_ps,
    _mm512_maskz_mov_ps, _mm512_max_ps, _mm512_min_ps, _mm512_mul_ps, _mm512_rsqrt14_ps,
    _mm512_set1_ps, _mm512_setzero_ps, _mm512_storeu_ps, _mm512_sub_ps, _mm512_unpackhi_pd,
    _mm512_unpackhi_ps, _mm512_unpacklo_pd, _mm512_unpacklo_ps,
};

use glam::Vec3A;

use super::Mesh;
use super::kernel::{self, Kick};
use super::lanes::Lanes;
use crate::tissue::Nodes;

/// Only made by the functions below, which need the instructions: so its methods may use them.
#[derive(Clone, Copy)]
pub(super) struct Sixteen(__m512);

#[target_feature(enable = "avx512f")]
pub(super) fn kick(
    mesh: &Mesh,
    nodes: &mut Nodes,
    shift: &[Vec3A],
    gradient: &mut [Vec3A],
    kick: &Kick,
) {
    kernel::kick::<Sixteen>(mesh, nodes, shift, gradient, kick);
}

#[target_feature(enable = "avx512f")]
pub(super) fn drift(nodes: &mut Nodes, step_s: f32) {
    kernel::drift::<Sixteen>(nodes, step_s);
}

#[target_feature(enable = "avx512f")]
pub(super) fn stretch(mesh: &Mesh, nodes: &Nodes, force: &mut [Vec3A], law: [f32; 2]) {
    kernel::stretch::<Sixteen>(mesh, nodes, force, law);
}

/// Four nodes, one to each quarter.
#[inline(always)]
fn quarters(node: impl Fn(usize) -> __m128) -> __m512 {
    // SAFETY: the processor has the instructions, see `Sixteen`.
    unsafe {
        let q = _mm512_castps128_ps512(node(0));
        let q = _mm512_insertf32x4::<1>(q, node(4));
        let q = _mm512_insertf32x4::<2>(q, node(8));
        _mm512_insertf32x4::<3>(q, node(12))
    }
}

/// x, y, z of sixteen nodes.
#[inline(always)]
fn columns(node: impl Fn(usize) -> __m128) -> [Sixteen; 3] {
    let r: [__m512; 4] = std::array::from_fn(|k| quarters(|q| node(q + k)));
    // SAFETY: the processor has the instructions, see `Sixteen`.
    unsafe {
        let xy01 = _mm512_castps_pd(_mm512_unpacklo_ps(r[0], r[1]));
        let xy23 = _mm512_castps_pd(_mm512_unpacklo_ps(r[2], r[3]));
        let z01 = _mm512_castps_pd(_mm512_unpackhi_ps(r[0], r[1]));
        let z23 = _mm512_castps_pd(_mm512_unpackhi_ps(r[2], r[3]));
        [
            Sixteen(_mm512_castpd_ps(_mm512_unpacklo_pd(xy01, xy23))),
            Sixteen(_mm512_castpd_ps(_mm512_unpackhi_pd(xy01, xy23))),
            Sixteen(_mm512_castpd_ps(_mm512_unpacklo_pd(z01, z23))),
        ]
    }
}

/// The nodes of x, y and z: the k-th of the four holds nodes k, k + 4, k + 8 and k + 12.
#[inline(always)]
fn rows([x, y, z]: [Sixteen; 3]) -> [__m512; 4] {
    // SAFETY: the processor has the instructions, see `Sixteen`.
    unsafe {
        let none = _mm512_setzero_ps();
        let xy01 = _mm512_castps_pd(_mm512_unpacklo_ps(x.0, y.0));
        let xy23 = _mm512_castps_pd(_mm512_unpackhi_ps(x.0, y.0));
        let z01 = _mm512_castps_pd(_mm512_unpacklo_ps(z.0, none));
        let z23 = _mm512_castps_pd(_mm512_unpackhi_ps(z.0, none));
        [
            _mm512_castpd_ps(_mm512_unpacklo_pd(xy01, z01)),
            _mm512_castpd_ps(_mm512_unpackhi_pd(xy01, z01)),
            _mm512_castpd_ps(_mm512_unpacklo_pd(xy23, z23)),
            _mm512_castpd_ps(_mm512_unpackhi_pd(xy23, z23)),
        ]
    }
}

#[inline(always)]
fn spill(nodes: &mut [Vec3A], k: usize, row: __m512) {
    let nodes = &mut nodes[..16];
    let to = nodes.as_mut_ptr().cast::<f32>();
    // SAFETY: four floats at each of nodes k, k + 4, k + 8, k + 12, all below 16; a node is aligned to 16.
    unsafe {
        _mm_store_ps(to.add(4 * k), _mm512_castps512_ps128(row));
        _mm_store_ps(to.add(4 * (k + 4)), _mm512_extractf32x4_ps::<1>(row));
        _mm_store_ps(to.add(4 * (k + 8)), _mm512_extractf32x4_ps::<2>(row));
        _mm_store_ps(to.add(4 * (k + 12)), _mm512_extractf32x4_ps::<3>(row));
    }
}

impl Lanes for Sixteen {
    const N: usize = 16;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: the processor has the instructions, see `Sixteen`; so in all below.
        Self(unsafe { _mm512_set1_ps(value) })
    }

    #[inline(always)]
    fn load(from: &[f32; 16], _part: usize) -> Self {
        // SAFETY: sixteen floats.
        Self(unsafe { _mm512_loadu_ps(from.as_ptr()) })
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_sub_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, other.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_abs_ps(self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        // One step of Newton's takes the estimate's 14 bits to those of an f32.
        // SAFETY: see `splat`.
        unsafe {
            let r = _mm512_rsqrt14_ps(self.0);
            let half = _mm512_mul_ps(self.0, _mm512_set1_ps(0.5));
            let rest = _mm512_fnmadd_ps(_mm512_mul_ps(half, r), r, _mm512_set1_ps(1.5));
            Self(_mm512_mul_ps(r, rest))
        }
    }

    #[inline(always)]
    fn where_positive(self, sign: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe {
            let mask = _mm512_cmp_ps_mask::<_CMP_GE_OQ>(sign.0, _mm512_setzero_ps());
            Self(_mm512_maskz_mov_ps(mask, self.0))
        }
    }

    #[inline(always)]
    unsafe fn fetch(nodes: &[Vec3A], offset: &[u32; 16], _part: usize) -> [Self; 3] {
        let from = nodes.as_ptr();
        // SAFETY: the caller's offsets are those of nodes; a node is aligned to 16.
        columns(|k| unsafe { _mm_load_ps(from.byte_add(offset[k] as usize).cast()) })
    }

    #[inline(always)]
    fn own(nodes: &[Vec3A], first: usize) -> [Self; 3] {
        let from = nodes[first..first + 16].as_ptr();
        // SAFETY: sixteen nodes, see the slice.
        columns(|k| unsafe { _mm_load_ps(from.add(k).cast()) })
    }

    #[inline(always)]
    fn kick(nodes: &mut [Vec3A], first: usize, change: [Self; 3], step: f32, keep: f32) {
        let nodes = &mut nodes[first..first + 16];
        let from = nodes.as_ptr();
        // SAFETY: sixteen nodes, see the slice.
        let old: [__m512; 4] =
            std::array::from_fn(|k| quarters(|q| unsafe { _mm_load_ps(from.add(q + k).cast()) }));
        for (k, (old, change)) in old.into_iter().zip(rows(change)).enumerate() {
            // SAFETY: see `splat`.
            let new = unsafe {
                let new = _mm512_fmadd_ps(change, _mm512_set1_ps(step), old);
                _mm512_mul_ps(new, _mm512_set1_ps(keep))
            };
            spill(nodes, k, new);
        }
    }

    #[inline(always)]
    fn drift(places: &mut [Vec3A], velocities: &[Vec3A], first: usize, step: f32) {
        let to = places[first..first + 16].as_mut_ptr().cast::<f32>();
        let from = velocities[first..first + 16].as_ptr().cast::<f32>();
        for k in 0..4 {
            // SAFETY: sixteen nodes of four floats, see the slices.
            unsafe {
                let place = _mm512_loadu_ps(to.add(16 * k));
                let velocity = _mm512_loadu_ps(from.add(16 * k));
                let place = _mm512_fmadd_ps(velocity, _mm512_set1_ps(step), place);
                _mm512_storeu_ps(to.add(16 * k), place);
            }
        }
    }

    #[inline(always)]
    fn put(nodes: &mut [Vec3A], first: usize, value: [Self; 3]) {
        for (k, row) in rows(value).into_iter().enumerate() {
            spill(&mut nodes[first..first + 16], k, row);
        }
    }
}
