//! Logarithms and powers of eight numbers, from exactly rounded operations alone.

#[cfg(target_arch = "x86_64")]
use std::mem::transmute as cast;

use super::{F32x8, I32x8, LANES};

/// Bits of `sqrt(1/2)`: significands lie between it and `sqrt(2)`.
const ROOT_HALF: i32 = 0x3f35_04f3;

impl<const AVX2: bool> I32x8<AVX2> {
    /// The numbers that these are the bits of.
    #[inline(always)]
    fn as_f32(self) -> F32x8<AVX2> {
        either! {
            avx2: cast(self),
            lanes: F32x8(lanes!(0.0, i => f32::from_bits(self.0[i] as u32))),
        }
    }
}

impl<const AVX2: bool> F32x8<AVX2> {
    /// The logarithm to base 2 of positive normal numbers, to 1.2e-7 of the larger of it and 1:
    /// `2 artanh((m - 1) / (m + 1)) / ln 2` of the significand, as a series.
    #[inline(always)]
    pub(in crate::engine::cpu) fn log2(self) -> Self {
        let s = Self::splat;
        let bits = self.to_bits();
        let exponent = (bits - I32x8::splat(ROOT_HALF)) >> 23;
        let m = (bits - (exponent << 23)).as_f32();
        let t = (m - Self::ONE) / (m + Self::ONE);
        let t2 = t * t;
        let series = ((t2 * s(0.320_598_9) + s(0.412_198_6)) * t2 + s(0.577_078_04)) * t2;
        exponent.to_f32() + t * ((series + s(0.961_796_7)) * t2 + s(2.885_39))
    }

    /// 2 to the power of numbers in -126..=126 (others are moved there), within 3e-7 of the result.
    #[inline(always)]
    pub(in crate::engine::cpu) fn exp2(self) -> Self {
        let s = Self::splat;
        let x = self.clamp(-126.0, 126.0);
        let whole = x.round_i32();
        let f = x - whole.to_f32();
        // Of `exp(f ln 2)`, |f| at most 1/2.
        let high = ((f * s(1.540_353e-4) + s(1.333_355_8e-3)) * f + s(9.618_129e-3)) * f;
        let low = ((high + s(0.055_504_11)) * f + s(0.240_226_5)) * f + s(core::f32::consts::LN_2);
        ((whole + I32x8::splat(127)) << 23).as_f32() * (low * f + Self::ONE)
    }

    /// Positive normal numbers to a power.
    #[inline(always)]
    pub(in crate::engine::cpu) fn powf(self, exponent: f32) -> Self {
        (self.log2() * Self::splat(exponent)).exp2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_right_to_single_precision() {
        for i in 0..160_000_u32 {
            let x = f32::from_bits(0x2000_0000 + i * 9_973);
            let got = f64::from(F32x8::<false>::splat(x).log2().0[0]);
            let wanted = libm::log2(f64::from(x));
            let error = (got - wanted).abs() / wanted.abs().max(1.0);
            assert!(error < 1.2e-7, "{x}: {got} {wanted}");
        }
    }

    #[test]
    fn powers_of_two_are_right_to_three_ten_millionths() {
        for i in -126 * 512..=126 * 512 {
            let x = i as f32 / 512.0;
            let got = f64::from(F32x8::<false>::splat(x).exp2().0[0]);
            let wanted = libm::exp2(f64::from(x));
            assert!((got / wanted - 1.0).abs() < 3e-7, "{x}: {got} {wanted}");
        }
        assert_eq!(F32x8::<false>::splat(0.0).exp2(), F32x8::ONE);
    }
}
