//! What a person wears, with every number settled.

use serde::{Deserialize, Serialize};

/// Clothes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outfit {
    /// Upper body.
    pub top: Top,
    /// Legs; a dress is here too, and its skirt is of the top's cloth.
    pub bottom: Bottom,
    /// Over the top.
    pub outer: Outer,
    /// Feet.
    pub shoes: Shoes,
}

/// Kind of garment of the upper body.
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
pub enum TopKind {
    /// Knitted, without a collar, with short sleeves.
    TShirt,
    /// The same with long sleeves.
    LongSleeve,
    /// Woven, with a collar and a button placket.
    Shirt,
    /// Knitted, with a collar, a short placket and short sleeves.
    Polo,
    /// Without sleeves.
    TankTop,
    /// Wide, with a hood that lies on the back, and a pocket.
    Hoodie,
    /// Thick knitwear.
    Sweater,
}

/// Kind of garment of the legs.
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
pub enum BottomKind {
    /// One tube a leg.
    Trousers,
    /// Trousers of denim, straight and close.
    Jeans,
    /// Trousers that lie on the skin.
    Leggings,
    /// Trousers that end at or above the knee.
    Shorts,
    /// A skirt that ends above the knee.
    SkirtShort,
    /// A skirt that ends below the knee.
    SkirtLong,
    /// The short skirt of a dress.
    DressShort,
    /// The long skirt of a dress.
    DressLong,
}

impl BottomKind {
    /// Whether it is one tube round both legs.
    #[must_use]
    pub const fn is_skirt(self) -> bool {
        matches!(self, Self::SkirtShort | Self::SkirtLong) || self.is_dress()
    }

    /// Whether it is one piece with the top.
    #[must_use]
    pub const fn is_dress(self) -> bool {
        matches!(self, Self::DressShort | Self::DressLong)
    }
}

/// Kind of garment over the top.
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
pub enum OuterKind {
    /// No such garment.
    None,
    /// To the hip.
    Jacket,
    /// To the thigh.
    Coat,
}

/// What the feet wear.
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
pub enum ShoeKind {
    /// Low shoes in one colour.
    Shoes,
    /// With light soles.
    Sneakers,
    /// With a shaft round the shin.
    Boots,
    /// Soles and straps.
    Sandals,
    /// Nothing.
    Barefoot,
}

/// Garment of the upper body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Top {
    /// Which.
    pub kind: TopKind,
    /// End of the sleeve along the arm: 0 shoulder .. 1 wrist.
    pub sleeve: f64,
    /// How deep the neckline is cut: 0 at the neck .. 1 deep.
    pub neckline: f64,
    /// Gap between skin and cloth.
    pub looseness_m: f64,
    /// Linear colour of the cloth.
    pub color: [f64; 3],
    /// Cloth pattern: texture id in the library; plain where absent.
    pub texture: Option<String>,
    /// How the cloth is woven: a relief's id in the library; folds alone where absent.
    #[serde(default)]
    pub relief: Option<String>,
    /// Where its hue is turned and where it shines: a finish's id in the library; the same all over
    /// where absent.
    #[serde(default)]
    pub finish: Option<String>,
    /// Rotation of the hue of the cloth.
    pub hue_offset_deg: f64,
}

/// Garment of the legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bottom {
    /// Which.
    pub kind: BottomKind,
    /// End along the leg: 0 hip .. 1 ankle.
    pub length: f64,
    /// How a skirt widens downwards: 0 it hangs straight .. 1 wide.
    pub flare: f64,
    /// Gap between skin and cloth.
    pub looseness_m: f64,
    /// Linear colour of the cloth.
    pub color: [f64; 3],
    /// Cloth pattern: texture id in the library; plain where absent.
    pub texture: Option<String>,
    /// How the cloth is woven: a relief's id in the library; folds alone where absent.
    #[serde(default)]
    pub relief: Option<String>,
    /// Where its hue is turned and where it shines: a finish's id in the library; the same all over
    /// where absent.
    #[serde(default)]
    pub finish: Option<String>,
    /// Rotation of the hue of the cloth.
    pub hue_offset_deg: f64,
}

/// Garment over the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outer {
    /// Which.
    pub kind: OuterKind,
    /// Whether its front stands open.
    pub open: bool,
    /// Gap between the cloth under it and its own.
    pub looseness_m: f64,
    /// Linear colour of the cloth.
    pub color: [f64; 3],
    /// Cloth pattern: texture id in the library; plain where absent.
    pub texture: Option<String>,
    /// How the cloth is woven: a relief's id in the library; folds alone where absent.
    #[serde(default)]
    pub relief: Option<String>,
    /// Where its hue is turned and where it shines: a finish's id in the library; the same all over
    /// where absent.
    #[serde(default)]
    pub finish: Option<String>,
    /// Rotation of the hue of the cloth.
    pub hue_offset_deg: f64,
}

/// Shoes and socks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shoes {
    /// Which.
    pub kind: ShoeKind,
    /// Linear colour.
    pub color: [f64; 3],
    /// Upper end of the socks over the ankle, as a share of the lower leg; 0 for none that show.
    pub socks: f64,
    /// Linear colour of the socks.
    pub sock_color: [f64; 3],
}
