//! Clothes.

use super::background::asset;
use super::keys;
use super::people::Source;
use super::value::{color, item, number};
use crate::document::Wardrobe;
use crate::scene::{Bottom, BottomKind, Outfit, Shoes, Top};

/// The cut of the clothes lasts as long as the person does, their colours and patterns are drawn
/// anew.
pub(super) fn outfit(
    wardrobe: &Wardrobe,
    patterns: &[String],
    lasting: Source,
    here: Source,
) -> Outfit {
    let cut = |key| lasting.random_if(wardrobe.enabled).of(key);
    let dye = |key| here.random_if(wardrobe.enabled).of(key);
    let (top, bottom) = (&wardrobe.top, &wardrobe.bottom);
    let kind = *item(&bottom.kind, cut(keys::BOTTOM_KIND));
    Outfit {
        top: Top {
            sleeve: number(&top.sleeve, cut(keys::TOP_SLEEVE)),
            neckline: number(&top.neckline, cut(keys::TOP_NECKLINE)),
            looseness_m: number(&top.looseness_m, cut(keys::TOP_LOOSENESS)),
            color: color(&top.color, dye(keys::TOP_COLOR)),
            texture: asset(&top.pattern, patterns, dye(keys::TOP_PATTERN)),
            hue_offset_deg: number(&top.hue_offset_deg, dye(keys::TOP_HUE)),
        },
        bottom: Bottom {
            kind,
            length: match kind {
                BottomKind::Trousers => number(&bottom.trousers_length, cut(keys::BOTTOM_TROUSERS)),
                BottomKind::Shorts => number(&bottom.shorts_length, cut(keys::BOTTOM_SHORTS)),
            },
            looseness_m: number(&bottom.looseness_m, cut(keys::BOTTOM_LOOSENESS)),
            color: color(&bottom.color, dye(keys::BOTTOM_COLOR)),
            texture: asset(&bottom.pattern, patterns, dye(keys::BOTTOM_PATTERN)),
            hue_offset_deg: number(&bottom.hue_offset_deg, dye(keys::BOTTOM_HUE)),
        },
        shoes: Shoes { color: color(&wardrobe.shoes.color, dye(keys::SHOE_COLOR)) },
    }
}
