//! Materials: maps, hue and masked layers, down to albedo, roughness and normal.

use super::GROUPS;
use super::surface::{Points, TexturePoints, Textured};
use super::texture::{Sampler, footprint};
use crate::draw::DrawList;
use crate::draw::abi::Material;
use crate::engine::cpu::simd::{F32x8, Vec3x8};

/// A material ready for shading.
pub(in crate::engine::cpu) struct Surface<'a> {
    /// With the hue already rotated where there is no albedo map.
    base_color: [f32; 3],
    albedo_map: Option<Sampler<'a>>,
    detail: Option<(Sampler<'a>, f32)>,
    uv_repeat: [f32; 2],
    /// Sixths of a turn, to be applied after the albedo map.
    hue_offset: Option<f32>,
    roughness: f32,
    pub(super) metallic: f32,
    normal_map: Option<(Sampler<'a>, f32)>,
    finish: Option<Sampler<'a>>,
    mask: Option<Sampler<'a>>,
    layers: [[f32; 4]; 4],
    pub(super) wrap: f32,
}

/// What light sees of eight fragments.
#[derive(Clone, Copy)]
pub(super) struct Look<const AVX2: bool> {
    /// Linear.
    pub(super) albedo: Vec3x8<AVX2>,
    /// Perceptual.
    pub(super) roughness: F32x8<AVX2>,
    /// Unit, view space.
    pub(super) normal: Vec3x8<AVX2>,
}

impl<const AVX2: bool> Look<AVX2> {
    pub(super) const ZERO: Self =
        Self { albedo: Vec3x8::ZERO, roughness: F32x8::ZERO, normal: Vec3x8::ZERO };
}

impl<'a> Surface<'a> {
    pub(in crate::engine::cpu) fn new(material: &Material, list: &'a DrawList) -> Self {
        let sampler =
            |map: Option<u32>| map.map(|index| Sampler::new(&list.textures[index as usize]));
        let turn = material.hue_offset_deg / 60.0;
        let hue_offset = (turn != 0.0).then(|| turn - 6.0 * (turn / 6.0).floor());
        let albedo_map = sampler(material.albedo_map);
        let finish = sampler(material.finish_map);
        // Where all of a plain colour is turned, that is done here.
        let hue_varies = albedo_map.is_some() || finish.is_some();
        let mut base_color = material.base_color;
        if let (Some(turn), false) = (hue_offset, hue_varies) {
            let rotated = rotate_hue(Vec3x8::<false>::splat(base_color), turn);
            base_color = [rotated.x.0[0], rotated.y.0[0], rotated.z.0[0]];
        }
        Self {
            base_color,
            detail: sampler(material.detail_map).map(|s| (s, material.detail_strength)),
            uv_repeat: material.uv_repeat,
            hue_offset: hue_offset.filter(|_| hue_varies),
            finish,
            albedo_map,
            roughness: material.roughness.clamp(0.04, 1.0),
            metallic: material.metallic.clamp(0.0, 1.0),
            normal_map: sampler(material.normal_map)
                .filter(|_| material.normal_strength != 0.0)
                .map(|s| (s, material.normal_strength)),
            mask: sampler(material.mask),
            layers: material.layers,
            wrap: material.wrap.clamp(0.0, 0.5),
        }
    }

    /// What look-ups need.
    pub(super) const fn textured(&self) -> Textured {
        Textured {
            coordinates: self.albedo_map.is_some()
                || self.detail.is_some()
                || self.normal_map.is_some()
                || self.finish.is_some()
                || self.mask.is_some(),
            directions: self.normal_map.is_some(),
        }
    }

    /// The material at fragments whose normals face the viewer.
    #[inline(always)]
    pub(super) fn look<const AVX2: bool>(&self, points: &[Points<AVX2>], looks: &mut [Look<AVX2>]) {
        for (look, points) in looks.iter_mut().zip(points) {
            *look = Look {
                albedo: Vec3x8::splat(self.base_color),
                roughness: F32x8::splat(self.roughness),
                normal: points.normal,
            };
        }
        self.apply_repeated(points, looks);
        if let Some(mask) = &self.mask {
            for (look, points) in looks.iter_mut().zip(points) {
                let texture = &points.texture;
                let size = footprint(texture.d_dx, texture.d_dy);
                self.apply_layers(mask.sample::<AVX2, 4>(texture.uv, size), look);
            }
        }
    }

    /// Albedo, finish, detail and normal map, which share the repeated coordinates.
    #[inline(always)]
    fn apply_repeated<const AVX2: bool>(&self, points: &[Points<AVX2>], looks: &mut [Look<AVX2>]) {
        let none = self.albedo_map.is_none()
            && self.detail.is_none()
            && self.normal_map.is_none()
            && self.finish.is_none();
        if none {
            return;
        }
        let repeat = [F32x8::splat(self.uv_repeat[0]), F32x8::splat(self.uv_repeat[1])];
        let mut places = [([F32x8::ZERO; 2], F32x8::ZERO); GROUPS];
        for ((uv, size), points) in places.iter_mut().zip(points) {
            let t = &points.texture;
            *uv = times(t.uv, repeat);
            *size = footprint(times(t.d_dx, repeat), times(t.d_dy, repeat));
        }
        if let Some(map) = &self.albedo_map {
            for (look, (uv, size)) in looks.iter_mut().zip(&places) {
                let [r, g, b] = map.sample::<AVX2, 3>(*uv, *size);
                look.albedo = look.albedo * Vec3x8::new(r, g, b);
            }
        }
        if let Some(map) = &self.finish {
            for (look, (uv, size)) in looks.iter_mut().zip(&places) {
                let [turned, gloss] = map.sample::<AVX2, 2>(*uv, *size);
                if let Some(turn) = self.hue_offset {
                    look.albedo = look.albedo.mix(rotate_hue(look.albedo, turn), turned);
                }
                look.roughness = look.roughness.mix(F32x8::splat(Material::GLOSSY), gloss);
            }
        } else if let Some(turn) = self.hue_offset {
            for look in looks.iter_mut() {
                look.albedo = rotate_hue(look.albedo, turn);
            }
        }
        if let Some((map, strength)) = &self.detail {
            for (look, (uv, size)) in looks.iter_mut().zip(&places) {
                let [r] = map.sample::<AVX2, 1>(*uv, *size);
                let factor = F32x8::ONE + F32x8::splat(*strength) * (r + r - F32x8::ONE);
                look.albedo = look.albedo.scale(factor.max(F32x8::ZERO));
            }
        }
        if let Some((map, strength)) = &self.normal_map {
            for ((look, (uv, size)), points) in looks.iter_mut().zip(&places).zip(points) {
                let [x, y, z] = map.sample::<AVX2, 3>(*uv, *size);
                let (one, strength) = (F32x8::ONE, F32x8::splat(*strength));
                let bend = [(x + x - one) * strength, (y + y - one) * strength];
                look.normal = bent(look.normal, bend, z + z - one, &points.texture);
            }
        }
    }

    #[inline(always)]
    fn apply_layers<const AVX2: bool>(&self, mask: [F32x8<AVX2>; 4], look: &mut Look<AVX2>) {
        for k in 0..4 {
            let [r, g, b, roughness] = self.layers[k];
            look.albedo = look.albedo.mix(Vec3x8::splat([r, g, b]), mask[k]);
            look.roughness = look.roughness.mix(F32x8::splat(roughness), mask[k]);
        }
        look.roughness = look.roughness.clamp(0.04, 1.0);
    }
}

#[inline(always)]
fn times<const AVX2: bool>(a: [F32x8<AVX2>; 2], b: [F32x8<AVX2>; 2]) -> [F32x8<AVX2>; 2] {
    [a[0] * b[0], a[1] * b[1]]
}

/// The unit direction within the surface that is nearest to a direction.
#[inline(always)]
fn onto_surface<const AVX2: bool>(d: Vec3x8<AVX2>, normal: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
    (d - normal.scale(d.dot(normal))).normalized()
}

/// A normal turned by a tangent-space one: x along growing u, y up the picture (against v), z
/// along the normal.
#[inline(always)]
fn bent<const AVX2: bool>(
    normal: Vec3x8<AVX2>,
    [x, y]: [F32x8<AVX2>; 2],
    z: F32x8<AVX2>,
    texture: &TexturePoints<AVX2>,
) -> Vec3x8<AVX2> {
    let tangent = onto_surface(texture.tangent, normal);
    let bitangent = onto_surface(texture.bitangent, normal);
    (tangent.scale(x) - bitangent.scale(y) + normal.scale(z.max(F32x8::splat(0.05)))).normalized()
}

/// Rotates the hue in HSV by sixths of a turn in 0..6; saturation and value stay.
///
/// Value V and chroma C give back each channel as `V - C clamp(min(k, 4 - k), 0, 1)` with
/// `k = (n + hue) mod 6` and n = 5, 3, 1 for red, green and blue.
#[inline(always)]
fn rotate_hue<const AVX2: bool>(c: Vec3x8<AVX2>, turn: f32) -> Vec3x8<AVX2> {
    let value = c.x.max(c.y).max(c.z);
    let chroma = value - c.x.min(c.y).min(c.z);
    let inverse = F32x8::ONE / chroma.max(F32x8::splat(1e-12));
    let of_red = (c.y - c.z) * inverse;
    let of_green = (c.z - c.x) * inverse + F32x8::splat(2.0);
    let of_blue = (c.x - c.y) * inverse + F32x8::splat(4.0);
    let hue = c.x.ge(value).select(of_red, c.y.ge(value).select(of_green, of_blue));
    let hue = hue + F32x8::splat(turn);
    let r = value - chroma * hue_share(hue + F32x8::splat(5.0));
    let g = value - chroma * hue_share(hue + F32x8::splat(3.0));
    let b = value - chroma * hue_share(hue + F32x8::splat(1.0));
    Vec3x8::new(r, g, b)
}

/// `clamp(min(k, 4 - k), 0, 1)` of a number modulo 6.
#[inline(always)]
fn hue_share<const AVX2: bool>(k: F32x8<AVX2>) -> F32x8<AVX2> {
    let k = k - (k * F32x8::splat(1.0 / 6.0)).floor() * F32x8::splat(6.0);
    k.min(F32x8::splat(4.0) - k).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rotated(rgb: [f32; 3], deg: f32) -> [f32; 3] {
        let v = rotate_hue(Vec3x8::<false>::splat(rgb), deg / 60.0);
        [v.x.0[3], v.y.0[3], v.z.0[3]]
    }

    #[test]
    fn a_third_of_a_turn_moves_every_channel_on() {
        for rgb in [[0.8, 0.2, 0.1], [0.1, 0.9, 0.5], [0.3, 0.3, 0.7], [0.4, 0.4, 0.4]] {
            let [r, g, b] = rotated(rgb, 120.0);
            for (got, want) in [(r, rgb[2]), (g, rgb[0]), (b, rgb[1])] {
                assert!((got - want).abs() < 1e-6, "{rgb:?} -> {r} {g} {b}");
            }
        }
    }

    #[test]
    fn red_turns_through_yellow_at_a_sixth() {
        for (got, want) in rotated([1.0, 0.0, 0.0], 60.0).iter().zip([1.0, 1.0, 0.0]) {
            assert!((got - want).abs() < 1e-6);
        }
    }
}
