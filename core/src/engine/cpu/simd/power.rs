//! Logarithms and powers of eight numbers, from exactly rounded operations alone.

#[cfg(target_arch = "x86_64")]
use std::mem::transmute as cast;

use super::{F32x8, I32x8, LANES};

/// Bits of `sqrt(1/2)`: significands lie between it and `sqrt(2)`.
const ROOT_HALF: i32 = 0x3f35_04f3;

impl<const AVX2: bool> I32x8<AVX2> {
    /// The numbers that these are the bits of.
    #[inline(always)]
    pub(in crate::engine::cpu) fn as_f32(self) -> F32x8<AVX2> {
        either! {
            avx2: cast(self),
            lanes: F32x8(lanes!(0.0, i => f32::from_bits(self.0[i] as u32))),
        }
    }
}

impl<const AVX2: bool> F32x8<AVX2> {
    /// The logarithm to base 2 of positive normal numbers, to 2.3e-6 and one step of single
    /// precision: a polynomial of the significand, fitted for the least largest error.
    #[inline(always)]
    pub(in crate::engine::cpu) fn log2(self) -> Self {
        let s = Self::splat;
        let bits = self.to_bits();
        let exponent = (bits - I32x8::splat(ROOT_HALF)) >> 23;
        let f = (bits - (exponent << 23)).as_f32() - Self::ONE;
        let high = (f * s(-0.206_589_76) + s(0.322_154_34)) * f + s(-0.367_490_3);
        let low = (high * f + s(0.479_348_06)) * f + s(-0.721_131_86);
        exponent.to_f32() + (low * f + s(1.442_713_5)) * f
    }

    /// 2 to the power of numbers in -126..=126, within 4e-6 of the result; harmless nonsense beyond.
    #[inline(always)]
    pub(in crate::engine::cpu) fn exp2(self) -> Self {
        let s = Self::splat;
        let whole = self.round_i32();
        let f = self - whole.to_f32();
        let high = (f * s(9.681_713e-3) + s(0.055_919_767)) * f + s(0.240_220_25);
        ((whole + I32x8::splat(127)) << 23).as_f32() * ((high * f + s(0.693_121_5)) * f + Self::ONE)
    }

    /// Positive normal numbers to a power, where that lies in 2^-126..=2^126.
    #[inline(always)]
    pub(in crate::engine::cpu) fn powf(self, exponent: f32) -> Self {
        (self.log2() * Self::splat(exponent)).exp2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_right_to_a_few_millionths() {
        for i in 0..160_000_u32 {
            let x = f32::from_bits(0x2000_0000 + i * 9_973);
            let got = f64::from(F32x8::<false>::splat(x).log2().0[0]);
            let wanted = libm::log2(f64::from(x));
            let error = (got - wanted).abs() - 1.2e-7 * wanted.abs();
            assert!(error < 2.3e-6, "{x}: {got} {wanted}");
        }
    }

    #[test]
    fn powers_of_two_are_right_to_four_millionths() {
        for i in -126 * 512..=126 * 512 {
            let x = i as f32 / 512.0;
            let got = f64::from(F32x8::<false>::splat(x).exp2().0[0]);
            let wanted = libm::exp2(f64::from(x));
            assert!((got / wanted - 1.0).abs() < 4e-6, "{x}: {got} {wanted}");
        }
        assert_eq!(F32x8::<false>::splat(0.0).exp2(), F32x8::ONE);
    }
}
