//! People: placement, bodies, looks, clothes and poses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cast::Member;
use super::face::Expression;
use super::place::PoissonDisk;
use super::{Auto, Choice, Color, ColorLaw, Flag, Param, Placement, Rotation, Wardrobe};
use crate::scene::{BeardStyle, Glasses, HairStyle, HandShape, HeadwearKind, Sex, Shape};

/// Everybody in the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct People {
    /// Where false, there is nobody.
    pub enabled: bool,
    /// How many different people there are, over all frames; `null` for somebody new each time.
    /// Who comes again has the same body, face, hair and cut of clothes; the clothes' colours, the
    /// pose and the place are drawn anew. People who recur take no time to shape. At least as many
    /// as the cast; `null` with a cast for the people of the cast alone.
    pub identities: Option<u32>,
    /// People who are listed: the first identities, in this order.
    pub cast: Vec<Member>,
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
    /// What they sit on.
    pub seats: Seats,
}

impl Default for People {
    fn default() -> Self {
        Self {
            enabled: true,
            identities: Some(50),
            cast: Vec::new(),
            placement: Placement::PoissonDisk(PoissonDisk {
                x_m: [-7.5, 7.5],
                y_m: [-7.5, 7.5],
                depth_m: Param::uniform(-9.0, 6.0),
                separation_m: 3.0,
                count: None,
                no_overlap: false,
                in_view: 0.0,
            }),
            scale: Param::uniform(0.5, 3.0),
            rotation_deg: Rotation::YAW,
            body: Body::default(),
            look: Look::default(),
            wardrobe: Wardrobe::default(),
            pose: Pose::default(),
            seats: Seats::default(),
        }
    }
}

impl People {
    /// How many different people recur over all frames, those of the cast among them; `None` where
    /// somebody new comes each time.
    #[must_use]
    pub fn identity_count(&self) -> Option<u32> {
        let listed = u32::try_from(self.cast.len()).unwrap_or(u32::MAX);
        self.identities.or((listed > 0).then_some(listed))
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
    /// Body mass over the square of the stature, kg/m2; `"auto"` draws it for age and sex. The body
    /// model reaches about 13 to 40.
    pub bmi_kg_m2: Auto<Param>,
    /// Slider at an average weight; very thin and very heavy people have less.
    pub muscle: Param,
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
            bmi_kg_m2: Auto::default(),
            muscle: Param::normal(0.5, 0.18, 0.15, 0.95),
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
    /// Hair, brows and beard.
    pub hair_color: Auto<Color>,
    /// Whether hair whose colour is `"auto"` is dyed pink, blue, green and the like, from the age of
    /// 14 on.
    pub dyed: Flag,
    /// Hair on the face; `"auto"` gives beards to men by age.
    pub beard: Auto<Choice<BeardStyle>>,
    /// On the head. It presses the hair below it flat; a headscarf hides all of it. `"auto"` leaves
    /// nine heads in ten bare.
    pub headwear: Auto<Choice<HeadwearKind>>,
    /// Colour of what is on the head.
    pub headwear_color: Auto<Color>,
    /// In front of the eyes; `"auto"` gives glasses to few young people and to many old ones.
    pub glasses: Auto<Choice<Glasses>>,
    /// Iris.
    pub iris_color: Auto<Color>,
    /// How many local shapes are added to a face.
    pub face_targets: Param,
    /// Standard deviation of their amount.
    pub face_std: f64,
    /// Largest amount.
    pub face_max: f64,
    /// Expression and gaze.
    pub expression: Expression,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            enabled: true,
            skin: Auto::default(),
            hair: Auto::default(),
            hair_color: Auto::default(),
            dyed: Flag::with_probability(0.02),
            beard: Auto::default(),
            headwear: Auto::default(),
            headwear_color: Auto::default(),
            glasses: Auto::default(),
            iris_color: Auto::default(),
            face_targets: Param::uniform(10.0, 25.0),
            face_std: 0.35,
            face_max: 0.8,
            expression: Expression::default(),
        }
    }
}

/// What people do: frames of motion clips, and poses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pose {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// Id of a motion clip (`"walk"`) or of a pose (`"pose/sitting_chair"`); `"any_clip"`,
    /// `"any_pose"` or `"any"` for one of all.
    pub clip: Choice<String>,
    /// Whether nobody takes a pose that the clothes are not made for, such as swimming in a coat: where
    /// one is drawn, another one is drawn in its place. What the config leaves no choice of is taken
    /// in any clothes.
    pub suits_clothes: bool,
    /// Position in the clip: 0 its first frame .. 1 its last. Poses have none.
    pub phase: Param,
    /// Whether left and right are exchanged.
    pub mirrored: Flag,
    /// How far joints stray from the clip or the pose, each for itself: 0 not at all .. 1 by a
    /// standard deviation of 3 to 14 degrees. No joint goes beyond what human joints can do.
    pub variation: Param,
    /// A second clip or pose that is mixed in.
    pub blend: Blend,
    /// What fingers do; `"auto"` leaves it to the pose and draws it for clips, mostly relaxed.
    pub hands: Auto<Choice<HandShape>>,
    /// How far the head is turned beyond the pose: to the left, and up.
    pub gaze_deg: [Param; 2],
}

impl Default for Pose {
    fn default() -> Self {
        Self {
            enabled: true,
            clip: Choice::Always("any_clip".to_owned()),
            suits_clothes: false,
            phase: Param::uniform(0.0, 1.0),
            mirrored: Flag::with_probability(0.5),
            variation: Param::Constant(0.0),
            blend: Blend::default(),
            hands: Auto::default(),
            gaze_deg: [Param::Constant(0.0), Param::Constant(0.0)],
        }
    }
}

/// What whoever takes a sitting pose sits on: a block from the ground up to the seat, as wide and as
/// deep as the body needs. It hides what is behind it and is no person's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Seats {
    /// Where false, sitting people sit on nothing.
    pub enabled: bool,
    /// Form; its height and width are the body's.
    pub shape: Choice<Shape>,
    /// Texture id; `"any"` for one of all, `"none"` for plain.
    pub texture: Choice<String>,
    /// Multiplies the texture.
    pub color: Color,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
}

impl Default for Seats {
    fn default() -> Self {
        Self {
            enabled: true,
            shape: Choice::of([(Shape::Cube, 2.0), (Shape::Cylinder, 1.0)]),
            texture: Choice::Always("none".to_owned()),
            color: Color::Other(ColorLaw::Hsv([
                Param::uniform(15.0, 45.0),
                Param::uniform(0.1, 0.6),
                Param::uniform(0.2, 0.75),
            ])),
            hue_offset_deg: Param::Constant(0.0),
        }
    }
}

/// A second clip or pose that is mixed in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Blend {
    /// Id, as in `clip`.
    pub clip: Choice<String>,
    /// Position in the clip: 0 its first frame .. 1 its last.
    pub phase: Param,
    /// 0 the first alone .. 1 the second alone.
    pub share: Param,
}

impl Default for Blend {
    fn default() -> Self {
        Self {
            clip: Choice::Always("any_clip".to_owned()),
            phase: Param::uniform(0.0, 1.0),
            share: Param::Constant(0.0),
        }
    }
}
