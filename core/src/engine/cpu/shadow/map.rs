//! The sun's depth map, and how much of its light reaches a point.
//!
//! A tile of the map is rastered when it is first looked up: less than half of what casts lies in
//! tiles that any visible, sunward point asks for. Single-sided triangles cast where their front
//! faces the sun. Look-ups filter four texels bilinearly (percentage-closer filtering, Reeves et
//! al. 1987) and are moved off the surface along its normal (Holbert, "Saying goodbye to shadow
//! acne", GDC 2011).

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::{ShadowView, TILE};
use crate::engine::cpu::chunk::ChunkList;
use crate::engine::cpu::raster;
use crate::engine::cpu::samples::BLOCK;
use crate::engine::cpu::simd::{F32x8, I32x8, LANES, Level, Mask8, Vec3x8};

const TILE_TEXELS: usize = TILE * TILE;
const TILE_LOG2: u32 = TILE.ilog2();

/// The map: tiles of 64x64 texels, within them blocks of 4x4.
///
/// Threads may ask for the same tile: the first fills it, and others wait. Texels are atomic so
/// that they can be filled while others are read; no order between them is needed, as a tile is
/// read only after [`OnceLock`] has said that it is full.
#[derive(Default)]
pub(in crate::engine::cpu) struct ShadowMap {
    /// Bits of depths; room for the largest map so far.
    texels: Vec<AtomicU32>,
    /// What each tile of this frame holds, once it was asked for.
    tiles: Vec<OnceLock<Content>>,
    /// Columns and rows of texels.
    size: [usize; 2],
    /// Time spent on rastering this frame's tiles.
    raster_ns: AtomicU64,
}

/// What a tile of the map holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    /// Nothing casts there; its texels are zeros.
    Empty,
    /// Depths.
    Depths,
}

impl ShadowMap {
    /// Forgets the last frame's tiles.
    pub(in crate::engine::cpu) fn restart(&mut self, size: [u32; 2]) {
        self.size = size.map(|side| side as usize);
        let count = self.size[0] / TILE * (self.size[1] / TILE);
        self.tiles.clear();
        self.tiles.resize_with(count, OnceLock::new);
        if self.texels.len() < count * TILE_TEXELS {
            self.texels.resize_with(count * TILE_TEXELS, || AtomicU32::new(0));
        }
        *self.raster_ns.get_mut() = 0;
    }

    /// Time spent on rastering this frame's tiles, by all threads.
    pub(in crate::engine::cpu) fn raster_time(&self) -> Duration {
        Duration::from_nanos(self.raster_ns.load(Ordering::Relaxed))
    }

    /// Rasters a tile.
    fn raster(&self, index: usize, casting: &ChunkList, level: Level) -> Content {
        let start = Instant::now();
        let columns = self.size[0] / TILE;
        let tile = [(index % columns) as u32, (index / columns) as u32];
        let touching = casting.by_tile().of(tile);
        let (mut depth, mut farthest) = ([0.0; TILE_TEXELS], [0.0; TILE_TEXELS / BLOCK]);
        let content = if touching.is_empty() { Content::Empty } else { Content::Depths };
        if content == Content::Depths {
            let chunks = casting.as_slice();
            raster::raster_tile::<1, false, TILE>(
                level,
                chunks,
                touching,
                tile,
                &mut depth,
                &mut [],
                &mut farthest,
            );
        }
        for (texel, depth) in self.texels[index * TILE_TEXELS..].iter().zip(&depth) {
            texel.store(depth.to_bits(), Ordering::Relaxed);
        }
        self.raster_ns.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        content
    }
}

/// The map with its projection and what is drawn into it: what shading looks up.
pub(in crate::engine::cpu) struct SunShadow<'a> {
    pub(in crate::engine::cpu) map: &'a ShadowMap,
    pub(in crate::engine::cpu) view: ShadowView,
    pub(in crate::engine::cpu) casting: &'a ChunkList,
    pub(in crate::engine::cpu) level: Level,
}

impl SunShadow<'_> {
    /// The share of the sun's light, 0..1, that reaches points with these normals.
    ///
    /// The offset covers the change of depth over the filter's width on a plane of any slope:
    /// that change is `texel * tan(angle)`, and an offset of h along the normal gains
    /// `h / cos(angle)`. `extra_m` moves look-ups further off, for light that wraps round.
    #[inline(always)]
    pub(in crate::engine::cpu) fn lit<const AVX2: bool>(
        &self,
        p: Vec3x8<AVX2>,
        n: Vec3x8<AVX2>,
        n_dot_l: F32x8<AVX2>,
        extra_m: f32,
    ) -> F32x8<AVX2> {
        let view = &self.view;
        let sine = (F32x8::ONE - n_dot_l * n_dot_l).max(F32x8::ZERO).sqrt();
        let offset_m =
            sine * F32x8::splat(1.5 * view.texel_m) + F32x8::splat(0.25 * view.texel_m + extra_m);
        let q = p + n.scale(offset_m);
        let half = F32x8::splat(0.5);
        let (x, y) = (affine8(&view.rows[0], q) - half, affine8(&view.rows[1], q) - half);
        let depth = affine8(&view.rows[2], q) + F32x8::splat(0.5 * view.texel_m * view.depth_per_m);
        let [last_x, last_y] = self.map.size.map(|side| F32x8::splat(side as f32 - 1.0));
        let inside = x.ge(F32x8::ZERO) & last_x.gt(x) & y.ge(F32x8::ZERO) & last_y.gt(y);
        if !inside.any() {
            return F32x8::ONE;
        }
        let (x, y) = (inside.select(x, F32x8::ZERO), inside.select(y, F32x8::ZERO));
        inside.select(self.filter([x, y], depth, inside), F32x8::ONE)
    }

    /// Bilinear mean of four comparisons; nonsense where not `wanted`.
    #[inline(always)]
    fn filter<const AVX2: bool>(
        &self,
        [x, y]: [F32x8<AVX2>; 2],
        depth: F32x8<AVX2>,
        wanted: Mask8<AVX2>,
    ) -> F32x8<AVX2> {
        let (left, top) = (x.floor(), y.floor());
        let (wx, wy) = (x - left, y - top);
        let (left, top) = (left.round_i32(), top.round_i32());
        let one = I32x8::splat(1);
        if !self.anything_casts([left, left + one], [top, top + one], wanted) {
            return F32x8::ONE;
        }
        let columns = [column_offset(left), column_offset(left + one)];
        let tiles_per_row = (self.map.size[0] / TILE) as i32;
        let rows = [row_offset(top, tiles_per_row), row_offset(top + one, tiles_per_row)];
        let upper = self
            .compare(rows[0] + columns[0], depth)
            .mix(self.compare(rows[0] + columns[1], depth), wx);
        let lower = self
            .compare(rows[1] + columns[0], depth)
            .mix(self.compare(rows[1] + columns[1], depth), wx);
        upper.mix(lower, wy)
    }

    /// 1 where nothing in the map is nearer to the sun, else 0.
    #[inline(always)]
    fn compare<const AVX2: bool>(&self, index: I32x8<AVX2>, depth: F32x8<AVX2>) -> F32x8<AVX2> {
        let nearest = index.gather_shared_f32(&self.map.texels);
        nearest.gt(depth).select(F32x8::ZERO, F32x8::ONE)
    }

    /// Has the tiles of some columns and rows of texels rastered; whether any of them holds
    /// anything.
    #[inline(always)]
    fn anything_casts<const AVX2: bool>(
        &self,
        columns: [I32x8<AVX2>; 2],
        rows: [I32x8<AVX2>; 2],
        wanted: Mask8<AVX2>,
    ) -> bool {
        let per_row = I32x8::splat((self.map.size[0] / TILE) as i32);
        let upper_left = (rows[0] >> TILE_LOG2) * per_row + (columns[0] >> TILE_LOG2);
        let lower_right = (rows[1] >> TILE_LOG2) * per_row + (columns[1] >> TILE_LOG2);
        let first = I32x8::splat(upper_left.0[0]);
        let elsewhere = !(upper_left.eq(first) & lower_right.eq(first)).bits();
        if elsewhere & 0xff == 0 {
            return self.content(first.0[0]) == Content::Depths;
        }
        // Over the border of a tile, the four texels lie in two or four of them.
        let mut any = false;
        let mut left = wanted.bits();
        while left != 0 {
            let lane = left.trailing_zeros() as usize & (LANES - 1);
            left &= left - 1;
            let [from, to] = [upper_left.0[lane], lower_right.0[lane]];
            let across = columns[1].0[lane] >> TILE_LOG2 != columns[0].0[lane] >> TILE_LOG2;
            any |= self.content(from) == Content::Depths;
            if from != to {
                any |= self.content(to) == Content::Depths;
                any |= self.content(from + i32::from(across)) == Content::Depths;
                any |= self.content(to - i32::from(across)) == Content::Depths;
            }
        }
        any
    }

    /// What a tile holds; rasters it if nobody has asked before.
    #[inline(always)]
    fn content(&self, tile: i32) -> Content {
        let known = &self.map.tiles[tile as usize];
        match known.get() {
            Some(content) => *content,
            None => self.fill(tile as usize),
        }
    }

    #[cold]
    #[inline(never)]
    fn fill(&self, tile: usize) -> Content {
        let raster = || self.map.raster(tile, self.casting, self.level);
        *self.map.tiles[tile].get_or_init(raster)
    }
}

/// An affine function of eight points.
#[inline(always)]
fn affine8<const AVX2: bool>(row: &[f32; 4], p: Vec3x8<AVX2>) -> F32x8<AVX2> {
    Vec3x8::splat([row[0], row[1], row[2]]).dot(p) + F32x8::splat(row[3])
}

/// What a texel's column adds to its place in the map.
#[inline(always)]
fn column_offset<const AVX2: bool>(x: I32x8<AVX2>) -> I32x8<AVX2> {
    ((x >> 6) << 12) + (((x >> 2) & I32x8::splat(15)) << 4) + (x & I32x8::splat(3))
}

/// What a texel's row adds to its place in the map.
#[inline(always)]
fn row_offset<const AVX2: bool>(y: I32x8<AVX2>, tiles_per_row: i32) -> I32x8<AVX2> {
    (y >> 6) * I32x8::splat(tiles_per_row << 12)
        + (((y >> 2) & I32x8::splat(15)) << 8)
        + ((y & I32x8::splat(3)) << 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::cpu::samples::Layout;

    #[test]
    fn texels_are_found_where_the_raster_puts_them() {
        // Within a tile of 64 texels the raster stores blocks of 4x4 row by row.
        for (x, y) in [(0, 0), (3, 1), (4, 0), (63, 63), (64, 0), (17, 70), (127, 127)] {
            let (tile, inner) = ((y / 64) * 2 + x / 64, [x % 64, y % 64]);
            let block = inner[1] / 4 * 16 + inner[0] / 4;
            let lane = inner[1] % 4 * 4 + inner[0] % 4;
            assert_eq!(
                Layout::<1>::BLOCK_16TH[lane],
                [inner[0] as i32 % 4 * 16 + 8, inner[1] as i32 % 4 * 16 + 8]
            );
            let found = column_offset(I32x8::<false>::splat(x as i32))
                + row_offset(I32x8::<false>::splat(y as i32), 2);
            assert_eq!(found.0[0] as usize, tile * 4096 + block * 16 + lane);
        }
    }
}
