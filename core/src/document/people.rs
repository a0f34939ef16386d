//! People: placement, bodies, looks, clothes and poses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::place::PoissonDisk;
use super::{Auto, Choice, Color, Flag, Param, Placement, Rotation, Wardrobe};
use crate::scene::{HairStyle, Sex};

/// Everybody in the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct People {
    /// Where false, there is nobody.
    pub enabled: bool,
    /// How many different people there are, over all frames; `null` for somebody new each time.
    /// Who comes again has the same body, face, hair and cut of clothes; the clothes' colours, the
    /// pose and the place are drawn anew. People who recur take no time to shape.
    pub identities: Option<u32>,
    /// Where they stand.
    pub placement: Placement,
    /// Multiplies a person of normal size.
    pub scale: Param,
    /// Orientation; unrotated they face +Z.
    pub rotation_deg: Rotation,
    /// Body shape.
    pub body: Body,
    /// Skin, hair, eyes and face.
    pub look: Look,
    /// Clothes.
    pub wardrobe: Wardrobe,
    /// Pose.
    pub pose: Pose,
}

impl Default for People {
    fn default() -> Self {
        Self {
            enabled: true,
            identities: Some(100),
            placement: Placement::PoissonDisk(PoissonDisk {
                x_m: [-7.5, 7.5],
                y_m: [-7.5, 7.5],
                depth_m: Param::uniform(-9.0, 6.0),
                separation_m: 3.0,
            }),
            scale: Param::uniform(0.5, 3.0),
            rotation_deg: Rotation::YAW,
            body: Body::default(),
            look: Look::default(),
            wardrobe: Wardrobe::default(),
            pose: Pose::default(),
        }
    }
}

/// Body shape. The sliders are those of the body model, 0..1 with 0.5 in the middle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Body {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// 1..90.
    pub age_years: Param,
    /// Of the body model.
    pub sex: Choice<Sex>,
    /// Standing height without shoes, before `people.scale`; `"auto"` draws it for age and sex.
    pub stature_m: Auto<Param>,
    /// Slider.
    pub muscle: Param,
    /// Slider.
    pub weight: Param,
    /// Slider: 0 idealised, 1 uncommon.
    pub proportions: Param,
    /// Where the forebears lived.
    pub ancestry: Ancestry,
    /// Slider, women only.
    pub cup: Param,
    /// Slider, women only.
    pub firmness: Param,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            enabled: true,
            age_years: Param::mix([
                (0.85, Param::uniform(18.0, 60.0)),
                (0.15, Param::uniform(60.0, 80.0)),
            ]),
            sex: Choice::of([(Sex::Male, 1.0), (Sex::Female, 1.0)]),
            stature_m: Auto::default(),
            // Within these bounds the body mass index stays between about 16 and 34.
            muscle: Param::normal(0.5, 0.18, 0.15, 0.95),
            weight: Param::normal(0.5, 0.2, 0.15, 0.95),
            proportions: Param::normal(0.4, 0.2, 0.0, 1.0),
            ancestry: Ancestry::Dirichlet([0.4; 3]),
            cup: Param::uniform(0.2, 0.8),
            firmness: Param::uniform(0.3, 0.8),
        }
    }
}

/// Shares of African, Asian and European forebears.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ancestry {
    /// Mixtures by the Dirichlet law with these concentrations (African, Asian, European); below 1
    /// most people are mostly of one kind.
    Dirichlet([f64; 3]),
    /// Always these shares (African, Asian, European); they need not sum to 1.
    Shares([f64; 3]),
    /// One of the three by weight.
    Choice(Vec<(Origin, f64)>),
}

/// Where all forebears lived.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Africa.
    African,
    /// Asia.
    Asian,
    /// Europe.
    European,
}

/// Skin, hair, eyes and face. `"auto"` follows ancestry, age and sex.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Look {
    /// Where false, every parameter takes its median and no local shape is added to the face.
    pub enabled: bool,
    /// Base colour of the skin.
    pub skin: Auto<Color>,
    /// Hair on the head.
    pub hair: Auto<Choice<HairStyle>>,
    /// Hair and brows.
    pub hair_color: Auto<Color>,
    /// Iris.
    pub iris_color: Auto<Color>,
    /// How many local shapes are added to a face.
    pub face_targets: Param,
    /// Standard deviation of their amount.
    pub face_std: f64,
    /// Largest amount.
    pub face_max: f64,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            enabled: true,
            skin: Auto::default(),
            hair: Auto::default(),
            hair_color: Auto::default(),
            iris_color: Auto::default(),
            face_targets: Param::uniform(10.0, 25.0),
            face_std: 0.35,
            face_max: 0.8,
        }
    }
}

/// A frame of a motion clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pose {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// Clip id; `"any"` for one of all.
    pub clip: Choice<String>,
    /// Position in the clip: 0 its first frame .. 1 its last.
    pub phase: Param,
    /// Whether left and right are exchanged.
    pub mirrored: Flag,
}

impl Default for Pose {
    fn default() -> Self {
        Self {
            enabled: true,
            clip: Choice::Always("any".to_owned()),
            phase: Param::uniform(0.0, 1.0),
            mirrored: Flag::with_probability(0.5),
        }
    }
}
