//! What is made of a scene: exposure, labels, files and quality.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Param;
use crate::plan::{Output as Kind, Outputs};

/// What happens to the light behind the lens.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Post {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// Exposure value at ISO 100; one more halves the picture's brightness.
    pub exposure_ev: Param,
    /// Taken off the exposure value; one more doubles the picture's brightness.
    pub compensation_ev: Param,
}

impl Default for Post {
    fn default() -> Self {
        // The seed's own compensation is +3 in its engine's light units. In photometric units this
        // one, with the surroundings' light, gives its published pictures' mean luma (0.505) and
        // clipped share (1 %).
        let compensation_ev = (-1.5).into();
        Self { enabled: true, exposure_ev: Param::uniform(5.0, 10.0), compensation_ev }
    }
}

/// How labels are made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Labels {
    /// Samples per pixel: 1, 4 or 16.
    pub samples: u32,
    /// Which people are written.
    pub scheme: Scheme,
}

impl Default for Labels {
    fn default() -> Self {
        Self { samples: 4, scheme: Scheme::Visible }
    }
}

/// Which people are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Of whom something is seen.
    Visible,
    /// Also who stands in the frame but is hidden.
    VisibleAndOccluded,
    /// Everybody.
    All,
}

/// What is written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Pictures and labels.
    pub outputs: Outputs,
    /// How pictures are stored.
    pub image_format: ImageFormat,
    /// 1..100.
    pub jpeg_quality: u8,
}

impl Default for Output {
    fn default() -> Self {
        Self { outputs: Kind::ALL.into(), image_format: ImageFormat::Jpeg, jpeg_quality: 92 }
    }
}

/// How pictures are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImageFormat {
    /// Small.
    Jpeg,
    /// Without loss.
    Png,
}

/// What accuracy may cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Quality {
    /// Largest side of the sun's shadow map in texels, a multiple of 64. It is smaller where texels
    /// would be finer than a pixel.
    pub shadow_map_size: u32,
    /// How far a simplified mesh may stray from the full one, pixels.
    pub lod_error_px: f64,
    /// Textures are reduced to this side, texels; a power of two.
    pub max_texture_size: u32,
}

impl Default for Quality {
    fn default() -> Self {
        Self { shadow_map_size: 2048, lod_error_px: 0.25, max_texture_size: 1024 }
    }
}
