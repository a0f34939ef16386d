//! Shadow: depth seen from the sun, and how much of its light reaches a point.
//!
//! A parallel projection is fitted to where the visible surfaces and the shadows that can fall on
//! them meet, with texels no finer than a pixel; casters are drawn whatever their distance towards
//! the sun. Single-sided triangles cast where their front faces the sun. Look-ups filter four texels
//! bilinearly (percentage-closer filtering, Reeves et al. 1987) and are moved off the surface along
//! its normal (Holbert, "Saying goodbye to shadow acne", GDC 2011).

use rayon::prelude::*;

use super::chunk::ChunkList;
use super::project::{Projection, SCREEN_BITS, ScreenVertex, Vertex, positions8};
use super::raster;
use super::samples::BLOCK;
use super::simd::{F32x8, I32x8, LANES, Level, Mask8, Vec3x8, kernel};

/// Side of a tile of the map in texels.
pub(super) const TILE: usize = 64;
const TILE_TEXELS: usize = TILE * TILE;
/// Texels left free around what the map is fitted to.
const MARGIN: f64 = 2.0;

/// An orthonormal frame with its third axis towards the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SunAxes([[f32; 3]; 3]);

impl SunAxes {
    /// A frame round a direction.
    pub(super) fn new(direction_to_sun: [f32; 3]) -> Self {
        let unit = |v: [f32; 3]| {
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-20);
            v.map(|x| x / length)
        };
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let to_sun = unit(direction_to_sun);
        let helper = if to_sun[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
        let right = unit(cross(helper, to_sun));
        Self([right, cross(to_sun, right), to_sun])
    }

    /// A point's coordinates along the three axes, metres.
    pub(super) fn coordinates(&self, p: [f32; 3]) -> [f32; 3] {
        self.0.map(|axis| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2])
    }

    #[inline(always)]
    fn coordinates8<const AVX2: bool>(&self, p: Vec3x8<AVX2>) -> [F32x8<AVX2>; 3] {
        let [right, up, to_sun] = self.0;
        [Vec3x8::splat(right).dot(p), Vec3x8::splat(up).dot(p), Vec3x8::splat(to_sun).dot(p)]
    }
}

/// A box along the sun's axes, metres, and how near to the camera anything in it comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
    /// Along the camera's axis.
    nearest_m: f32,
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds {
    /// Holds nothing.
    pub(super) const EMPTY: Self =
        Self { min: [f32::MAX; 3], max: [f32::MIN; 3], nearest_m: f32::MAX };

    /// Grows to hold a point of view space.
    pub(super) fn add(&mut self, point: [f32; 3], axes: &SunAxes) {
        let p = axes.coordinates(point);
        self.nearest_m = self.nearest_m.min(-point[2]);
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(p[axis]);
            self.max[axis] = self.max[axis].max(p[axis]);
        }
    }

    /// Whether a shadow of what is in here can fall on what is in another box.
    pub(super) fn may_shade(&self, receivers: &Self) -> bool {
        let beside = (0..2).any(|axis| {
            self.max[axis] < receivers.min[axis] || self.min[axis] > receivers.max[axis]
        });
        // Deeper than anything seen, it is in others' shadow and shades nothing.
        !beside && self.max[2] >= receivers.min[2]
    }

    /// Grows to hold another box.
    pub(super) fn join(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
            nearest_m: self.nearest_m.min(other.nearest_m),
        }
    }
}

kernel! {
    /// Bounds of all vertices, and of those within the picture.
    fn bound_vertices(
        vertices: &[Vertex],
        screen: &[ScreenVertex],
        size: [u32; 2],
        axes: &SunAxes,
    ) -> (Bounds, Bounds) = bound_body
}

#[inline(always)]
fn bound_body<const AVX2: bool>(
    vertices: &[Vertex],
    screen: &[ScreenVertex],
    size: [u32; 2],
    axes: &SunAxes,
) -> (Bounds, Bounds) {
    let [width, height] = size.map(|s| (s as i32) << SCREEN_BITS);
    let (low, high) = (F32x8::<AVX2>::splat(f32::MAX), F32x8::<AVX2>::splat(f32::MIN));
    let (mut all, mut seen) = ([[low, high]; 3], [[low, high]; 3]);
    let (mut nearest_all, mut nearest_seen) = (low, low);
    for (vertices, screen) in vertices.chunks_exact(LANES).zip(screen.chunks_exact(LANES)) {
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            (x[lane], y[lane]) = (screen[lane].x, screen[lane].y);
        }
        let visible = within::<AVX2>(I32x8(x), width) & within(I32x8(y), height);
        let position = positions8(vertices);
        nearest_all = nearest_all.min(-position.z);
        nearest_seen = nearest_seen.min(visible.select(-position.z, low));
        let p = axes.coordinates8(position);
        for axis in 0..3 {
            all[axis][0] = all[axis][0].min(p[axis]);
            all[axis][1] = all[axis][1].max(p[axis]);
            seen[axis][0] = seen[axis][0].min(visible.select(p[axis], low));
            seen[axis][1] = seen[axis][1].max(visible.select(p[axis], high));
        }
    }
    (narrowed(&all, nearest_all), narrowed(&seen, nearest_seen))
}

/// Whether whole numbers lie in `0..=end`.
#[inline(always)]
fn within<const AVX2: bool>(v: I32x8<AVX2>, end: i32) -> Mask8<AVX2> {
    v.gt(I32x8::splat(-1)) & I32x8::splat(end + 1).gt(v)
}

/// Eight boxes to one.
#[inline(always)]
fn narrowed<const AVX2: bool>(b: &[[F32x8<AVX2>; 2]; 3], nearest: F32x8<AVX2>) -> Bounds {
    Bounds {
        min: [b[0][0].smallest(), b[1][0].smallest(), b[2][0].smallest()],
        max: [b[0][1].largest(), b[1][1].largest(), b[2][1].largest()],
        nearest_m: nearest.smallest(),
    }
}

/// How points are found in the shadow map.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowView {
    /// The map as a picture.
    pub(super) projection: Projection,
    /// Texel column, texel row and depth of a view-space point.
    rows: [[f32; 4]; 3],
    /// Larger side of a texel, metres.
    texel_m: f32,
    /// Change of depth over a metre towards the sun.
    depth_per_m: f32,
}

impl ShadowView {
    /// Fits a map of at most `largest` texels a side; nothing if no shadow can be seen. Texels are
    /// no finer than a pixel at the nearest receiver, which is half a pixel at twice its distance.
    pub(super) fn fit(
        axes: &SunAxes,
        casters: &Bounds,
        receivers: &Bounds,
        largest: u32,
        focal_px: f32,
    ) -> Option<Self> {
        let mut low = [0.0; 2];
        let mut scale = [0.0; 2];
        let mut size = [0; 2];
        let pixel_m = f64::from(receivers.nearest_m / focal_px);
        for axis in 0..2 {
            low[axis] = f64::from(casters.min[axis].max(receivers.min[axis]));
            let high = f64::from(casters.max[axis].min(receivers.max[axis]));
            if high < low[axis] {
                return None;
            }
            let extent_m = (high - low[axis]).max(1e-3);
            let texels = (extent_m / pixel_m + 2.0 * MARGIN).min(f64::from(largest));
            size[axis] = (texels.ceil() as u32).next_multiple_of(TILE as u32).min(largest);
            scale[axis] = (f64::from(size[axis]) - 2.0 * MARGIN) / extent_m;
        }
        let both = casters.join(receivers);
        let [far, near] = [both.min[2], both.max[2]].map(f64::from);
        // Depth stays above 0, which means that nothing casts.
        let depth_scale = 0.998 / (near - far).max(1e-3);
        let row = |axis: usize, scale: f64, offset: f64| -> [f64; 4] {
            let a = axes.0[axis].map(f64::from);
            [a[0] * scale, a[1] * scale, a[2] * scale, offset]
        };
        // Rows run down, against the second axis, so that front faces turn as in a picture.
        let x = row(0, scale[0], MARGIN - low[0] * scale[0]);
        let y = row(1, -scale[1], f64::from(size[1]) - MARGIN + low[1] * scale[1]);
        let depth = row(2, depth_scale, 0.001 - far * depth_scale);
        Some(Self {
            projection: Projection::parallel(x, y, depth, size),
            rows: [x, y, depth].map(|r| r.map(|v| v as f32)),
            texel_m: (1.0 / scale[0].min(scale[1])) as f32,
            depth_per_m: depth_scale as f32,
        })
    }
}

/// The map: tiles of 64x64 texels, within them blocks of 4x4.
#[derive(Default)]
pub(super) struct ShadowMap {
    /// Room for the largest map so far.
    texels: Vec<f32>,
    /// Which tiles hold anything but zeros.
    dirty: Vec<bool>,
    /// Columns and rows of texels.
    size: [usize; 2],
}

impl ShadowMap {
    /// Rasters the casters; tiles that none touches are only cleared if they need it.
    pub(super) fn raster(&mut self, level: Level, casting: &ChunkList, size: [u32; 2]) {
        let (chunks, by_tile) = (casting.as_slice(), casting.by_tile());
        self.size = size.map(|side| side as usize);
        let [columns, rows] = self.size.map(|side| side / TILE);
        let count = columns * rows;
        if self.dirty.len() < count {
            self.dirty.resize(count, false);
            self.texels.resize(count * TILE_TEXELS, 0.0);
        }
        let texels = self.texels[..count * TILE_TEXELS].par_chunks_mut(TILE_TEXELS);
        let tiles = texels.zip(self.dirty[..count].par_iter_mut());
        tiles.enumerate().with_min_len(8).for_each(|(index, (texels, dirty))| {
            let tile = [(index % columns) as u32, (index / columns) as u32];
            let touching = by_tile.of(tile);
            if !touching.is_empty() {
                let mut farthest = [0.0; TILE_TEXELS / BLOCK];
                raster::raster_tile::<1, false, TILE>(
                    level,
                    chunks,
                    touching,
                    tile,
                    texels,
                    &mut [],
                    &mut farthest,
                );
            } else if *dirty {
                texels.fill(0.0);
            }
            *dirty = !touching.is_empty();
        });
    }
}

/// The map with its projection: what shading looks up.
pub(super) struct SunShadow<'a> {
    pub(super) map: &'a ShadowMap,
    pub(super) view: ShadowView,
}

impl SunShadow<'_> {
    /// The share of the sun's light, 0..1, that reaches points with these normals.
    ///
    /// The offset covers the change of depth over the filter's width on a plane of any slope:
    /// that change is `texel * tan(angle)`, and an offset of h along the normal gains
    /// `h / cos(angle)`. `extra_m` moves look-ups further off, for light that wraps round.
    #[inline(always)]
    pub(super) fn lit<const AVX2: bool>(
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
        inside.select(
            self.filter(inside.select(x, F32x8::ZERO), inside.select(y, F32x8::ZERO), depth),
            F32x8::ONE,
        )
    }

    /// Bilinear mean of four comparisons.
    #[inline(always)]
    fn filter<const AVX2: bool>(
        &self,
        x: F32x8<AVX2>,
        y: F32x8<AVX2>,
        depth: F32x8<AVX2>,
    ) -> F32x8<AVX2> {
        let (left, top) = (x.floor(), y.floor());
        let (wx, wy) = (x - left, y - top);
        let (left, top) = (left.round_i32(), top.round_i32());
        let one = I32x8::splat(1);
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
        index.gather_f32(&self.map.texels).gt(depth).select(F32x8::ZERO, F32x8::ONE)
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

    #[test]
    fn axes_are_a_right_handed_frame() {
        for d in [[0.0, 1.0, 0.0], [0.3, -0.5, 0.8], [1.0, 0.0, 0.0]] {
            let SunAxes([r, u, s]) = SunAxes::new(d);
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            for (a, b) in [(r, u), (u, s), (s, r)] {
                assert!(dot(a, b).abs() < 1e-6);
            }
            let cross =
                [r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2], r[0] * u[1] - r[1] * u[0]];
            assert!(dot(cross, s) > 0.999_99 && dot(d, s) > 0.9);
        }
    }
}
