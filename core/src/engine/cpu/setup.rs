//! Cull: from projected vertices to the triangles that may cover a sample.
//!
//! Drops back faces, triangles outside the picture, and those that lie between the rows or
//! columns of samples. Triangles with a vertex that could not be projected go to [`super::clip`].

use super::chunk::{Chunk, DepthPlane, Face, Triangle};
use super::project::{Projection, SCREEN_BITS, ScreenVertex, Vertex};
use super::samples::{Layout, RASTER_BITS, TILE};
use super::shadow::SunAxes;
use super::simd::kernel;
use super::{clip, shadow};

/// Triangles up to this size have edge functions below 2^31 all over a tile: with extent E and
/// tile side T in pixels, the largest is 2 E (E + T) 2^14, for E = 192 and T = 34 some 1.4e9.
const SMALL_PX: i32 = 192;

/// Below this thickness a triangle's depth is taken from its longest edge alone, as its slope
/// would be made of rounding; 1/512 pixel in 16.16 fixed point.
const SLIVER: f64 = 128.0;

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
    /// Axes along which to bound what is seen, for the fit of a shadow map.
    pub(super) sun: Option<&'a SunAxes>,
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
            sun: None,
        }
    }

    /// The sun's shadow map.
    pub(super) fn shadow(
        vertices: &'a [Vertex],
        screen: &'a [ScreenVertex],
        projection: &'a Projection,
    ) -> Self {
        Self { tile_log2: shadow::TILE.ilog2(), ..Self::picture::<1>(vertices, screen, projection) }
    }
}

kernel! {
    /// Culls, clips and bins the triangles of a chunk.
    fn set_up(chunk: &mut Chunk, mesh_triangles: &[[u32; 3]], target: &Target<'_>) = set_up_body
}

// Triangle by triangle; as a kernel it gets the instructions of the detected processor.
#[inline(always)]
fn set_up_body<const AVX2: bool>(
    chunk: &mut Chunk,
    mesh_triangles: &[[u32; 3]],
    target: &Target<'_>,
) {
    chunk.triangles.clear();
    chunk.faces.clear();
    chunk.crossing.clear();
    chunk.border.clear();
    for triangle in &mesh_triangles[chunk.source.clone()] {
        let corners = triangle.map(|v| v + chunk.first_vertex);
        let v = corners.map(|c| target.screen[c as usize]);
        if v.iter().any(|v| v.x == ScreenVertex::OUTSIDE) {
            chunk.crossing.push(corners);
        } else if let Some(t) = cull(chunk, &v, target) {
            let plane = plane(&v);
            if target.sun.is_some() && reaches_over_border(&v, target) {
                chunk.border.push(corners);
            }
            chunk.push(t.with_plane(plane), corners, target);
        }
    }
    clip::add_crossing(chunk, target);
    if let Some(sun) = target.sun {
        clip::bound_border(chunk, target, sun);
    }
    chunk.bins.fill(&chunk.triangles, target.tile_log2);
}

impl Triangle {
    #[inline(always)]
    pub(super) fn with_plane(self, plane: DepthPlane) -> Self {
        Self { plane, ..self }
    }
}

impl Chunk {
    /// Takes a triangle over.
    #[inline(always)]
    pub(super) fn push(&mut self, triangle: Triangle, corners: [u32; 3], target: &Target<'_>) {
        if target.shaded {
            let normal = facing(&triangle.plane, target.projection);
            self.faces.push(Face { corners, normal });
        }
        self.triangles.push(triangle);
    }
}

/// The triangle in raster coordinates, without its plane, if it faces the viewer and may cover a
/// sample.
#[inline(always)]
pub(super) fn cull(chunk: &Chunk, v: &[ScreenVertex; 3], target: &Target<'_>) -> Option<Triangle> {
    const HALF: i32 = 1 << (SCREEN_BITS - RASTER_BITS - 1);
    let snap = |fixed: i32| (fixed + HALF) >> (SCREEN_BITS - RASTER_BITS);
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
    // Plain comparisons: depths are numbers, and the standard functions look for those that are not.
    let nearer = |a: f32, b: f32| if a > b { a } else { b };
    let nearest = nearer(nearer(v[0].depth, v[1].depth), v[2].depth);
    Some(Triangle {
        x,
        y,
        plane: DepthPlane::default(),
        nearest,
        pixels: [px0 as u16, px1 as u16, py0 as u16, py1 as u16],
        large: (x1 - x0).max(y1 - y0) > SMALL_PX << RASTER_BITS,
    })
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
