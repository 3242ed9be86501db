//! Eight lanes of AVX2 with FMA; see `avx512` for how neighbours are fetched.

use std::arch::x86_64::{
    __m128, __m256, _CMP_GE_OQ, _mm_load_ps, _mm_store_ps, _mm256_and_ps, _mm256_andnot_ps,
    _mm256_castpd_ps, _mm256_castps_pd, _mm256_castps128_ps256, _mm256_castps256_ps128,
    _mm256_cmp_ps, _mm256_extractf128_ps, _mm256_fmadd_ps, _mm256_fnmadd_ps, _mm256_insertf128_ps,
    _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_mul_ps, _mm256_rsqrt_ps, _mm256_set1_ps,
    _mm256_setzero_ps, _mm256_sub_ps, _mm256_unpackhi_pd, _mm256_unpackhi_ps, _mm256_unpacklo_pd,
    _mm256_unpacklo_ps,
};

use glam::Vec3A;

use super::Mesh;
use super::kernel::{self, Kick};
use super::lanes::Lanes;
use crate::tissue::Nodes;

/// Only made by the functions below, which need the instructions: so its methods may use them.
#[derive(Clone, Copy)]
pub(super) struct Eight(__m256);

#[target_feature(enable = "avx2,fma")]
pub(super) fn kick(
    mesh: &Mesh,
    nodes: &mut Nodes,
    shift: &[Vec3A],
    gradient: &mut [Vec3A],
    kick: &Kick,
) {
    kernel::kick::<Eight>(mesh, nodes, shift, gradient, kick);
}

#[target_feature(enable = "avx2,fma")]
pub(super) fn drift(nodes: &mut Nodes, step_s: f32) {
    kernel::drift::<Eight>(nodes, step_s);
}

#[target_feature(enable = "avx2,fma")]
pub(super) fn stretch(mesh: &Mesh, nodes: &Nodes, force: &mut [Vec3A], law: [f32; 2]) {
    kernel::stretch::<Eight>(mesh, nodes, force, law);
}

/// Two nodes, one to each half.
#[inline(always)]
fn halves(node: impl Fn(usize) -> __m128) -> __m256 {
    // SAFETY: the processor has the instructions, see `Eight`.
    unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(node(0)), node(4)) }
}

/// x, y, z of eight nodes.
#[inline(always)]
fn columns(node: impl Fn(usize) -> __m128) -> [Eight; 3] {
    let r: [__m256; 4] = std::array::from_fn(|k| halves(|q| node(q + k)));
    // SAFETY: the processor has the instructions, see `Eight`.
    unsafe {
        let xy01 = _mm256_castps_pd(_mm256_unpacklo_ps(r[0], r[1]));
        let xy23 = _mm256_castps_pd(_mm256_unpacklo_ps(r[2], r[3]));
        let z01 = _mm256_castps_pd(_mm256_unpackhi_ps(r[0], r[1]));
        let z23 = _mm256_castps_pd(_mm256_unpackhi_ps(r[2], r[3]));
        [
            Eight(_mm256_castpd_ps(_mm256_unpacklo_pd(xy01, xy23))),
            Eight(_mm256_castpd_ps(_mm256_unpackhi_pd(xy01, xy23))),
            Eight(_mm256_castpd_ps(_mm256_unpacklo_pd(z01, z23))),
        ]
    }
}

/// The nodes of x, y and z: the k-th of the four holds nodes k and k + 4.
#[inline(always)]
fn rows([x, y, z]: [Eight; 3]) -> [__m256; 4] {
    // SAFETY: the processor has the instructions, see `Eight`.
    unsafe {
        let none = _mm256_setzero_ps();
        let xy01 = _mm256_castps_pd(_mm256_unpacklo_ps(x.0, y.0));
        let xy23 = _mm256_castps_pd(_mm256_unpackhi_ps(x.0, y.0));
        let z01 = _mm256_castps_pd(_mm256_unpacklo_ps(z.0, none));
        let z23 = _mm256_castps_pd(_mm256_unpackhi_ps(z.0, none));
        [
            _mm256_castpd_ps(_mm256_unpacklo_pd(xy01, z01)),
            _mm256_castpd_ps(_mm256_unpackhi_pd(xy01, z01)),
            _mm256_castpd_ps(_mm256_unpacklo_pd(xy23, z23)),
            _mm256_castpd_ps(_mm256_unpackhi_pd(xy23, z23)),
        ]
    }
}

#[inline(always)]
fn spill(nodes: &mut [Vec3A], k: usize, row: __m256) {
    let nodes = &mut nodes[..8];
    let to = nodes.as_mut_ptr().cast::<f32>();
    // SAFETY: four floats at both nodes k and k + 4, below 8; a node is aligned to 16.
    unsafe {
        _mm_store_ps(to.add(4 * k), _mm256_castps256_ps128(row));
        _mm_store_ps(to.add(4 * (k + 4)), _mm256_extractf128_ps::<1>(row));
    }
}

impl Lanes for Eight {
    const N: usize = 8;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: the processor has the instructions, see `Eight`; so in all below.
        Self(unsafe { _mm256_set1_ps(value) })
    }

    #[inline(always)]
    fn load(from: &[f32; 16], part: usize) -> Self {
        // SAFETY: eight floats, see the slice.
        Self(unsafe { _mm256_loadu_ps(from[8 * part..8 * part + 8].as_ptr()) })
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, other.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        // One step of Newton's takes the estimate's 12 bits to 23.
        // SAFETY: see `splat`.
        unsafe {
            let r = _mm256_rsqrt_ps(self.0);
            let half = _mm256_mul_ps(self.0, _mm256_set1_ps(0.5));
            let rest = _mm256_fnmadd_ps(_mm256_mul_ps(half, r), r, _mm256_set1_ps(1.5));
            Self(_mm256_mul_ps(r, rest))
        }
    }

    #[inline(always)]
    fn where_positive(self, sign: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe {
            let mask = _mm256_cmp_ps::<_CMP_GE_OQ>(sign.0, _mm256_setzero_ps());
            Self(_mm256_and_ps(mask, self.0))
        }
    }

    #[inline(always)]
    unsafe fn fetch(nodes: &[Vec3A], offset: &[u32; 16], part: usize) -> [Self; 3] {
        let (from, offset) = (nodes.as_ptr(), &offset[8 * part..8 * part + 8]);
        // SAFETY: the caller's offsets are those of nodes; a node is aligned to 16.
        columns(|k| unsafe { _mm_load_ps(from.byte_add(offset[k] as usize).cast()) })
    }

    #[inline(always)]
    fn own(nodes: &[Vec3A], first: usize) -> [Self; 3] {
        let from = nodes[first..first + 8].as_ptr();
        // SAFETY: eight nodes, see the slice.
        columns(|k| unsafe { _mm_load_ps(from.add(k).cast()) })
    }

    #[inline(always)]
    fn kick(nodes: &mut [Vec3A], first: usize, change: [Self; 3], step: f32, keep: f32) {
        let nodes = &mut nodes[first..first + 8];
        let from = nodes.as_ptr();
        // SAFETY: eight nodes, see the slice.
        let old: [__m256; 4] =
            std::array::from_fn(|k| halves(|q| unsafe { _mm_load_ps(from.add(q + k).cast()) }));
        for (k, (old, change)) in old.into_iter().zip(rows(change)).enumerate() {
            // SAFETY: see `splat`.
            let new = unsafe {
                let new = _mm256_fmadd_ps(change, _mm256_set1_ps(step), old);
                _mm256_mul_ps(new, _mm256_set1_ps(keep))
            };
            spill(nodes, k, new);
        }
    }

    #[inline(always)]
    fn put(nodes: &mut [Vec3A], first: usize, value: [Self; 3]) {
        for (k, row) in rows(value).into_iter().enumerate() {
            spill(&mut nodes[first..first + 8], k, row);
        }
    }
}
