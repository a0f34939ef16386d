//! What happens to the light behind the lens, in this order: exposure, bloom, vignette, the sensor's
//! noise, white balance, contrast, saturation, tone curve, grain.
//!
//! Ranges and meanings are those of the seed, PeopleSansPeople. Its grain was switched off.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Param;
use crate::scene::ToneCurve;

/// What happens to the light behind the lens. An effect of strength 0 costs nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Post {
    /// Where false, the exposure takes its median and the other effects are off.
    pub enabled: bool,
    /// Exposure value at ISO 100; one more halves the picture's brightness.
    pub exposure_ev: Param,
    /// Taken off the exposure value; one more doubles the picture's brightness.
    pub compensation_ev: Param,
    /// Light that the lens scatters round what is bright: the share `2^bloom - 1` of all light, so
    /// that 0 is none and 1 all of it. The picture keeps its light as a whole.
    pub bloom: Param,
    /// How far it is scattered, 0 a few pixels .. 1 over the picture.
    pub bloom_scatter: Param,
    /// How much darker the corners are: 0 not at all .. 1. At 0.5 the corners are black and the
    /// middles of the edges have 0.4375 of their light.
    pub vignette: Param,
    /// Variance of the sensor's noise per unit of light, 1 being what fills it: 0.001 is that of a
    /// thousand electrons. Each channel of each pixel has its own noise.
    pub shot_noise: Param,
    /// Standard deviation of the sensor's noise in the dark, where 1 fills it.
    pub read_noise: Param,
    /// White balance, -100 bluish .. 100 yellowish.
    pub white_balance_temperature: Param,
    /// White balance, -100 greenish .. 100 purple.
    pub white_balance_tint: Param,
    /// -100 all grey .. 100 twice the differences in log light from mid-grey.
    pub contrast: Param,
    /// -100 without colour .. 100 twice the colour.
    pub saturation: Param,
    /// From the sensor's light to that of the display.
    pub tone_curve: ToneCurve,
    /// Standard deviation of monochrome noise, as a share of the picture's full scale (sRGB): 0.02
    /// is five steps of 255.
    pub grain: Param,
}

impl Default for Post {
    fn default() -> Self {
        Self {
            enabled: true,
            exposure_ev: Param::uniform(5.0, 10.0),
            // The seed's own compensation is +3 in its engine's light units. In photometric units
            // this one, with the surroundings' light, gives its published pictures' mean luma
            // (0.505) and clipped share (1 %).
            compensation_ev: (-1.5).into(),
            bloom: 0.2.into(),
            bloom_scatter: 0.7.into(),
            vignette: Param::uniform(0.0, 0.5),
            shot_noise: 0.0.into(),
            read_noise: 0.0.into(),
            white_balance_temperature: Param::uniform(-20.0, 20.0),
            white_balance_tint: 0.0.into(),
            contrast: Param::uniform(-30.0, 30.0),
            saturation: Param::uniform(-30.0, 30.0),
            tone_curve: ToneCurve::Aces,
            grain: 0.0.into(),
        }
    }
}
