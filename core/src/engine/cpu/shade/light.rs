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
//! the energy. Surrounding light: its irradiance E and what a mirror of the roughness sees L, from
//! a picture of it, or from the hemisphere of sky and ground, of which a mirror sees E / pi of the
//! mirrored direction. With Karis' fit of the split sum ("Physically based shading on mobile",
//! 2014), with `(1 - n.v)^6` for its exponential, and the light that leaves rough surfaces after
//! several reflections (Fdez-Aguera, "A multiple-scattering microfacet model for real-time
//! image-based lighting", 2019), so that nothing is lost and white in white vanishes:
//!
//! ```text
//! F1 = f0 scale + bias        lost = 1 - (scale + bias)        Fm = f0 + (1 - f0) / 21
//! Fn = F1 Fm lost / (1 - Fm lost)
//! L F1 + E / pi (Fn + albedo (1 - metallic) (1 - F1 - Fn))
//! ```
//!
//! All of it times what [`Blocker`]s let through.

use std::f32::consts::PI;
use std::ops::Range;

use super::GROUPS;
use super::environment::EnvironmentLight;
use super::material::Look;
use super::surface::Points;
use crate::draw::DrawList;
use crate::draw::abi::Blocker;
use crate::engine::cpu::shadow::map::SunShadow;
use crate::engine::cpu::simd::{F32x8, Vec3x8};

/// How much further off the surface wrapped light looks up shadows, metres per unit of `wrap`:
/// where light goes round the terminator, the body must not shade itself at once.
const WRAP_OFFSET_M: f32 = 0.04;

/// f0 of what is not metal.
const DIELECTRIC: f32 = 0.04;

/// A point light, scaled by the exposure.
#[derive(Clone, Copy)]
struct Point {
    position: [f32; 3],
    color_cd: [f32; 3],
    /// Squared range.
    range_m2: f32,
    /// Its inverse.
    per_range_m2: f32,
    /// Inverse of the radius.
    per_radius_m: f32,
}

/// Light that goes round the terminator.
#[derive(Clone, Copy)]
struct Wrap {
    /// How far, 0 for not at all.
    by: f32,
    /// Keeps the energy.
    scale: f32,
}

/// A sphere in the way of surrounding light.
#[derive(Clone, Copy)]
struct Sphere {
    center: [f32; 3],
    /// Squared radius.
    radius_m2: f32,
    /// Squared reach, and its inverse.
    reach_m2: f32,
    per_reach_m2: f32,
}

impl Sphere {
    fn new(blocker: &Blocker) -> Self {
        let Blocker { center, radius_m } = *blocker;
        let reach_m2 = (Blocker::REACH * radius_m) * (Blocker::REACH * radius_m);
        let radius_m2 = radius_m * radius_m;
        Self { center, radius_m2, reach_m2, per_reach_m2: 1.0 / reach_m2.max(1e-12) }
    }
}

/// What of the lights matters to a tile.
#[derive(Clone, Debug, Default)]
pub(in crate::engine::cpu) struct Reaching {
    /// Point lights whose range reaches it.
    lamps: Vec<u32>,
    /// Spheres that may be in the way of its surrounding light.
    blockers: Vec<u32>,
}

/// All lights, scaled by the exposure.
pub(in crate::engine::cpu) struct Lighting<'a> {
    /// Unit direction towards the sun and its colour.
    sun: Option<([f32; 3], [f32; 3])>,
    shadow: Option<SunShadow<'a>>,
    points: Vec<Point>,
    blockers: Vec<Sphere>,
    sky: [f32; 3],
    ground: [f32; 3],
    /// World +Y in view space.
    up: [f32; 3],
    /// Stands in for sky and ground.
    environment: Option<EnvironmentLight<'a>>,
}

impl<'a> Lighting<'a> {
    pub(in crate::engine::cpu) fn new(list: &'a DrawList, shadow: Option<SunShadow<'a>>) -> Self {
        let (lights, exposure, view_from_world) =
            (&list.lights, list.exposure, &list.view.view_from_world);
        let exposed = |c: [f32; 3]| c.map(|v| v * exposure);
        Self {
            sun: lights.sun.map(|sun| (unit(sun.direction_to_sun), exposed(sun.color_lux))),
            shadow,
            points: lights
                .points
                .iter()
                .map(|p| Point {
                    position: p.position,
                    color_cd: exposed(p.color_cd),
                    range_m2: p.range_m * p.range_m,
                    per_range_m2: 1.0 / (p.range_m * p.range_m),
                    per_radius_m: 1.0 / p.radius_m.max(1e-6),
                })
                .collect(),
            blockers: list.blockers.iter().map(Sphere::new).collect(),
            sky: exposed(lights.sky_lux),
            ground: exposed(lights.ground_lux),
            up: view_from_world.map(|row| row[1]),
            environment: lights.surroundings.as_ref().map(|s| EnvironmentLight::new(s, exposure)),
        }
    }

    /// The picture of what stands behind everything, if there is one.
    pub(in crate::engine::cpu) const fn environment(&self) -> Option<&EnvironmentLight<'a>> {
        self.environment.as_ref()
    }

    /// Names what reaches a view-space box.
    pub(in crate::engine::cpu) fn reaching(
        &self,
        low: [f32; 3],
        high: [f32; 3],
        out: &mut Reaching,
    ) {
        let distance2 = |p: &[f32; 3]| -> f32 {
            (0..3).map(|i| (low[i] - p[i]).max(p[i] - high[i]).max(0.0)).map(|d| d * d).sum()
        };
        out.lamps.clear();
        let lamps = self.points.iter().zip(0..);
        out.lamps.extend(lamps.filter(|l| distance2(&l.0.position) < l.0.range_m2).map(|l| l.1));
        out.blockers.clear();
        let blockers = self.blockers.iter().zip(0..);
        out.blockers
            .extend(blockers.filter(|b| distance2(&b.0.center) < b.0.reach_m2).map(|b| b.1));
    }

    /// Light that fragments send to the camera, times the exposure.
    #[inline(always)]
    pub(super) fn reflected<const AVX2: bool>(
        &self,
        points: &[Points<AVX2>],
        looks: &[Look<AVX2>],
        (metallic, wrap): (f32, f32),
        (reaching, own): (&Reaching, &Range<u32>),
        out: &mut [Vec3x8<AVX2>],
    ) {
        let mut reflectors = [Reflector::ZERO; GROUPS];
        let reflectors = &mut reflectors[..out.len()];
        for (group, reflector) in reflectors.iter_mut().enumerate() {
            let look = &looks[group];
            *reflector = Reflector::new(points[group].position, look, metallic);
            out[group] = self.surrounding(reflector, look.roughness);
        }
        if !reaching.blockers.is_empty() {
            for (reflector, out) in reflectors.iter().zip(out.iter_mut()) {
                *out = out.scale(self.unblocked(reflector, &reaching.blockers, own));
            }
        }
        let reaching = &reaching.lamps[..];
        let wrap = Wrap { by: wrap, scale: 1.0 / ((1.0 + wrap) * (1.0 + wrap)) };
        if metallic > 0.0 {
            self.add_lights::<AVX2, true>(points, reflectors, (wrap, reaching), out);
        } else {
            self.add_lights::<AVX2, false>(points, reflectors, (wrap, reaching), out);
        }
    }

    /// Adds the sun and the point lights.
    #[inline(always)]
    fn add_lights<const AVX2: bool, const METAL: bool>(
        &self,
        points: &[Points<AVX2>],
        reflectors: &[Reflector<AVX2>],
        (wrap, reaching): (Wrap, &[u32]),
        out: &mut [Vec3x8<AVX2>],
    ) {
        if let Some((direction, color)) = self.sun {
            let to_sun = Vec3x8::splat(direction);
            for ((reflector, points), out) in reflectors.iter().zip(points).zip(out.iter_mut()) {
                let cosine = reflector.normal.dot(to_sun);
                if !cosine.gt(F32x8::splat(-wrap.by)).any() {
                    continue;
                }
                let lit = self.sunlit(points, to_sun, wrap.by);
                if lit.gt(F32x8::ZERO).any() {
                    let l_dot_v = to_sun.dot(reflector.to_viewer);
                    let light = (Vec3x8::splat(color), lit);
                    *out = *out + reflector.reflect::<METAL>(wrap, cosine, l_dot_v, light);
                }
            }
        }
        let mut arriving = [Arriving::ZERO; GROUPS];
        let arriving = &mut arriving[..out.len()];
        for &index in reaching {
            let light = self.points[index as usize];
            // In two steps: what depends on nothing else is computed for all first, so that the
            // processor need not wait for one group's roots and quotients before the next.
            for (reflector, arriving) in reflectors.iter().zip(arriving.iter_mut()) {
                *arriving = Arriving::new(&light, reflector);
            }
            let color = Vec3x8::splat(light.color_cd);
            for ((reflector, arriving), out) in
                reflectors.iter().zip(&*arriving).zip(out.iter_mut())
            {
                let Arriving { cosine, l_dot_v, share } = *arriving;
                if cosine.gt(F32x8::splat(-wrap.by)).any() {
                    let light = reflector.reflect::<METAL>(wrap, cosine, l_dot_v, (color, share));
                    *out = *out + light;
                }
            }
        }
    }

    /// Share of the sun's light that reaches eight fragments.
    #[inline(always)]
    fn sunlit<const AVX2: bool>(
        &self,
        points: &Points<AVX2>,
        to_sun: Vec3x8<AVX2>,
        wrap: f32,
    ) -> F32x8<AVX2> {
        match &self.shadow {
            Some(shadow) => {
                let cosine = points.normal.dot(to_sun);
                shadow.lit(points.position, points.normal, cosine, wrap * WRAP_OFFSET_M)
            }
            None => F32x8::ONE,
        }
    }

    /// Light from all around.
    #[inline(always)]
    fn surrounding<const AVX2: bool>(
        &self,
        r: &Reflector<AVX2>,
        roughness: F32x8<AVX2>,
    ) -> Vec3x8<AVX2> {
        let both_ways = r.n_dot_v + r.n_dot_v;
        let (irradiance, mirrored) = match &self.environment {
            Some(environment) => {
                let direction = r.normal.scale(both_ways) - r.to_viewer;
                let mirrored = environment.mirrored(direction, roughness);
                (environment.irradiance(r.normal), mirrored)
            }
            None => {
                let up = Vec3x8::splat(self.up);
                let upwards = r.normal.dot(up);
                let mirrored = self.hemisphere(both_ways * upwards - r.to_viewer.dot(up));
                (self.hemisphere(upwards), mirrored.scale(F32x8::splat(1.0 / PI)))
            }
        };
        let [scale, bias] = split_sum(roughness, r.n_dot_v);
        let one = Vec3x8::splat([1.0; 3]);
        let bias = Vec3x8::new(bias, bias, bias);
        let single = r.f0.scale(scale) + bias;
        let lost = (F32x8::ONE - (scale + bias.x)).max(F32x8::ZERO);
        let mean = r.f0.mix(one, F32x8::splat(1.0 / 21.0));
        let again = (single * mean).scale(lost) / (one - mean.scale(lost));
        let matt = r.diffuse * (one - single - again) + again.scale(F32x8::splat(1.0 / PI));
        mirrored * single + irradiance * matt
    }

    /// Share of surrounding light that the spheres among some let through; `own` are the object's.
    #[inline(always)]
    fn unblocked<const AVX2: bool>(
        &self,
        r: &Reflector<AVX2>,
        among: &[u32],
        own: &Range<u32>,
    ) -> F32x8<AVX2> {
        let s = F32x8::splat;
        let mut open = F32x8::ONE;
        for index in among {
            let sphere = &self.blockers[*index as usize];
            let way = Vec3x8::splat(sphere.center) - r.position;
            let distance2 = way.dot(way).max(s(1e-12));
            let far = distance2 * s(sphere.per_reach_m2);
            if !F32x8::ONE.gt(far).any() {
                continue;
            }
            let bias = if own.contains(index) { Blocker::OWN_BIAS } else { 0.0 };
            let cosine = r.normal.dot(way) * (F32x8::ONE / distance2.sqrt());
            let faces = (cosine - s(bias)).max(F32x8::ZERO) * s(1.0 / (1.0 - bias));
            let share = (s(sphere.radius_m2) / distance2).min(F32x8::ONE);
            let window = (F32x8::ONE - far * far).max(F32x8::ZERO);
            open = open * (F32x8::ONE - faces * share * (window * window));
        }
        open
    }

    /// Irradiance of surfaces that face so far upwards, -1..1.
    #[inline(always)]
    fn hemisphere<const AVX2: bool>(&self, upwards: F32x8<AVX2>) -> Vec3x8<AVX2> {
        let half = F32x8::splat(0.5);
        let share = (upwards * half + half).clamp(0.0, 1.0);
        Vec3x8::splat(self.ground).mix(Vec3x8::splat(self.sky), share)
    }
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-20);
    v.map(|x| x / length)
}

/// What arrives of a point light at eight fragments.
#[derive(Clone, Copy)]
struct Arriving<const AVX2: bool> {
    /// Between normal and light.
    cosine: F32x8<AVX2>,
    /// Cosine between light and viewer.
    l_dot_v: F32x8<AVX2>,
    /// Illuminance of a surface that faces the light, over its intensity.
    share: F32x8<AVX2>,
}

impl<const AVX2: bool> Arriving<AVX2> {
    const ZERO: Self = Self { cosine: F32x8::ZERO, l_dot_v: F32x8::ZERO, share: F32x8::ZERO };

    #[inline(always)]
    fn new(light: &Point, reflector: &Reflector<AVX2>) -> Self {
        let to_light = Vec3x8::splat(light.position) - reflector.position;
        let distance2 = to_light.dot(to_light).max(F32x8::splat(1e-12));
        let inverse = F32x8::ONE / distance2.sqrt();
        let near = inverse.min(F32x8::splat(light.per_radius_m));
        let in_range = distance2 * F32x8::splat(light.per_range_m2);
        let window = (F32x8::ONE - in_range * in_range).max(F32x8::ZERO);
        let share = near * window;
        Self {
            cosine: reflector.normal.dot(to_light) * inverse,
            l_dot_v: to_light.dot(reflector.to_viewer) * inverse,
            share: share * share,
        }
    }
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
#[derive(Clone, Copy)]
struct Reflector<const AVX2: bool> {
    position: Vec3x8<AVX2>,
    normal: Vec3x8<AVX2>,
    to_viewer: Vec3x8<AVX2>,
    n_dot_v: F32x8<AVX2>,
    f0: Vec3x8<AVX2>,
    /// Lambert term over irradiance.
    diffuse: Vec3x8<AVX2>,
    /// `a^2 - 1`.
    lobe: F32x8<AVX2>,
    /// `a^2 / (2 pi)`.
    peak: F32x8<AVX2>,
    /// Factor on `n.l` and offset that give `mix(2 n.l n.v, n.l + n.v, a)`.
    visibility: [F32x8<AVX2>; 2],
}

impl<const AVX2: bool> Reflector<AVX2> {
    const ZERO: Self = Self {
        position: Vec3x8::ZERO,
        normal: Vec3x8::ZERO,
        to_viewer: Vec3x8::ZERO,
        n_dot_v: F32x8::ZERO,
        f0: Vec3x8::ZERO,
        diffuse: Vec3x8::ZERO,
        lobe: F32x8::ZERO,
        peak: F32x8::ZERO,
        visibility: [F32x8::ZERO; 2],
    };

    #[inline(always)]
    fn new(position: Vec3x8<AVX2>, look: &Look<AVX2>, metallic: f32) -> Self {
        let to_viewer = (Vec3x8::ZERO - position).normalized();
        let n_dot_v = look.normal.dot(to_viewer).clamp(1e-3, 1.0);
        let a = look.roughness * look.roughness;
        let a2 = a * a;
        let both_ways = n_dot_v + n_dot_v;
        Self {
            position,
            normal: look.normal,
            to_viewer,
            n_dot_v,
            f0: Vec3x8::splat([DIELECTRIC; 3]).mix(look.albedo, F32x8::splat(metallic)),
            diffuse: look.albedo.scale(F32x8::splat((1.0 - metallic) / PI)),
            lobe: a2 - F32x8::ONE,
            peak: a2 * F32x8::splat(0.5 / PI),
            visibility: [both_ways + (F32x8::ONE - both_ways) * a, n_dot_v * a],
        }
    }

    /// Light sent to the viewer, given the cosines between light, normal and viewer, and the
    /// illuminance of a surface that faces the light: its colour, and a share of it. Where nothing
    /// is of `METAL`, f0 is the same for all.
    #[inline(always)]
    fn reflect<const METAL: bool>(
        &self,
        wrap: Wrap,
        cosine: F32x8<AVX2>,
        l_dot_v: F32x8<AVX2>,
        (color, share): (Vec3x8<AVX2>, F32x8<AVX2>),
    ) -> Vec3x8<AVX2> {
        let s = F32x8::splat;
        let n_dot_l = cosine.max(F32x8::ZERO);
        // |l + v|^2 = 2 + 2 l.v; n.h and v.h follow from it.
        let halfway2 = (s(2.0) + l_dot_v + l_dot_v).max(s(1e-4));
        let n_dot_sum = cosine + self.n_dot_v;
        // A normal that leans away from the viewer must not push n.h over 1, to the lobe's pole.
        let lobe = (n_dot_sum * n_dot_sum).min(halfway2) * self.lobe + halfway2;
        let visibility = n_dot_l * self.visibility[0] + self.visibility[1];
        let mirror = self.peak * halfway2 * halfway2 / (lobe * lobe * visibility).max(s(1e-30));
        let mirror = mirror * n_dot_l * share;
        let grazing = (F32x8::ONE - halfway2.sqrt() * s(0.5)).max(F32x8::ZERO);
        let grazing2 = grazing * grazing;
        let fresnel = grazing2 * grazing2 * grazing;
        let mirror = if METAL {
            self.f0.mix(Vec3x8::splat([1.0; 3]), fresnel).scale(mirror)
        } else {
            let mirror = (fresnel * s(1.0 - DIELECTRIC) + s(DIELECTRIC)) * mirror;
            Vec3x8::new(mirror, mirror, mirror)
        };
        let lambert = if wrap.by > 0.0 {
            (cosine + s(wrap.by)).max(F32x8::ZERO) * s(wrap.scale)
        } else {
            n_dot_l
        };
        (self.diffuse.scale(lambert * share) + mirror) * color
    }
}
