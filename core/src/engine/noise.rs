//! Grain: the noise of a pixel, of which both engines must make the same.

/// Standard deviation of the sum of four bytes that take all values alike.
pub(super) const GRAIN_STD: f32 = 147.800_31;

/// A well mixed number: PCG (Jarzynski and Olano, "Hash functions for GPU rendering", Journal of
/// Computer Graphics Techniques 9, 2020).
#[inline(always)]
pub(super) const fn mixed(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
