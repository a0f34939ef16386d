//! Clothes.

use super::background::asset;
use super::keys;
use super::value::{color, item, number};
use crate::base::rng::Draws;
use crate::document::Wardrobe;
use crate::scene::{Bottom, BottomKind, Outfit, Shoes, Top};

pub(super) fn outfit(wardrobe: &Wardrobe, patterns: &[String], draws: Draws, slot: u32) -> Outfit {
    let of = |key| draws.random_if(wardrobe.enabled).of(key, slot);
    let (top, bottom) = (&wardrobe.top, &wardrobe.bottom);
    let kind = *item(&bottom.kind, of(keys::BOTTOM_KIND));
    Outfit {
        top: Top {
            sleeve: number(&top.sleeve, of(keys::TOP_SLEEVE)),
            neckline: number(&top.neckline, of(keys::TOP_NECKLINE)),
            looseness_m: number(&top.looseness_m, of(keys::TOP_LOOSENESS)),
            color: color(&top.color, of(keys::TOP_COLOR)),
            texture: asset(&top.pattern, patterns, of(keys::TOP_PATTERN)),
            hue_offset_deg: number(&top.hue_offset_deg, of(keys::TOP_HUE)),
        },
        bottom: Bottom {
            kind,
            length: match kind {
                BottomKind::Trousers => number(&bottom.trousers_length, of(keys::BOTTOM_TROUSERS)),
                BottomKind::Shorts => number(&bottom.shorts_length, of(keys::BOTTOM_SHORTS)),
            },
            looseness_m: number(&bottom.looseness_m, of(keys::BOTTOM_LOOSENESS)),
            color: color(&bottom.color, of(keys::BOTTOM_COLOR)),
            texture: asset(&bottom.pattern, patterns, of(keys::BOTTOM_PATTERN)),
            hue_offset_deg: number(&bottom.hue_offset_deg, of(keys::BOTTOM_HUE)),
        },
        shoes: Shoes { color: color(&wardrobe.shoes.color, of(keys::SHOE_COLOR)) },
    }
}
