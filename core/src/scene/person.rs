//! One person with every number settled: body, looks, clothes and pose.

use serde::{Deserialize, Serialize};

use super::{Outfit, Placement};

/// A person in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Person {
    /// The slot that keyed this person's values; stable when others come or go.
    pub slot: u32,
    /// Who of the people that recur over frames it is; absent if nobody does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identity: Option<u32>,
    /// Where the person stands: the model's origin is on the ground between the feet at rest,
    /// and the posed body's lowest point touches model y = 0.
    pub placement: Placement,
    /// Body shape.
    pub body: Body,
    /// Skin, hair, eyes and face.
    pub look: Look,
    /// Clothes.
    pub outfit: Outfit,
    /// Pose.
    pub pose: Pose,
}

/// Anatomical sex of the body model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sex {
    /// Male.
    Male,
    /// Female.
    Female,
}

/// Body shape. The sliders are those of the body model, all 0..1 with 0.5 in the middle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Male or female.
    pub sex: Sex,
    /// 1..90.
    pub age_years: f64,
    /// Standing height without shoes; the model's height slider is solved for it.
    pub stature_m: f64,
    /// Slider.
    pub muscle: f64,
    /// Slider.
    pub weight: f64,
    /// Slider: 0 idealised, 1 uncommon.
    pub proportions: f64,
    /// African, Asian, European: weights, normalised to sum 1 by their use.
    pub ancestry: [f64; 3],
    /// Slider, women only.
    pub cup: f64,
    /// Slider, women only.
    pub firmness: f64,
}

/// Hair on the head.
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
pub enum HairStyle {
    /// None.
    Bald,
    /// A few millimetres.
    Cropped,
    /// A cap of short hair.
    Short,
    /// A thick round cap.
    Afro,
    /// Down to the shoulders.
    Long,
}

/// What a person looks like beyond the body's shape. Colours are linear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Look {
    /// Base colour of the skin.
    pub skin_color: [f64; 3],
    /// Hair on the head.
    pub hair: HairStyle,
    /// Hair and brows.
    pub hair_color: [f64; 3],
    /// Iris.
    pub iris_color: [f64; 3],
    /// Local face targets by their name in the figure library, with their amount (0..1).
    pub face: Vec<(String, f64)>,
}

/// A frame of a motion clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Clip id in the library.
    pub clip: String,
    /// Position in the clip, 0 its first frame .. 1 its last; between frames it is interpolated.
    pub phase: f64,
    /// Left and right exchanged.
    pub mirrored: bool,
}
