//! Cull: from projected vertices to the triangles that may cover a sample.
//!
//! Drops back faces, triangles outside the picture, and those that lie between the rows or
//! columns of samples. Triangles with a vertex that could not be projected go to [`super::clip`].

use super::chunk::{Chunk, DepthPlane, Face, Triangle};
use super::cutout::CutPlanes;
use super::project::{Projection, SCREEN_BITS, ScreenVertex, Vertex};
use super::samples::{Layout, RASTER_BITS, TILE};
use super::shadow::SunAxes;
use super::simd::{I32x8, LANES, Mask8, kernel, unzipped};
use super::{clip, shadow};
use crate::engine::squares::Squares;
use crate::library::mesh;

/// Triangles up to this size have edge functions below 2^31 all over a tile: with extent E and
/// tile side T in pixels, the largest is 2 E (E + T) 2^14, for E = 192 and T = 34 some 1.4e9.
const SMALL_PX: i32 = 192;

/// Below this thickness a triangle's depth is taken from its longest edge alone, as its slope
/// would be made of rounding; 1/512 pixel in 16.16 fixed point.
const SLIVER: f64 = 128.0;

/// Binary digits that the raster has fewer than [`ScreenVertex`].
const SNAP_BITS: u32 = SCREEN_BITS - RASTER_BITS;
/// Half a step of the raster.
const HALF: i32 = 1 << (SNAP_BITS - 1);

/// What triangles are set up for.
pub(super) struct Target<'a> {
    pub(super) vertices: &'a [Vertex],
    pub(super) screen: &'a [ScreenVertex],
    pub(super) projection: &'a Projection,
    /// Tiles are `1 << tile_log2` pixels wide.
    pub(super) tile_log2: u32,
    /// First row of samples, raster coordinates.
    pub(super) first_row: i32,
    /// log2 of the distance between rows of samples, raster coordinates.
    pub(super) row_step_log2: u32,
    /// Whether the triangles will be shaded.
    pub(super) shaded: bool,
    /// Whether samples look at cutouts.
    pub(super) cuts: bool,
    /// Axes along which to bound what is seen, for the fit of a shadow map.
    pub(super) sun: Option<&'a SunAxes>,
    /// Where in the picture the samples of a lens's plane stand; without a lens they stand where
    /// they are.
    pub(super) squares: Option<&'a Squares>,
}

impl<'a> Target<'a> {
    /// The camera's picture with `S` samples a pixel.
    pub(super) fn picture<const S: usize>(
        vertices: &'a [Vertex],
        screen: &'a [ScreenVertex],
        projection: &'a Projection,
    ) -> Self {
        Self {
            vertices,
            screen,
            projection,
            tile_log2: TILE.ilog2(),
            first_row: Layout::<S>::FIRST_ROW,
            row_step_log2: Layout::<S>::ROW_STEP_LOG2,
            shaded: false,
            cuts: true,
            sun: None,
            squares: None,
        }
    }

    /// The plane behind a lens, where samples may lie anywhere.
    pub(super) fn lens(
        vertices: &'a [Vertex],
        screen: &'a [ScreenVertex],
        projection: &'a Projection,
        squares: &'a Squares,
    ) -> Self {
        Self {
            first_row: 0,
            row_step_log2: 0,
            squares: Some(squares),
            ..Self::picture::<1>(vertices, screen, projection)
        }
    }

    /// The sun's shadow map.
    pub(super) fn shadow(
        vertices: &'a [Vertex],
        screen: &'a [ScreenVertex],
        projection: &'a Projection,
    ) -> Self {
        let tile_log2 = shadow::TILE.ilog2();
        Self { tile_log2, cuts: false, ..Self::picture::<1>(vertices, screen, projection) }
    }
}

kernel! {
    /// Culls, clips and bins the triangles of a chunk.
    fn set_up(chunk: &mut Chunk, mesh_triangles: &[mesh::Triangle], target: &Target<'_>) = set_up_body
}

#[inline(always)]
fn set_up_body<const AVX2: bool>(
    chunk: &mut Chunk,
    mesh_triangles: &[mesh::Triangle],
    target: &Target<'_>,
) {
    chunk.triangles.clear();
    chunk.faces.clear();
    chunk.cuts.clear();
    chunk.crossing.clear();
    chunk.border.clear();
    chunk.bins.clear();
    let (eights, rest) = mesh_triangles[chunk.source.clone()].as_chunks();
    for triangles in eights {
        set_up_eight::<AVX2>(chunk, triangles, target);
    }
    for triangle in rest {
        set_up_one(chunk, triangle.get().map(|v| v + chunk.first_vertex), target);
    }
    clip::add_crossing(chunk, target);
    if let Some(sun) = target.sun {
        clip::bound_border(chunk, target, sun);
    }
    chunk.bins.fill();
}

/// Sets up one triangle, of any size.
#[inline(always)]
fn set_up_one(chunk: &mut Chunk, corners: [u32; 3], target: &Target<'_>) {
    let v = corners.map(|c| target.screen[c as usize]);
    if v.iter().any(|v| v.x == ScreenVertex::OUTSIDE) {
        chunk.crossing.push(corners);
    } else if let Some(t) = cull(chunk, &v, target) {
        chunk.take(t, corners, &v, target);
    }
}

/// Sets up eight triangles: most are dropped, so that the eight are looked at together and what
/// is left one by one.
#[inline(always)]
fn set_up_eight<const AVX2: bool>(
    chunk: &mut Chunk,
    triangles: &[mesh::Triangle; LANES],
    target: &Target<'_>,
) {
    let corners = triangles.map(|t| t.get().map(|v| v + chunk.first_vertex));
    let eight = Eight::<AVX2>::new(&corners, target);
    let culled = eight.cull(chunk, target);
    let mut left = culled.kept | eight.special;
    while left != 0 {
        let lane = left.trailing_zeros() as usize;
        left &= left - 1;
        let corners = corners[lane];
        if eight.special >> lane & 1 == 1 {
            set_up_one(chunk, corners, target);
            continue;
        }
        let v = corners.map(|c| target.screen[c as usize]);
        chunk.take(culled.triangle(lane, nearest(&v)), corners, &v, target);
    }
}

/// Eight triangles in raster coordinates.
struct Eight<const AVX2: bool> {
    x: [I32x8<AVX2>; 3],
    y: [I32x8<AVX2>; 3],
    /// Which must be set up one by one: those with a corner that was not projected, and those too
    /// large for areas of 32 bits.
    special: u32,
}

/// Twice the area of a triangle is at most that of the rectangle round it: up to this size it
/// stays below 2^31, also where the products that it is the difference of do not.
const EIGHT_PX: i32 = 45;

impl<const AVX2: bool> Eight<AVX2> {
    #[inline(always)]
    fn new(corners: &[[u32; 3]; LANES], target: &Target<'_>) -> Self {
        let half = I32x8::splat(HALF);
        let (mut x, mut y) = ([I32x8::ZERO; 3], [I32x8::ZERO; 3]);
        let mut outside = Mask8::NONE;
        for corner in 0..3 {
            let mut both = [[0; 2]; LANES];
            for lane in 0..LANES {
                let v = &target.screen[corners[lane][corner] as usize];
                both[lane] = [v.x, v.y];
            }
            let [fixed_x, fixed_y] = unzipped(both);
            outside = outside | fixed_x.eq(I32x8::splat(ScreenVertex::OUTSIDE));
            x[corner] = (fixed_x + half) >> SNAP_BITS;
            y[corner] = (fixed_y + half) >> SNAP_BITS;
        }
        let limit = I32x8::splat(EIGHT_PX << RASTER_BITS);
        let large = (most(&x) - least(&x)).gt(limit) | (most(&y) - least(&y)).gt(limit);
        let special = (outside | large).bits();
        Self { x, y, special }
    }

    /// As [`cull`]; nonsense where triangles are special.
    #[inline(always)]
    fn cull(&self, chunk: &Chunk, target: &Target<'_>) -> Culled<AVX2> {
        let (x, y) = (&self.x, &self.y);
        let area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
        let turned = I32x8::ZERO.gt(area);
        let faces = match (chunk.double_sided, chunk.mirrored) {
            (true, _) => turned | area.gt(I32x8::ZERO),
            (false, true) => area.gt(I32x8::ZERO),
            (false, false) => turned,
        };
        let [width, height] = target.projection.size;
        let (across, in_x) = extent(x, width as i32, target);
        let (down, in_y) = extent(y, height as i32, target);
        let kept = (faces & in_x & in_y).bits() & !self.special;
        let pixels = [across[0], across[1], down[0], down[1]];
        Culled { x: swapped(x, turned), y: swapped(y, turned), pixels, kept }
    }
}

/// Eight triangles in raster coordinates, clockwise, of which some may cover samples.
struct Culled<const AVX2: bool> {
    x: [I32x8<AVX2>; 3],
    y: [I32x8<AVX2>; 3],
    /// See [`Triangle::pixels`].
    pixels: [I32x8<AVX2>; 4],
    /// Which may.
    kept: u32,
}

impl<const AVX2: bool> Culled<AVX2> {
    #[inline(always)]
    fn triangle(&self, lane: usize, nearest: f32) -> Triangle {
        let lane = lane & (LANES - 1);
        let ([x0, x1, x2], [y0, y1, y2]) = (&self.x, &self.y);
        let [left, right, top, bottom] = &self.pixels;
        Triangle {
            x: [x0.0[lane], x1.0[lane], x2.0[lane]],
            y: [y0.0[lane], y1.0[lane], y2.0[lane]],
            plane: DepthPlane::default(),
            nearest,
            pixels: [
                left.0[lane] as u16,
                right.0[lane] as u16,
                top.0[lane] as u16,
                bottom.0[lane] as u16,
            ],
            large: false,
        }
    }
}

/// Corners with the second and third exchanged where wanted.
#[inline(always)]
fn swapped<const AVX2: bool>(v: &[I32x8<AVX2>; 3], wanted: Mask8<AVX2>) -> [I32x8<AVX2>; 3] {
    [v[0], wanted.select_i32(v[2], v[1]), wanted.select_i32(v[1], v[2])]
}

#[inline(always)]
fn least<const AVX2: bool>(v: &[I32x8<AVX2>; 3]) -> I32x8<AVX2> {
    v[0].min(v[1]).min(v[2])
}

#[inline(always)]
fn most<const AVX2: bool>(v: &[I32x8<AVX2>; 3]) -> I32x8<AVX2> {
    v[0].max(v[1]).max(v[2])
}

/// First and last pixel, of so many, along one axis, and which triangles may cover a sample there.
#[inline(always)]
fn extent<const AVX2: bool>(
    v: &[I32x8<AVX2>; 3],
    size: i32,
    target: &Target<'_>,
) -> ([I32x8<AVX2>; 2], Mask8<AVX2>) {
    let (low, high) = (least(v), most(v));
    let step = I32x8::splat((1 << target.row_step_log2) - 1);
    let first_row = I32x8::splat(target.first_row);
    let row_from = (low - first_row + step) >> target.row_step_log2;
    let row_to = (high - first_row) >> target.row_step_log2;
    let first = (low >> RASTER_BITS).max(I32x8::ZERO);
    let last = (high >> RASTER_BITS).min(I32x8::splat(size - 1));
    let one = I32x8::splat(1);
    ([first, last], (row_to + one).gt(row_from) & (last + one).gt(first))
}

impl Triangle {
    #[inline(always)]
    pub(super) fn with_plane(self, plane: DepthPlane) -> Self {
        Self { plane, ..self }
    }
}

impl Chunk {
    /// Takes over a triangle whose corners were projected.
    #[inline(always)]
    fn take(
        &mut self,
        triangle: Triangle,
        corners: [u32; 3],
        v: &[ScreenVertex; 3],
        target: &Target<'_>,
    ) {
        if target.sun.is_some() && reaches_over_border(v, target) {
            self.border.push(corners);
        }
        self.push(triangle.with_plane(plane(v)), corners, target);
    }

    /// Takes a triangle over.
    #[inline(always)]
    pub(super) fn push(&mut self, mut triangle: Triangle, corners: [u32; 3], target: &Target<'_>) {
        if let Some(squares) = target.squares {
            match squares.pixels_of(triangle.pixels) {
                Some(pixels) => triangle.pixels = pixels,
                None => return,
            }
        }
        if target.shaded {
            let normal = facing(&triangle.plane, target.projection);
            self.faces.push(Face { corners, normal });
        }
        if target.cuts && self.cutout.is_some() {
            let corners = corners.map(|c| &target.vertices[c as usize]);
            self.cuts.push(CutPlanes::new(corners, target.projection));
        }
        self.bins.add(&triangle.pixels, target.tile_log2);
        self.triangles.push(triangle);
    }
}

/// The triangle in raster coordinates, without its plane, if it faces the viewer and may cover a
/// sample.
#[inline(always)]
pub(super) fn cull(chunk: &Chunk, v: &[ScreenVertex; 3], target: &Target<'_>) -> Option<Triangle> {
    let snap = |fixed: i32| (fixed + HALF) >> SNAP_BITS;
    let (mut x, mut y) = (v.map(|v| snap(v.x)), v.map(|v| snap(v.y)));
    let (ux, uy) = (i64::from(x[1] - x[0]), i64::from(y[1] - y[0]));
    let (wx, wy) = (i64::from(x[2] - x[0]), i64::from(y[2] - y[0]));
    // y runs down, so counter-clockwise in space is negative here.
    let area = ux * wy - uy * wx;
    if area == 0 || ((area > 0) != chunk.mirrored && !chunk.double_sided) {
        return None;
    }
    if area < 0 {
        x.swap(1, 2);
        y.swap(1, 2);
    }
    let least = |v: [i32; 3]| v[0].min(v[1]).min(v[2]);
    let most = |v: [i32; 3]| v[0].max(v[1]).max(v[2]);
    let (x0, x1, y0, y1) = (least(x), most(x), least(y), most(y));
    let misses_rows = |low: i32, high: i32| {
        let step = (1 << target.row_step_log2) - 1;
        (low - target.first_row + step) >> target.row_step_log2
            > (high - target.first_row) >> target.row_step_log2
    };
    if misses_rows(x0, x1) || misses_rows(y0, y1) {
        return None;
    }
    let [width, height] = target.projection.size.map(|s| s as i32);
    let (px0, px1) = ((x0 >> RASTER_BITS).max(0), (x1 >> RASTER_BITS).min(width - 1));
    let (py0, py1) = ((y0 >> RASTER_BITS).max(0), (y1 >> RASTER_BITS).min(height - 1));
    if px0 > px1 || py0 > py1 {
        return None;
    }
    Some(Triangle {
        x,
        y,
        plane: DepthPlane::default(),
        nearest: nearest(v),
        pixels: [px0 as u16, px1 as u16, py0 as u16, py1 as u16],
        large: (x1 - x0).max(y1 - y0) > SMALL_PX << RASTER_BITS,
    })
}

/// The largest depth of three.
#[inline(always)]
fn nearest(v: &[ScreenVertex; 3]) -> f32 {
    // Plain comparisons: depths are numbers, and the standard functions look for those that are not.
    let nearer = |a: f32, b: f32| if a > b { a } else { b };
    nearer(nearer(v[0].depth, v[1].depth), v[2].depth)
}

/// Depth over the picture, from the vertices before they were snapped to the raster.
#[inline(always)]
fn plane(v: &[ScreenVertex; 3]) -> DepthPlane {
    const PX: f64 = (1 << SCREEN_BITS) as f64;
    let [x0, x1, x2] = v.map(|v| f64::from(v.x));
    let [y0, y1, y2] = v.map(|v| f64::from(v.y));
    let [z0, z1, z2] = v.map(|v| f64::from(v.depth));
    let (ux, uy, uz) = (x1 - x0, y1 - y0, z1 - z0);
    let (wx, wy, wz) = (x2 - x0, y2 - y0, z2 - z0);
    let area = ux * wy - uy * wx;
    let farther = |a: f64, b: f64| if a > b { a } else { b };
    let reach = farther(farther(ux.abs(), uy.abs()), farther(wx.abs(), wy.abs()));
    let (dx, dy) = if area.abs() < SLIVER * reach {
        along_longest_edge([[ux, uy, uz], [wx, wy, wz], [wx - ux, wy - uy, wz - uz]])
    } else {
        let scale = PX / area;
        ((uz * wy - wz * uy) * scale, (wz * ux - uz * wx) * scale)
    };
    DepthPlane { origin: z0 - (dx * x0 + dy * y0) / PX, dx, dy }
}

/// The slope, per pixel, that explains the depth along the longest of three edges and is level
/// across it.
fn along_longest_edge(edges: [[f64; 3]; 3]) -> (f64, f64) {
    const PX: f64 = (1 << SCREEN_BITS) as f64;
    let length2 = |e: &[f64; 3]| e[0] * e[0] + e[1] * e[1];
    let mut longest = edges[0];
    for e in &edges[1..] {
        if length2(e) > length2(&longest) {
            longest = *e;
        }
    }
    let scale = PX * longest[2] / length2(&longest).max(1.0);
    (longest[0] * scale, longest[1] * scale)
}

/// Whether part of a triangle lies outside the picture.
#[inline(always)]
fn reaches_over_border(v: &[ScreenVertex; 3], target: &Target<'_>) -> bool {
    let [width, height] = target.projection.size.map(|s| (s as i32) << SCREEN_BITS);
    v.iter().any(|v| v.x < 0 || v.y < 0 || v.x > width || v.y > height)
}

/// The normal of a plane in view space, from its depth as a function of the picture: a plane
/// `n . p = c` has depth proportional to `(n . ray) / c`.
#[inline(always)]
fn facing(plane: &DepthPlane, projection: &Projection) -> [i8; 3] {
    let rows = &projection.rows;
    let (fx, cx) = (rows[0][0], -rows[0][2]);
    let (fy, cy) = (-rows[1][1], -rows[1][2]);
    let axis = plane.origin + plane.dx * cx + plane.dy * cy;
    let n = [plane.dx * fx, plane.dy * fy, axis].map(|v| v as f32);
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt().max(1e-30);
    let scale = 127.0 / length;
    n.map(|v| (v * scale) as i8)
}
