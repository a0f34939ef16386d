//! Eight lanes, and the choice of instruction set at run time.
//!
//! Kernels are written once over [`F32x8`] and [`I32x8`], with the instruction set as a constant
//! parameter; the [`kernel`] macro compiles each of them twice. Without AVX2 the lanes are plain
//! arrays that the compiler vectorises as the target allows; with it, each operation is one
//! instruction, as the compiler cannot be relied on to find eight lanes again in a long kernel.
//! Only exactly rounded operations are used (no fused multiply-add, no approximate reciprocal), so
//! both give the same bits. Nothing of rendering belongs here.
//!
//! What a kernel calls must be `#[inline(always)]`: a function, or a closure, that stands alone is
//! compiled for the baseline and takes its vectors through memory.

#![allow(clippy::missing_transmute_annotations, reason = "lanes and registers, as declared")]

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Shl, Shr, Sub};
use std::sync::atomic::{AtomicU32, Ordering};

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

/// Defines a function that runs an `#[inline(always)]` body in the form that a [`Level`] names;
/// the body's first constant parameter says which.
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
                    $body::<true $($(, $c)+)?>($($arg),*)
                }
                if level.has_avx2() {
                    #[expect(unsafe_code, reason = "a function for a detected instruction set")]
                    // SAFETY: a level has AVX2 only after the processor was asked for it.
                    return unsafe { avx2 $(::<$($c),+>)? ($($arg),*) };
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _ = level;
            $body::<false $($(, $c)+)?>($($arg),*)
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

/// Eight single-precision numbers. Those with `AVX2` set may be computed with only inside the AVX2
/// form of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct F32x8<const AVX2: bool>(pub(in crate::engine::cpu) [f32; LANES]);

/// Eight 32-bit integers with wrapping arithmetic; see [`F32x8`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct I32x8<const AVX2: bool>(pub(in crate::engine::cpu) [i32; LANES]);

/// Eight truth values, all bits set or none; see [`F32x8`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct Mask8<const AVX2: bool>([i32; LANES]);

/// The AVX2 form of an operation, or its lane by lane form.
macro_rules! either {
    (avx2: $vector:expr, lanes: $lanes:expr $(,)?) => {{
        #[cfg(target_arch = "x86_64")]
        {
            if AVX2 {
                #[expect(unsafe_code, reason = "vector instructions of a detected processor")]
                // SAFETY: lanes with AVX2 set are computed with only in the AVX2 form of kernels,
                // which run only where it was detected; the types on both sides are 32 bytes of
                // numbers for which every bit pattern is valid.
                return unsafe { $vector };
            }
        }
        $lanes
    }};
}

/// Vector registers as lanes and back.
#[cfg(target_arch = "x86_64")]
use std::{arch::x86_64 as arch, mem::transmute as cast};

macro_rules! binary {
    ($t:ident, $trait:ident, $f:ident, $zero:expr, $instruction:ident, $a:ident, $b:ident => $e:expr) => {
        impl<const AVX2: bool> $trait for $t<AVX2> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, other: Self) -> Self {
                either! {
                    avx2: cast(arch::$instruction(cast(self.0), cast(other.0))),
                    lanes: Self(lanes!($zero, i => { let ($a, $b) = (self.0[i], other.0[i]); $e })),
                }
            }
        }
    };
}
binary!(F32x8, Add, add, 0.0, _mm256_add_ps, a, b => a + b);
binary!(F32x8, Sub, sub, 0.0, _mm256_sub_ps, a, b => a - b);
binary!(F32x8, Mul, mul, 0.0, _mm256_mul_ps, a, b => a * b);
binary!(F32x8, Div, div, 0.0, _mm256_div_ps, a, b => a / b);
binary!(I32x8, Add, add, 0, _mm256_add_epi32, a, b => a.wrapping_add(b));
binary!(I32x8, Sub, sub, 0, _mm256_sub_epi32, a, b => a.wrapping_sub(b));
binary!(I32x8, Mul, mul, 0, _mm256_mullo_epi32, a, b => a.wrapping_mul(b));
binary!(I32x8, BitAnd, bitand, 0, _mm256_and_si256, a, b => a & b);
binary!(I32x8, BitOr, bitor, 0, _mm256_or_si256, a, b => a | b);
binary!(Mask8, BitAnd, bitand, 0, _mm256_and_si256, a, b => a & b);
binary!(Mask8, BitOr, bitor, 0, _mm256_or_si256, a, b => a | b);

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

impl<const AVX2: bool> Shl<u32> for I32x8<AVX2> {
    type Output = Self;
    /// By less than 32 bits.
    #[inline(always)]
    fn shl(self, bits: u32) -> Self {
        either! {
            avx2: cast(arch::_mm256_sll_epi32(cast(self.0), arch::_mm_cvtsi32_si128(bits as i32))),
            lanes: Self(lanes!(0, i => self.0[i].wrapping_shl(bits))),
        }
    }
}

impl<const AVX2: bool> Shr<u32> for I32x8<AVX2> {
    type Output = Self;
    /// By less than 32 bits, keeping the sign.
    #[inline(always)]
    fn shr(self, bits: u32) -> Self {
        either! {
            avx2: cast(arch::_mm256_sra_epi32(cast(self.0), arch::_mm_cvtsi32_si128(bits as i32))),
            lanes: Self(lanes!(0, i => self.0[i].wrapping_shr(bits))),
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

impl<const AVX2: bool> I32x8<AVX2> {
    pub(in crate::engine::cpu) const ZERO: Self = Self([0; LANES]);

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: i32) -> Self {
        Self([v; LANES])
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn gt(self, other: Self) -> Mask8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_cmpgt_epi32(cast(self.0), cast(other.0))),
            lanes: Mask8(lanes!(0, i => -i32::from(self.0[i] > other.0[i]))),
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn eq(self, other: Self) -> Mask8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_cmpeq_epi32(cast(self.0), cast(other.0))),
            lanes: Mask8(lanes!(0, i => -i32::from(self.0[i] == other.0[i]))),
        }
    }

    /// The smaller number.
    #[inline(always)]
    pub(in crate::engine::cpu) fn min(self, other: Self) -> Self {
        either! {
            avx2: cast(arch::_mm256_min_epi32(cast(self.0), cast(other.0))),
            lanes: Self(lanes!(0, i => self.0[i].min(other.0[i]))),
        }
    }

    /// The larger number.
    #[inline(always)]
    pub(in crate::engine::cpu) fn max(self, other: Self) -> Self {
        either! {
            avx2: cast(arch::_mm256_max_epi32(cast(self.0), cast(other.0))),
            lanes: Self(lanes!(0, i => self.0[i].max(other.0[i]))),
        }
    }

    /// Shifts every lane by the lowest five bits of another.
    #[inline(always)]
    pub(in crate::engine::cpu) fn shl_each(self, bits: Self) -> Self {
        let bits = bits & Self::splat(31);
        either! {
            avx2: cast(arch::_mm256_sllv_epi32(cast(self.0), cast(bits.0))),
            lanes: Self(lanes!(0, i => self.0[i].wrapping_shl(bits.0[i] as u32))),
        }
    }

    /// The smaller number of two without signs.
    #[inline(always)]
    fn min_unsigned(self, other: Self) -> Self {
        either! {
            avx2: cast(arch::_mm256_min_epu32(cast(self.0), cast(other.0))),
            lanes: Self(lanes!(0, i => (self.0[i] as u32).min(other.0[i] as u32) as i32)),
        }
    }

    /// Entries of a table, which must not be empty; the last for lanes beyond its end. One load a
    /// lane: gather instructions are no faster, and much slower on processors that guard them
    /// against data sampling.
    #[inline(always)]
    fn gather<T>(self, table: &[T], load: impl Fn(&T) -> u32) -> [u32; LANES] {
        let last = table.len().checked_sub(1).expect("a table has entries");
        let at = self.min_unsigned(Self::splat(last.min(u32::MAX as usize) as u32 as i32));
        let mut entries = [0; LANES];
        let mut i = 0;
        while i < LANES {
            #[expect(unsafe_code, reason = "eight comparisons at once instead of one by one")]
            // SAFETY: no lane is above `last`, the place of the table's last entry.
            let entry = unsafe { table.get_unchecked(at.0[i] as u32 as usize) };
            entries[i] = load(entry);
            i += 1;
        }
        entries
    }

    /// As [`Self::gather`], of the bits of numbers that other threads may write meanwhile.
    #[inline(always)]
    pub(in crate::engine::cpu) fn gather_shared_f32(self, table: &[AtomicU32]) -> F32x8<AVX2> {
        let bits = self.gather(table, |entry| entry.load(Ordering::Relaxed));
        F32x8(lanes!(0.0, i => f32::from_bits(bits[i])))
    }

    /// As [`Self::gather`].
    #[inline(always)]
    pub(in crate::engine::cpu) fn gather_u32(self, table: &[u32]) -> Self {
        let entries = self.gather(table, |entry| *entry);
        Self(lanes!(0, i => entries[i] as i32))
    }

    /// Entries of a table of two or more and the entries that follow them; the last two for lanes
    /// beyond. One load of both a lane.
    #[inline(always)]
    pub(in crate::engine::cpu) fn gather_pairs(self, table: &[u32]) -> [Self; 2] {
        let last = table.len().checked_sub(2).expect("a table of pairs has two entries");
        let at = self.min_unsigned(Self::splat(last.min(u32::MAX as usize) as u32 as i32));
        let mut both = [[0; 2]; LANES];
        let mut i = 0;
        while i < LANES {
            let at = at.0[i] as u32 as usize;
            #[expect(unsafe_code, reason = "eight comparisons at once instead of one by one")]
            // SAFETY: no lane is above `last`, the place of the table's last entry but one.
            let pair = unsafe { [*table.get_unchecked(at), *table.get_unchecked(at + 1)] };
            both[i] = pair.map(|entry| entry as i32);
            i += 1;
        }
        unzipped(both)
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn to_f32(self) -> F32x8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_cvtepi32_ps(cast(self.0))),
            lanes: F32x8(lanes!(0.0, i => self.0[i] as f32)),
        }
    }
}

impl<const AVX2: bool> Mask8<AVX2> {
    pub(in crate::engine::cpu) const NONE: Self = Self([0; LANES]);

    /// The first value where set, the second elsewhere.
    #[inline(always)]
    pub(in crate::engine::cpu) fn select(
        self,
        set: F32x8<AVX2>,
        unset: F32x8<AVX2>,
    ) -> F32x8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_blendv_ps(cast(unset.0), cast(set.0), cast(self.0))),
            lanes: F32x8(lanes!(0.0, i => {
                let mask = self.0[i] as u32;
                f32::from_bits((set.0[i].to_bits() & mask) | (unset.0[i].to_bits() & !mask))
            })),
        }
    }

    /// The first value where set, the second elsewhere.
    #[inline(always)]
    pub(in crate::engine::cpu) fn select_i32(
        self,
        set: I32x8<AVX2>,
        unset: I32x8<AVX2>,
    ) -> I32x8<AVX2> {
        either! {
            avx2: cast(arch::_mm256_blendv_epi8(cast(unset.0), cast(set.0), cast(self.0))),
            lanes: I32x8(lanes!(0, i => (set.0[i] & self.0[i]) | (unset.0[i] & !self.0[i]))),
        }
    }

    /// One bit a lane, the first lane lowest.
    #[inline(always)]
    pub(in crate::engine::cpu) fn bits(self) -> u32 {
        either! {
            avx2: arch::_mm256_movemask_ps(cast(self.0)) as u32,
            lanes: {
                let mut bits = 0;
                let mut i = 0;
                while i < LANES {
                    bits |= (self.0[i] as u32 & 1) << i;
                    i += 1;
                }
                bits
            },
        }
    }

    /// The first value where set, the second elsewhere, for unsigned integers.
    #[inline(always)]
    pub(in crate::engine::cpu) fn select_u32(self, set: u32, unset: [u32; LANES]) -> [u32; LANES] {
        either! {
            avx2: {
                let set = arch::_mm256_set1_epi32(set as i32);
                cast(arch::_mm256_blendv_epi8(cast(unset), set, cast(self.0)))
            },
            lanes: lanes!(0, i => {
                let mask = self.0[i] as u32;
                (set & mask) | (unset[i] & !mask)
            }),
        }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn any(self) -> bool {
        either! {
            avx2: arch::_mm256_movemask_ps(cast(self.0)) != 0,
            lanes: {
                let m = self.0;
                ((m[0] | m[4]) | (m[1] | m[5])) | ((m[2] | m[6]) | (m[3] | m[7])) != 0
            },
        }
    }
}

/// The first and the second of eight pairs.
#[inline(always)]
pub(in crate::engine::cpu) fn unzipped<const AVX2: bool>(
    pairs: [[i32; 2]; LANES],
) -> [I32x8<AVX2>; 2] {
    either! {
        avx2: {
            // Lanes 0, 1, 4, 5 and 2, 3, 6, 7: shuffling works within halves.
            let both = |i: usize| i64::from(pairs[i][0] as u32) | i64::from(pairs[i][1]) << 32;
            let low = arch::_mm256_set_epi64x(both(5), both(4), both(1), both(0));
            let high = arch::_mm256_set_epi64x(both(7), both(6), both(3), both(2));
            let (low, high) = (cast(low), cast(high));
            [
                cast(arch::_mm256_shuffle_ps::<0b10_00_10_00>(low, high)),
                cast(arch::_mm256_shuffle_ps::<0b11_01_11_01>(low, high)),
            ]
        },
        lanes: [
            I32x8(lanes!(0, i => pairs[i][0])),
            I32x8(lanes!(0, i => pairs[i][1])),
        ],
    }
}

/// Rows to columns.
#[inline(always)]
pub(in crate::engine::cpu) fn transposed<const AVX2: bool>(
    rows: [[f32; LANES]; LANES],
) -> [F32x8<AVX2>; LANES] {
    either! {
        avx2: {
            // Halves of rows 0 and 4, 1 and 5 and so on, then 4x4 within halves.
            let r: [[arch::__m128; 2]; LANES] = cast(rows);
            let mut columns = [F32x8::ZERO; LANES];
            let mut half = 0;
            while half < 2 {
                let a = arch::_mm256_set_m128(r[4][half], r[0][half]);
                let b = arch::_mm256_set_m128(r[5][half], r[1][half]);
                let c = arch::_mm256_set_m128(r[6][half], r[2][half]);
                let d = arch::_mm256_set_m128(r[7][half], r[3][half]);
                let (ab, cd) = (arch::_mm256_unpacklo_ps(a, b), arch::_mm256_unpacklo_ps(c, d));
                let (ab2, cd2) = (arch::_mm256_unpackhi_ps(a, b), arch::_mm256_unpackhi_ps(c, d));
                columns[half * 4] = cast(arch::_mm256_shuffle_ps::<0b01_00_01_00>(ab, cd));
                columns[half * 4 + 1] = cast(arch::_mm256_shuffle_ps::<0b11_10_11_10>(ab, cd));
                columns[half * 4 + 2] = cast(arch::_mm256_shuffle_ps::<0b01_00_01_00>(ab2, cd2));
                columns[half * 4 + 3] = cast(arch::_mm256_shuffle_ps::<0b11_10_11_10>(ab2, cd2));
                half += 1;
            }
            columns
        },
        lanes: {
            let mut columns = [F32x8::ZERO; LANES];
            for (lane, row) in rows.iter().enumerate() {
                for (column, value) in columns.iter_mut().zip(row) {
                    column.0[lane] = *value;
                }
            }
            columns
        },
    }
}

/// Eight vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine::cpu) struct Vec3x8<const AVX2: bool> {
    pub(in crate::engine::cpu) x: F32x8<AVX2>,
    pub(in crate::engine::cpu) y: F32x8<AVX2>,
    pub(in crate::engine::cpu) z: F32x8<AVX2>,
}

impl<const AVX2: bool> Vec3x8<AVX2> {
    pub(in crate::engine::cpu) const ZERO: Self =
        Self { x: F32x8::ZERO, y: F32x8::ZERO, z: F32x8::ZERO };

    #[inline(always)]
    pub(in crate::engine::cpu) const fn new(
        x: F32x8<AVX2>,
        y: F32x8<AVX2>,
        z: F32x8<AVX2>,
    ) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) const fn splat(v: [f32; 3]) -> Self {
        Self { x: F32x8::splat(v[0]), y: F32x8::splat(v[1]), z: F32x8::splat(v[2]) }
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn dot(self, o: Self) -> F32x8<AVX2> {
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
    pub(in crate::engine::cpu) fn scale(self, s: F32x8<AVX2>) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }

    /// Unit length; a zero vector stays zero.
    #[inline(always)]
    pub(in crate::engine::cpu) fn normalized(self) -> Self {
        let length = self.dot(self).max(F32x8::splat(1e-30)).sqrt();
        self.scale(F32x8::ONE / length)
    }

    #[inline(always)]
    pub(in crate::engine::cpu) fn mix(self, o: Self, t: F32x8<AVX2>) -> Self {
        self + (o - self).scale(t)
    }
}

impl<const AVX2: bool> Add for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<const AVX2: bool> Sub for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<const AVX2: bool> Mul for Vec3x8<AVX2> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { x: self.x * o.x, y: self.y * o.y, z: self.z * o.z }
    }
}

#[cfg(test)]
mod tests;
