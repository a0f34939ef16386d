//! What the surface is like where a fragment is shaded: position, normal, texture coordinates and
//! their change over a pixel, from the triangle of its id.
//!
//! Barycentric coordinates come from the ray through the fragment's point and the unclipped
//! triangle (Moeller and Trumbore 1997), clamped to the triangle, so that points just off it at a
//! silhouette stay on the surface.

use crate::draw::abi::View;
use crate::engine::cpu::chunk::{Chunk, Face, split_id};
use crate::engine::cpu::fragment::Fragment;
use crate::engine::cpu::project::Vertex;
use crate::engine::cpu::simd::{F32x8, LANES, Mask8, Vec3x8};

/// Triangles by id.
#[derive(Clone, Copy)]
pub(in crate::engine::cpu) struct Geometry<'a> {
    pub(in crate::engine::cpu) chunks: &'a [Chunk],
    pub(in crate::engine::cpu) vertices: &'a [Vertex],
}

impl<'a> Geometry<'a> {
    #[inline(always)]
    fn corners(&self, id: u32) -> [&'a Vertex; 3] {
        let (chunk, triangle) = split_id(id);
        let face: &Face = &self.chunks[chunk].faces[triangle];
        let [a, b, c] = face.corners;
        [&self.vertices[a as usize], &self.vertices[b as usize], &self.vertices[c as usize]]
    }
}

/// Rays through the picture.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine::cpu) struct Rays {
    center: [f32; 2],
    /// Change of a ray's x over a pixel to the right and of its y over a pixel down, at z = -1.
    step: [f32; 2],
}

impl Rays {
    pub(in crate::engine::cpu) fn new(view: &View) -> Self {
        Self { center: [view.cx, view.cy], step: [1.0 / view.fx, -1.0 / view.fy] }
    }
}

/// Surface under eight fragments.
pub(super) struct Points<const AVX2: bool> {
    /// View space.
    pub(super) position: Vec3x8<AVX2>,
    /// Unit shading normal, view space, towards the side that was modelled.
    pub(super) normal: Vec3x8<AVX2>,
    /// Where the triangle's counter-clockwise side faces away.
    pub(super) back: Mask8<AVX2>,
    /// Present where asked for.
    pub(super) texture: Option<TexturePoints<AVX2>>,
}

/// Texture coordinates under eight fragments.
pub(super) struct TexturePoints<const AVX2: bool> {
    pub(super) uv: [F32x8<AVX2>; 2],
    /// Change over a pixel to the right.
    pub(super) d_dx: [F32x8<AVX2>; 2],
    /// Change over a pixel down.
    pub(super) d_dy: [F32x8<AVX2>; 2],
    /// Direction in which u grows, view space, any length.
    pub(super) tangent: Vec3x8<AVX2>,
    /// Direction in which v grows, view space, any length.
    pub(super) bitangent: Vec3x8<AVX2>,
}

/// The triangles of eight fragments: one corner, the two edges from it, and the vertices.
struct Triangles<'a, const AVX2: bool> {
    origin: Vec3x8<AVX2>,
    edge1: Vec3x8<AVX2>,
    edge2: Vec3x8<AVX2>,
    corners: [[&'a Vertex; 3]; LANES],
    /// All eight are the same.
    same: bool,
}

impl<'a, const AVX2: bool> Triangles<'a, AVX2> {
    #[inline(always)]
    fn new(geometry: &Geometry<'a>, fragments: &[Fragment]) -> Self {
        let first = geometry.corners(fragments[0].id);
        let mut other = 0;
        for fragment in fragments {
            other |= fragment.id ^ fragments[0].id;
        }
        let same = other == 0;
        let mut corners = [first; LANES];
        let p = if same {
            [
                Vec3x8::splat(first[0].position()),
                Vec3x8::splat(first[1].position()),
                Vec3x8::splat(first[2].position()),
            ]
        } else {
            for lane in 0..LANES {
                corners[lane] = geometry.corners(fragments[lane].id);
            }
            [positions(&corners, 0), positions(&corners, 1), positions(&corners, 2)]
        };
        Self { origin: p[0], edge1: p[1] - p[0], edge2: p[2] - p[0], corners, same }
    }

    /// All eight numbers of the vertices, interpolated.
    #[inline(always)]
    fn interpolate(&self, weights: [F32x8<AVX2>; 3]) -> [F32x8<AVX2>; LANES] {
        let mut out = [F32x8::ZERO; LANES];
        if self.same {
            let [a, b, c] = self.corners[0];
            for k in Vertex::U..LANES {
                out[k] = weights[0] * F32x8::splat(a.0[k])
                    + weights[1] * F32x8::splat(b.0[k])
                    + weights[2] * F32x8::splat(c.0[k]);
            }
        } else {
            for lane in 0..LANES {
                let [a, b, c] = self.corners[lane];
                let mixed = F32x8::<AVX2>(a.0) * F32x8::splat(weights[0].0[lane])
                    + F32x8(b.0) * F32x8::splat(weights[1].0[lane])
                    + F32x8(c.0) * F32x8::splat(weights[2].0[lane]);
                for k in Vertex::U..LANES {
                    out[k].0[lane] = mixed.0[k];
                }
            }
        }
        out
    }

    /// Differences of texture coordinates along both edges.
    #[inline(always)]
    fn texture_edges(&self) -> [[F32x8<AVX2>; 2]; 2] {
        let mut d = [[F32x8::ZERO; 2]; 2];
        for lane in 0..LANES {
            let [a, b, c] = self.corners[lane];
            d[0][0].0[lane] = b.0[Vertex::U] - a.0[Vertex::U];
            d[0][1].0[lane] = b.0[Vertex::V] - a.0[Vertex::V];
            d[1][0].0[lane] = c.0[Vertex::U] - a.0[Vertex::U];
            d[1][1].0[lane] = c.0[Vertex::V] - a.0[Vertex::V];
        }
        d
    }
}

/// Positions of one corner of eight triangles.
#[inline(always)]
fn positions<const AVX2: bool>(corners: &[[&Vertex; 3]; LANES], corner: usize) -> Vec3x8<AVX2> {
    let mut p = Vec3x8::ZERO;
    for lane in 0..LANES {
        let [x, y, z] = corners[lane][corner].position();
        (p.x.0[lane], p.y.0[lane], p.z.0[lane]) = (x, y, z);
    }
    p
}

/// Finds the surface under eight fragments.
#[inline(always)]
pub(super) fn points<const AVX2: bool>(
    geometry: &Geometry<'_>,
    rays: &Rays,
    fragments: &[Fragment],
    textured: bool,
) -> Points<AVX2> {
    let fragments = &fragments[..LANES];
    let (mut x, mut y) = (F32x8::ZERO, F32x8::ZERO);
    for lane in 0..LANES {
        (x.0[lane], y.0[lane]) = (fragments[lane].x, fragments[lane].y);
    }
    let ray = Vec3x8::new(
        (x - F32x8::splat(rays.center[0])) * F32x8::splat(rays.step[0]),
        (y - F32x8::splat(rays.center[1])) * F32x8::splat(rays.step[1]),
        F32x8::splat(-1.0),
    );
    let triangles = Triangles::new(geometry, fragments);
    let (origin, edge1, edge2) = (triangles.origin, triangles.edge1, triangles.edge2);

    // From the first corner to where the ray is as deep as it: short, so that little cancels.
    let to_ray =
        Vec3x8::new(-origin.z * ray.x - origin.x, -origin.z * ray.y - origin.y, F32x8::ZERO);
    let across = ray.cross(edge2);
    let determinant = edge1.dot(across);
    let inverse = determinant / (determinant * determinant).max(F32x8::splat(1e-36));
    let raw1 = to_ray.dot(across) * inverse;
    let raw2 = ray.dot(to_ray.cross(edge1)) * inverse;
    let weights = clamp_to_triangle(raw1, raw2);

    let mixed = triangles.interpolate(weights);
    let position = origin + edge1.scale(weights[1]) + edge2.scale(weights[2]);
    let n = Vertex::NORMAL;
    let normal = Vec3x8::new(mixed[n], mixed[n + 1], mixed[n + 2]).normalized();
    let back = F32x8::ZERO.gt(determinant);
    let texture = if textured {
        let uv = [mixed[Vertex::U], mixed[Vertex::V]];
        Some(texture_points(&triangles, rays, [raw1, raw2], inverse, uv))
    } else {
        None
    };
    Points { position, normal, back, texture }
}

/// How texture coordinates change over a pixel, and in which directions they grow.
#[inline(always)]
fn texture_points<const AVX2: bool>(
    triangles: &Triangles<'_, AVX2>,
    rays: &Rays,
    barycentric: [F32x8<AVX2>; 2],
    inverse: F32x8<AVX2>,
    uv: [F32x8<AVX2>; 2],
) -> TexturePoints<AVX2> {
    let [along1, along2] = triangles.texture_edges();
    let [change1, change2] = barycentric_change(triangles, rays, barycentric, inverse);
    // Solves edge_k = u_k tangent + v_k bitangent; the sign of the area is all that is kept of the
    // denominator, lengths do not matter.
    let area = along1[0] * along2[1] - along1[1] * along2[0];
    let sign = area.ge(F32x8::ZERO).select(F32x8::ONE, F32x8::splat(-1.0));
    let tangent = triangles.edge1.scale(along2[1]) - triangles.edge2.scale(along1[1]);
    let bitangent = triangles.edge2.scale(along1[0]) - triangles.edge1.scale(along2[0]);
    TexturePoints {
        uv,
        d_dx: [
            change1[0] * along1[0] + change2[0] * along2[0],
            change1[0] * along1[1] + change2[0] * along2[1],
        ],
        d_dy: [
            change1[1] * along1[0] + change2[1] * along2[0],
            change1[1] * along1[1] + change2[1] * along2[1],
        ],
        tangent: tangent.scale(sign),
        bitangent: bitangent.scale(sign),
    }
}

/// Weights of the three corners, none negative and of sum 1, from two of them.
#[inline(always)]
fn clamp_to_triangle<const AVX2: bool>(w1: F32x8<AVX2>, w2: F32x8<AVX2>) -> [F32x8<AVX2>; 3] {
    let zero = F32x8::ZERO;
    let (w1, w2) = (w1.max(zero), w2.max(zero));
    let w0 = (F32x8::ONE - w1 - w2).max(zero);
    let inverse = F32x8::ONE / (w0 + w1 + w2);
    [w0 * inverse, w1 * inverse, w2 * inverse]
}

/// Change of the second and third barycentric coordinate over a pixel to the right and a pixel
/// down: numerators and determinant are linear in the ray.
#[inline(always)]
fn barycentric_change<const AVX2: bool>(
    t: &Triangles<'_, AVX2>,
    rays: &Rays,
    at: [F32x8<AVX2>; 2],
    inverse: F32x8<AVX2>,
) -> [[F32x8<AVX2>; 2]; 2] {
    let numerators = [t.origin.cross(t.edge2), t.edge1.cross(t.origin)];
    let determinant = t.edge2.cross(t.edge1);
    let mut change = [[F32x8::ZERO; 2]; 2];
    for k in 0..2 {
        let x = (numerators[k].x - at[k] * determinant.x) * inverse;
        let y = (numerators[k].y - at[k] * determinant.y) * inverse;
        change[k] = [x * F32x8::splat(rays.step[0]), y * F32x8::splat(rays.step[1])];
    }
    change
}
