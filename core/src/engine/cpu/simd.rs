//! Eight lanes of plain arrays, and the choice of instruction set at run time.
//!
//! Kernels are written once over [`F32x8`] and [`I32x8`]; the [`kernel`] macro compiles each of
//! them twice, for the target's baseline and for AVX2, and the compiler turns the lane loops into
//! vector instructions. Only exactly rounded operations are used (no fused multiply-add, no
//! approximate reciprocal), so both give the same bits. Nothing of rendering belongs here.
//!
//! What a kernel calls must be `#[inline(always)]`: a function, or a closure, that stands alone is
//! compiled for the baseline and takes its vectors through memory.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Shl, Shr, Sub};

/// Number of lanes.
pub(in crate::engine::cpu) const LANES: usize = 8;

/// Which compiled form of the kernels runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine::cpu) struct Level {
    /// Set by detection only: running the AVX2 form on other processors is undefined.
    avx2: bool,
}

impl Level {
    /// What every processor of the target has.
    pub(in crate::engine::cpu) const BASELINE: Self = Self { avx2: false };

    /// The best form that this processor runs.
    pub(in crate::engine::cpu) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        return Self { avx2: std::arch::is_x86_feature_detected!("avx2") };
        #[cfg(not(target_arch = "x86_64"))]
        Self::BASELINE
    }

    #[cfg(target_arch = "x86_64")]
    pub(in crate::engine::cpu) const fn has_avx2(self) -> bool {
        self.avx2
    }

    pub(in crate::engine::cpu) const fn name(self) -> &'static str {
        if self.avx2 { "avx2" } else { "baseline" }
    }
}

/// Defines a function that runs an `#[inline(always)]` body in the form that a [`Level`] names.
macro_rules! kernel {
    ($(#[$meta:meta])* fn $name:ident $([$(const $c:ident: $ct:ty),+])?
     ($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? = $body:ident) => {
        $(#[$meta])*
        pub(in crate::engine::cpu) fn $name $(<$(const $c: $ct),+>)? (
            level: $crate::engine::cpu::simd::Level, $($arg: $ty),*
        ) $(-> $ret)? {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2 $(<$(const $c: $ct),+>)? ($($arg: $ty),*) $(-> $ret)? {
                    $body $(::<$($c),+>)? ($($arg),*)
                }
                if level.has_avx2() {
                    #[expect(unsafe_code, reason = "a function for a detected instruction set")]
                    // SAFETY: a level has AVX2 only after the processor was asked for it.
                    return unsafe { avx2 $(::<$($c),+>)? ($($arg),*) };
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _ = level;
            $body $(::<$($c),+>)? ($($arg),*)
        }
    };
}
pub(in crate::engine::cpu) use kernel;

/// An array whose entry `$i` is `$e`, written as a loop that the compiler vectorises.
macro_rules! lanes {
    ($zero:expr, $i:ident => $e:expr) => {{
        let mut out = [$zero; LANES];
        let mut $i = 0;
        while $i < LANES {
            out[$i] = $e;
            $i += 1;
        }
        out
    }};
}

/// Eight single-precision numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct F32x8(pub(in crate::engine::cpu) [f32; LANES]);

/// Eight 32-bit integers with wrapping arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct I32x8(pub(in crate::engine::cpu) [i32; LANES]);

/// Eight truth values, all bits set or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct Mask8([i32; LANES]);

macro_rules! binary {
    ($t:ident, $trait:ident, $f:ident, $zero:expr, $a:ident, $b:ident => $e:expr) => {
        impl $trait for $t {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                Self(lanes!($zero, i => { let ($a, $b) = (self.0[i], other.0[i]); $e }))
            }
        }
    };
}
binary!(F32x8, Add, add, 0.0, a, b => a + b);
binary!(F32x8, Sub, sub, 0.0, a, b => a - b);
binary!(F32x8, Mul, mul, 0.0, a, b => a * b);
binary!(F32x8, Div, div, 0.0, a, b => a / b);
binary!(I32x8, Add, add, 0, a, b => a.wrapping_add(b));
binary!(I32x8, Sub, sub, 0, a, b => a.wrapping_sub(b));
binary!(I32x8, Mul, mul, 0, a, b => a.wrapping_mul(b));
binary!(I32x8, BitAnd, bitand, 0, a, b => a & b);
binary!(I32x8, BitOr, bitor, 0, a, b => a | b);
binary!(Mask8, BitAnd, bitand, 0, a, b => a & b);
binary!(Mask8, BitOr, bitor, 0, a, b => a | b);

impl Neg for F32x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(lanes!(0.0, i => -self.0[i]))
    }
}

impl Shl<u32> for I32x8 {
    type Output = Self;
    #[inline(always)]
    fn shl(self, bits: u32) -> Self {
        Self(lanes!(0, i => self.0[i].wrapping_shl(bits)))
    }
}

impl Shr<u32> for I32x8 {
    type Output = Self;
    #[inline(always)]
    fn shr(self, bits: u32) -> Self {
        Self(lanes!(0, i => self.0[i].wrapping_shr(bits)))
    }
}

/// Adding it to a number below 2^22 leaves the number, rounded, in the low bits.
const ROUND: f32 = 12_582_912.0;

/// The smaller of two numbers.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

impl F32x8 {
    pub(in crate::engine::cpu) const ZERO: Self = Self([0.0; LANES]);
    pub(in crate::engine::cpu) const ONE: Self = Self([1.0; LANES]);

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: f32) -> Self {
        Self([v; LANES])
    }

    /// The first eight numbers of a slice.
    #[inline(always)]
    pub(in crate::engine::cpu) fn load(from: &[f32]) -> Self {
        let from = &from[..LANES];
        Self(lanes!(0.0, i => from[i]))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn store(self, to: &mut [f32]) {
        to[..LANES].copy_from_slice(&self.0);
    }

    /// The smaller number; the other's where `self` is NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn min(self, other: Self) -> Self {
        Self(lanes!(0.0, i => if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// The larger number; the other's where `self` is NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn max(self, other: Self) -> Self {
        Self(lanes!(0.0, i => if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// Within two bounds; the lower one for NaN.
    #[inline(always)]
    pub(in crate::engine::cpu) fn clamp(self, low: f32, high: f32) -> Self {
        self.max(Self::splat(low)).min(Self::splat(high))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn sqrt(self) -> Self {
        Self(lanes!(0.0, i => self.0[i].sqrt()))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn gt(self, other: Self) -> Mask8 {
        Mask8(lanes!(0, i => -i32::from(self.0[i] > other.0[i])))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn ge(self, other: Self) -> Mask8 {
        Mask8(lanes!(0, i => -i32::from(self.0[i] >= other.0[i])))
    }

    /// The nearest integer, for magnitudes below 2^22; harmless nonsense beyond.
    #[inline(always)]
    pub(in crate::engine::cpu) fn round_i32(self) -> I32x8 {
        I32x8(lanes!(0, i => {
            ((self.0[i] + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
        }))
    }

    /// The largest integer not above, for magnitudes below 2^22; harmless nonsense beyond.
    #[inline(always)]
    pub(in crate::engine::cpu) fn floor(self) -> Self {
        Self(lanes!(0.0, i => {
            let rounded = (self.0[i] + ROUND) - ROUND;
            rounded - if rounded > self.0[i] { 1.0 } else { 0.0 }
        }))
    }

    /// The bits as integers.
    #[inline(always)]
    pub(in crate::engine::cpu) fn to_bits(self) -> I32x8 {
        I32x8(lanes!(0, i => self.0[i].to_bits() as i32))
    }

    /// The smallest of the eight.
    #[inline(always)]
    pub(in crate::engine::cpu) fn smallest(self) -> f32 {
        let v = self.0;
        let half = [least(v[0], v[4]), least(v[1], v[5]), least(v[2], v[6]), least(v[3], v[7])];
        least(least(half[0], half[2]), least(half[1], half[3]))
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

impl I32x8 {
    pub(in crate::engine::cpu) const ZERO: Self = Self([0; LANES]);

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: i32) -> Self {
        Self([v; LANES])
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn gt(self, other: Self) -> Mask8 {
        Mask8(lanes!(0, i => -i32::from(self.0[i] > other.0[i])))
    }

    /// Shifts every lane by its own number of bits.
    #[inline(always)]
    pub(in crate::engine::cpu) fn shl_each(self, bits: Self) -> Self {
        Self(lanes!(0, i => self.0[i].wrapping_shl(bits.0[i] as u32)))
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn to_f32(self) -> F32x8 {
        F32x8(lanes!(0.0, i => self.0[i] as f32))
    }
}

impl Mask8 {
    /// The first value where set, the second elsewhere.
    #[inline(always)]
    pub(in crate::engine::cpu) fn select(self, set: F32x8, unset: F32x8) -> F32x8 {
        F32x8(lanes!(0.0, i => {
            let mask = self.0[i] as u32;
            f32::from_bits((set.0[i].to_bits() & mask) | (unset.0[i].to_bits() & !mask))
        }))
    }

    /// The first value where set, the second elsewhere, for unsigned integers.
    #[inline(always)]
    pub(in crate::engine::cpu) fn select_u32(self, set: u32, unset: [u32; LANES]) -> [u32; LANES] {
        lanes!(0, i => {
            let mask = self.0[i] as u32;
            (set & mask) | (unset[i] & !mask)
        })
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn any(self) -> bool {
        let m = self.0;
        ((m[0] | m[4]) | (m[1] | m[5])) | ((m[2] | m[6]) | (m[3] | m[7])) != 0
    }
}

/// Eight vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine::cpu) struct Vec3x8 {
    pub(in crate::engine::cpu) x: F32x8,
    pub(in crate::engine::cpu) y: F32x8,
    pub(in crate::engine::cpu) z: F32x8,
}

impl Vec3x8 {
    pub(in crate::engine::cpu) const ZERO: Self =
        Self { x: F32x8::ZERO, y: F32x8::ZERO, z: F32x8::ZERO };

    #[inline(always)]
    pub(in crate::engine::cpu) const fn new(x: F32x8, y: F32x8, z: F32x8) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: [f32; 3]) -> Self {
        Self { x: F32x8::splat(v[0]), y: F32x8::splat(v[1]), z: F32x8::splat(v[2]) }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn dot(self, o: Self) -> F32x8 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn cross(self, o: Self) -> Self {
        Self {
            x: self.y * o.z - self.z * o.y,
            y: self.z * o.x - self.x * o.z,
            z: self.x * o.y - self.y * o.x,
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn scale(self, s: F32x8) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }

    /// Unit length; a zero vector stays zero.
    #[inline(always)]
    pub(in crate::engine::cpu) fn normalized(self) -> Self {
        let length = self.dot(self).max(F32x8::splat(1e-30)).sqrt();
        self.scale(F32x8::ONE / length)
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn mix(self, o: Self, t: F32x8) -> Self {
        self + (o - self).scale(t)
    }
}

impl Add for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl Sub for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl Mul for Vec3x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { x: self.x * o.x, y: self.y * o.y, z: self.z * o.z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_and_floor_are_exact_on_both_sides_of_zero() {
        let v = F32x8([-2.5, -1.0, -0.25, 0.0, 0.25, 1.75, 4_000_000.0, -4_000_000.0]);
        assert_eq!(v.floor().0, [-3.0, -1.0, -1.0, 0.0, 0.0, 1.0, 4_000_000.0, -4_000_000.0]);
        assert_eq!(v.round_i32().0, [-2, -1, 0, 0, 0, 2, 4_000_000, -4_000_000]);
    }

    #[test]
    fn clamping_turns_nan_into_the_lower_bound() {
        assert_eq!(F32x8::splat(f32::NAN).clamp(0.0, 1.0), F32x8::ZERO);
    }

    #[test]
    fn smallest_and_largest_look_at_every_lane() {
        for lane in 0..LANES {
            let mut v = [0.5; LANES];
            v[lane] = -3.0;
            assert_eq!(F32x8(v).smallest(), -3.0);
            v[lane] = 7.0;
            assert_eq!(F32x8(v).largest(), 7.0);
        }
    }
}
