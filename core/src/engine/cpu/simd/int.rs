//! Eight integers, and look-ups by them.

use std::ops::{Add, BitAnd, BitOr, Mul, Shl, Shr, Sub};
use std::sync::atomic::{AtomicU32, Ordering};
#[cfg(target_arch = "x86_64")]
use std::{arch::x86_64 as arch, mem::transmute as cast};

use super::{F32x8, LANES, Mask8, unzipped};

/// Eight 32-bit integers with wrapping arithmetic; see [`F32x8`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct I32x8<const AVX2: bool>(pub(in crate::engine::cpu) [i32; LANES]);

binary!(I32x8, Add, add, 0, _mm256_add_epi32, a, b => a.wrapping_add(b));
binary!(I32x8, Sub, sub, 0, _mm256_sub_epi32, a, b => a.wrapping_sub(b));
binary!(I32x8, Mul, mul, 0, _mm256_mullo_epi32, a, b => a.wrapping_mul(b));
binary!(I32x8, BitAnd, bitand, 0, _mm256_and_si256, a, b => a & b);
binary!(I32x8, BitOr, bitor, 0, _mm256_or_si256, a, b => a | b);

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
