//! One person with every number settled: body, looks, clothes and pose.

use serde::{Deserialize, Serialize};

use super::{Material, Outfit, Placement, Shape};

/// A person in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Person {
    /// The slot that keyed this person's values; stable when others come or go.
    pub slot: u32,
    /// Who of the people that recur over frames it is; absent if nobody does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identity: Option<u32>,
    /// What the config calls this person, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
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
    /// What the person sits on; as high and as wide as the body needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seat: Option<Seat>,
}

/// Something to sit on, without its size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seat {
    /// Form.
    pub shape: Shape,
    /// What it is made of.
    pub material: Material,
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

/// Body shape. The sliders are those of the body model, all 0..1 with 0.5 in the middle; the ones
/// that are not here, of height and weight, are solved for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Male or female.
    pub sex: Sex,
    /// 1..90.
    pub age_years: f64,
    /// Standing height without shoes.
    pub stature_m: f64,
    /// Body mass over the square of the stature. What the model does not reach becomes the nearest
    /// that it does, between about 13 and 40 for most adults.
    pub bmi_kg_m2: f64,
    /// Slider at an average weight; it falls towards 0 for the very thin and the very heavy.
    pub muscle: f64,
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
    Default,
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
    #[default]
    Bald,
    /// A wreath round a bald crown.
    Balding,
    /// A few millimetres.
    Cropped,
    /// Close at the sides, a little longer on top.
    CrewCut,
    /// Loose short hair that falls away from the whorl.
    Short,
    /// Short hair combed away from a parting on the left.
    SideParting,
    /// Short, brushed forwards into a fringe.
    Pixie,
    /// A round cloud of tight curls.
    Afro,
    /// Loose curls down to the jaw.
    Curly,
    /// Straight down to the jaw.
    Bob,
    /// Straight, over the shoulders.
    #[serde(alias = "long")]
    LongStraight,
    /// Wavy, over the shoulders.
    LongWavy,
    /// Drawn back into a tail.
    Ponytail,
    /// Drawn back into a knot.
    Bun,
    /// Parted in the middle, two braids in front of the shoulders.
    Braids,
}

impl HairStyle {
    /// All styles.
    pub const ALL: [Self; 15] = [
        Self::Bald,
        Self::Balding,
        Self::Cropped,
        Self::CrewCut,
        Self::Short,
        Self::SideParting,
        Self::Pixie,
        Self::Afro,
        Self::Curly,
        Self::Bob,
        Self::LongStraight,
        Self::LongWavy,
        Self::Ponytail,
        Self::Bun,
        Self::Braids,
    ];
}

/// Hair on the face.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
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
pub enum BeardStyle {
    /// Shaven, or none grows.
    #[default]
    None,
    /// A few days old.
    Stubble,
    /// On the upper lip.
    Moustache,
    /// Round the mouth and on the chin.
    Goatee,
    /// Cheeks, chin and upper lip.
    Full,
}

impl BeardStyle {
    /// All styles.
    pub const ALL: [Self; 5] =
        [Self::None, Self::Stubble, Self::Moustache, Self::Goatee, Self::Full];
}

/// What is worn on the head.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
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
pub enum HeadwearKind {
    /// Nothing.
    #[default]
    None,
    /// A cap with a visor.
    Cap,
    /// A knitted cap.
    Beanie,
    /// A hat with a brim all round.
    BrimmedHat,
    /// A scarf that leaves only the face free.
    Headscarf,
}

impl HeadwearKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::None, Self::Cap, Self::Beanie, Self::BrimmedHat, Self::Headscarf];
}

/// What is worn on the head, and its colour.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Headwear {
    /// Which.
    pub kind: HeadwearKind,
    /// Linear.
    pub color: [f64; 3],
}

/// What is worn in front of the eyes.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
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
pub enum Glasses {
    /// Nothing.
    #[default]
    None,
    /// A thin frame with clear lenses.
    Thin,
    /// A thick dark frame with clear lenses.
    Thick,
    /// Dark lenses.
    Sunglasses,
}

impl Glasses {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::None, Self::Thin, Self::Thick, Self::Sunglasses];
}

/// What a person looks like beyond the body's shape. Colours are linear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Look {
    /// Base colour of the skin.
    pub skin_color: [f64; 3],
    /// Hair on the head.
    pub hair: HairStyle,
    /// Hair, brows and beard.
    pub hair_color: [f64; 3],
    /// Hair on the face.
    #[serde(default)]
    pub beard: BeardStyle,
    /// On the head.
    #[serde(default)]
    pub headwear: Headwear,
    /// In front of the eyes.
    #[serde(default)]
    pub glasses: Glasses,
    /// Iris.
    pub iris_color: [f64; 3],
    /// Freckles: 0 none .. 1 all over the face.
    #[serde(default)]
    pub freckles: f64,
    /// How strongly blood shows through at cheeks, nose and ears: 0 not at all .. 1 most.
    #[serde(default)]
    pub flush: f64,
    /// Local face targets by their name in the figure library, with their amount (0..1).
    pub face: Vec<(String, f64)>,
}

/// A frame of a motion clip or a pose, with what was changed in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Id in the library of a clip, or of a pose, which begins with `pose/`.
    pub clip: String,
    /// Position in the clip, 0 its first frame .. 1 its last; between frames it is interpolated.
    pub phase: f64,
    /// Left and right exchanged, of all that follows as well.
    pub mirrored: bool,
    /// What the person does.
    #[serde(default)]
    pub activity: String,
    /// A second clip or pose that has a share in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<PoseBlend>,
    /// Joint angles by name, with what is added to them, degrees; joints stop at their limits.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variation_deg: Vec<(String, f64)>,
    /// How the head is turned beyond that: to the left, and up.
    #[serde(default, skip_serializing_if = "is_straight")]
    pub gaze_deg: [f64; 2],
    /// Fingers of the left and right hand; absent where they are those of the pose, and relaxed in
    /// a clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hands: Option<[HandShape; 2]>,
}

fn is_straight(gaze_deg: &[f64; 2]) -> bool {
    *gaze_deg == [0.0; 2]
}

/// A second clip or pose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseBlend {
    /// Id in the library.
    pub clip: String,
    /// Position in the clip, 0..1.
    pub phase: f64,
    /// 0 the first alone .. 1 this alone.
    pub share: f64,
}

/// What fingers do.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
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
pub enum HandShape {
    /// Loosely bent.
    #[default]
    Relaxed,
    /// Straight and together.
    Flat,
    /// Straight and apart.
    Spread,
    /// Round a handle.
    Grip,
    /// Closed.
    Fist,
    /// Closed but for the index finger.
    Point,
}

impl HandShape {
    /// All.
    pub const ALL: [Self; 6] =
        [Self::Relaxed, Self::Flat, Self::Spread, Self::Grip, Self::Fist, Self::Point];

    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Relaxed => "relaxed",
            Self::Flat => "flat",
            Self::Spread => "spread",
            Self::Grip => "grip",
            Self::Fist => "fist",
            Self::Point => "point",
        }
    }
}
