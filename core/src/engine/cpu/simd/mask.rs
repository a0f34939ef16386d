//! Eight truth values.

use std::ops::{BitAnd, BitOr};
#[cfg(target_arch = "x86_64")]
use std::{arch::x86_64 as arch, mem::transmute as cast};

use super::{F32x8, I32x8, LANES};

/// Eight truth values, all bits set or none; see [`F32x8`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(in crate::engine::cpu) struct Mask8<const AVX2: bool>(pub(super) [i32; LANES]);

binary!(Mask8, BitAnd, bitand, 0, _mm256_and_si256, a, b => a & b);
binary!(Mask8, BitOr, bitor, 0, _mm256_or_si256, a, b => a | b);

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
