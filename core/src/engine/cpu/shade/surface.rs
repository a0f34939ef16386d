//! What the surface is like where a fragment is shaded: position, normal, texture coordinates and
//! their change over a pixel, from the triangle of its id.
//!
//! Barycentric coordinates come from the ray through the fragment's point and the unclipped
//! triangle (Moeller and Trumbore 1997), clamped to the triangle, so that points just off it at a
//! silhouette stay on the surface.

use crate::draw::abi::View;
use crate::engine::cpu::chunk::{Chunk, Face, split_id};
use crate::engine::cpu::fragment::Bucket;
use crate::engine::cpu::project::Vertex;
use crate::engine::cpu::samples::TILE;
use crate::engine::cpu::simd::{F32x8, LANES, Mask8, Vec3x8, transposed};

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

    /// Directions through positions in the picture, view space, z = -1.
    #[inline(always)]
    pub(in crate::engine::cpu) fn directions<const AVX2: bool>(
        &self,
        [x, y]: [F32x8<AVX2>; 2],
    ) -> Vec3x8<AVX2> {
        Vec3x8::new(
            (x - F32x8::splat(self.center[0])) * F32x8::splat(self.step[0]),
            (y - F32x8::splat(self.center[1])) * F32x8::splat(self.step[1]),
            F32x8::splat(-1.0),
        )
    }

    /// Those through eight fragments.
    #[inline(always)]
    pub(super) fn through<const AVX2: bool>(
        &self,
        fragments: &Bucket,
        first: usize,
    ) -> RaysThrough<AVX2> {
        let (x, y) = (F32x8::load(&fragments.x[first..]), F32x8::load(&fragments.y[first..]));
        let [right, down] = self.step.map(F32x8::splat);
        RaysThrough {
            x: (x - F32x8::splat(self.center[0])) * right,
            y: (y - F32x8::splat(self.center[1])) * down,
            right: [right, F32x8::ZERO],
            down: [F32x8::ZERO, down],
        }
    }
}

/// Rays through eight fragments, at z = -1, and how their x and y change over a pixel.
#[derive(Clone, Copy)]
pub(super) struct RaysThrough<const AVX2: bool> {
    x: F32x8<AVX2>,
    y: F32x8<AVX2>,
    right: [F32x8<AVX2>; 2],
    down: [F32x8<AVX2>; 2],
}

/// Rays through the pixels of a tile behind a lens.
pub(in crate::engine::cpu) type LensRays = [[f32; TILE * TILE]; 6];

/// Rays through eight fragments behind a lens, from those through the middle of their pixels.
#[inline(always)]
pub(super) fn lens_rays<const AVX2: bool>(
    rays: &LensRays,
    fragments: &Bucket,
    first: usize,
) -> RaysThrough<AVX2> {
    let slots: &[u16; LANES] =
        fragments.slot[first..].first_chunk().expect("padded to a multiple of eight");
    let (at_x, at_y) = (F32x8::load(&fragments.x[first..]), F32x8::load(&fragments.y[first..]));
    let half = F32x8::splat(0.5);
    let (from_x, from_y) = (at_x - at_x.floor() - half, at_y - at_y.floor() - half);
    let mut of_pixel = [F32x8::<AVX2>::ZERO; 6];
    for (values, all) in of_pixel.iter_mut().zip(rays) {
        for lane in 0..LANES {
            values.0[lane] = all[usize::from(slots[lane]) & (all.len() - 1)];
        }
    }
    let [x, y, x_right, x_down, y_right, y_down] = of_pixel;
    RaysThrough {
        x: x + x_right * from_x + x_down * from_y,
        y: y + y_right * from_x + y_down * from_y,
        right: [x_right, y_right],
        down: [x_down, y_down],
    }
}

/// Surface under eight fragments.
#[derive(Clone, Copy)]
pub(super) struct Points<const AVX2: bool> {
    /// View space.
    pub(super) position: Vec3x8<AVX2>,
    /// Unit shading normal, view space, towards the side that was modelled.
    pub(super) normal: Vec3x8<AVX2>,
    /// Where the triangle's counter-clockwise side faces away.
    pub(super) back: Mask8<AVX2>,
    /// Zeros where no textures are looked up.
    pub(super) texture: TexturePoints<AVX2>,
}

impl<const AVX2: bool> Points<AVX2> {
    pub(super) const ZERO: Self = Self {
        position: Vec3x8::ZERO,
        normal: Vec3x8::ZERO,
        back: Mask8::NONE,
        texture: TexturePoints::ZERO,
    };
}

/// Texture coordinates under eight fragments.
#[derive(Clone, Copy)]
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

impl<const AVX2: bool> TexturePoints<AVX2> {
    const ZERO: Self = Self {
        uv: [F32x8::ZERO; 2],
        d_dx: [F32x8::ZERO; 2],
        d_dy: [F32x8::ZERO; 2],
        tangent: Vec3x8::ZERO,
        bitangent: Vec3x8::ZERO,
    };
}

/// The triangles of eight fragments: all numbers of one corner, and how they change along the two
/// edges from it.
struct Triangles<const AVX2: bool> {
    origin: [F32x8<AVX2>; LANES],
    edge1: [F32x8<AVX2>; LANES],
    edge2: [F32x8<AVX2>; LANES],
}

impl<const AVX2: bool> Triangles<AVX2> {
    #[inline(always)]
    fn new(geometry: &Geometry<'_>, ids: &[u32; LANES]) -> Self {
        let mut corners = [[F32x8::ZERO; LANES]; 3];
        if ids.iter().fold(0, |differ, id| differ | (id ^ ids[0])) == 0 {
            for (corner, vertex) in corners.iter_mut().zip(geometry.corners(ids[0])) {
                for k in 0..LANES {
                    corner[k] = F32x8::splat(vertex.0[k]);
                }
            }
        } else {
            let mut rows = [[[0.0; LANES]; LANES]; 3];
            for lane in 0..LANES {
                let [a, b, c] = geometry.corners(ids[lane]);
                (rows[0][lane], rows[1][lane], rows[2][lane]) = (a.0, b.0, c.0);
            }
            corners = [transposed(rows[0]), transposed(rows[1]), transposed(rows[2])];
        }
        let [origin, second, third] = corners;
        let (mut edge1, mut edge2) = ([F32x8::ZERO; LANES], [F32x8::ZERO; LANES]);
        for k in 0..LANES {
            edge1[k] = second[k] - origin[k];
            edge2[k] = third[k] - origin[k];
        }
        Self { origin, edge1, edge2 }
    }

    /// Some of the eight numbers of the vertices, interpolated.
    #[inline(always)]
    fn interpolate<const N: usize>(&self, at: [usize; N], w: [F32x8<AVX2>; 2]) -> [F32x8<AVX2>; N] {
        let mut out = [F32x8::ZERO; N];
        for (out, k) in out.iter_mut().zip(at) {
            *out = self.origin[k] + self.edge1[k] * w[0] + self.edge2[k] * w[1];
        }
        out
    }
}

/// Three numbers of vertices as a vector.
#[inline(always)]
fn vector<const AVX2: bool>(from: &[F32x8<AVX2>; LANES], first: usize) -> Vec3x8<AVX2> {
    Vec3x8::new(from[first], from[first + 1], from[first + 2])
}

/// Finds the surface under eight fragments; `textured` as in [`Textured`].
#[inline(always)]
pub(super) fn points<const AVX2: bool, const LENS: bool>(
    geometry: &Geometry<'_>,
    rays: &RaysThrough<AVX2>,
    ids: &[u32; LANES],
    textured: Textured,
) -> Points<AVX2> {
    let ray = Vec3x8::new(rays.x, rays.y, F32x8::splat(-1.0));
    let triangles = Triangles::new(geometry, ids);
    let origin = vector(&triangles.origin, 0);
    let (edge1, edge2) = (vector(&triangles.edge1, 0), vector(&triangles.edge2, 0));

    // From the first corner to where the ray is as deep as it: short, so that little cancels.
    let to_ray =
        Vec3x8::new(-origin.z * ray.x - origin.x, -origin.z * ray.y - origin.y, F32x8::ZERO);
    let across = ray.cross(edge2);
    let determinant = edge1.dot(across);
    let inverse = determinant / (determinant * determinant).max(F32x8::splat(1e-36));
    let raw1 = to_ray.dot(across) * inverse;
    let raw2 = ray.dot(to_ray.cross(edge1)) * inverse;
    let weights = clamp_to_triangle(raw1, raw2);

    let n = Vertex::NORMAL;
    let [px, py, pz, nx, ny, nz, u, v] =
        triangles.interpolate([0, 1, 2, n, n + 1, n + 2, Vertex::U, Vertex::V], weights);
    let normal = Vec3x8::new(nx, ny, nz).normalized();
    let back = F32x8::ZERO.gt(determinant);
    let mut texture = TexturePoints::ZERO;
    if textured.coordinates {
        texture.uv = [u, v];
        let triangle = [origin, edge1, edge2];
        let change = barycentric_change::<AVX2, LENS>(triangle, rays, [raw1, raw2], inverse);
        change_uv(&triangles, change, &mut texture);
        if textured.directions {
            tangents(&triangles, &mut texture);
        }
    }
    Points { position: Vec3x8::new(px, py, pz), normal, back, texture }
}

/// What of [`TexturePoints`] is wanted.
#[derive(Clone, Copy)]
pub(super) struct Textured {
    /// Coordinates and their change.
    pub(super) coordinates: bool,
    /// Tangents.
    pub(super) directions: bool,
}

/// How texture coordinates change over a pixel.
#[inline(always)]
fn change_uv<const AVX2: bool>(
    t: &Triangles<AVX2>,
    [change1, change2]: [[F32x8<AVX2>; 2]; 2],
    out: &mut TexturePoints<AVX2>,
) {
    for (i, k) in [Vertex::U, Vertex::V].into_iter().enumerate() {
        out.d_dx[i] = change1[0] * t.edge1[k] + change2[0] * t.edge2[k];
        out.d_dy[i] = change1[1] * t.edge1[k] + change2[1] * t.edge2[k];
    }
}

/// In which directions texture coordinates grow.
#[inline(always)]
fn tangents<const AVX2: bool>(t: &Triangles<AVX2>, out: &mut TexturePoints<AVX2>) {
    let (edge1, edge2) = (vector(&t.edge1, 0), vector(&t.edge2, 0));
    let along1 = [t.edge1[Vertex::U], t.edge1[Vertex::V]];
    let along2 = [t.edge2[Vertex::U], t.edge2[Vertex::V]];
    // Solves edge_k = u_k tangent + v_k bitangent; the sign of the area is all that is kept of the
    // denominator, lengths do not matter.
    let area = along1[0] * along2[1] - along1[1] * along2[0];
    let sign = area.ge(F32x8::ZERO).select(F32x8::ONE, F32x8::splat(-1.0));
    out.tangent = (edge1.scale(along2[1]) - edge2.scale(along1[1])).scale(sign);
    out.bitangent = (edge2.scale(along1[0]) - edge1.scale(along2[0])).scale(sign);
}

/// Weights of the second and third corner, such that those of all three are not negative and of
/// sum 1.
#[inline(always)]
fn clamp_to_triangle<const AVX2: bool>(w1: F32x8<AVX2>, w2: F32x8<AVX2>) -> [F32x8<AVX2>; 2] {
    let zero = F32x8::ZERO;
    let (w1, w2) = (w1.max(zero), w2.max(zero));
    let w0 = (F32x8::ONE - w1 - w2).max(zero);
    let inverse = F32x8::ONE / (w0 + w1 + w2);
    [w1 * inverse, w2 * inverse]
}

/// Change of the second and third barycentric coordinate over a pixel to the right and a pixel
/// down: numerators and determinant are linear in the ray.
#[inline(always)]
fn barycentric_change<const AVX2: bool, const LENS: bool>(
    [origin, edge1, edge2]: [Vec3x8<AVX2>; 3],
    rays: &RaysThrough<AVX2>,
    at: [F32x8<AVX2>; 2],
    inverse: F32x8<AVX2>,
) -> [[F32x8<AVX2>; 2]; 2] {
    let numerators = [origin.cross(edge2), edge1.cross(origin)];
    let determinant = edge2.cross(edge1);
    let mut change = [[F32x8::ZERO; 2]; 2];
    for k in 0..2 {
        let x = (numerators[k].x - at[k] * determinant.x) * inverse;
        let y = (numerators[k].y - at[k] * determinant.y) * inverse;
        change[k] = if LENS {
            [x * rays.right[0] + y * rays.right[1], x * rays.down[0] + y * rays.down[1]]
        } else {
            [x * rays.right[0], y * rays.down[1]]
        };
    }
    change
}
