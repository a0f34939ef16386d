//! What a user may ask for.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::pass::Buffer;

/// A kind of label or picture. The order is that of every listing.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Output {
    /// The picture, 8-bit sRGB.
    Rgb,
    /// Box round the visible samples of each person.
    Box2d,
    /// COCO-17 keypoints in 2D and 3D, with visibility.
    Keypoints,
    /// Which person a pixel shows, 16-bit ids; also the COCO masks.
    Instance,
    /// Which class a pixel shows, as colours.
    Semantic,
}

/// A set of wanted outputs, in listing order.
pub type Outputs = BTreeSet<Output>;

impl Output {
    /// Every output there is.
    pub const ALL: [Self; 5] =
        [Self::Rgb, Self::Box2d, Self::Keypoints, Self::Instance, Self::Semantic];

    /// The name in configs and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgb => "rgb",
            Self::Box2d => "box2d",
            Self::Keypoints => "keypoints",
            Self::Instance => "instance",
            Self::Semantic => "semantic",
        }
    }

    /// The buffers that a frame must hold for it.
    #[must_use]
    pub const fn needs(self) -> &'static [Buffer] {
        match self {
            Self::Rgb => &[Buffer::Picture],
            Self::Box2d => &[Buffer::ObjectSamples],
            // Visibility is judged from the same raster as the picture.
            Self::Keypoints => &[Buffer::Points, Buffer::ObjectIds, Buffer::Depth],
            Self::Instance | Self::Semantic => &[Buffer::ObjectIds, Buffer::ObjectSamples],
        }
    }
}
