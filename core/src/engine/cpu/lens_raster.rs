//! Raster behind a lens: ids and depth of the samples of one tile, wherever in the plane they lie.
//!
//! As [`super::raster`], but for where samples stand: each block's positions come from a table, so
//! that edge functions are computed sample by sample from the block's corner. They are exact and
//! decide ties alike, so that no crack opens between neighbours.

use super::chunk::{Chunk, NOTHING, Triangle, first_id};
use super::cutout::Cut;
use super::lens::LensTile;
use super::raster::Blocks;
use super::samples::{BLOCK, Layout, RASTER_BITS};
use super::simd::{F32x8, I32x8, LANES, Mask8, kernel};

/// Bound of edge functions that lanes compute with: what is added within a block must be smaller.
const BOUND: i64 = 1 << 30;

kernel! {
    /// Rasters the triangles that touch a tile into its samples, which are overwritten: depths, ids
    /// and the farthest depth of each block. `touching` names the chunks that hold any.
    fn raster_lens_tile[const S: usize](
        chunks: &[Chunk],
        touching: &[u32],
        tile: [u32; 2],
        lens: &LensTile,
        samples: (&mut [f32], &mut [u32], &mut [f32]),
    ) = raster_body
}

#[inline(always)]
fn raster_body<const AVX2: bool, const S: usize>(
    chunks: &[Chunk],
    touching: &[u32],
    tile: [u32; 2],
    lens: &LensTile,
    (depth, ids, farthest): (&mut [f32], &mut [u32], &mut [f32]),
) {
    depth.fill(0.0);
    farthest.fill(0.0);
    ids.fill(NOTHING);
    let (depth, ids) = (depth.as_chunks_mut().0, ids.as_chunks_mut().0);
    for &index in touching {
        let chunk = &chunks[index as usize];
        for &t in chunk.bins.of(tile) {
            let triangle = &chunk.triangles[t as usize];
            let rect = bounds(triangle);
            let Some(blocks) = lens.blocks_in::<AVX2, S>(rect) else { continue };
            let blocks = Blocks(blocks);
            if blocks.all_hide(triangle.nearest, Layout::<S>::BLOCKS_ACROSS, farthest) {
                continue;
            }
            let id = first_id(index as usize) + t;
            let (from, samples) = ((triangle, id), (&mut *depth, &mut *ids, &mut *farthest));
            let cut = Cut::of(chunk, t as usize);
            raster_triangle::<AVX2, S>(from, cut, rect, blocks, lens, samples);
        }
    }
}

/// Least x and y, largest x and y of a triangle.
#[inline(always)]
fn bounds(t: &Triangle) -> [i32; 4] {
    let ([x0, x1, x2], [y0, y1, y2]) = (t.x, t.y);
    [x0.min(x1).min(x2), y0.min(y1).min(y2), x0.max(x1).max(x2), y0.max(y1).max(y2)]
}

/// The edge functions of a triangle: not negative on the inner side. A raster unit to the right adds
/// `a`, one down adds `b`.
struct Edges {
    a: [i32; 3],
    b: [i32; 3],
    /// 1 where samples right on the edge belong to the neighbour.
    bias: [i64; 3],
}

impl Edges {
    #[inline(always)]
    fn new(t: &Triangle) -> Self {
        let (mut a, mut b, mut bias) = ([0; 3], [0; 3], [0; 3]);
        for i in 0..3 {
            let j = if i == 2 { 0 } else { i + 1 };
            a[i] = t.y[i] - t.y[j];
            b[i] = t.x[j] - t.x[i];
            let top_left = a[i] > 0 || (a[i] == 0 && b[i] > 0);
            bias[i] = i64::from(!top_left);
        }
        Self { a, b, bias }
    }

    /// Exact values at a place.
    #[inline(always)]
    fn at(&self, t: &Triangle, x: i32, y: i32) -> [i64; 3] {
        let mut value = [0; 3];
        for i in 0..3 {
            value[i] = i64::from(self.a[i]) * i64::from(x - t.x[i])
                + i64::from(self.b[i]) * i64::from(y - t.y[i])
                - self.bias[i];
        }
        value
    }
}

/// How a block's rectangle lies to a triangle.
enum Cover {
    Outside,
    Inside,
    /// Values at the block's corner that keep their sign all over it, for lanes.
    Part([i32; 3]),
    /// Edge functions are too large for lanes.
    Large,
}

#[inline(always)]
fn cover(edges: &Edges, at: &[i64; 3], width: i32, height: i32) -> Cover {
    let (mut inside, mut large) = (true, false);
    let mut clamped = [0; 3];
    for i in 0..3 {
        let [across, down] =
            [i64::from(edges.a[i]) * i64::from(width), i64::from(edges.b[i]) * i64::from(height)];
        if at[i] + across.max(0) + down.max(0) < 0 {
            return Cover::Outside;
        }
        inside &= at[i] + across.min(0) + down.min(0) >= 0;
        large |= across.abs() + down.abs() >= BOUND;
        clamped[i] = at[i].clamp(-BOUND, BOUND) as i32;
    }
    match (inside, large) {
        (true, _) => Cover::Inside,
        (false, false) => Cover::Part(clamped),
        (false, true) => Cover::Large,
    }
}

#[inline(always)]
fn raster_triangle<const AVX2: bool, const S: usize>(
    (t, id): (&Triangle, u32),
    cut: Option<Cut<'_>>,
    rect: [i32; 4],
    Blocks([bx0, bx1, by0, by1]): Blocks,
    lens: &LensTile,
    (depth, ids, farthest): (&mut [[f32; BLOCK]], &mut [[u32; BLOCK]], &mut [f32]),
) {
    const PX: f64 = 1.0 / (1 << RASTER_BITS) as f64;
    let edges = Edges::new(t);
    let [mut slope_x, mut slope_y] = [(t.plane.dx * PX) as f32, (t.plane.dy * PX) as f32];
    if !(slope_x.is_finite() && slope_y.is_finite()) {
        (slope_x, slope_y) = (0.0, 0.0);
    }
    for by in by0..by1 + 1 {
        for bx in bx0..bx1 + 1 {
            let block = by as usize * Layout::<S>::BLOCKS_ACROSS + bx as usize;
            let [left, top, right, bottom] = lens.rects[block];
            let beside =
                (left > rect[2]) | (top > rect[3]) | (right < rect[0]) | (bottom < rect[1]);
            if beside || t.nearest <= farthest[block] {
                continue;
            }
            let at = edges.at(t, left, top);
            let cover = cover(&edges, &at, right - left, bottom - top);
            if matches!(cover, Cover::Outside) {
                continue;
            }
            let block_depth = (t.plane.origin
                + t.plane.dx * PX * f64::from(left)
                + t.plane.dy * PX * f64::from(top)) as f32;
            let places = &lens.blocks[block];
            let mut least = F32x8::<AVX2>::splat(f32::MAX);
            let mut from = 0;
            while from < BLOCK {
                let x = offsets::<AVX2>(&places[0], from, left);
                let y = offsets::<AVX2>(&places[1], from, top);
                let inside = match cover {
                    Cover::Part(at) => {
                        let mut all = I32x8::ZERO;
                        for i in 0..3 {
                            all = all
                                | (I32x8::splat(at[i])
                                    + I32x8::splat(edges.a[i]) * x
                                    + I32x8::splat(edges.b[i]) * y);
                        }
                        all.gt(I32x8::splat(-1))
                    }
                    Cover::Large => covered(&edges, &at, x, y),
                    Cover::Inside | Cover::Outside => I32x8::ZERO.gt(I32x8::splat(-1)),
                };
                let old_depth = F32x8::load(&depth[block][from..]);
                let new_depth = F32x8::splat(block_depth)
                    + F32x8::splat(slope_x) * x.to_f32()
                    + F32x8::splat(slope_y) * y.to_f32();
                let mut wins = inside & new_depth.gt(old_depth);
                if let (true, Some(cut)) = (wins.any(), &cut) {
                    let corner_px = [left, top].map(|v| f64::from(v) * PX);
                    let units = F32x8::splat(PX as f32);
                    wins = wins & cut.leaves(corner_px, [x.to_f32() * units, y.to_f32() * units]);
                }
                let kept = wins.select(new_depth, old_depth);
                kept.store(&mut depth[block][from..]);
                let ids = &mut ids[block][from..from + LANES];
                let mut old = [0; LANES];
                old.copy_from_slice(ids);
                ids.copy_from_slice(&wins.select_u32(id, old));
                least = least.min(kept);
                from += LANES;
            }
            farthest[block] = least.smallest();
        }
    }
}

/// Eight samples of a block from its corner.
#[inline(always)]
fn offsets<const AVX2: bool>(places: &[i32; BLOCK], from: usize, corner: i32) -> I32x8<AVX2> {
    let mut eight = [0; LANES];
    eight.copy_from_slice(&places[from..from + LANES]);
    I32x8(eight) + I32x8::splat(-corner)
}

/// Which of eight samples, from the block's corner, lie in a triangle of any size.
#[inline(always)]
fn covered<const AVX2: bool>(
    edges: &Edges,
    at: &[i64; 3],
    x: I32x8<AVX2>,
    y: I32x8<AVX2>,
) -> Mask8<AVX2> {
    let mut outside = [0; LANES];
    for lane in 0..LANES {
        for i in 0..3 {
            let value = at[i]
                + i64::from(edges.a[i]) * i64::from(x.0[lane])
                + i64::from(edges.b[i]) * i64::from(y.0[lane]);
            outside[lane] |= (value >> 63) as i32;
        }
    }
    I32x8(outside).gt(I32x8::splat(-1))
}
