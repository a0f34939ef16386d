//! Clothes: who wears what, and how it is cut and coloured.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Auto, Choice, Color, ColorLaw, Flag, Param};
use crate::scene::{BottomKind, OuterKind, Sex, ShoeKind, TopKind};

/// Clothes. What goes together is drawn from a table by age, sex and season; kinds that are given
/// for single garments take the place of the table's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Wardrobe {
    /// Where false, every parameter takes its median.
    pub enabled: bool,
    /// For which season people have dressed.
    pub season: Choice<Season>,
    /// Who wears what together; `"auto"` for the built-in table.
    pub outfit: Auto<Vec<OutfitRow>>,
    /// Upper body.
    pub top: Top,
    /// Legs, dresses among them.
    pub bottom: Bottom,
    /// Over the top.
    pub outer: Outer,
    /// Feet.
    pub shoes: Shoes,
}

impl Default for Wardrobe {
    fn default() -> Self {
        let seasons = [Season::Spring, Season::Summer, Season::Autumn, Season::Winter];
        Self {
            enabled: true,
            season: Choice::of(seasons.map(|s| (s, 1.0))),
            outfit: Auto::default(),
            top: Top::default(),
            bottom: Bottom::default(),
            outer: Outer::default(),
            shoes: Shoes::default(),
        }
    }
}

/// Quarter of the year in a temperate climate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Season {
    /// Mild.
    Spring,
    /// Warm.
    Summer,
    /// Cool.
    Autumn,
    /// Cold.
    Winter,
}

/// One way to dress, and for whom. Where no row fits a person, all rows are open to them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutfitRow {
    /// How often, against the other rows that fit a person.
    #[serde(default = "one")]
    pub weight: f64,
    /// For whom; everybody where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sex: Option<Sex>,
    /// From this age to that, years.
    #[serde(default = "all_ages")]
    pub age_years: [f64; 2],
    /// When; always where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seasons: Vec<Season>,
    /// Upper body.
    pub top: Choice<TopKind>,
    /// Legs.
    pub bottom: Choice<BottomKind>,
    /// Over the top.
    #[serde(default = "no_outer")]
    pub outer: Choice<OuterKind>,
    /// Feet.
    #[serde(default = "plain_shoes")]
    pub shoes: Choice<ShoeKind>,
}

const fn one() -> f64 {
    1.0
}

const fn all_ages() -> [f64; 2] {
    [0.0, 200.0]
}

const fn no_outer() -> Choice<OuterKind> {
    Choice::Always(OuterKind::None)
}

const fn plain_shoes() -> Choice<ShoeKind> {
    Choice::Always(ShoeKind::Shoes)
}

/// Garment of the upper body. `"auto"` follows its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Top {
    /// Which; `"auto"` as the outfit says.
    pub kind: Auto<Choice<TopKind>>,
    /// End of the sleeve along the arm: 0 shoulder .. 1 wrist.
    pub sleeve: Auto<Param>,
    /// How deep the neckline is cut: 0 at the neck .. 1 deep.
    pub neckline: Auto<Param>,
    /// Gap between skin and cloth.
    pub looseness_m: Auto<Param>,
    /// Colour of the cloth.
    pub color: Auto<Color>,
    /// Cloth pattern id; `"any"` for one of all, `"none"` for plain.
    pub pattern: Choice<String>,
    /// How the cloth is woven: a relief's id; `"any"` for one of all, `"none"` for folds alone. Knitwear
    /// and leather have one of their own.
    pub relief: Choice<String>,
    /// Where its hue is turned and where it shines: a finish's id; `"any"` for one of all, `"none"` for
    /// the same all over.
    pub finish: Choice<String>,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
}

impl Default for Top {
    fn default() -> Self {
        Self {
            kind: Auto::default(),
            sleeve: Auto::default(),
            neckline: Auto::default(),
            looseness_m: Auto::default(),
            color: Auto::default(),
            pattern: some_pattern(0.35),
            relief: some_pattern(0.6),
            finish: some_pattern(0.4),
            hue_offset_deg: Param::uniform(0.0, 360.0),
        }
    }
}

/// Garment of the legs. `"auto"` follows its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Bottom {
    /// Which; `"auto"` as the outfit says.
    pub kind: Auto<Choice<BottomKind>>,
    /// End of trousers along the leg: 0 hip .. 1 ankle.
    pub trousers_length: Param,
    /// End of shorts along the leg.
    pub shorts_length: Param,
    /// End of skirts and dresses along the leg.
    pub skirt_length: Auto<Param>,
    /// How skirts and dresses widen downwards: 0 they hang straight .. 1 wide.
    pub flare: Param,
    /// Gap between skin and cloth.
    pub looseness_m: Auto<Param>,
    /// Colour of the cloth.
    pub color: Auto<Color>,
    /// Cloth pattern id; `"any"` for one of all, `"none"` for plain.
    pub pattern: Choice<String>,
    /// How the cloth is woven: a relief's id; `"any"` for one of all, `"none"` for folds alone. Knitwear
    /// and leather have one of their own.
    pub relief: Choice<String>,
    /// Where its hue is turned and where it shines: a finish's id; `"any"` for one of all, `"none"` for
    /// the same all over.
    pub finish: Choice<String>,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
}

impl Default for Bottom {
    fn default() -> Self {
        Self {
            kind: Auto::default(),
            trousers_length: Param::uniform(0.92, 1.0),
            shorts_length: Param::uniform(0.28, 0.52),
            skirt_length: Auto::default(),
            flare: Param::uniform(0.05, 0.8),
            looseness_m: Auto::default(),
            color: Auto::default(),
            pattern: some_pattern(0.15),
            relief: some_pattern(0.6),
            finish: some_pattern(0.4),
            hue_offset_deg: Param::uniform(0.0, 360.0),
        }
    }
}

/// Garment over the top. `"auto"` follows its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Outer {
    /// Which; `"auto"` as the outfit says.
    pub kind: Auto<Choice<OuterKind>>,
    /// Whether its front stands open.
    pub open: Flag,
    /// Gap between the cloth under it and its own.
    pub looseness_m: Auto<Param>,
    /// Colour of the cloth.
    pub color: Auto<Color>,
    /// Cloth pattern id; `"any"` for one of all, `"none"` for plain.
    pub pattern: Choice<String>,
    /// How the cloth is woven: a relief's id; `"any"` for one of all, `"none"` for folds alone. Knitwear
    /// and leather have one of their own.
    pub relief: Choice<String>,
    /// Where its hue is turned and where it shines: a finish's id; `"any"` for one of all, `"none"` for
    /// the same all over.
    pub finish: Choice<String>,
    /// Rotation of the hue.
    pub hue_offset_deg: Param,
}

impl Default for Outer {
    fn default() -> Self {
        Self {
            kind: Auto::default(),
            open: Flag::with_probability(0.4),
            looseness_m: Auto::default(),
            color: Auto::default(),
            pattern: some_pattern(0.15),
            relief: some_pattern(0.6),
            finish: some_pattern(0.4),
            hue_offset_deg: Param::default(),
        }
    }
}

/// Shoes and socks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Shoes {
    /// Which; `"auto"` as the outfit says.
    pub kind: Auto<Choice<ShoeKind>>,
    /// Colour.
    pub color: Color,
    /// Upper end of socks over the ankle, as a share of the lower leg; 0 for none that show.
    pub socks: Param,
    /// Colour of the socks.
    pub sock_color: Color,
}

impl Default for Shoes {
    fn default() -> Self {
        let colors = vec![
            ([0.04, 0.04, 0.04], 3.0),
            ([0.12, 0.12, 0.11], 2.0),
            ([0.35, 0.34, 0.33], 1.0),
            ([0.75, 0.74, 0.71], 1.0),
            ([0.92, 0.9, 0.87], 2.0),
            ([0.33, 0.21, 0.13], 1.5),
            ([0.12, 0.18, 0.36], 1.0),
            ([0.6, 0.12, 0.12], 0.5),
        ];
        let socks = vec![
            ([0.9, 0.89, 0.87], 3.0),
            ([0.5, 0.5, 0.5], 1.0),
            ([0.06, 0.06, 0.07], 2.0),
            ([0.13, 0.16, 0.3], 0.5),
            ([0.55, 0.16, 0.16], 0.3),
        ];
        Self {
            kind: Auto::default(),
            color: Color::Other(ColorLaw::Palette(colors)),
            socks: Param::mix([
                (0.25, Param::Constant(0.0)),
                (0.45, Param::uniform(0.08, 0.2)),
                (0.3, Param::uniform(0.25, 0.6)),
            ]),
            sock_color: Color::Other(ColorLaw::Palette(socks)),
        }
    }
}

fn some_pattern(share: f64) -> Choice<String> {
    Choice::of([("none".to_owned(), 1.0 - share), ("any".to_owned(), share)])
}
