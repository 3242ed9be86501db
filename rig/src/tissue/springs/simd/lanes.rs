//! What the kernel asks of a vector of floats.

use glam::Vec3A;

/// A vector of [`Self::N`] floats; 16 is a multiple of N. A block's 16 values are worked on in parts.
pub(super) trait Lanes: Copy {
    const N: usize;

    fn splat(value: f32) -> Self;
    /// Part `part` of 16 values.
    fn load(from: &[f32; 16], part: usize) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `self * factor + other`.
    fn mul_add(self, factor: Self, other: Self) -> Self;
    fn abs(self) -> Self;
    fn max(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    /// 1 / sqrt, to the precision of f32 but for its last bits.
    fn rsqrt(self) -> Self;
    /// Itself where `sign` is not below 0, else 0.
    fn where_positive(self, sign: Self) -> Self;

    /// x, y, z of the nodes at these bytes from the first, of part `part`.
    ///
    /// # Safety
    /// Every offset is that of a node.
    unsafe fn fetch(nodes: &[Vec3A], offset: &[u32; 16], part: usize) -> [Self; 3];
    /// x, y, z of N nodes in a row.
    fn own(nodes: &[Vec3A], first: usize) -> [Self; 3];
    /// `(node + change * step) * keep` for N nodes in a row.
    fn kick(nodes: &mut [Vec3A], first: usize, change: [Self; 3], step: f32, keep: f32);
    /// `place + velocity * step` for N nodes in a row.
    #[inline(always)]
    fn drift(places: &mut [Vec3A], velocities: &[Vec3A], first: usize, step: f32) {
        let velocities = &velocities[first..first + Self::N];
        for (place, velocity) in places[first..first + Self::N].iter_mut().zip(velocities) {
            *place += *velocity * step;
        }
    }
    /// N nodes in a row become these.
    fn put(nodes: &mut [Vec3A], first: usize, value: [Self; 3]);
}
