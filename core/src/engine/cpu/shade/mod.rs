//! Shade: the light that the fragments of a tile send to the camera, developed and summed up.
//!
//! Reads fragments, placed vertices, materials, textures, lights and the shadow map; adds to the
//! tile's colours. Developing comes before the sum over a pixel's fragments, so that a bright
//! edge stays smooth; the sum is made in linear display light.

mod environment;
mod light;
mod material;
mod surface;
mod texture;

use std::ops::Range;

use super::develop::Develop;
use super::fragment::Bucket;
use super::samples::TILE;
use super::simd::{F32x8, LANES, Vec3x8, kernel};

use self::material::Look;
use self::surface::{Points, RaysThrough};

pub(super) use light::{Lighting, Reaching};
pub(super) use material::Surface;
pub(super) use surface::{Geometry, LensRays, Rays};

/// How many times eight fragments go through the steps together: so that what a step needs of
/// the material and the lights is set up once for all of them, its loop is short, and what lies
/// between the steps stays in the nearest cache.
const GROUPS: usize = 8;

/// Linear display light of a tile's pixel slots, by channel.
pub(super) type TileColor = [[f32; TILE * TILE]; 3];

/// What fragments are shaded with.
pub(super) struct Stage<'a> {
    pub(super) geometry: Geometry<'a>,
    pub(super) rays: Rays,
    pub(super) lighting: Lighting<'a>,
    pub(super) develop: Develop,
}

/// What the fragments of one draw share.
#[derive(Clone, Copy)]
pub(super) struct DrawnSurface<'a> {
    pub(super) surface: &'a Surface<'a>,
    /// Normals are turned to the viewer.
    pub(super) double_sided: bool,
    /// The object's transform turns triangles inside out.
    pub(super) mirrored: bool,
    /// The object's own spheres.
    pub(super) blockers: &'a Range<u32>,
}

kernel! {
    /// Shades the fragments of one draw; `rays` are those of a lens where there is one, which `LENS`
    /// says, `noise` the pixels' where there is any.
    fn shade[const LENS: bool](
        stage: &Stage<'_>,
        drawn: DrawnSurface<'_>,
        rays: Option<&[[f32; TILE * TILE]; 6]>,
        near: (&Reaching, Option<&TileColor>),
        fragments: &Bucket,
        color: &mut TileColor,
    ) = shade_body
}

#[inline(always)]
fn shade_body<const AVX2: bool, const LENS: bool>(
    stage: &Stage<'_>,
    drawn: DrawnSurface<'_>,
    rays: Option<&[[f32; TILE * TILE]; 6]>,
    (reaching, noise): (&Reaching, Option<&TileColor>),
    fragments: &Bucket,
    color: &mut TileColor,
) {
    let surface = drawn.surface;
    let mut points = [Points::<AVX2>::ZERO; GROUPS];
    let mut looks = [Look::ZERO; GROUPS];
    let mut light = [Vec3x8::ZERO; GROUPS];
    let groups = fragments.id.len() / LANES;
    let mut first = 0;
    while first < groups {
        let count = GROUPS.min(groups - first);
        for (group, points) in points[..count].iter_mut().enumerate() {
            let first = (first + group) * LANES;
            *points = match rays {
                Some(rays) if LENS => {
                    let rays = surface::lens_rays(rays, fragments, first);
                    visible_points::<AVX2, true>(stage, drawn, rays, fragments, first)
                }
                _ => {
                    let rays = stage.rays.through(fragments, first);
                    visible_points::<AVX2, false>(stage, drawn, rays, fragments, first)
                }
            };
        }
        let (points, looks, light) = (&points[..count], &mut looks[..count], &mut light[..count]);
        surface.look(points, looks);
        let (body, near) = ((surface.metallic, surface.wrap), (reaching, drawn.blockers));
        stage.lighting.reflected(points, looks, body, near, light);
        for (group, light) in light.iter().enumerate() {
            let first = (first + group) * LANES;
            let at = [F32x8::load(&fragments.x[first..]), F32x8::load(&fragments.y[first..])];
            let unit = noise.map_or(Vec3x8::ZERO, |noise| of_pixels(noise, fragments, first));
            add_to_picture(stage.develop.display(*light, at, unit), fragments, first, color);
        }
        first += count;
    }
}

/// The surface under eight fragments, its normals turned to the viewer where that is wanted.
#[inline(always)]
fn visible_points<const AVX2: bool, const LENS: bool>(
    stage: &Stage<'_>,
    drawn: DrawnSurface<'_>,
    rays: RaysThrough<AVX2>,
    fragments: &Bucket,
    first: usize,
) -> Points<AVX2> {
    let ids = fragments.id[first..].first_chunk().expect("padded to a multiple of eight");
    let textured = drawn.surface.textured();
    let mut points = surface::points::<AVX2, LENS>(&stage.geometry, &rays, ids, textured);
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
    points
}

/// What the pixels of eight fragments have in a tile.
#[inline(always)]
fn of_pixels<const AVX2: bool>(tile: &TileColor, fragments: &Bucket, first: usize) -> Vec3x8<AVX2> {
    let slots: &[u16; LANES] =
        fragments.slot[first..].first_chunk().expect("padded to a multiple of eight");
    let [r, g, b] =
        [0, 1, 2].map(|c| F32x8(slots.map(|slot| tile[c][usize::from(slot) & (TILE * TILE - 1)])));
    Vec3x8::new(r, g, b)
}

/// Adds the display light of eight fragments to their pixels.
#[inline(always)]
fn add_to_picture<const AVX2: bool>(
    light: Vec3x8<AVX2>,
    fragments: &Bucket,
    first: usize,
    color: &mut TileColor,
) {
    let weight = F32x8::load(&fragments.weight[first..]);
    let slots: &[u16; LANES] =
        fragments.slot[first..].first_chunk().expect("padded to a multiple of eight");
    let start = usize::from(slots[0]);
    let strayed =
        slots.iter().zip(slots[0]..).fold(0, |strayed, (slot, next)| strayed | (slot ^ next));
    for (sum, value) in color.iter_mut().zip([light.x, light.y, light.z]) {
        let value: F32x8<AVX2> = value * weight;
        if strayed == 0 {
            // Neighbouring pixels, as nearly everywhere within surfaces.
            (F32x8::load(&sum[start..]) + value).store(&mut sum[start..]);
        } else {
            for (slot, value) in slots.iter().zip(value.0) {
                sum[usize::from(*slot) & (TILE * TILE - 1)] += value;
            }
        }
    }
}
