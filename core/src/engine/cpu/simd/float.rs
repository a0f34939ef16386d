//! Eight single-precision numbers.

use std::ops::{Add, Div, Mul, Neg, Sub};
#[cfg(target_arch = "x86_64")]
use std::{arch::x86_64 as arch, mem::transmute as cast};

use super::{I32x8, LANES, Mask8};

/// Eight single-precision numbers. Those with `AVX2` set may be computed with only inside the AVX2
/// form of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct F32x8<const AVX2: bool>(pub(in crate::engine::cpu) [f32; LANES]);

binary!(F32x8, Add, add, 0.0, _mm256_add_ps, a, b => a + b);
binary!(F32x8, Sub, sub, 0.0, _mm256_sub_ps, a, b => a - b);
binary!(F32x8, Mul, mul, 0.0, _mm256_mul_ps, a, b => a * b);
binary!(F32x8, Div, div, 0.0, _mm256_div_ps, a, b => a / b);

impl<const AVX2: bool> Neg for F32x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        either! {
            avx2: cast(arch::_mm256_xor_ps(cast(self.0), arch::_mm256_set1_ps(-0.0))),
            lanes: Self(lanes!(0.0, i => -self.0[i])),
        }
    }
}

/// Adding it to a number below 2^22 leaves the number, rounded, in the low bits.
const ROUND: f32 = 12_582_912.0;

/// The smaller of two numbers.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl<const AVX2: bool> F32x8<AVX2> {
    pub(in crate::engine::cpu) const ZERO: Self = Self([0.0; LANES]);
    pub(in crate::engine::cpu) const ONE: Self = Self([1.0; LANES]);

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: f32) -> Self {
        Self([v; LANES])
    }

    /// The first eight numbers of a slice.
    #[inline(always)]
    pub(in crate::engine::cpu) fn load(from: &[f32]) -> Self {
        let from: &[f32; LANES] = from.first_chunk().expect("at least eight numbers");
        Self(*from)
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn store(self, to: &mut [f32]) {
        *to.first_chunk_mut().expect("room for eight numbers") = self.0;
    }

    /// The smaller number; the other's where `self` is NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn min(self, other: Self) -> Self {
        either! {
            avx2: cast(arch::_mm256_min_ps(cast(self.0), cast(other.0))),
            lanes: Self(lanes!(0.0, i => least(self.0[i], other.0[i]))),
        }
    }

    /// The larger number; the other's where `self` is NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn max(self, other: Self) -> Self {
        either! {
            avx2: cast(arch::_mm256_max_ps(cast(self.0), cast(other.0))),
            lanes: Self(lanes!(0.0, i => {
                if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }
            })),
        }
    }

    /// Within two bounds; the lower one for NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn clamp(self, low: f32, high: f32) -> Self {
        self.max(Self::splat(low)).min(Self::splat(high))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn sqrt(self) -> Self {
        either! {
            avx2: cast(arch::_mm256_sqrt_ps(cast(self.0))),
            lanes: Self(lanes!(0.0, i => self.0[i].sqrt())),
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn gt(self, other: Self) -> Mask8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_cmp_ps::<{ arch::_CMP_GT_OQ }>(cast(self.0), cast(other.0))),
            lanes: Mask8(lanes!(0, i => -i32::from(self.0[i] > other.0[i]))),
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn ge(self, other: Self) -> Mask8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_cmp_ps::<{ arch::_CMP_GE_OQ }>(cast(self.0), cast(other.0))),
            lanes: Mask8(lanes!(0, i => -i32::from(self.0[i] >= other.0[i]))),
        }
    }

    /// The nearest integer, for magnitudes below 2^22; harmless nonsense beyond.
    #[inline(always)]
    pub(in crate::engine::cpu) fn round_i32(self) -> I32x8<AVX2> {
        (self + Self::splat(ROUND)).to_bits() - I32x8::splat(ROUND.to_bits() as i32)
    }

    /// The largest integer not above, for magnitudes below 2^22; harmless nonsense beyond.
    #[inline(always)]
    pub(in crate::engine::cpu) fn floor(self) -> Self {
        let round = Self::splat(ROUND);
        let rounded = (self + round) - round;
        rounded - rounded.gt(self).select(Self::ONE, Self::ZERO)
    }

    /// The bits as integers.
    #[inline(always)]
    pub(in crate::engine::cpu) fn to_bits(self) -> I32x8<AVX2> {
        either! {
            avx2: cast(self),
            lanes: I32x8(lanes!(0, i => self.0[i].to_bits() as i32)),
        }
    }

    /// The smallest of the eight.
    #[inline(always)]
    pub(in crate::engine::cpu) fn smallest(self) -> f32 {
        either! {
            avx2: {
                let v: arch::__m256 = cast(self.0);
                let low = arch::_mm256_castps256_ps128(v);
                let half = arch::_mm_min_ps(low, arch::_mm256_extractf128_ps::<1>(v));
                let pair = arch::_mm_min_ps(half, arch::_mm_movehl_ps(half, half));
                let odd = arch::_mm_shuffle_ps::<1>(pair, pair);
                arch::_mm_cvtss_f32(arch::_mm_min_ss(pair, odd))
            },
            lanes: {
                let v = self.0;
                let half =
                    [least(v[0], v[4]), least(v[1], v[5]), least(v[2], v[6]), least(v[3], v[7])];
                least(least(half[0], half[2]), least(half[1], half[3]))
            },
        }
    }

    /// The largest of the eight.
    #[inline(always)]
    pub(in crate::engine::cpu) fn largest(self) -> f32 {
        -(-self).smallest()
    }

    /// `self` at 0, `other` at 1.
    #[inline(always)]
    pub(in crate::engine::cpu) fn mix(self, other: Self, t: Self) -> Self {
        self + (other - self) * t
    }
}
