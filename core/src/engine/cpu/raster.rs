//! Raster: ids and depth of the samples of one tile.
//!
//! Coverage by exact integer edge functions with the top-left rule; the nearest sample wins, of
//! equals the earlier drawn. Depth is linear over the picture on every plane, so no division is
//! needed. Works in blocks of 16 samples ([`super::samples`]), each with the depth of its farthest
//! sample, so that what lies wholly behind is skipped.

use super::chunk::{Chunk, NOTHING, Triangle, first_id};
use super::cutout::Cut;
use super::samples::{BLOCK, Layout, RASTER_BITS};
use super::simd::{F32x8, I32x8, LANES, kernel};

/// Halves of a block.
const HALVES: usize = BLOCK / LANES;

/// Bound of a large triangle's edge functions within a block: coordinates differ by at most 2^14
/// pixels, so the sum of both slopes is at most 2^25, and a block has fewer than 32 grid steps.
const LARGE_BOUND: i64 = 1 << 30;

kernel! {
    /// Rasters the triangles that touch a tile of `SIDE` pixels into its samples, which are
    /// overwritten; without `IDS` only depth. `touching` names the chunks that hold any.
    fn raster_tile[const S: usize, const IDS: bool, const SIDE: usize](
        chunks: &[Chunk],
        touching: &[u32],
        tile: [u32; 2],
        depth: &mut [f32],
        ids: &mut [u32],
        farthest: &mut [f32],
    ) = raster_body
}

#[inline(always)]
fn raster_body<const AVX2: bool, const S: usize, const IDS: bool, const SIDE: usize>(
    chunks: &[Chunk],
    touching: &[u32],
    tile: [u32; 2],
    depth: &mut [f32],
    ids: &mut [u32],
    farthest: &mut [f32],
) {
    let samples = SIDE * SIDE * S;
    let depth = &mut depth[..samples];
    let farthest = &mut farthest[..samples / BLOCK];
    depth.fill(0.0);
    farthest.fill(0.0);
    let ids = if IDS {
        ids[..samples].fill(NOTHING);
        ids[..samples].as_chunks_mut().0
    } else {
        ids.as_chunks_mut().0
    };
    let depth = depth.as_chunks_mut().0;
    let origin_px = [(tile[0] as usize * SIDE) as i32, (tile[1] as usize * SIDE) as i32];
    for &index in touching {
        let chunk = &chunks[index as usize];
        for &t in chunk.bins.of(tile) {
            let triangle = &chunk.triangles[t as usize];
            let blocks = Blocks::new::<S, SIDE>(triangle, origin_px);
            if blocks.all_hide(triangle.nearest, SIDE >> Layout::<S>::BLOCK_LOG2, farthest) {
                continue;
            }
            let id = first_id(index as usize) + t;
            let mut edges = Edges::new::<S>(triangle, origin_px);
            let last_step = SIDE as i32 * Layout::<S>::GRID_PER_PX - 1;
            let is_large = triangle.large && !edges.forgotten_inside(last_step);
            let from = Source { triangle, id, cut: Cut::of(chunk, t as usize) };
            let at = (origin_px, &edges, blocks);
            let into = (&mut *depth, &mut *ids, &mut *farthest);
            match (is_large, IDS && from.cut.is_some()) {
                (true, true) => raster_triangle::<AVX2, S, IDS, SIDE, true, true>(from, at, into),
                (true, false) => raster_triangle::<AVX2, S, IDS, SIDE, true, false>(from, at, into),
                (false, true) => raster_triangle::<AVX2, S, IDS, SIDE, false, true>(from, at, into),
                (false, false) => {
                    raster_triangle::<AVX2, S, IDS, SIDE, false, false>(from, at, into);
                }
            }
        }
    }
}

/// First and last column, then row, of the blocks that a triangle may touch.
#[derive(Clone, Copy)]
pub(super) struct Blocks(pub(super) [i32; 4]);

impl Blocks {
    #[inline(always)]
    fn new<const S: usize, const SIDE: usize>(t: &Triangle, origin_px: [i32; 2]) -> Self {
        let log2 = Layout::<S>::BLOCK_LOG2;
        let side = SIDE as i32 - 1;
        let first = |px: u16, axis: usize| (i32::from(px) - origin_px[axis]).max(0) >> log2;
        let last = |px: u16, axis: usize| (i32::from(px) - origin_px[axis]).min(side) >> log2;
        let p = t.pixels;
        Self([first(p[0], 0), last(p[1], 0), first(p[2], 1), last(p[3], 1)])
    }

    /// Whether all samples of all these blocks are at least as near as `nearest`.
    #[inline(always)]
    pub(super) fn all_hide(self, nearest: f32, blocks_per_row: usize, farthest: &[f32]) -> bool {
        let [x0, x1, y0, y1] = self.0;
        (y0..y1 + 1).all(|y| {
            let row = y as usize * blocks_per_row;
            let row = &farthest[row + x0 as usize..row + x1 as usize + 1];
            row.iter().all(|farthest| nearest <= *farthest)
        })
    }
}

/// The edge functions of a triangle on the grid of sample positions of a tile: not negative on
/// the inner side. One step to the right adds `a`, one down adds `b`.
struct Edges {
    a: [i32; 3],
    b: [i32; 3],
    /// At the tile's origin.
    at_origin: [i64; 3],
}

impl Edges {
    #[inline(always)]
    fn new<const S: usize>(t: &Triangle, origin_px: [i32; 2]) -> Self {
        let ox = (origin_px[0] << RASTER_BITS) + Layout::<S>::GRID_ORIGIN;
        let oy = (origin_px[1] << RASTER_BITS) + Layout::<S>::GRID_ORIGIN;
        let (mut a, mut b, mut at_origin) = ([0; 3], [0; 3], [0; 3]);
        for i in 0..3 {
            let j = if i == 2 { 0 } else { i + 1 };
            a[i] = t.y[i] - t.y[j];
            b[i] = t.x[j] - t.x[i];
            let value =
                i64::from(b[i]) * i64::from(oy - t.y[i]) + i64::from(a[i]) * i64::from(ox - t.x[i]);
            // Samples right on an edge belong to the triangle below or to the right of it.
            let top_left = a[i] > 0 || (a[i] == 0 && b[i] > 0);
            // On the grid the function changes in steps of 1 << GRID_LOG2, so that rounding down
            // keeps its sign at every sample.
            at_origin[i] = (value - i64::from(!top_left)) >> Layout::<S>::GRID_LOG2;
        }
        Self { a, b, at_origin }
    }

    /// Sets all to 0, which is inside, if all of the tile is; says whether it did so.
    #[inline(always)]
    fn forgotten_inside(&mut self, last_step: i32) -> bool {
        let steps = i64::from(last_step);
        let inside = (0..3).all(|i| {
            let [a, b] = [self.a[i], self.b[i]].map(|slope| i64::from(slope.min(0)));
            self.at_origin[i] + (a + b) * steps >= 0
        });
        if inside {
            *self = Self { a: [0; 3], b: [0; 3], at_origin: [0; 3] };
        }
        inside
    }

    /// Values at a block's corner, given in grid steps from the tile's origin.
    #[inline(always)]
    fn at<const LARGE: bool>(&self, x: i32, y: i32) -> [i32; 3] {
        let mut value = [0; 3];
        for i in 0..3 {
            value[i] = if LARGE {
                let exact = self.at_origin[i]
                    + i64::from(self.a[i]) * i64::from(x)
                    + i64::from(self.b[i]) * i64::from(y);
                // Clamped values keep their sign all over the block.
                exact.clamp(-LARGE_BOUND, LARGE_BOUND) as i32
            } else {
                self.at_origin[i] as i32 + self.a[i] * x + self.b[i] * y
            };
        }
        value
    }
}

/// A triangle, its id, and what is cut out of it.
struct Source<'a> {
    triangle: &'a Triangle,
    id: u32,
    cut: Option<Cut<'a>>,
}

#[inline(always)]
fn raster_triangle<
    const AVX2: bool,
    const S: usize,
    const IDS: bool,
    const SIDE: usize,
    const LARGE: bool,
    const CUT: bool,
>(
    Source { triangle: t, id, cut }: Source<'_>,
    (origin_px, edges, blocks): ([i32; 2], &Edges, Blocks),
    (depth, ids, farthest): (&mut [[f32; BLOCK]], &mut [[u32; BLOCK]], &mut [f32]),
) {
    let block_px = Layout::<S>::BLOCK_PX;
    let grid_per_block = block_px * Layout::<S>::GRID_PER_PX;
    let blocks_per_row = SIDE >> Layout::<S>::BLOCK_LOG2;
    // What a step within the block adds: per lane, and at most.
    let last_step = grid_per_block - 1;
    let mut lane_edges = [[I32x8::<AVX2>::ZERO; 3]; HALVES];
    let mut first_half = [I32x8::ZERO; 3];
    let mut at_most = [0; 3];
    let [mut slope_x, mut slope_y] = [t.plane.dx as f32, t.plane.dy as f32];
    if !(slope_x.is_finite() && slope_y.is_finite()) {
        (slope_x, slope_y) = (0.0, 0.0);
    }
    let mut lane_depth = [F32x8::<AVX2>::ZERO; HALVES];
    for (half, (lane_edges, lane_depth)) in lane_edges.iter_mut().zip(&mut lane_depth).enumerate() {
        let (x, y) = lane_steps::<AVX2, S>(half);
        for i in 0..3 {
            lane_edges[i] = if S == 16 || half == 0 {
                I32x8::splat(edges.a[i]) * x + I32x8::splat(edges.b[i]) * y
            } else {
                // The same pattern half a block further down.
                first_half[i] + I32x8::splat(edges.b[i] * (grid_per_block / 2))
            };
        }
        first_half = *lane_edges;
        let (x, y) = lane_px::<AVX2, S>(half);
        *lane_depth = F32x8::splat(slope_x) * x + F32x8::splat(slope_y) * y;
    }
    for i in 0..3 {
        at_most[i] = edges.a[i].max(0) * last_step + edges.b[i].max(0) * last_step;
    }
    let depth_origin = (t.plane.origin
        + t.plane.dx * f64::from(origin_px[0])
        + t.plane.dy * f64::from(origin_px[1])) as f32;

    let Blocks([bx0, bx1, by0, by1]) = blocks;
    for by in by0..by1 + 1 {
        for bx in bx0..bx1 + 1 {
            let block = by as usize * blocks_per_row + bx as usize;
            if t.nearest <= farthest[block] {
                continue;
            }
            let at = edges.at::<LARGE>(bx * grid_per_block, by * grid_per_block);
            if ((at[0] + at_most[0]) | (at[1] + at_most[1]) | (at[2] + at_most[2])) < 0 {
                continue;
            }
            let block_depth =
                depth_origin + slope_x * (bx * block_px) as f32 + slope_y * (by * block_px) as f32;
            let mut least = F32x8::<AVX2>::splat(f32::MAX);
            for half in 0..HALVES {
                let from = half * LANES;
                let old_depth = F32x8::load(&depth[block][from..]);
                let new_depth = F32x8::splat(block_depth) + lane_depth[half];
                let inside = (I32x8::splat(at[0]) + lane_edges[half][0])
                    | (I32x8::splat(at[1]) + lane_edges[half][1])
                    | (I32x8::splat(at[2]) + lane_edges[half][2]);
                let mut wins = inside.gt(I32x8::splat(-1)) & new_depth.gt(old_depth);
                if let (true, Some(cut)) = (CUT && wins.any(), &cut) {
                    let corner_px =
                        [origin_px[0] + bx * block_px, origin_px[1] + by * block_px].map(f64::from);
                    let (x, y) = lane_px::<AVX2, S>(half);
                    wins = wins & cut.leaves(corner_px, [x, y]);
                }
                let kept = wins.select(new_depth, old_depth);
                kept.store(&mut depth[block][from..]);
                if IDS {
                    let ids = &mut ids[block][from..from + LANES];
                    let mut old = [0; LANES];
                    old.copy_from_slice(ids);
                    ids.copy_from_slice(&wins.select_u32(id, old));
                }
                least = least.min(kept);
            }
            farthest[block] = least.smallest();
        }
    }
}

/// Position of the lanes of half a block, in grid steps from the block's corner.
#[inline(always)]
fn lane_steps<const AVX2: bool, const S: usize>(half: usize) -> (I32x8<AVX2>, I32x8<AVX2>) {
    let (mut x, mut y) = ([0; LANES], [0; LANES]);
    for lane in 0..LANES {
        let p = Layout::<S>::BLOCK_16TH[half * LANES + lane];
        let steps = |v: i32| if S == 1 { (v - 8) / 16 } else { v };
        (x[lane], y[lane]) = (steps(p[0]), steps(p[1]));
    }
    (I32x8(x), I32x8(y))
}

/// Position of the lanes of half a block, in pixels from the block's corner.
#[inline(always)]
fn lane_px<const AVX2: bool, const S: usize>(half: usize) -> (F32x8<AVX2>, F32x8<AVX2>) {
    let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        let p = Layout::<S>::BLOCK_16TH[half * LANES + lane];
        (x[lane], y[lane]) = (p[0] as f32 / 16.0, p[1] as f32 / 16.0);
    }
    (F32x8(x), F32x8(y))
}
