//! Bin: which triangles of a chunk touch which tile, and which chunks do, as one list per tile.
//!
//! The table spans only the tiles that the chunk touches, so that many small chunks cost little
//! also in a large picture.

use super::chunk::Chunk;

/// Triangle indices by tile.
#[derive(Default)]
pub(super) struct Bins {
    /// First and last column, then row of the tiles that each triangle may touch.
    touched: Vec<[u16; 4]>,
    /// First and last column, then row of tiles that hold anything; first > last when none does.
    rect: [u32; 4],
    /// Where each tile's list starts, row by row within `rect`, then the end of the last.
    starts: Vec<u32>,
    /// Triangle indices, tile after tile, in draw order within each.
    list: Vec<u32>,
}

impl Bins {
    /// Forgets all triangles.
    pub(super) fn clear(&mut self) {
        self.touched.clear();
    }

    /// Adds the next triangle, with the pixels that it may touch, to square tiles of
    /// `1 << tile_log2` of them.
    #[inline(always)]
    pub(super) fn add(&mut self, pixels: &[u16; 4], tile_log2: u32) {
        self.touched.push(pixels.map(|px| px >> tile_log2));
    }

    /// Sorts the triangles that were added.
    pub(super) fn fill(&mut self) {
        let rect = self.touched.iter().fold([u16::MAX, 0, u16::MAX, 0], |r, t| {
            [r[0].min(t[0]), r[1].max(t[1]), r[2].min(t[2]), r[3].max(t[3])]
        });
        self.rect = rect.map(u32::from);
        self.starts.clear();
        self.list.clear();
        if self.touched.is_empty() {
            return;
        }
        let [left, right, top, bottom] = self.rect;
        let columns = (right - left + 1) as usize;
        let count = columns * (bottom - top + 1) as usize;
        // Counts stand two places on, so that after filling every start stands at its own place.
        self.starts.resize(count + 2, 0);
        for tiles in &self.touched {
            each_tile(tiles.map(u32::from), self.rect, |tile| self.starts[tile + 2] += 1);
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.list.resize(self.starts[count + 1] as usize, 0);
        for (index, tiles) in self.touched.iter().enumerate() {
            each_tile(tiles.map(u32::from), self.rect, |tile| {
                let at = &mut self.starts[tile + 1];
                self.list[*at as usize] = index as u32;
                *at += 1;
            });
        }
    }

    /// Calls a function with column and row of each tile that a triangle touches.
    fn each_filled(&self, mut f: impl FnMut([u32; 2])) {
        let [left, right, top, bottom] = self.rect;
        if self.list.is_empty() {
            return;
        }
        let mut ends = self.starts.windows(2);
        for y in top..bottom + 1 {
            for x in left..right + 1 {
                if ends.next().is_some_and(|pair| pair[0] < pair[1]) {
                    f([x, y]);
                }
            }
        }
    }

    /// The triangles that touch a tile, in draw order.
    #[inline]
    pub(super) fn of(&self, [x, y]: [u32; 2]) -> &[u32] {
        let [left, right, top, bottom] = self.rect;
        if x < left || x > right || y < top || y > bottom {
            return &[];
        }
        let tile = ((y - top) * (right - left + 1) + (x - left)) as usize;
        &self.list[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }
}

/// Chunk indices by tile, so that a tile need not ask all chunks.
#[derive(Default)]
pub(super) struct ChunksByTile {
    columns: u32,
    /// As in [`Bins`], for all tiles of the picture.
    starts: Vec<u32>,
    /// Chunk indices, tile after tile, in draw order within each.
    list: Vec<u32>,
}

impl ChunksByTile {
    /// Sorts the chunks of a picture of so many columns and rows of tiles.
    pub(super) fn fill(&mut self, chunks: &[Chunk], [columns, rows]: [u32; 2]) {
        self.columns = columns;
        self.starts.clear();
        self.starts.resize((columns * rows) as usize + 2, 0);
        for chunk in chunks {
            chunk.bins.each_filled(|[x, y]| self.starts[(y * columns + x) as usize + 2] += 1);
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.list.clear();
        self.list.resize(self.starts.last().map_or(0, |end| *end as usize), 0);
        for (index, chunk) in chunks.iter().enumerate() {
            chunk.bins.each_filled(|[x, y]| {
                let at = &mut self.starts[(y * columns + x) as usize + 1];
                self.list[*at as usize] = index as u32;
                *at += 1;
            });
        }
    }

    /// The chunks with triangles that touch a tile, in draw order.
    #[inline]
    pub(super) fn of(&self, [x, y]: [u32; 2]) -> &[u32] {
        let tile = (y * self.columns + x) as usize;
        &self.list[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }
}

/// Calls a function with the place, row by row within `rect`, of each of a triangle's tiles.
#[inline(always)]
fn each_tile([x0, x1, y0, y1]: [u32; 4], rect: [u32; 4], mut f: impl FnMut(usize)) {
    let columns = rect[1] - rect[0] + 1;
    if x0 == x1 && y0 == y1 {
        // As most triangles do.
        f(((y0 - rect[2]) * columns + (x0 - rect[0])) as usize);
        return;
    }
    for y in y0..y1 + 1 {
        let row = (y - rect[2]) * columns;
        for x in x0..x1 + 1 {
            f((row + (x - rect[0])) as usize);
        }
    }
}
