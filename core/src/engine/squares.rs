//! Behind a lens: which part of the picture may show what stands in a rectangle of the plane.
//!
//! The plane is divided into cells of 16 pixels. Each names the columns and rows of the squares of
//! the picture with samples in it; coarser levels join two by two cells, so that a rectangle of any
//! size looks up four. The answer may be too large, never too small.

use super::lens::SQUARE;
use super::pattern::RASTER_BITS;

/// log2 of a cell's side in pixels of the plane.
const CELL_LOG2: u32 = 4;

/// First and last column, then row of squares; first > last where there is none.
pub(super) type Span = [u16; 4];

/// No square.
const NONE: Span = [u16::MAX, 0, u16::MAX, 0];

/// Squares by cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Squares {
    /// Level by level, the finest first: row by row within each.
    pub(super) cells: Vec<Span>,
    /// Where each level starts, and its columns.
    pub(super) levels: Vec<[u32; 2]>,
}

impl Squares {
    /// From the least x and y and the largest x and y of the samples of each square, raster units of
    /// a plane of so many pixels; `columns` of squares make a row.
    pub(super) fn new(plane_px: [u32; 2], columns: usize, samples: &[[i32; 4]]) -> Self {
        let mut size = plane_px.map(|px| px.div_ceil(1 << CELL_LOG2));
        let mut cells = vec![NONE; (size[0] * size[1]) as usize];
        let cell = |raster: i32| (raster >> (RASTER_BITS + CELL_LOG2)) as u32;
        for (index, rect) in samples.iter().enumerate() {
            let [column, row] = [(index % columns) as u16, (index / columns) as u16];
            let [x0, y0, x1, y1] = rect.map(cell);
            for y in y0..=y1 {
                for x in x0..=x1 {
                    let at = (y * size[0] + x) as usize;
                    cells[at] = joined(cells[at], [column, column, row, row]);
                }
            }
        }
        let mut levels = vec![[0, size[0]]];
        while size != [1, 1] {
            let [start, across] = levels[levels.len() - 1];
            let finer = size;
            size = size.map(|side| side.div_ceil(2));
            levels.push([cells.len() as u32, size[0]]);
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let mut all = NONE;
                    for (x, y) in
                        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (2 * x + i, 2 * y + j))
                    {
                        if x < finer[0] && y < finer[1] {
                            all = joined(all, cells[(start + y * across + x) as usize]);
                        }
                    }
                    cells.push(all);
                }
            }
        }
        Self { cells, levels }
    }

    /// Columns and rows of squares with samples in a rectangle of the plane: first and last pixel in
    /// x, then in y, which lie in the plane.
    #[inline(always)]
    pub(super) fn of(&self, [x0, x1, y0, y1]: [u16; 4]) -> Span {
        let [x0, x1, y0, y1] = [x0, x1, y0, y1].map(|px| u32::from(px) >> CELL_LOG2);
        // At the level where the ends are the same or neighbours.
        let apart = (x1 - x0).max(y1 - y0);
        let mut level = 32 - apart.leading_zeros();
        level = level.saturating_sub(1);
        let touching = |a: u32, b: u32, level: u32| (b >> level) - (a >> level) <= 1;
        if !(touching(x0, x1, level) && touching(y0, y1, level)) {
            level += 1;
        }
        let [start, across] = self.levels[(level as usize).min(self.levels.len() - 1)];
        let at =
            |x: u32, y: u32| self.cells[(start + (y >> level) * across + (x >> level)) as usize];
        joined(joined(at(x0, y0), at(x1, y0)), joined(at(x0, y1), at(x1, y1)))
    }

    /// As [`Self::of`], in pixels of a picture.
    #[inline(always)]
    pub(super) fn pixels_of(&self, plane: [u16; 4]) -> Option<[u16; 4]> {
        let [x0, x1, y0, y1] = self.of(plane);
        let side = SQUARE as u16;
        let last = side - 1;
        (x0 <= x1).then(|| [x0 * side, x1 * side + last, y0 * side, y1 * side + last])
    }
}

/// The span that holds two.
#[inline(always)]
const fn joined(a: Span, b: Span) -> Span {
    const fn least(a: u16, b: u16) -> u16 {
        if a < b { a } else { b }
    }
    const fn most(a: u16, b: u16) -> u16 {
        if a > b { a } else { b }
    }
    [least(a[0], b[0]), most(a[1], b[1]), least(a[2], b[2]), most(a[3], b[3])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of a picture whose samples lie in the plane as they are, but for a margin.
    fn plain(columns: usize, rows: usize) -> Squares {
        let samples: Vec<[i32; 4]> = (0..columns * rows)
            .map(|i| {
                let [x, y] = [i % columns, i / columns].map(|v| (v as i32 * 8 + 3) << RASTER_BITS);
                [x, y, x + (7 << RASTER_BITS), y + (7 << RASTER_BITS)]
            })
            .collect();
        Squares::new([columns as u32 * 8 + 6, rows as u32 * 8 + 6], columns, &samples)
    }

    #[test]
    fn rectangles_of_all_sizes_find_their_squares() {
        let squares = plain(70, 33);
        for (x0, x1) in [(0, 565), (3, 3), (31, 32), (100, 110), (160, 400), (565, 565)] {
            for (y0, y1) in [(0, 0), (5, 269), (47, 49), (100, 164)] {
                let [c0, c1, r0, r1] = squares.of([x0, x1, y0, y1]);
                let square = |px: u16| (px.max(3) - 3) / 8;
                assert!(c0 <= square(x0) && c1 >= square(x1).min(69), "{x0}..{x1}");
                assert!(r0 <= square(y0) && r1 >= square(y1).min(32), "{y0}..{y1}");
                // Not much too large: cells of the level are at most as large as the rectangle.
                let room = |a: u16, b: u16| 2 * (b - a).max(16) / 8 + 4;
                let most = room(x0, x1).max(room(y0, y1));
                assert!(c1 - c0 <= 2 * most && r1 - r0 <= 2 * most, "{x0}..{x1} {y0}..{y1}");
            }
        }
    }

    #[test]
    fn where_no_sample_lies_there_is_no_square() {
        let unit = 1 << RASTER_BITS;
        let squares = Squares::new([64, 64], 1, &[[40 * unit; 4]]);
        assert_eq!(squares.pixels_of([0, 15, 0, 15]), None);
        assert_eq!(squares.pixels_of([40, 40, 40, 40]), Some([0, 7, 0, 7]));
        assert_eq!(squares.pixels_of([0, 63, 0, 63]), Some([0, 7, 0, 7]));
    }
}
