//! From view space to fixed-point picture coordinates, for the camera and for the sun.
//!
//! Projection runs in `f64`, so that a snapped vertex is off by the snapping alone, also at 8192
//! pixels. Culling and clipping are not done here; what cannot be projected is marked.

use super::simd::{F32x8, LANES, Vec3x8, kernel};
use crate::draw::abi::View;

/// Binary digits of a pixel in [`ScreenVertex`]; the raster rounds to fewer.
pub(super) const SCREEN_BITS: u32 = 16;
/// Vertices up to this far outside the picture are rastered as they are, pixels. Together with the
/// largest picture it bounds every coordinate difference to 2^14 pixels, on which the exactness of
/// the raster's integers rests.
pub(super) const GUARD_PX: f64 = 4096.0;

/// A placed vertex: view-space position and u, view-space unit normal and v. The eight numbers
/// fill one vector register, so that all are interpolated at once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Vertex(pub(super) [f32; LANES]);

impl Vertex {
    /// Where x, y and z of the normal stand.
    pub(super) const NORMAL: usize = 4;
    /// Where u stands.
    pub(super) const U: usize = 3;
    /// Where v stands.
    pub(super) const V: usize = 7;

    /// View space, metres.
    #[inline(always)]
    pub(super) const fn position(&self) -> [f32; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
}

/// A projected vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ScreenVertex {
    /// Pixels in 16.16 fixed point, or [`ScreenVertex::OUTSIDE`].
    pub(super) x: i32,
    /// Pixels in 16.16 fixed point.
    pub(super) y: i32,
    /// Reversed depth, larger is nearer.
    pub(super) depth: f32,
}

impl ScreenVertex {
    /// Marks a vertex in front of the near plane or outside the guard band.
    pub(super) const OUTSIDE: i32 = i32::MIN;
}

/// A projective map: rows give `x w`, `y w` (pixels), `w` and `depth w` of a view-space point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Projection {
    /// Four affine functions of the point.
    pub(super) rows: [[f64; 4]; 4],
    /// Points with a smaller `w` are not projected.
    pub(super) near_w: f64,
    /// Pixels.
    pub(super) size: [u32; 2],
}

/// Row of [`Projection::rows`] that gives `x w`.
pub(super) const ROW_X: usize = 0;
/// Row of [`Projection::rows`] that gives `y w`.
pub(super) const ROW_Y: usize = 1;
/// Row of [`Projection::rows`] that gives `w`.
pub(super) const ROW_W: usize = 2;
/// Row of [`Projection::rows`] that gives `depth w`.
pub(super) const ROW_DEPTH: usize = 3;

/// An affine function of a point.
#[inline(always)]
pub(super) fn affine(row: &[f64; 4], p: [f64; 3]) -> f64 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]
}

impl Projection {
    /// The camera of [`crate::base::space`].
    pub(super) fn perspective(view: &View) -> Self {
        let [fx, fy, cx, cy, near] =
            [view.fx, view.fy, view.cx, view.cy, view.near_m].map(f64::from);
        Self {
            rows: [
                [fx, 0.0, -cx, 0.0],
                [0.0, -fy, -cy, 0.0],
                [0.0, 0.0, -1.0, 0.0],
                [0.0, 0.0, 0.0, near],
            ],
            near_w: near,
            size: [view.width, view.height],
        }
    }

    /// A parallel projection whose rows give x, y and depth.
    pub(super) fn parallel(x: [f64; 4], y: [f64; 4], depth: [f64; 4], size: [u32; 2]) -> Self {
        Self { rows: [x, y, [0.0, 0.0, 0.0, 1.0], depth], near_w: 0.5, size }
    }

    /// Projects one point, which must lie in the guard band and behind the near plane.
    pub(super) fn project(&self, p: [f64; 3]) -> ScreenVertex {
        let w = affine(&self.rows[ROW_W], p);
        let fixed = |row: usize| to_fixed(affine(&self.rows[row], p) / w);
        let depth = (affine(&self.rows[ROW_DEPTH], p) / w) as f32;
        ScreenVertex { x: fixed(ROW_X), y: fixed(ROW_Y), depth }
    }

    /// Projects eight points.
    #[inline(always)]
    pub(super) fn project8<const AVX2: bool>(&self, p: Vec3x8<AVX2>, out: &mut [ScreenVertex]) {
        let out = &mut out[..LANES];
        let guard_x = f64::from(self.size[0]) + GUARD_PX;
        let guard_y = f64::from(self.size[1]) + GUARD_PX;
        let (mut x, mut y, mut depth) = ([0; LANES], [0; LANES], [0.0; LANES]);
        let mut i = 0;
        while i < LANES {
            let q = [f64::from(p.x.0[i]), f64::from(p.y.0[i]), f64::from(p.z.0[i])];
            let w = affine(&self.rows[ROW_W], q);
            let inverse_w = 1.0 / w;
            let x_px = affine(&self.rows[ROW_X], q) * inverse_w;
            let y_px = affine(&self.rows[ROW_Y], q) * inverse_w;
            let inside = (w >= self.near_w)
                & (x_px >= -GUARD_PX)
                & (x_px <= guard_x)
                & (y_px >= -GUARD_PX)
                & (y_px <= guard_y);
            x[i] = if inside { to_fixed(x_px) } else { ScreenVertex::OUTSIDE };
            y[i] = to_fixed(y_px);
            depth[i] = (affine(&self.rows[ROW_DEPTH], q) * inverse_w) as f32;
            i += 1;
        }
        for i in 0..LANES {
            out[i] = ScreenVertex { x: x[i], y: y[i], depth: depth[i] };
        }
    }
}

/// Pixels to 16.16 fixed point, rounded to nearest, by way of a number so large that its last
/// binary digit is worth one; vectorises where a cast would not.
#[inline(always)]
fn to_fixed(px: f64) -> i32 {
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
    (px * f64::from(1 << SCREEN_BITS) + ROUND).to_bits() as i32
}

/// Positions of eight vertices.
#[inline(always)]
pub(super) fn positions8<const AVX2: bool>(vertices: &[Vertex]) -> Vec3x8<AVX2> {
    let vertices = &vertices[..LANES];
    let (mut x, mut y, mut z) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for i in 0..LANES {
        [x[i], y[i], z[i]] = vertices[i].position();
    }
    Vec3x8::new(F32x8(x), F32x8(y), F32x8(z))
}

kernel! {
    /// Projects vertices, a multiple of eight of them.
    fn project_all(vertices: &[Vertex], projection: &Projection, out: &mut [ScreenVertex])
        = project_body
}

#[inline(always)]
fn project_body<const AVX2: bool>(
    vertices: &[Vertex],
    projection: &Projection,
    out: &mut [ScreenVertex],
) {
    for (from, to) in vertices.chunks_exact(LANES).zip(out.chunks_exact_mut(LANES)) {
        projection.project8(positions8::<AVX2>(from), to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_point_rounds_to_nearest_on_both_sides_of_zero() {
        for (px, fixed) in [(0.0, 0), (1.5, 98_304), (-4096.0, -268_435_456), (-1e-5, -1)] {
            assert_eq!(to_fixed(px), fixed);
        }
    }

    #[test]
    fn what_cannot_be_projected_is_marked() {
        let view = View {
            width: 64,
            height: 64,
            fx: 64.0,
            fy: 64.0,
            cx: 32.0,
            cy: 32.0,
            near_m: 0.1,
            ..View::default()
        };
        let projection = Projection::perspective(&view);
        let mut vertices = [Vertex::default(); LANES];
        for (v, p) in vertices.iter_mut().zip([
            [0.0, 0.0, -1.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -0.05],
            [1000.0, 0.0, -1.0],
            [0.0, 0.0, 0.0],
            [0.5, 0.5, -1.0],
            [0.0, -1000.0, -1.0],
            [0.0, 0.0, -1000.0],
        ]) {
            v.0[..3].copy_from_slice(&p);
        }
        let mut out = [ScreenVertex::default(); LANES];
        project_all(crate::engine::cpu::simd::Level::BASELINE, &vertices, &projection, &mut out);
        let marked = out.map(|v| v.x == ScreenVertex::OUTSIDE);
        assert_eq!(marked, [false, true, true, true, true, false, true, false]);
        assert_eq!((out[5].x, out[5].y), (64 << 16, 0));
        assert!((out[7].depth - 0.1 / 1000.0).abs() < 1e-10);
    }
}
