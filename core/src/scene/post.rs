//! What happens to the light behind the lens, settled.

use serde::{Deserialize, Serialize};

/// Effects between exposure and file; all of them do nothing at 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Post {
    /// 0..1: the lens scatters the share `2^bloom - 1` of the light.
    #[serde(default)]
    pub bloom: f64,
    /// How far, 0..1; see [`crate::draw::abi::Bloom`].
    #[serde(default)]
    pub bloom_scatter: f64,
    /// 0..1: `1 - d.d` of the light is left at `d = 3 vignette |xy / size - 1/2|`, each axis at most 1.
    pub vignette: f64,
    /// Variance of the sensor's noise per unit of light, 1 being what fills it.
    #[serde(default)]
    pub shot_noise: f64,
    /// Standard deviation of the sensor's noise in the dark.
    #[serde(default)]
    pub read_noise: f64,
    /// -100 bluish .. 100 yellowish.
    pub white_balance_temperature: f64,
    /// -100 greenish .. 100 purple.
    pub white_balance_tint: f64,
    /// -100..100, percent of the differences from mid-grey in log light.
    pub contrast: f64,
    /// -100..100, percent of the differences from grey.
    pub saturation: f64,
    /// From the sensor's light to that of the display.
    pub tone_curve: ToneCurve,
    /// Standard deviation of monochrome noise, a share of the picture's full scale (sRGB).
    pub grain: f64,
    /// Key of that noise and of the sensor's.
    pub grain_key: u32,
}

/// From the sensor's light to that of the display.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum ToneCurve {
    /// Filmic: a fit of the reference rendering transform of the Academy Color Encoding System.
    #[default]
    Aces,
    /// Softer, without shifts of hue in strong light.
    Agx,
    /// Linear; what is too bright is clipped.
    None,
}
