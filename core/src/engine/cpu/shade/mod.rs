//! Shade: the light that the fragments of a tile send to the camera, tone-mapped and summed up.
//!
//! Reads fragments, placed vertices, materials, textures, lights and the shadow map; adds to the
//! tile's colours. Tone mapping comes before the sum over a pixel's fragments, so that a bright
//! edge stays smooth; the sum is made in linear display light.

mod light;
mod material;
mod surface;
mod texture;

use super::display::tone_map;
use super::fragment::Fragment;
use super::samples::TILE;
use super::simd::{F32x8, LANES, Vec3x8, kernel};

pub(super) use light::Lighting;
pub(super) use material::Surface;
pub(super) use surface::{Geometry, Rays};

/// Linear display light of a tile's pixel slots, by channel.
pub(super) type TileColor = [[f32; TILE * TILE]; 3];

/// What fragments are shaded with.
pub(super) struct Stage<'a> {
    pub(super) geometry: Geometry<'a>,
    pub(super) rays: Rays,
    pub(super) lighting: Lighting<'a>,
}

/// What the fragments of one draw share.
#[derive(Clone, Copy)]
pub(super) struct DrawnSurface<'a> {
    pub(super) surface: &'a Surface<'a>,
    /// Normals are turned to the viewer.
    pub(super) double_sided: bool,
    /// The object's transform turns triangles inside out.
    pub(super) mirrored: bool,
}

kernel! {
    /// Shades the fragments of one draw, a multiple of eight of them.
    fn shade(
        stage: &Stage<'_>,
        drawn: DrawnSurface<'_>,
        reaching: &[u32],
        fragments: &[Fragment],
        color: &mut TileColor,
    ) = shade_body
}

#[inline(always)]
fn shade_body<const AVX2: bool>(
    stage: &Stage<'_>,
    drawn: DrawnSurface<'_>,
    reaching: &[u32],
    fragments: &[Fragment],
    color: &mut TileColor,
) {
    let surface = drawn.surface;
    for eight in fragments.chunks_exact(LANES) {
        let mut points =
            surface::points::<AVX2>(&stage.geometry, &stage.rays, eight, surface.textured());
        if drawn.double_sided {
            let turned = Vec3x8::ZERO - points.normal;
            let (away, towards) =
                if drawn.mirrored { (points.normal, turned) } else { (turned, points.normal) };
            points.normal = Vec3x8::new(
                points.back.select(away.x, towards.x),
                points.back.select(away.y, towards.y),
                points.back.select(away.z, towards.z),
            );
        }
        let look = surface.look(&points);
        let light = stage.lighting.reflected(
            points.position,
            points.normal,
            &look,
            (surface.metallic, surface.wrap),
            reaching,
        );
        let channels: [F32x8<AVX2>; 3] = [tone_map(light.x), tone_map(light.y), tone_map(light.z)];
        for (sum, value) in color.iter_mut().zip(channels) {
            for (fragment, value) in eight.iter().zip(value.0) {
                sum[usize::from(fragment.slot) & (TILE * TILE - 1)] += value * fragment.weight;
            }
        }
    }
}
