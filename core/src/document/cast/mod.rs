//! People who are listed: what lasts of a person as a value that can be named, saved and edited.
//!
//! A [`Member`] holds settled numbers, no laws. Whatever it leaves out is drawn from the config's
//! laws as it would be for the identity whose place it takes; one that leaves nothing out is the
//! same person in every config. Pose and place do not belong to it. Colours and patterns of clothes
//! are fixed where they are given and drawn anew each time otherwise. [`mod@file`] reads members
//! that lie in files of their own.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub mod file;

use super::format;
use crate::base::color::linear_rgb;
use crate::scene::{
    BeardStyle, BottomKind, Glasses, HairStyle, HeadwearKind, OuterKind, Sex, ShoeKind, TopKind,
};

/// A person who is listed. Whatever is absent is drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Member {
    /// A file that holds these values, from the config's folder or from one of `assets`. What
    /// stands beside it here comes before what stands in it. A file that holds a list stands for
    /// all people in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Letters, digits, `_` and `-`, at most 64; no two people have the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Body shape.
    #[serde(skip_serializing_if = "MemberBody::is_empty")]
    pub body: MemberBody,
    /// Skin, hair, eyes and face.
    #[serde(skip_serializing_if = "MemberLook::is_empty")]
    pub look: MemberLook,
    /// Clothes.
    #[serde(skip_serializing_if = "MemberWardrobe::is_empty")]
    pub wardrobe: MemberWardrobe,
}

impl Member {
    /// These values, and those of another member where this one has none.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            file: self.file.or(other.file),
            name: self.name.or(other.name),
            body: self.body.or(other.body),
            look: self.look.or(other.look),
            wardrobe: self.wardrobe.or(other.wardrobe),
        }
    }

    /// What it has in place of a parameter of the document, by the parameter's path; nothing for
    /// what it leaves out.
    #[must_use]
    pub fn number(&self, path: &str) -> Option<f64> {
        let MemberWardrobe { top, bottom, outer, shoes } = &self.wardrobe;
        match path.strip_prefix("people.")? {
            "body.age_years" => self.body.age_years,
            "body.stature_m" => self.body.stature_m,
            "body.bmi_kg_m2" => self.body.bmi_kg_m2,
            "body.muscle" => self.body.muscle,
            "body.proportions" => self.body.proportions,
            "body.cup" => self.body.cup,
            "body.firmness" => self.body.firmness,
            "wardrobe.top.sleeve" => top.sleeve,
            "wardrobe.top.neckline" => top.neckline,
            "wardrobe.top.looseness_m" => top.looseness_m,
            "wardrobe.top.hue_offset_deg" => top.hue_offset_deg,
            "wardrobe.bottom.flare" => bottom.flare,
            "wardrobe.bottom.looseness_m" => bottom.looseness_m,
            "wardrobe.bottom.hue_offset_deg" => bottom.hue_offset_deg,
            "wardrobe.outer.looseness_m" => outer.looseness_m,
            "wardrobe.outer.hue_offset_deg" => outer.hue_offset_deg,
            "wardrobe.shoes.socks" => shoes.socks,
            _ => None,
        }
    }
}

/// The text of a file that holds one person.
#[must_use]
pub fn text(member: &Member) -> String {
    format::pretty(&serde_json::to_string(member).expect(TEXT_KEYS))
}

/// The text of a file that holds a list of people.
#[must_use]
pub fn list_text(members: &[Member]) -> String {
    format::pretty(&serde_json::to_string(members).expect(TEXT_KEYS))
}

/// Why turning members into JSON cannot fail.
const TEXT_KEYS: &str = "members have only text keys";

/// A group of values each of which may be absent.
macro_rules! values {
    ($(#[$about:meta])* $group:ident { $($(#[$doc:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        pub struct $group {
            $(
                $(#[$doc])*
                #[serde(skip_serializing_if = "Option::is_none")]
                pub $field: Option<$type>,
            )*
        }

        impl $group {
            fn is_empty(&self) -> bool {
                *self == Self::default()
            }

            fn or(self, other: Self) -> Self {
                Self { $($field: self.$field.or(other.$field),)* }
            }
        }
    };
}

values! {
    /// Body shape. The sliders are those of the body model, 0..1 with 0.5 in the middle.
    MemberBody {
        /// Of the body model.
        sex: Sex,
        /// 1..90.
        age_years: f64,
        /// Standing height without shoes.
        stature_m: f64,
        /// Body mass over the square of the stature.
        bmi_kg_m2: f64,
        /// Slider at an average weight.
        muscle: f64,
        /// Slider: 0 idealised, 1 uncommon.
        proportions: f64,
        /// Shares of African, Asian and European forebears; they need not sum to 1.
        ancestry: [f64; 3],
        /// Slider, women only.
        cup: f64,
        /// Slider, women only.
        firmness: f64,
    }
}

values! {
    /// Skin, hair, eyes and face.
    MemberLook {
        /// Base colour of the skin.
        skin: FixedColor,
        /// Hair on the head.
        hair: HairStyle,
        /// Hair, brows and beard.
        hair_color: FixedColor,
        /// Hair on the face.
        beard: BeardStyle,
        /// On the head.
        headwear: HeadwearKind,
        /// Colour of what is on the head.
        headwear_color: FixedColor,
        /// In front of the eyes.
        glasses: Glasses,
        /// Iris.
        iris_color: FixedColor,
        /// Freckles: 0 none .. 1 all over the face.
        freckles: f64,
        /// How strongly blood shows through at cheeks, nose and ears, 0..1.
        flush: f64,
        /// All shapes that make the face somebody's own, by their names, with their amounts, 0..1.
        face: BTreeMap<String, f64>,
        /// All units of expression and gaze, by their names, with their amounts, 0..1.
        expression: BTreeMap<String, f64>,
    }
}

/// Clothes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MemberWardrobe {
    /// Upper body.
    #[serde(skip_serializing_if = "MemberTop::is_empty")]
    pub top: MemberTop,
    /// Legs, dresses among them.
    #[serde(skip_serializing_if = "MemberBottom::is_empty")]
    pub bottom: MemberBottom,
    /// Over the top.
    #[serde(skip_serializing_if = "MemberOuter::is_empty")]
    pub outer: MemberOuter,
    /// Feet.
    #[serde(skip_serializing_if = "MemberShoes::is_empty")]
    pub shoes: MemberShoes,
}

impl MemberWardrobe {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn or(self, other: Self) -> Self {
        Self {
            top: self.top.or(other.top),
            bottom: self.bottom.or(other.bottom),
            outer: self.outer.or(other.outer),
            shoes: self.shoes.or(other.shoes),
        }
    }
}

values! {
    /// Garment of the upper body.
    MemberTop {
        /// Which.
        kind: TopKind,
        /// End of the sleeve along the arm: 0 shoulder .. 1 wrist.
        sleeve: f64,
        /// How deep the neckline is cut: 0 at the neck .. 1 deep.
        neckline: f64,
        /// Gap between skin and cloth.
        looseness_m: f64,
        /// Colour of the cloth.
        color: FixedColor,
        /// Cloth pattern id; `"none"` for plain.
        pattern: String,
        /// Id of how the cloth is woven; `"none"` for folds alone.
        relief: String,
        /// Id of where its hue is turned and where it shines; `"none"` for the same all over.
        finish: String,
        /// Rotation of the hue of the cloth.
        hue_offset_deg: f64,
    }
}

values! {
    /// Garment of the legs.
    MemberBottom {
        /// Which.
        kind: BottomKind,
        /// End along the leg: 0 hip .. 1 ankle.
        length: f64,
        /// How a skirt widens downwards: 0 it hangs straight .. 1 wide.
        flare: f64,
        /// Gap between skin and cloth.
        looseness_m: f64,
        /// Colour of the cloth.
        color: FixedColor,
        /// Cloth pattern id; `"none"` for plain.
        pattern: String,
        /// Id of how the cloth is woven; `"none"` for folds alone.
        relief: String,
        /// Id of where its hue is turned and where it shines; `"none"` for the same all over.
        finish: String,
        /// Rotation of the hue of the cloth.
        hue_offset_deg: f64,
    }
}

values! {
    /// Garment over the top.
    MemberOuter {
        /// Which.
        kind: OuterKind,
        /// Whether its front stands open.
        open: bool,
        /// Gap between the cloth under it and its own.
        looseness_m: f64,
        /// Colour of the cloth.
        color: FixedColor,
        /// Cloth pattern id; `"none"` for plain.
        pattern: String,
        /// Id of how the cloth is woven; `"none"` for folds alone.
        relief: String,
        /// Id of where its hue is turned and where it shines; `"none"` for the same all over.
        finish: String,
        /// Rotation of the hue of the cloth.
        hue_offset_deg: f64,
    }
}

values! {
    /// Shoes and socks.
    MemberShoes {
        /// Which.
        kind: ShoeKind,
        /// Their colour.
        color: FixedColor,
        /// Upper end of socks over the ankle, as a share of the lower leg; 0 for none that show.
        socks: f64,
        /// Colour of the socks.
        sock_color: FixedColor,
    }
}

/// One colour. Three numbers are sRGB, 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum FixedColor {
    /// Red, green and blue in sRGB, 0..1.
    Srgb([f64; 3]),
    /// In another way.
    Other(FixedColorOther),
}

/// Another way to give one colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FixedColorOther {
    /// Linear red, green and blue, 0..1. What the program writes, as it loses nothing.
    Linear([f64; 3]),
}

impl FixedColor {
    /// From linear red, green and blue, exactly.
    #[must_use]
    pub const fn from_linear(rgb: [f64; 3]) -> Self {
        Self::Other(FixedColorOther::Linear(rgb))
    }

    /// Linear red, green and blue, 0..1.
    #[must_use]
    pub fn linear(self) -> [f64; 3] {
        match self {
            Self::Srgb(rgb) => linear_rgb(rgb.map(|v| v as f32)).map(f64::from),
            Self::Other(FixedColorOther::Linear(rgb)) => rgb,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_entry_says_comes_before_its_file() {
        let read = |text| serde_json::from_str::<Member>(text).unwrap();
        let entry = read(r#"{"body": {"age_years": 60}, "look": {"hair": "bun"}}"#);
        let saved = read(
            r#"{"name": "maria", "body": {"age_years": 34, "sex": "female"},
                "wardrobe": {"shoes": {"kind": "boots"}}}"#,
        );
        let expected = read(
            r#"{"name": "maria", "body": {"age_years": 60, "sex": "female"},
                "look": {"hair": "bun"}, "wardrobe": {"shoes": {"kind": "boots"}}}"#,
        );
        assert_eq!(entry.or(saved), expected);
    }

    #[test]
    fn only_what_is_given_is_written_and_colours_lose_nothing() {
        let rgb = [0.1 + 0.2, 1.0 / 3.0, 0.0];
        let look = MemberLook { skin: Some(FixedColor::from_linear(rgb)), ..Default::default() };
        let member = Member { name: Some("Zoë".to_owned()), look, ..Default::default() };
        let text = text(&member);
        assert!(!text.contains("body") && !text.contains("null"), "{text}");
        let back: Member = serde_json::from_str(&text).unwrap();
        assert_eq!(back, member);
        assert_eq!(back.look.skin.unwrap().linear(), rgb);
        let srgb: FixedColor = serde_json::from_str("[1, 0.5, 0]").unwrap();
        let [r, g, b] = srgb.linear();
        assert!(r == 1.0 && (g - 0.214).abs() < 1e-3 && b == 0.0, "{g}");
    }
}
