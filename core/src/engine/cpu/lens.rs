//! Behind a lens: the samples of each tile in the pinhole's plane, block by block, and the rays
//! through its pixels.
//!
//! Made once for a lens and a size and kept, unless a picture is so large that its tables would fill
//! the memory: then each tile's is made when it is rastered.

use std::sync::Mutex;

use rayon::prelude::*;

use super::samples::{BLOCK, Layout, RASTER_BITS, TILE};
use super::simd::{F32x8, I32x8, LANES, Level, kernel};
use crate::draw::DrawList;
use crate::engine::lens::{EIGHT, LensPlane, SQUARE};
use crate::engine::squares::Squares;

/// Bytes of tables that are kept.
const KEPT_BYTES: usize = 1 << 29;
/// Blocks in a row of a tile at most.
const ACROSS: usize = TILE;
/// Squares in a row of a tile.
const SQUARES: usize = TILE / SQUARE as usize;

/// Least x and y, largest x and y, raster units of the plane.
pub(super) type Rect = [i32; 4];

const EMPTY: Rect = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];

/// Where the samples of a tile lie in the plane. Those beyond the picture's border lie somewhere
/// near it.
#[derive(Clone, Debug)]
pub(super) struct LensTile {
    /// x, then y of the samples of each block, raster units.
    pub(super) blocks: Vec<[[i32; BLOCK]; 2]>,
    /// Of each block.
    pub(super) rects: Vec<Rect>,
    /// Least and largest x in each column of blocks, then y in each row.
    spans: [[[i32; ACROSS]; 2]; 2],
    /// Of all.
    pub(super) rect: Rect,
    pub(super) rays: LensRays,
}

/// Rays through the pixels of a tile by slot, view space at z = -1: x, y, the change of x over a pixel
/// to the right and down, and that of y.
pub(super) type LensRays = Box<[[f32; TILE * TILE]; 6]>;

impl Default for LensTile {
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            rects: Vec::new(),
            spans: [[[i32::MAX; ACROSS], [i32::MIN; ACROSS]]; 2],
            rect: EMPTY,
            rays: Box::new([[0.0; TILE * TILE]; 6]),
        }
    }
}

/// A picture behind a lens.
pub(super) struct Lens {
    pub(super) plane: LensPlane,
    samples: u32,
    /// Columns of tiles.
    columns: u32,
    /// Row by row; empty where they are not kept.
    tiles: Vec<LensTile>,
    pub(super) squares: Squares,
}

impl Lens {
    /// Whether it is that of a draw list.
    pub(super) fn serves(&self, list: &DrawList) -> bool {
        self.samples == list.samples && self.plane.serves(list)
    }

    /// Behind the lens of a draw list with `S` samples a pixel; nothing where there is none.
    pub(super) fn new<const S: usize>(level: Level, list: &DrawList) -> Option<Self> {
        let plane = LensPlane::new(list)?;
        let [columns, rows] = [list.view.width, list.view.height].map(|s| s.div_ceil(TILE as u32));
        let count = (columns * rows) as usize;
        let bytes = count * TILE * TILE * (S * 8 + 24);
        let keep = bytes <= KEPT_BYTES;
        let spare = Mutex::new(Vec::new());
        let make = |index: usize| {
            let pop = || spare.lock().ok().and_then(|mut spare| spare.pop());
            let mut tile: LensTile = if keep { None } else { pop() }.unwrap_or_default();
            fill_tile::<S>(
                level,
                &plane,
                [index as u32 % columns, index as u32 / columns],
                &mut tile,
            );
            let squares = tile.squares::<S>();
            if keep {
                return (squares, Some(tile));
            }
            if let Ok(mut spare) = spare.lock() {
                spare.push(tile);
            }
            (squares, None)
        };
        let made: Vec<_> = (0..count).into_par_iter().map(make).collect();
        let across = columns as usize * SQUARES;
        let mut squares = vec![EMPTY; across * rows as usize * SQUARES];
        let mut tiles = Vec::new();
        for (index, (of_tile, tile)) in made.into_iter().enumerate() {
            let (column, row) = (index % columns as usize, index / columns as usize);
            for (i, rect) in of_tile.into_iter().enumerate() {
                let (x, y) = (column * SQUARES + i % SQUARES, row * SQUARES + i / SQUARES);
                squares[y * across + x] = rect;
            }
            tiles.extend(tile);
        }
        let plane_px = [plane.plane.width, plane.plane.height];
        let squares = Squares::new(plane_px, across, &squares);
        Some(Self { plane, samples: S as u32, columns, tiles, squares })
    }

    /// A tile, made in `scratch` where it is not kept.
    pub(super) fn tile<'a, const S: usize>(
        &'a self,
        level: Level,
        tile: [u32; 2],
        scratch: &'a mut LensTile,
    ) -> &'a LensTile {
        match self.tiles.get((tile[1] * self.columns + tile[0]) as usize) {
            Some(kept) => kept,
            None => {
                fill_tile::<S>(level, &self.plane, tile, scratch);
                scratch
            }
        }
    }
}

kernel! {
    /// Finds where the samples of a tile lie.
    fn fill_tile[const S: usize](plane: &LensPlane, tile: [u32; 2], out: &mut LensTile) = fill_body
}

#[inline(always)]
fn fill_body<const AVX2: bool, const S: usize>(
    plane: &LensPlane,
    tile: [u32; 2],
    out: &mut LensTile,
) {
    out.blocks.resize(TILE * TILE * S / BLOCK, [[0; BLOCK]; 2]);
    let origin = tile.map(|t| t * TILE as u32);
    let mut first = 0;
    while first < TILE * TILE {
        let (mut columns, mut rows) = ([0; EIGHT], [0; EIGHT]);
        for i in 0..EIGHT {
            let xy = Layout::<S>::SLOT_XY[first + i];
            columns[i] = origin[0] + u32::from(xy[0]);
            rows[i] = origin[1] + u32::from(xy[1]);
        }
        let pixels = plane.pixels(columns, rows);
        for k in 0..S {
            let [x, y] = plane.samples(&pixels, Layout::<S>::POSITIONS[k]);
            for i in 0..EIGHT {
                let sample = (first + i) * S + k;
                let block = &mut out.blocks[sample / BLOCK];
                block[0][sample % BLOCK] = x[i];
                block[1][sample % BLOCK] = y[i];
            }
        }
        let rays = plane.rays(&pixels);
        let [x, y, change @ ..] = &mut *out.rays;
        F32x8::<AVX2>(rays.x).store(&mut x[first..]);
        F32x8::<AVX2>(rays.y).store(&mut y[first..]);
        for (to, from) in change.iter_mut().zip(rays.change) {
            F32x8::<AVX2>(from).store(&mut to[first..]);
        }
        first += EIGHT;
    }
    out.bound::<AVX2, S>();
}

impl LensTile {
    /// Bounds what the blocks hold.
    #[inline(always)]
    fn bound<const AVX2: bool, const S: usize>(&mut self) {
        let across = Layout::<S>::BLOCKS_ACROSS;
        self.spans = [[[i32::MAX; ACROSS], [i32::MIN; ACROSS]]; 2];
        self.rect = EMPTY;
        self.rects.clear();
        for (index, [x, y]) in self.blocks.iter().enumerate() {
            let mut rect = EMPTY;
            for i in 0..BLOCK {
                rect = joined(rect, [x[i], y[i], x[i], y[i]]);
            }
            let (column, row) = (index % across, index / across);
            for (axis, at) in [column, row].into_iter().enumerate() {
                let [low, high] = &mut self.spans[axis];
                low[at] = low[at].min(rect[axis]);
                high[at] = high[at].max(rect[axis + 2]);
            }
            self.rect = joined(self.rect, rect);
            self.rects.push(rect);
        }
    }

    /// Bounds of each square of [`SQUARE`] pixels, row by row.
    fn squares<const S: usize>(&self) -> [Rect; SQUARES * SQUARES] {
        let across = Layout::<S>::BLOCKS_ACROSS;
        let blocks = across / SQUARES;
        let mut squares = [EMPTY; SQUARES * SQUARES];
        for (index, rect) in self.rects.iter().enumerate() {
            let (column, row) = (index % across / blocks, index / across / blocks);
            let square = &mut squares[row * SQUARES + column];
            *square = joined(*square, *rect);
        }
        squares
    }

    /// First and last column, then row of the blocks whose samples may lie in a rectangle; nothing
    /// where there is none.
    #[inline(always)]
    pub(super) fn blocks_in<const AVX2: bool, const S: usize>(
        &self,
        rect: Rect,
    ) -> Option<[i32; 4]> {
        let [left, top, right, bottom] = rect;
        let [x0, x1] = self.overlapping::<AVX2, S>(0, left, right)?;
        let [y0, y1] = self.overlapping::<AVX2, S>(1, top, bottom)?;
        Some([x0, x1, y0, y1])
    }

    /// First and last of the columns (or rows) whose span overlaps another.
    #[inline(always)]
    fn overlapping<const AVX2: bool, const S: usize>(
        &self,
        axis: usize,
        low: i32,
        high: i32,
    ) -> Option<[i32; 2]> {
        let [lows, highs] = &self.spans[axis];
        let (low, high) = (I32x8::<AVX2>::splat(low), I32x8::splat(high));
        let mut apart = 0;
        let mut first = 0;
        while first < Layout::<S>::BLOCKS_ACROSS {
            let (mut from, mut to) = ([0; LANES], [0; LANES]);
            from.copy_from_slice(&lows[first..first + LANES]);
            to.copy_from_slice(&highs[first..first + LANES]);
            apart |= (I32x8(from).gt(high) | low.gt(I32x8(to))).bits() << first;
            first += LANES;
        }
        let touching = !apart & (u32::MAX >> (32 - Layout::<S>::BLOCKS_ACROSS));
        if touching == 0 {
            return None;
        }
        Some([touching.trailing_zeros() as i32, 31 - touching.leading_zeros() as i32])
    }

    /// Bounds of the rays through all samples at z = -1: least x and y, largest x and y, view space.
    pub(super) fn ray_box(&self, plane: &LensPlane) -> [f32; 4] {
        let view = &plane.plane;
        let px = self.rect.map(|v| v as f32 / (1 << RASTER_BITS) as f32);
        [
            (px[0] - view.cx) / view.fx,
            (view.cy - px[3]) / view.fy,
            (px[2] - view.cx) / view.fx,
            (view.cy - px[1]) / view.fy,
        ]
    }
}

#[inline(always)]
fn joined(a: Rect, b: Rect) -> Rect {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}
