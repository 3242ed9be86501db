//! What the kernel asks of a vector of floats.

use glam::Vec3A;

/// A vector of [`Self::N`] floats; 16 is a multiple of N. A block's 16 values are worked on in parts.
pub(super) trait Lanes: Copy {
    const N: usize;

    fn splat(value: f32) -> Self;
    /// Part `part` of 16 values.
    fn load(from: &[f32; 16], part: usize) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `self * factor + other`.
    fn mul_add(self, factor: Self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// 1 / sqrt, to the precision of f32 but for its last bits.
    fn rsqrt(self) -> Self;
    /// Itself where `sign` is not below 0, else 0.
    fn where_positive(self, sign: Self) -> Self;

    /// x, y, z of the nodes that part `part` of `index` names.
    ///
    /// # Safety
    /// Every index is below the number of nodes.
    unsafe fn fetch(nodes: &[Vec3A], index: &[u32; 16], part: usize) -> [Self; 3];
    /// x, y, z of N nodes in a row.
    fn own(nodes: &[Vec3A], first: usize) -> [Self; 3];
    /// `(node + change * step) * keep` for N nodes in a row.
    fn kick(nodes: &mut [Vec3A], first: usize, change: [Self; 3], step: f32, keep: f32);
    /// N nodes in a row become these.
    fn put(nodes: &mut [Vec3A], first: usize, value: [Self; 3]);
}
