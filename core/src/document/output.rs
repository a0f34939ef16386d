//! What is made of a scene: labels, files and quality.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Param;
use crate::plan::{Output as Kind, Outputs};

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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Pictures and labels.
    pub outputs: Outputs,
    /// How pictures are stored.
    pub image_format: ImageFormat,
    /// 1..100, rounded to the nearest whole number.
    pub jpeg_quality: Param,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            outputs: Kind::ALL.into(),
            image_format: ImageFormat::Jpeg,
            jpeg_quality: 92.0.into(),
        }
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
