//! Lanes brought into another order.

#[cfg(target_arch = "x86_64")]
use std::{arch::x86_64 as arch, mem::transmute as cast};

use super::{F32x8, I32x8, LANES};

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
