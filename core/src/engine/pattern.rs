//! Where the samples of a pixel lie: what both engines must agree on before anything is drawn.

/// Binary digits of a pixel in the raster's fixed-point coordinates.
pub(super) const RASTER_BITS: u32 = 10;

/// Position of the one sample in 1/16 pixel: the centre.
const ONE: [[i32; 2]; 1] = [[8, 8]];
/// A rotated grid.
const FOUR: [[i32; 2]; 4] = [[6, 2], [14, 6], [2, 10], [10, 14]];
/// Sixteen rooks: every row and every column of the 16x16 grid holds one sample. The offsets are
/// those of Direct3D's standard pattern.
const SIXTEEN: [[i32; 2]; 16] = [
    [9, 9],
    [7, 5],
    [5, 10],
    [12, 7],
    [3, 6],
    [10, 13],
    [13, 11],
    [11, 3],
    [6, 14],
    [8, 1],
    [4, 2],
    [2, 12],
    [0, 8],
    [15, 4],
    [14, 15],
    [1, 0],
];

/// Positions of the samples of a pixel in 1/16 pixel, for 1, 4 or else 16 of them.
pub(super) const fn positions(samples: u32) -> &'static [[i32; 2]] {
    match samples {
        1 => &ONE,
        4 => &FOUR,
        _ => &SIXTEEN,
    }
}

/// First row (and column) of samples of a pixel, and log2 of the distance between rows, in raster
/// coordinates.
pub(super) const fn rows(samples: u32) -> (i32, u32) {
    match samples {
        1 => (1 << (RASTER_BITS - 1), RASTER_BITS),
        4 => (2 << (RASTER_BITS - 4), RASTER_BITS - 2),
        _ => (0, RASTER_BITS - 4),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_of_the_samples_share_a_row_or_a_column() {
        for samples in [1, 4, 16] {
            for axis in 0..2 {
                let mut values: Vec<i32> = positions(samples).iter().map(|p| p[axis]).collect();
                values.sort_unstable();
                values.dedup();
                assert_eq!(values.len(), samples as usize);
                let (first, step_log2) = rows(samples);
                for (k, v) in (0..).zip(values) {
                    assert_eq!(v << (RASTER_BITS - 4), first + (k << step_log2));
                }
            }
        }
    }
}
