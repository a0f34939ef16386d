//! What a stage's shader is compiled for: samples a pixel, and the kinds of light of a frame.
//!
//! Software adapters run both sides of a condition, and hardware keeps registers for both, even if
//! all invocations agree. So what a frame has not got is no part of its shader. Names in the text are
//! those of the constants below.

use super::abi::Frame;
use super::stage::Stage;
use crate::engine::pattern;

/// Numbers of samples a pixel of which there are variants.
const SAMPLES: [u32; 3] = [1, 4, 16];
/// Tone curves as [`Frame::tone_curve`] numbers them.
const TONE_CURVES: u32 = 3;
/// Most lamps that a shader counts on; what a frame has more of is looped over.
const KNOWN_LAMPS: u32 = 8;

/// A form of the shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Variant {
    /// Samples a pixel.
    pub samples: u32,
    /// What shading must know of.
    pub light: Light,
    /// Whether anything is cut out of triangles.
    pub cutouts: bool,
}

/// Kinds of light in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Light {
    /// A picture of the surroundings.
    environment: bool,
    /// Spheres in the way of surrounding light.
    blockers: bool,
    /// A sun.
    sun: bool,
    /// That casts shadows.
    shadow: bool,
    /// The sensor's noise.
    noise: bool,
    /// Which tone curve.
    tone_curve: u32,
    /// Light is kept, to be developed by the pixel.
    keeps: bool,
    /// Lamps that the shader counts on, one after the other without a loop: a multiple of four.
    known_lamps: u32,
}

impl Light {
    /// Of a frame.
    pub fn of(frame: &Frame) -> Self {
        Self {
            environment: frame.has_environment != 0,
            blockers: frame.blocker_count != 0,
            sun: frame.has_sun != 0,
            shadow: frame.has_shadow != 0,
            noise: frame.shot_noise > 0.0 || frame.read_variance > 0.0,
            tone_curve: frame.tone_curve,
            keeps: false,
            known_lamps: frame.light_count.next_multiple_of(4).min(KNOWN_LAMPS),
        }
    }
}

impl Light {
    /// What of it makes a difference to a stage.
    fn of_stage(self, stage: Stage) -> Self {
        match stage {
            Stage::Shade | Stage::LensShade => self,
            Stage::KeepLight | Stage::LensKeepLight => {
                Self { noise: false, tone_curve: 0, keeps: true, ..self }
            }
            Stage::Finish => {
                let Self { noise, tone_curve, .. } = self;
                Self { noise, tone_curve, ..Self::default() }
            }
            _ => Self::default(),
        }
    }
}

impl Variant {
    /// Without what makes no difference to a stage.
    pub fn of(self, stage: Stage) -> Self {
        Self {
            samples: if stage.by_samples() { self.samples } else { 1 },
            light: self.light.of_stage(stage),
            cutouts: self.cutouts && matches!(stage, Stage::Raster | Stage::LensRaster),
        }
    }

    /// Those of a stage: all numbers of samples; of lights none and all, with each tone curve; without
    /// and with cutouts.
    pub fn all(stage: Stage) -> impl Iterator<Item = Self> {
        let of = move |(samples, light, cutouts)| Self { samples, light, cutouts }.of(stage);
        let lights = (0..2 * TONE_CURVES).map(|k| {
            let all = k % 2 == 1;
            let [environment, blockers, sun, shadow, noise] = [all; 5];
            let known_lamps = if all { KNOWN_LAMPS } else { 0 };
            let (keeps, tone_curve) = (false, k / 2);
            Light { environment, blockers, sun, shadow, noise, tone_curve, keeps, known_lamps }
        });
        let every = lights.flat_map(|light| {
            SAMPLES.map(|n| [(n, light, false), (n, light, true)]).into_iter().flatten()
        });
        let mut variants: Vec<Self> = every.map(of).collect();
        variants.sort_unstable();
        variants.dedup();
        variants.into_iter()
    }

    /// The constants in front of a shader.
    pub fn constants(self) -> String {
        let Self { samples, light, cutouts } = self;
        let positions: Vec<String> = pattern::positions(samples)
            .iter()
            .map(|[x, y]| format!("vec2<i32>({x}, {y})"))
            .collect();
        // With one sample a pixel, positions are whole pixels from its middle, else sixteenths.
        let (grid_log2, corner) = if samples == 1 { (10, 8) } else { (6, 0) };
        let pixels = pixels_of_lane(samples);
        let Light { environment, blockers, sun, shadow, noise, tone_curve, keeps, known_lamps } =
            light;
        format!(
            "const SAMPLES: u32 = {samples}u;\n\
             const POSITIONS = array<vec2<i32>, {samples}>({});\n\
             const GRID_LOG2: u32 = {grid_log2}u;\n\
             const GRID_PER_PX: i32 = {};\n\
             const GRID_CORNER = vec2<i32>({corner}, {corner});\n\
             const PIXELS: u32 = {pixels}u;\n\
             const HAS_ENVIRONMENT: bool = {environment};\n\
             const HAS_BLOCKERS: bool = {blockers};\n\
             const HAS_SUN: bool = {sun};\n\
             const HAS_SHADOW: bool = {shadow};\n\
             const HAS_NOISE: bool = {noise};\n\
             const HAS_CUTOUTS: bool = {cutouts};\n\
             const KEEPS_LIGHT: bool = {keeps};\n\
             const TONE_CURVE: u32 = {tone_curve}u;\n\
             const KNOWN_LAMPS: u32 = {known_lamps}u;\n",
            positions.join(", "),
            1 << (10 - grid_log2),
        )
    }
}

/// Pixels of a tile of 64 that one invocation of `raster` owns: as many as its registers hold the
/// samples of.
pub const fn pixels_of_lane(samples: u32) -> u32 {
    match samples {
        1 => 8,
        4 => 2,
        _ => 1,
    }
}
