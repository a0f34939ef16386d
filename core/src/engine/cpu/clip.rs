//! Clip: triangles that reach behind the near plane or far outside the picture.
//!
//! Works in view space and `f64` with planes taken from the projection. Each new point is
//! computed from the inner to the outer end of its edge, so that neighbours that share the edge
//! get the same point and no crack opens.

use super::chunk::{Chunk, DepthPlane};
use super::project::{
    GUARD_PX, Projection, ROW_DEPTH, ROW_W, ROW_X, ROW_Y, ScreenVertex, Vertex, affine,
};
use super::setup::{Target, cull};
use super::shadow::{Bounds, SunAxes};

/// A point of view space.
type Point = [f64; 3];

/// A convex polygon: a triangle cut by up to five planes.
struct Polygon {
    points: [Point; 8],
    len: usize,
}

impl Polygon {
    fn triangle(corners: [u32; 3], vertices: &[Vertex]) -> Self {
        let mut points = [[0.0; 3]; 8];
        for (point, corner) in points.iter_mut().zip(corners) {
            *point = vertices[corner as usize].position().map(f64::from);
        }
        Self { points, len: 3 }
    }

    fn points(&self) -> &[Point] {
        &self.points[..self.len]
    }

    /// Keeps the part where an affine function is not negative.
    fn cut(&mut self, plane: &[f64; 4]) {
        let mut kept = Self { points: [[0.0; 3]; 8], len: 0 };
        for i in 0..self.len {
            let (a, b) = (self.points[i], self.points[(i + 1) % self.len]);
            let (da, db) = (affine(plane, a), affine(plane, b));
            if da >= 0.0 {
                kept.add(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                kept.add(if da >= 0.0 { crossing(a, da, b, db) } else { crossing(b, db, a, da) });
            }
        }
        *self = kept;
    }

    fn add(&mut self, p: Point) {
        // Rounding can make a polygon that is not quite convex cross a plane once too often; a
        // point more than the exact result could have is then left out.
        if self.len < self.points.len() {
            self.points[self.len] = p;
            self.len += 1;
        }
    }
}

/// Where an edge meets a plane, from the inner end.
fn crossing(inner: Point, d_inner: f64, outer: Point, d_outer: f64) -> Point {
    let t = d_inner / (d_inner - d_outer);
    std::array::from_fn(|i| inner[i] + (outer[i] - inner[i]) * t)
}

/// The near plane and the four sides of the picture, moved outwards by a margin.
fn planes(projection: &Projection, margin_px: f64) -> [[f64; 4]; 5] {
    let rows = &projection.rows;
    let side = |row: usize, sign: f64, limit: f64| -> [f64; 4] {
        std::array::from_fn(|i| sign * (rows[row][i] - limit * rows[ROW_W][i]))
    };
    let [width, height] = projection.size.map(f64::from);
    let mut near = rows[ROW_W];
    near[3] -= projection.near_w;
    [
        near,
        side(ROW_X, 1.0, -margin_px),
        side(ROW_X, -1.0, width + margin_px),
        side(ROW_Y, 1.0, -margin_px),
        side(ROW_Y, -1.0, height + margin_px),
    ]
}

/// Cuts the triangles that could not be projected and adds what is left of them.
pub(super) fn add_crossing(chunk: &mut Chunk, target: &Target<'_>) {
    if chunk.crossing.is_empty() {
        return;
    }
    let picture = planes(target.projection, 0.0);
    // Inside the guard band by a pixel, so that rounding does not leave it.
    let guard = planes(target.projection, GUARD_PX - 1.0);
    let crossing = std::mem::take(&mut chunk.crossing);
    for &corners in &crossing {
        let mut polygon = Polygon::triangle(corners, target.vertices);
        let misses = |plane: &[f64; 4]| polygon.points().iter().all(|p| affine(plane, *p) < 0.0);
        if picture.iter().any(misses) {
            continue;
        }
        let Some(plane) = depth_plane(polygon.points(), target.projection) else { continue };
        guard.iter().for_each(|side| polygon.cut(side));
        let screen: Vec<ScreenVertex> =
            polygon.points().iter().map(|p| target.projection.project(*p)).collect();
        for i in 2..screen.len() {
            let fan = [screen[0], screen[i - 1], screen[i]];
            if let Some(t) = cull(chunk, &fan, target) {
                chunk.push(t.with_plane(plane), corners, target);
            }
        }
    }
    chunk.crossing = crossing;
}

/// Depth over the picture of a triangle whose corners need not be projectable: the linear function
/// g with `g . (x w, y w, w) = depth w` at each corner, by Cramer's rule.
fn depth_plane(corners: &[Point], projection: &Projection) -> Option<DepthPlane> {
    let at = |row: usize| -> [f64; 3] {
        std::array::from_fn(|i| affine(&projection.rows[row], corners[i]))
    };
    let (x, y, w, depth) = (at(ROW_X), at(ROW_Y), at(ROW_W), at(ROW_DEPTH));
    let determinant = triple(x, y, w);
    let plane = DepthPlane {
        origin: triple(x, y, depth) / determinant,
        dx: triple(depth, y, w) / determinant,
        dy: triple(x, depth, w) / determinant,
    };
    let finite = plane.origin.is_finite() && plane.dx.is_finite() && plane.dy.is_finite();
    finite.then_some(plane)
}

/// The determinant of a matrix with these columns.
fn triple(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1])
}

/// Bounds, along the sun's axes, the visible parts of the triangles that reach over the border.
pub(super) fn bound_border(chunk: &mut Chunk, target: &Target<'_>, sun: &SunAxes) {
    let mut bounds = Bounds::EMPTY;
    let picture = planes(target.projection, 0.0);
    for &corners in chunk.border.iter().chain(&chunk.crossing) {
        let mut polygon = Polygon::triangle(corners, target.vertices);
        picture.iter().for_each(|side| polygon.cut(side));
        for p in polygon.points() {
            bounds.add(p.map(|v| v as f32), sun);
        }
    }
    chunk.border_bounds = bounds;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::abi::View;

    fn projection() -> Projection {
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
        Projection::perspective(&view)
    }

    #[test]
    fn cutting_keeps_exactly_the_inner_part() {
        let mut points = [[0.0; 3]; 8];
        points[..3].copy_from_slice(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
        let mut polygon = Polygon { points, len: 3 };
        polygon.cut(&[-1.0, 0.0, 0.0, 1.0]); // x <= 1
        assert_eq!(
            polygon.points(),
            &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]]
        );
        polygon.cut(&[1.0, 0.0, 0.0, -5.0]); // x >= 5
        assert!(polygon.points().is_empty());
    }

    #[test]
    fn the_depth_plane_goes_through_corners_behind_the_camera() {
        let projection = projection();
        let corners = [[-1.0, -0.5, -3.0], [2.0, -0.5, 4.0], [0.0, 1.0, -2.0]];
        let plane = depth_plane(&corners, &projection).unwrap();
        for t in [[0.6, 0.1, 0.3], [0.2, 0.1, 0.7], [0.0, 0.0, 1.0]] {
            let p: Point =
                std::array::from_fn(|i| (0..3).map(|k| corners[k][i] * t[k]).sum::<f64>());
            let (x, y) = (32.0 - 64.0 * p[0] / p[2], 32.0 + 64.0 * p[1] / p[2]);
            let depth = plane.origin + plane.dx * x + plane.dy * y;
            assert!((depth - f64::from(0.1f32) / -p[2]).abs() < 1e-12);
        }
    }
}
