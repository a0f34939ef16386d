//! The sun, point lights and the light from all around.
//!
//! Photometric units. The seed's point-light intensities are written to its engine's raw field,
//! which for point lights is candela.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Choice, Color, Flag, Param, Vector};

/// All light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lights {
    /// The sun.
    pub sun: Sun,
    /// Lamps that stand still.
    pub points: Vec<PointLight>,
    /// A lamp that stands elsewhere in each frame.
    pub moving: MovingLight,
    /// Sky, ground and background.
    pub environment: Environment,
}

impl Default for Lights {
    fn default() -> Self {
        let at =
            |x, y, z| PointLight { position_m: Vector::constant(x, y, z), ..PointLight::default() };
        Self {
            sun: Sun::default(),
            points: vec![
                at(-10.0, 0.0, 0.0),
                at(10.0, 0.0, 0.0),
                at(0.0, 10.0, 0.0),
                at(0.0, -11.0, 0.0),
                at(0.0, 0.0, 10.0),
                at(0.0, 0.0, -7.0),
            ],
            moving: MovingLight::default(),
            environment: Environment::default(),
        }
    }
}

/// The sun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sun {
    /// Where false, there is no sun.
    pub enabled: bool,
    /// Where it stands.
    pub direction: SunDirection,
    /// On a surface that faces it.
    pub illuminance_lux: Param,
    /// Multiplies the illuminance.
    pub color: Color,
    /// Temperature of a glowing body, 1667..25000, whose colour multiplies this one without changing
    /// the luminance: 2700 for light bulbs, 5500 for the sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<Param>,
    /// Whether it casts shadows.
    pub shadow: bool,
}

impl Default for Sun {
    fn default() -> Self {
        Self {
            enabled: true,
            direction: SunDirection::Clock(Clock::default()),
            illuminance_lux: 10_000.0.into(),
            color: Color::srgb(1.0, 0.957, 0.839),
            temperature_k: None,
            shadow: true,
        }
    }
}

/// Where the sun stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case")]
pub enum SunDirection {
    /// By the time and the place; it may stand below the horizon and then shines from below.
    Clock(Clock),
    /// By two angles.
    Angles(SunAngles),
}

/// Time and place. North is +Z, east is -X; day 0 is the northern winter solstice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Clock {
    /// Solar time, 12 at noon.
    pub hour: Param,
    /// 0..365.
    pub day_of_year: Param,
    /// North is positive.
    pub latitude_deg: Param,
}

impl Default for Clock {
    fn default() -> Self {
        Self {
            hour: Param::uniform(0.0, 24.0),
            day_of_year: Param::uniform(0.0, 365.0),
            latitude_deg: Param::uniform(-90.0, 90.0),
        }
    }
}

/// Two angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunAngles {
    /// Clockwise seen from above, from north (+Z) over east (-X): at 0 it shines on what faces +Z.
    pub azimuth_deg: Param,
    /// Above the horizon.
    pub elevation_deg: Param,
}

/// A lamp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PointLight {
    /// Where false, there is no such lamp.
    pub enabled: bool,
    /// Whether it shines in a frame.
    pub on: Flag,
    /// Where it stands.
    pub position_m: Vector,
    /// The same in all directions.
    pub intensity_cd: Param,
    /// Multiplies the intensity.
    pub color: Color,
    /// Temperature of a glowing body, 1667..25000, whose colour multiplies this one without changing
    /// the luminance: 2700 for light bulbs, 5500 for the sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<Param>,
    /// Where its light reaches zero.
    pub range_m: f64,
    /// Radius of the lamp; light grows no further nearer than this.
    pub radius_m: f64,
}

impl Default for PointLight {
    fn default() -> Self {
        Self {
            enabled: true,
            on: Flag::with_probability(0.8),
            position_m: Vector::constant(0.0, 0.0, 0.0),
            intensity_cd: Param::uniform(5_000.0, 50_000.0),
            color: any_color(),
            temperature_k: None,
            range_m: 25.0,
            radius_m: 0.025,
        }
    }
}

/// A lamp that stands elsewhere in each frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MovingLight {
    /// Where false, there is no such lamp.
    pub enabled: bool,
    /// Whether it shines in a frame.
    pub on: Flag,
    /// Where it stands.
    pub position_m: Vector,
    /// Added to the position.
    pub position_offset_m: Vector,
    /// The same in all directions.
    pub intensity_cd: Param,
    /// Multiplies the intensity.
    pub color: Color,
    /// Temperature of a glowing body, 1667..25000, whose colour multiplies this one without changing
    /// the luminance: 2700 for light bulbs, 5500 for the sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<Param>,
    /// Where its light reaches zero.
    pub range_m: f64,
    /// Radius of the lamp; light grows no further nearer than this.
    pub radius_m: f64,
}

impl Default for MovingLight {
    fn default() -> Self {
        let lamp = PointLight::default();
        Self {
            enabled: lamp.enabled,
            on: lamp.on,
            position_m: Vector::constant(0.0, 7.0, 2.0),
            position_offset_m: Vector::within(3.65),
            intensity_cd: lamp.intensity_cd,
            color: lamp.color,
            temperature_k: None,
            range_m: lamp.range_m,
            radius_m: lamp.radius_m,
        }
    }
}

fn any_color() -> Color {
    let unit = || Param::uniform(0.0, 1.0);
    Color::Srgb([unit(), unit(), unit()])
}

/// Light from all around. The seed has a static probe of unknown strength; these values leave
/// nobody black at its exposures while the sun is below the horizon and all lamps are off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Environment {
    /// Where false, none.
    pub enabled: bool,
    /// Illuminance of a surface that faces up.
    pub sky_lux: Param,
    /// Multiplies it.
    pub sky_color: Color,
    /// Illuminance of a surface that faces down.
    pub ground_lux: Param,
    /// Multiplies it.
    pub ground_color: Color,
    /// Luminance where nothing stands.
    pub background_nits: Param,
    /// Multiplies it.
    pub background_color: Color,
    /// Whether bodies keep this light off what is near them: the ground under the feet, a side under
    /// an arm.
    pub ambient_occlusion: bool,
    /// A picture of all directions, which stands in for sky, ground and background.
    pub image: EnvironmentImage,
}

/// Light from all around as a picture of all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentImage {
    /// Id of a picture; `"any"` for one of all, `"sky"` for a sky computed from the sun's place,
    /// `"none"` for none. Pictures are those of the program and the .hdr and .exr files, twice as
    /// wide as high, of the folders in `assets`.
    pub source: Choice<String>,
    /// About the vertical; a computed sky is not turned.
    pub rotation_deg: Param,
    /// Illuminance of a surface, mean over all directions that it may face.
    pub illuminance_lux: Param,
    /// Of the computed sky.
    pub sky: Sky,
}

impl Default for EnvironmentImage {
    fn default() -> Self {
        Self {
            source: Choice::Always("none".to_owned()),
            rotation_deg: Param::uniform(0.0, 360.0),
            illuminance_lux: 1100.0.into(),
            sky: Sky::default(),
        }
    }
}

/// The sky by the place of the sun, whether that shines or not; one below the horizon counts as
/// one on it. The ground below has `ground_color`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sky {
    /// 1.7 very clear .. 10 hazy.
    pub turbidity: Param,
    /// Share of the sky that clouds hide, 0..1.
    pub cloud_cover: Param,
}

impl Default for Sky {
    fn default() -> Self {
        Self { turbidity: 3.0.into(), cloud_cover: 0.3.into() }
    }
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            enabled: true,
            sky_lux: 1400.0.into(),
            sky_color: Color::srgb(0.8, 0.9, 1.0),
            ground_lux: 800.0.into(),
            ground_color: Color::srgb(1.0, 0.95, 0.9),
            background_nits: 400.0.into(),
            background_color: Color::srgb(0.6, 0.75, 1.0),
            ambient_occlusion: false,
            image: EnvironmentImage::default(),
        }
    }
}
