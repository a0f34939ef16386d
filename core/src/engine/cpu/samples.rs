//! Where the samples of a pixel lie, and how those of a tile are laid out in memory.
//!
//! A *block* is 16 samples: 4x4 pixels of one sample, 2x2 of four, or one pixel of sixteen. The
//! samples of a pixel are neighbours, and so are the pixels of a block. A *pixel slot* numbers the
//! pixels of a tile in that order.

use crate::engine::pattern;

pub(super) use crate::engine::pattern::RASTER_BITS;

/// Side of a picture tile in pixels.
pub(super) const TILE: usize = 32;
/// Samples of a block.
pub(super) const BLOCK: usize = 16;
/// How `S` samples a pixel are laid out.
pub(super) struct Layout<const S: usize>;

impl<const S: usize> Layout<S> {
    /// log2 of a block's side in pixels.
    pub(super) const BLOCK_LOG2: u32 = match S {
        1 => 2,
        4 => 1,
        16 => 0,
        _ => panic!("1, 4 or 16 samples"),
    };
    /// A block's side in pixels.
    pub(super) const BLOCK_PX: i32 = 1 << Self::BLOCK_LOG2;
    /// Blocks in a row of a tile.
    pub(super) const BLOCKS_ACROSS: usize = TILE >> Self::BLOCK_LOG2;
    /// log2 of the grid that sample positions are multiples of, in raster coordinates: one pixel
    /// for a single sample, else 1/16 pixel.
    pub(super) const GRID_LOG2: u32 = if S == 1 { RASTER_BITS } else { RASTER_BITS - 4 };
    /// Raster coordinates of the grid's origin in a pixel.
    pub(super) const GRID_ORIGIN: i32 = if S == 1 { 1 << (RASTER_BITS - 1) } else { 0 };
    /// Grid steps in a pixel.
    pub(super) const GRID_PER_PX: i32 = 1 << (RASTER_BITS - Self::GRID_LOG2);
    /// Raster coordinate of the first row (and column) of samples in a pixel.
    pub(super) const FIRST_ROW: i32 = pattern::rows(S as u32).0;
    /// log2 of the distance between rows (and columns) of samples, in raster coordinates.
    pub(super) const ROW_STEP_LOG2: u32 = pattern::rows(S as u32).1;
    /// Position of each sample of a pixel in 1/16 pixel.
    /// Repeated up to sixteen.
    pub(super) const POSITIONS: [[i32; 2]; 16] = {
        let pattern = pattern::positions(S as u32);
        let mut p = [[0; 2]; 16];
        let mut i = 0;
        while i < 16 {
            p[i] = pattern[i % S];
            i += 1;
        }
        p
    };
    /// Smallest x and y, largest x and y of [`Self::POSITIONS`].
    pub(super) const EXTENT: [[i32; 2]; 2] = match S {
        1 => [[8, 8], [8, 8]],
        4 => [[2, 2], [14, 14]],
        _ => [[0, 0], [15, 15]],
    };
    /// Position of each sample of a block from the block's corner, in 1/16 pixel.
    pub(super) const BLOCK_16TH: [[i32; 2]; BLOCK] = {
        let mut p = [[0; 2]; BLOCK];
        let mut i = 0;
        while i < BLOCK {
            let pixel = (i / S) as i32;
            let side = Self::BLOCK_PX;
            p[i] = [
                pixel % side * 16 + Self::POSITIONS[i % S][0],
                pixel / side * 16 + Self::POSITIONS[i % S][1],
            ];
            i += 1;
        }
        p
    };
    /// Position in its tile of each pixel slot.
    pub(super) const SLOT_XY: [[u8; 2]; TILE * TILE] = {
        let side = Self::BLOCK_PX as usize;
        let blocks = TILE / side;
        let mut xy = [[0; 2]; TILE * TILE];
        let mut slot = 0;
        while slot < TILE * TILE {
            let (block, pixel) = (slot / (side * side), slot % (side * side));
            xy[slot] = [
                (block % blocks * side + pixel % side) as u8,
                (block / blocks * side + pixel / side) as u8,
            ];
            slot += 1;
        }
        xy
    };

    /// The slot of a pixel of a tile.
    #[inline(always)]
    pub(super) const fn slot(x: usize, y: usize) -> usize {
        let log2 = Self::BLOCK_LOG2;
        let side = 1 << log2;
        let block = (y >> log2) * (TILE >> log2) + (x >> log2);
        (block << (2 * log2)) + ((y & (side - 1)) << log2) + (x & (side - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slots_and_positions_agree<const S: usize>() {
        for y in 0..TILE {
            for x in 0..TILE {
                assert_eq!(Layout::<S>::SLOT_XY[Layout::<S>::slot(x, y)], [x as u8, y as u8]);
            }
        }
        let used = &Layout::<S>::POSITIONS[..S];
        for axis in 0..2 {
            let values: Vec<i32> = used.iter().map(|p| p[axis]).collect();
            assert_eq!(values.iter().min(), Some(&Layout::<S>::EXTENT[0][axis]));
            assert_eq!(values.iter().max(), Some(&Layout::<S>::EXTENT[1][axis]));
            for v in values {
                let from_first = v * 64 - Layout::<S>::FIRST_ROW;
                assert_eq!(from_first & ((1 << Layout::<S>::ROW_STEP_LOG2) - 1), 0);
            }
        }
    }

    #[test]
    fn layouts_are_consistent() {
        slots_and_positions_agree::<1>();
        slots_and_positions_agree::<4>();
        slots_and_positions_agree::<16>();
    }
}
