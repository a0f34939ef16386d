//! Develop: the light that reaches the sensor to linear display light.
//!
//! Vignette, the sensor's noise, white balance, contrast, saturation, tone curve, each left out where it does nothing.
//! Works on fragments, before they are summed up to pixels. Curves: Narkowicz, "ACES filmic tone
//! mapping curve" (2015); AgX (Sobotka, 2022) in the polynomial form of Wrensch, "Minimal AgX
//! implementation" (2023). The formulas stand in `shaders/shared/develop.wgsl` as well.

use super::samples::{Layout, TILE};
use super::shade::{LensRays, Stage, TileColor};
use super::simd::{F32x8, LANES, Vec3x8, kernel};
use crate::draw::DrawList;
use crate::draw::abi::{ColorGrade, Grade, ToneCurve};

/// Darkest and brightest light of AgX, binary orders of magnitude.
const AGX_RANGE: [f32; 2] = [-12.473_93, 4.026_069];
/// Rows of its primaries from Rec. 709, and back.
const AGX_INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_24, 0.878_468_64, 0.079_166_13],
    [0.042_375_654, 0.078_433_6, 0.879_143],
];
/// See [`AGX_INSET`].
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_85, 1.151_903_1, -0.098_961_18],
    [-0.052_971_635, -0.098_043_45, 1.151_073_7],
];

/// No light is kept that is brighter, 1 being what fills the sensor.
const BRIGHTEST: f32 = 1e4;

/// What is done with exposed light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Develop {
    vignette: Option<Vignette>,
    noise: Option<SensorNoise>,
    color: Option<ColorGrade>,
    curve: ToneCurve,
    /// Light is only kept, as [`compressed`] has it.
    keeps: bool,
}

/// Darkening with the distance from the middle, whose axes are functions of the pixel.
#[derive(Clone, Copy, Debug)]
struct Vignette {
    per_px: [f32; 2],
    at_middle: f32,
}

/// Noise of photons and of reading them out; see [`crate::draw::abi::Grade`].
#[derive(Clone, Copy, Debug)]
struct SensorNoise {
    shot: f32,
    read2: f32,
}

impl SensorNoise {
    /// Light with noise that is `unit` at standard deviation 1.
    #[inline(always)]
    fn add<const AVX2: bool>(&self, light: F32x8<AVX2>, unit: F32x8<AVX2>) -> F32x8<AVX2> {
        let variance = light.max(F32x8::ZERO) * F32x8::splat(self.shot) + F32x8::splat(self.read2);
        light + variance.sqrt() * unit
    }
}

impl Develop {
    pub(super) fn new(list: &DrawList) -> Self {
        let (grade, view) = (&list.grade, &list.view);
        let strength = 3.0 * grade.vignette;
        let vignette = Vignette {
            per_px: [view.width, view.height].map(|side| strength / side as f32),
            at_middle: 0.5 * strength,
        };
        let read2 = grade.read_noise * grade.read_noise;
        let noise = SensorNoise { shot: grade.shot_noise, read2 };
        Self {
            vignette: (grade.vignette > 0.0).then_some(vignette),
            noise: Self::is_noisy(grade).then_some(noise),
            color: grade.color,
            curve: grade.tone_curve,
            keeps: false,
        }
    }

    /// Keeps the light of fragments, to be developed by the pixel once all of it is known.
    pub(super) const fn keep() -> Self {
        let curve = ToneCurve::None;
        Self { vignette: None, noise: None, color: None, curve, keeps: true }
    }

    /// Whether pixels are developed later.
    pub(super) const fn keeps(&self) -> bool {
        self.keeps
    }

    /// Whether the sensor adds noise.
    pub(super) fn is_noisy(grade: &Grade) -> bool {
        grade.shot_noise > 0.0 || grade.read_noise > 0.0
    }

    /// Linear display light, 0..1, of exposed light at positions in the picture; `unit` is the
    /// pixels' noise at standard deviation 1.
    #[inline(always)]
    pub(super) fn display<const AVX2: bool>(
        &self,
        light: Vec3x8<AVX2>,
        at: [F32x8<AVX2>; 2],
        unit: Vec3x8<AVX2>,
    ) -> Vec3x8<AVX2> {
        if self.keeps {
            return compressed(light);
        }
        let light = match &self.vignette {
            Some(vignette) => light.scale(vignette.share(at)),
            None => light,
        };
        let light = match &self.noise {
            Some(noise) => Vec3x8::new(
                noise.add(light.x, unit.x),
                noise.add(light.y, unit.y),
                noise.add(light.z, unit.z),
            ),
            None => light,
        };
        let light = match &self.color {
            Some(grade) => graded(grade, light),
            None => light,
        };
        match self.curve {
            ToneCurve::Aces => Vec3x8::new(aces(light.x), aces(light.y), aces(light.z)),
            ToneCurve::Agx => agx(light),
            ToneCurve::None => Vec3x8::new(
                light.x.clamp(0.0, 1.0),
                light.y.clamp(0.0, 1.0),
                light.z.clamp(0.0, 1.0),
            ),
        }
    }
}

/// Light over one more than its brightest channel, so that sums of it are smooth where one is much
/// brighter than the others (Karis, "Tone mapping", 2013).
#[inline(always)]
pub(super) fn compressed<const AVX2: bool>(light: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
    let brightest = light.x.max(light.y).max(light.z).clamp(0.0, BRIGHTEST);
    let factor = F32x8::ONE / (F32x8::ONE + brightest);
    let within = |v: F32x8<AVX2>| v.clamp(0.0, BRIGHTEST) * factor;
    Vec3x8::new(within(light.x), within(light.y), within(light.z))
}

impl Vignette {
    /// Share of the light that is left.
    #[inline(always)]
    fn share<const AVX2: bool>(&self, at: [F32x8<AVX2>; 2]) -> F32x8<AVX2> {
        let x = at[0] * F32x8::splat(self.per_px[0]) - F32x8::splat(self.at_middle);
        let y = at[1] * F32x8::splat(self.per_px[1]) - F32x8::splat(self.at_middle);
        let (x2, y2) = ((x * x).min(F32x8::ONE), (y * y).min(F32x8::ONE));
        (F32x8::ONE - (x2 + y2)).max(F32x8::ZERO)
    }
}

#[inline(always)]
fn times<const AVX2: bool>(rows: &[[f32; 3]; 3], v: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
    Vec3x8::new(
        Vec3x8::splat(rows[0]).dot(v),
        Vec3x8::splat(rows[1]).dot(v),
        Vec3x8::splat(rows[2]).dot(v),
    )
}

/// See [`ColorGrade`].
#[inline(always)]
fn graded<const AVX2: bool>(grade: &ColorGrade, light: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
    let v = times(&grade.before, light);
    if grade.contrast == 1.0 {
        return v;
    }
    let power = grade.contrast;
    let v = Vec3x8::new(contrasted(v.x, power), contrasted(v.y, power), contrasted(v.z, power));
    times(&grade.after, v)
}

#[inline(always)]
fn contrasted<const AVX2: bool>(v: F32x8<AVX2>, power: f32) -> F32x8<AVX2> {
    v.clamp(1e-9, 1e9).powf(power)
}

#[inline(always)]
fn aces<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    let s = F32x8::splat;
    let x = v.clamp(0.0, 1e4);
    let y = (x * (x * s(2.51) + s(0.03))) / (x * (x * s(2.43) + s(0.59)) + s(0.14));
    y.clamp(0.0, 1.0)
}

#[inline(always)]
fn agx<const AVX2: bool>(light: Vec3x8<AVX2>) -> Vec3x8<AVX2> {
    let v = times(&AGX_INSET, light);
    let v = times(&AGX_OUTSET, Vec3x8::new(agx_curve(v.x), agx_curve(v.y), agx_curve(v.z)));
    Vec3x8::new(
        v.x.clamp(1e-9, 1.0).powf(2.2),
        v.y.clamp(1e-9, 1.0).powf(2.2),
        v.z.clamp(1e-9, 1.0).powf(2.2),
    )
}

#[inline(always)]
fn agx_curve<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    let s = F32x8::splat;
    let [darkest, brightest] = AGX_RANGE;
    let x = (v.clamp(1e-9, 1e9).log2() - s(darkest)) * s(1.0 / (brightest - darkest));
    let x = x.clamp(0.0, 1.0);
    let x2 = x * x;
    let x4 = x2 * x2;
    x4 * x2 * s(15.5) - x4 * x * s(40.14) + x4 * s(31.96) - x2 * x * s(6.868)
        + x2 * s(0.4298)
        + x * s(0.1191)
        - s(0.002_32)
}

/// What shows where nothing stands, unless there is a picture of the surroundings: exposed light.
#[derive(Clone, Copy)]
pub(super) struct Backdrop(pub(super) [f32; 3]);

kernel! {
    /// Starts a tile's colours with what shows where nothing stands; `rays` are those of a lens where
    /// there is one, `pixels` the background's share by pixel slot, and noise where there is any.
    fn start_with_background[const S: usize](
        stage: &Stage<'_>,
        backdrop: Backdrop,
        rays: Option<&LensRays>,
        origin_px: [u32; 2],
        pixels: (&[f32], Option<&TileColor>),
        color: &mut TileColor,
    ) = start_with_background_body
}

#[inline(always)]
fn start_with_background_body<const AVX2: bool, const S: usize>(
    stage: &Stage<'_>,
    backdrop: Backdrop,
    rays: Option<&LensRays>,
    origin_px: [u32; 2],
    (share, noise): (&[f32], Option<&TileColor>),
    color: &mut TileColor,
) {
    let [red, green, blue] = color;
    let develop = &stage.develop;
    let environment = stage.lighting.environment();
    let varies = develop.vignette.is_some() || environment.is_some() || noise.is_some();
    let mut exposed = Vec3x8::splat(backdrop.0);
    let plain = develop.display::<AVX2>(exposed, [F32x8::ZERO; 2], Vec3x8::ZERO);
    for first in (0..TILE * TILE).step_by(LANES) {
        let share = F32x8::<AVX2>::load(&share[first..]);
        let mut light = plain;
        if varies && share.gt(F32x8::ZERO).any() {
            let places = &Layout::<S>::SLOT_XY[first..first + LANES];
            let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
            for (lane, xy) in places.iter().enumerate() {
                x[lane] = (origin_px[0] + u32::from(xy[0])) as f32 + 0.5;
                y[lane] = (origin_px[1] + u32::from(xy[1])) as f32 + 0.5;
            }
            let at = [F32x8(x), F32x8(y)];
            if let Some(environment) = environment {
                let directions = match rays {
                    Some(rays) => Vec3x8::new(
                        F32x8::load(&rays[0][first..]),
                        F32x8::load(&rays[1][first..]),
                        F32x8::splat(-1.0),
                    ),
                    None => stage.rays.directions(at),
                };
                exposed = environment.seen(directions);
            }
            let unit = noise.map_or(Vec3x8::ZERO, |noise| {
                let [r, g, b] = [0, 1, 2].map(|c| F32x8::load(&noise[c][first..]));
                Vec3x8::new(r, g, b)
            });
            light = develop.display(exposed, at, unit);
        }
        (light.x * share).store(&mut red[first..]);
        (light.y * share).store(&mut green[first..]);
        (light.z * share).store(&mut blue[first..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn developed(grade: Grade, light: [f32; 3], at: [f32; 2]) -> [f32; 3] {
        let mut list = DrawList { grade, ..DrawList::default() };
        (list.view.width, list.view.height) = (400, 300);
        let light = Vec3x8::<false>::splat(light);
        let out = Develop::new(&list).display(light, at.map(F32x8::splat), Vec3x8::ZERO);
        [out.x, out.y, out.z].map(|v| v.0[0])
    }

    #[test]
    fn the_vignette_has_the_seeds_figures() {
        let grade = Grade { vignette: 0.5, tone_curve: ToneCurve::None, ..Grade::default() };
        let at = |x: f32, y: f32| developed(grade, [1.0; 3], [x * 400.0, y * 300.0])[0];
        assert_eq!(at(0.5, 0.5), 1.0);
        for (x, y) in [(0.0, 0.5), (1.0, 0.5), (0.5, 0.0), (0.5, 1.0)] {
            assert!((at(x, y) - 0.4375).abs() < 1e-6, "{}", at(x, y));
        }
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)] {
            assert_eq!(at(x, y), 0.0);
        }
    }

    #[test]
    fn contrast_is_a_power_round_mid_grey() {
        let scale = |v: f32| [[v, 0.0, 0.0], [0.0, v, 0.0], [0.0, 0.0, v]];
        let (before, after) = (scale(1.0 / 0.18), scale(0.18));
        let color = Some(ColorGrade { before, contrast: 1.3, after });
        let grade = Grade { color, tone_curve: ToneCurve::None, ..Grade::default() };
        for v in [0.0_f32, 1e-4, 0.01, 0.18, 0.5] {
            let got = developed(grade, [v; 3], [0.0; 2])[1];
            let wanted = 0.18 * libm::pow(f64::from(v) / 0.18, 1.3);
            assert!((f64::from(got) - wanted).abs() < 1e-5 * wanted.max(0.01), "{got} {wanted}");
        }
    }

    #[test]
    fn tone_curves_rise_from_0_to_1_and_survive_anything() {
        for tone_curve in [ToneCurve::Aces, ToneCurve::Agx, ToneCurve::None] {
            let grade = Grade { tone_curve, ..Grade::default() };
            let at = |v: f32| developed(grade, [v; 3], [0.0; 2])[0];
            assert!(at(0.0) < 1e-3 && at(-1.0) < 1e-3, "{tone_curve:?} {}", at(0.0));
            assert!(at(1e3) > 0.95 && at(f32::MAX) <= 1.0, "{tone_curve:?} {}", at(1e3));
            assert!((0.0..=1.0).contains(&at(f32::NAN)) && at(f32::INFINITY) <= 1.0);
            let rises = |i: i32| at(i as f32 * 0.01) >= at((i - 1) as f32 * 0.01) - 1e-6;
            assert!((1..1000).all(rises), "{tone_curve:?}");
        }
    }

    #[test]
    fn agx_shows_mid_grey_as_its_authors_do() {
        // The published curve, in f64, of a grey, which both matrices leave alone to 2e-4.
        let x = (libm::log2(0.18) + 12.473_93) / 16.499_999;
        let curve = 15.5 * x.powi(6) - 40.14 * x.powi(5) + 31.96 * x.powi(4) - 6.868 * x.powi(3)
            + 0.4298 * x * x
            + 0.1191 * x
            - 0.002_32;
        let grade = Grade { tone_curve: ToneCurve::Agx, ..Grade::default() };
        let got = f64::from(developed(grade, [0.18; 3], [0.0; 2])[2]);
        assert!((got - libm::pow(curve, 2.2)).abs() < 2e-4, "{got}");
    }
}
