//! Light on surfaces: the reflectance model, and which lights reach a tile.
//!
//! Reflectance: Lambert plus GGX (Walter et al. 2007) with the Smith height-correlated
//! visibility in Hammon's approximation (GDC 2017) and Schlick's Fresnel. With `l`, `v` and `n`
//! unit vectors towards light and viewer and the normal, `h` halfway, `a` the squared perceptual
//! roughness, `f0 = mix(0.04, albedo, metallic)`:
//!
//! ```text
//! f = albedo (1 - metallic) / pi + D V F
//! D = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2)
//! V = 0.5 / mix(2 n.l n.v, n.l + n.v, a)
//! F = f0 + (1 - f0) (1 - v.h)^5
//! ```
//!
//! Normals may lean away from the viewer: `n.v` is taken as at least 0.001, also within
//! `n.h = (n.l + n.v) / |l + v|`, which is at most 1. `wrap` w replaces the `n.l` of the Lambert term by `max(n.l + w, 0) / (1 + w)^2`, which keeps
//! the energy. Surrounding light: the irradiance of the hemisphere of sky and ground for the
//! Lambert term, and for the mirror term that of the mirrored direction over pi, times Karis'
//! fit of the split sum ("Physically based shading on mobile", 2014) with `(1 - n.v)^6` for its
//! exponential.

use std::f32::consts::PI;

use super::material::Look;
use crate::draw::abi::{Lights, PointLight};
use crate::engine::cpu::shadow::SunShadow;
use crate::engine::cpu::simd::{F32x8, Vec3x8};

/// How much further off the surface wrapped light looks up shadows, metres per unit of `wrap`:
/// where light goes round the terminator, the body must not shade itself at once.
const WRAP_OFFSET_M: f32 = 0.04;

/// All lights, scaled by the exposure.
pub(in crate::engine::cpu) struct Lighting<'a> {
    /// Unit direction towards the sun and its colour.
    sun: Option<([f32; 3], [f32; 3])>,
    shadow: Option<SunShadow<'a>>,
    points: Vec<PointLight>,
    sky: [f32; 3],
    ground: [f32; 3],
    /// World +Y in view space.
    up: [f32; 3],
}

impl<'a> Lighting<'a> {
    pub(in crate::engine::cpu) fn new(
        lights: &Lights,
        exposure: f32,
        view_from_world: &[[f32; 4]; 3],
        shadow: Option<SunShadow<'a>>,
    ) -> Self {
        let exposed = |c: [f32; 3]| c.map(|v| v * exposure);
        Self {
            sun: lights.sun.map(|sun| (unit(sun.direction_to_sun), exposed(sun.color_lux))),
            shadow,
            points: lights
                .points
                .iter()
                .map(|p| PointLight { color_cd: exposed(p.color_cd), ..*p })
                .collect(),
            sky: exposed(lights.sky_lux),
            ground: exposed(lights.ground_lux),
            up: view_from_world.map(|row| row[1]),
        }
    }

    /// Names the point lights whose range reaches a view-space box.
    pub(in crate::engine::cpu) fn reaching(
        &self,
        low: [f32; 3],
        high: [f32; 3],
        out: &mut Vec<u32>,
    ) {
        out.clear();
        for (index, light) in self.points.iter().enumerate() {
            let distance2: f32 = (0..3)
                .map(|i| (low[i] - light.position[i]).max(light.position[i] - high[i]).max(0.0))
                .map(|d| d * d)
                .sum();
            if distance2 < light.range_m * light.range_m {
                out.push(index as u32);
            }
        }
    }

    /// Light that eight fragments send to the camera, times the exposure.
    #[inline(always)]
    pub(super) fn reflected<const AVX2: bool>(
        &self,
        position: Vec3x8<AVX2>,
        surface_normal: Vec3x8<AVX2>,
        look: &Look<AVX2>,
        (metallic, wrap): (f32, f32),
        reaching: &[u32],
    ) -> Vec3x8<AVX2> {
        let reflector = Reflector::new(position, look, metallic, wrap);
        let mut sum = self.surrounding(&reflector, look.roughness);
        if let Some((direction, color)) = self.sun {
            let to_light = Vec3x8::splat(direction);
            if reflector.reached_from(to_light) {
                let lit = match &self.shadow {
                    Some(shadow) => {
                        let cosine = surface_normal.dot(to_light);
                        shadow.lit(position, surface_normal, cosine, wrap * WRAP_OFFSET_M)
                    }
                    None => F32x8::ONE,
                };
                sum = sum + reflector.reflect(to_light, Vec3x8::splat(color).scale(lit));
            }
        }
        for &index in reaching {
            let light = &self.points[index as usize];
            let (to_light, irradiance) = incoming(light, position);
            if reflector.reached_from(to_light) {
                sum = sum + reflector.reflect(to_light, irradiance);
            }
        }
        sum
    }

    /// Sky and ground.
    #[inline(always)]
    fn surrounding<const AVX2: bool>(
        &self,
        r: &Reflector<AVX2>,
        roughness: F32x8<AVX2>,
    ) -> Vec3x8<AVX2> {
        let mirrored = r.normal.scale(r.n_dot_v + r.n_dot_v) - r.to_viewer;
        let [scale, bias] = split_sum(roughness, r.n_dot_v);
        let bias = Vec3x8::new(bias, bias, bias);
        let mirror = r.f0.scale(scale) + bias;
        self.hemisphere(r.normal) * r.diffuse
            + (self.hemisphere(mirrored) * mirror).scale(F32x8::splat(1.0 / PI))
    }

    /// Irradiance of surfaces that face these directions.
    #[inline(always)]
    fn hemisphere<const AVX2: bool>(&self, d: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
        let half = F32x8::splat(0.5);
        let upwards = (d.dot(Vec3x8::splat(self.up)) * half + half).clamp(0.0, 1.0);
        Vec3x8::splat(self.ground).mix(Vec3x8::splat(self.sky), upwards)
    }
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-20);
    v.map(|x| x / length)
}

/// Direction towards a point light and the illuminance of a surface that faces it.
#[inline(always)]
fn incoming<const AVX2: bool>(
    light: &PointLight,
    position: Vec3x8<AVX2>,
) -> (Vec3x8<AVX2>, Vec3x8<AVX2>) {
    let to_light = Vec3x8::splat(light.position) - position;
    let distance2 = to_light.dot(to_light).max(F32x8::splat(1e-12));
    let inverse = F32x8::ONE / distance2.sqrt();
    let at_least = F32x8::splat(1.0 / light.radius_m.max(1e-6));
    let near = inverse.min(at_least);
    let in_range = distance2 * F32x8::splat(1.0 / (light.range_m * light.range_m));
    let window = (F32x8::ONE - in_range * in_range).max(F32x8::ZERO);
    let falloff = near * near * window * window;
    (to_light.scale(inverse), Vec3x8::splat(light.color_cd).scale(falloff))
}

/// Factor on f0 and offset of the surrounding's mirror term.
#[inline(always)]
fn split_sum<const AVX2: bool>(roughness: F32x8<AVX2>, n_dot_v: F32x8<AVX2>) -> [F32x8<AVX2>; 2] {
    let s = F32x8::splat;
    let (x, y) = (F32x8::ONE - roughness, s(0.0425) - roughness * s(0.0275));
    let (z, w) = (s(1.04) - roughness * s(0.572), roughness * s(0.022) - s(0.04));
    let grazing = F32x8::ONE - n_dot_v;
    let cubed = grazing * grazing * grazing;
    let a = (x * x).min(cubed * cubed) * x + y;
    [z - s(1.04) * a, s(1.04) * a + w]
}

/// What the reflectance needs of eight fragments, whatever the light.
struct Reflector<const AVX2: bool> {
    normal: Vec3x8<AVX2>,
    to_viewer: Vec3x8<AVX2>,
    n_dot_v: F32x8<AVX2>,
    f0: Vec3x8<AVX2>,
    /// Lambert term over irradiance.
    diffuse: Vec3x8<AVX2>,
    /// Squared perceptual roughness.
    a: F32x8<AVX2>,
    wrap: f32,
}

impl<const AVX2: bool> Reflector<AVX2> {
    #[inline(always)]
    fn new(position: Vec3x8<AVX2>, look: &Look<AVX2>, metallic: f32, wrap: f32) -> Self {
        let to_viewer = (Vec3x8::ZERO - position).normalized();
        let dielectric = Vec3x8::splat([0.04; 3]);
        Self {
            normal: look.normal,
            to_viewer,
            n_dot_v: look.normal.dot(to_viewer).clamp(1e-3, 1.0),
            f0: dielectric.mix(look.albedo, F32x8::splat(metallic)),
            diffuse: look.albedo.scale(F32x8::splat((1.0 - metallic) / PI)),
            a: look.roughness * look.roughness,
            wrap,
        }
    }

    /// Whether light from a direction can reach any of the eight.
    #[inline(always)]
    fn reached_from(&self, to_light: Vec3x8<AVX2>) -> bool {
        self.normal.dot(to_light).gt(F32x8::splat(-self.wrap)).any()
    }

    /// Light sent to the viewer, given the illuminance of a surface that faces the light.
    #[inline(always)]
    fn reflect(&self, to_light: Vec3x8<AVX2>, illuminance: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
        let s = F32x8::splat;
        let cosine = self.normal.dot(to_light);
        let n_dot_l = cosine.max(F32x8::ZERO);
        // |l + v|^2 = 2 + 2 l.v; n.h and v.h follow from it.
        let l_dot_v = to_light.dot(self.to_viewer);
        let halfway2 = (s(2.0) + l_dot_v + l_dot_v).max(s(1e-4));
        let n_dot_sum = cosine + self.n_dot_v;
        let a2 = self.a * self.a;
        // A normal that leans away from the viewer must not push n.h over 1, to the lobe's pole.
        let lobe = (n_dot_sum * n_dot_sum).min(halfway2) * (a2 - F32x8::ONE) + halfway2;
        let visibility = (n_dot_l + self.n_dot_v) * self.a
            + s(2.0) * n_dot_l * self.n_dot_v * (F32x8::ONE - self.a);
        let mirror =
            a2 * s(0.5 / PI) * halfway2 * halfway2 / (lobe * lobe * visibility).max(s(1e-30));
        let grazing = (F32x8::ONE - halfway2.sqrt() * s(0.5)).max(F32x8::ZERO);
        let grazing2 = grazing * grazing;
        let fresnel = self.f0.mix(Vec3x8::splat([1.0; 3]), grazing2 * grazing2 * grazing);
        let lambert = if self.wrap > 0.0 {
            let w = 1.0 + self.wrap;
            (cosine + s(self.wrap)).max(F32x8::ZERO) * s(1.0 / (w * w))
        } else {
            n_dot_l
        };
        (self.diffuse.scale(lambert) + fresnel.scale(mirror * n_dot_l)) * illuminance
    }
}
