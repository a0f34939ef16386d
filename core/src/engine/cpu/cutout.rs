//! Cutouts: which samples of a triangle lie on a strand of it.
//!
//! Texture coordinates at a sample come from the ray through it and the unclipped triangle: weights of
//! the corners times their sum, and that sum, are linear in the ray and so over the picture.

use super::chunk::Chunk;
use super::project::{Projection, Vertex};
use super::simd::{F32x8, I32x8, Mask8};
use crate::library::mesh::Cutout;

/// A linear function over the picture: at its top-left corner, per pixel to the right and down.
type Linear = [f64; 3];

/// Texture coordinates over the picture: those of one corner, and what the ratio of two of these
/// functions adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutPlanes {
    weight: Linear,
    /// Of u, then of v.
    change: [Linear; 2],
    corner: [f32; 2],
}

impl CutPlanes {
    /// Those of a triangle in view space, seen by a camera.
    pub(super) fn new(corners: [&Vertex; 3], camera: &Projection) -> Self {
        let [a, b, c] = corners.map(|v| v.position().map(f64::from));
        let less = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] - q[i]) };
        let (to_b, to_c) = (less(b, a), less(c, a));
        // For a ray r the corners' weights are r.(b x c), r.(c x a) and r.(a x b).
        let (of_b, of_c) = (cross(to_c, a), cross(a, to_b));
        let change = |k: usize| -> Linear {
            let at = |v: &Vertex| f64::from(v.0[k]);
            let (by_b, by_c) = (at(corners[1]) - at(corners[0]), at(corners[2]) - at(corners[0]));
            over_picture(std::array::from_fn(|i| by_b * of_b[i] + by_c * of_c[i]), camera)
        };
        Self {
            weight: over_picture(cross(to_b, to_c), camera),
            change: [change(Vertex::U), change(Vertex::V)],
            corner: [corners[0].0[Vertex::U], corners[0].0[Vertex::V]],
        }
    }
}

/// The product of a vector with the ray through each place of the picture.
fn over_picture([x, y, z]: [f64; 3], camera: &Projection) -> Linear {
    let rows = &camera.rows;
    let (fx, cx) = (rows[0][0], -rows[0][2]);
    let (fy, cy) = (-rows[1][1], -rows[1][2]);
    [y * cy / fy - x * cx / fx - z, x / fx, -y / fy]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// What is cut out of one triangle.
#[derive(Clone, Copy)]
pub(super) struct Cut<'a> {
    planes: &'a CutPlanes,
    cutout: Cutout,
}

impl<'a> Cut<'a> {
    /// Of a triangle of a chunk, if anything is.
    #[inline(always)]
    pub(super) fn of(chunk: &'a Chunk, triangle: usize) -> Option<Self> {
        let planes = chunk.cuts.get(triangle)?;
        Some(Self { planes, cutout: chunk.cutout? })
    }

    /// Which of eight samples there is anything at; they stand so many pixels from a place in the
    /// picture. See [`Cutout`] for the formula.
    #[inline(always)]
    pub(super) fn leaves<const AVX2: bool>(
        &self,
        corner_px: [f64; 2],
        [x, y]: [F32x8<AVX2>; 2],
    ) -> Mask8<AVX2> {
        let of = |[origin, dx, dy]: Linear| {
            let here = origin + dx * corner_px[0] + dy * corner_px[1];
            F32x8::splat(here as f32) + F32x8::splat(dx as f32) * x + F32x8::splat(dy as f32) * y
        };
        let per_weight = F32x8::ONE / of(self.planes.weight);
        let [u, v] = [0, 1]
            .map(|k| F32x8::splat(self.planes.corner[k]) + of(self.planes.change[k]) * per_weight);
        let strand = u * F32x8::splat(f32::from(self.cutout.strands_per_u));
        let left = strand.floor();
        let across = strand - left - F32x8::splat(0.5);
        let off = across.max(-across);
        let dice = left.round_i32() * I32x8::splat(Cutout::MULTIPLIER as i32);
        let byte = |shift: u32| ((dice >> shift) & I32x8::splat(255)).to_f32();
        let end = byte(16) * F32x8::splat(Cutout::END);
        let half = byte(24) * F32x8::splat(Cutout::HALF[1]) + F32x8::splat(Cutout::HALF[0]);
        let whole = F32x8::ONE - end;
        let way = v * F32x8::splat(1.0 / self.cutout.frayed_v()) - end;
        (half * whole.min(way)).gt(off * whole)
    }
}
