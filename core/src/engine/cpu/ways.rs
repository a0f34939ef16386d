//! Ways: how far what a pixel shows goes in the picture until the shutter closes.
//!
//! Of the nearest sample of each pixel, on the ray through the pixel's middle: the point of its triangle
//! there, that point's place when the shutter closes, and the way between them in the picture; the
//! formulas are those of `shaders/way.wgsl`.

use super::chunk::{NOTHING, split_id};
use super::lens::LensTile;
use super::samples::{Layout, TILE};
use super::tile::TilePass;
use crate::draw::abi::Shutter;
use crate::engine::optics::{MOST_WAY_PX, WAY_PER_PX};

/// Numbers of a tile's pixels by slot: the way in x and y, pixels, and the nearest sample's depth.
pub(super) type TileWays = [[f32; TILE * TILE]; 3];

/// A ray through a pixel's middle at z = -1, and its change over a pixel to the right and down.
#[derive(Clone, Copy)]
struct Ray {
    at: [f32; 2],
    right: [f32; 2],
    down: [f32; 2],
}

impl Ray {
    /// What a change of a ray is in the picture, pixels.
    fn px_of(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let per_det = 1.0 / (self.right[0] * self.down[1] - self.down[0] * self.right[1]);
        [
            (x * self.down[1] - y * self.down[0]) * per_det,
            (y * self.right[0] - x * self.right[1]) * per_det,
        ]
    }
}

/// The ways of a tile's pixels.
pub(super) fn ways_of_tile<const S: usize>(
    pass: &TilePass<'_>,
    shutter: &Shutter,
    origin_px: [u32; 2],
    lens: Option<&LensTile>,
    (ids, depth): (&[u32], &[f32]),
    out: &mut TileWays,
) {
    let samples = ids.as_chunks::<S>().0.iter().zip(depth.as_chunks::<S>().0);
    for (slot, ((ids, depth), xy)) in samples.zip(&Layout::<S>::SLOT_XY).enumerate() {
        let (mut id, mut nearest) = (NOTHING, 0.0);
        for (own, depth) in ids.iter().zip(depth) {
            if *depth > nearest {
                (id, nearest) = (*own, *depth);
            }
        }
        let pixel = [origin_px[0] + u32::from(xy[0]), origin_px[1] + u32::from(xy[1])];
        let ray = ray(pass, pixel, lens.map(|lens| (lens, slot)));
        let [x, y] = cut(pass.way(shutter, id, &ray), MOST_WAY_PX);
        (out[0][slot], out[1][slot], out[2][slot]) = (x, y, nearest);
    }
}

fn ray(pass: &TilePass<'_>, [x, y]: [u32; 2], lens: Option<(&LensTile, usize)>) -> Ray {
    if let Some((lens, slot)) = lens {
        let [x, y, x_right, x_down, y_right, y_down] = lens.rays.each_ref().map(|v| v[slot]);
        return Ray { at: [x, y], right: [x_right, y_right], down: [x_down, y_down] };
    }
    let view = &pass.list.view;
    let [right, down] = [1.0 / view.fx, -1.0 / view.fy];
    let at = [(x as f32 + 0.5 - view.cx) * right, (y as f32 + 0.5 - view.cy) * down];
    Ray { at, right: [right, 0.0], down: [0.0, down] }
}

/// No longer than so, in whole parts of a pixel.
pub(super) fn cut(way: [f32; 2], longest_px: f32) -> [f32; 2] {
    let length_px = (way[0] * way[0] + way[1] * way[1]).sqrt();
    // What is not a number is cut to nothing.
    if !length_px.is_finite() {
        return [0.0; 2];
    }
    let factor = longest_px / length_px.max(longest_px);
    way.map(|v| (v * factor * WAY_PER_PX + 0.5).floor() / WAY_PER_PX)
}

impl TilePass<'_> {
    /// The way of what a sample shows, pixels.
    fn way(&self, shutter: &Shutter, id: u32, ray: &Ray) -> [f32; 2] {
        let (from, to) = if id == NOTHING {
            let from = [ray.at[0], ray.at[1], -1.0];
            (from, shutter.end_from_view.map(|row| dot(row, from)))
        } else {
            let (chunk, triangle) = split_id(id);
            let chunk = &self.chunks[chunk];
            if self.list.objects[chunk.object as usize].end.is_none() {
                return [0.0; 2];
            }
            let corners = chunk.faces[triangle].corners.map(|c| c as usize);
            let points = corners.map(|c| self.placed.vertices[c].position());
            let shares = shares(points, [ray.at[0], ray.at[1], -1.0]);
            let from = weighed(points, shares);
            let way = weighed(corners.map(|c| self.placed.ways[c]), shares);
            (from, [0, 1, 2].map(|i| from[i] + way[i]))
        };
        let near = self.list.view.near_m.min(-from[2]);
        let plane = |p: [f32; 3]| [p[0], p[1]].map(|v| v / (-p[2]).max(near));
        let (from, to) = (plane(from), plane(to));
        ray.px_of([to[0] - from[0], to[1] - from[1]])
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn weighed(points: [[f32; 3]; 3], shares: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| dot([points[0][i], points[1][i], points[2][i]], shares))
}

/// Shares of a triangle's corners in the point that a ray from the origin meets, no farther off than
/// the triangle reaches (Moeller and Trumbore 1997).
fn shares([a, b, c]: [[f32; 3]; 3], ray: [f32; 3]) -> [f32; 3] {
    let minus = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let (u, v) = (minus(b, a), minus(c, a));
    let p = cross(ray, v);
    let q = cross(u, a);
    let det = dot(u, p);
    if det == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let second = (-dot(a, p) / det).clamp(0.0, 1.0);
    let third = (dot(ray, q) / det).clamp(0.0, 1.0 - second);
    [1.0 - second - third, second, third]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_triangles_where_they_do() {
        let corners = [[-1.0, -1.0, -2.0], [3.0, -1.0, -4.0], [0.0, 2.0, -3.0]];
        for wanted in [[0.2, 0.3, 0.5], [1.0, 0.0, 0.0], [0.0, 0.6, 0.4]] {
            let p = weighed(corners, wanted);
            let got = shares(corners, [p[0] / -p[2], p[1] / -p[2], -1.0]);
            let error = (0..3).map(|i| (got[i] - wanted[i]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-5, "{wanted:?}: {got:?}");
        }
        let beyond = shares(corners, [-2.0, -2.0, -1.0]);
        assert!(beyond.iter().all(|v| (0.0..=1.0).contains(v)), "{beyond:?}");
    }

    #[test]
    fn a_ray_that_changes_is_a_way_in_pixels() {
        let ray = Ray { at: [0.1, 0.2], right: [0.01, 0.002], down: [-0.003, -0.02] };
        let (x, y) = (3.0, -5.0);
        let change = [0, 1].map(|i| ray.right[i] * x + ray.down[i] * y);
        let got = ray.px_of(change);
        assert!((got[0] - x).abs() < 1e-4 && (got[1] - y).abs() < 1e-4, "{got:?}");
    }
}
