//! Clothes. What goes together comes from a table, cut and colour follow the kind of garment.

use std::sync::LazyLock;

use super::background::asset;
use super::cast::PLAIN;
use super::linked::Draw;
use super::people::{PersonTraits, Source};
use super::value::{color, flag, item, number};
use super::{Catalogue, keys, outfit_table, quantile};
use crate::base::rng::Key;
use crate::document::cast::{FixedColor, MemberWardrobe};
use crate::document::{self, Auto, Choice, Color, ColorLaw, OutfitRow, Param, Wardrobe};
use crate::scene::{Bottom, BottomKind, Outer, OuterKind, Outfit, Shoes, Top, TopKind};

/// The cut of the clothes lasts as long as the person does; their colours and patterns are drawn
/// anew. What is known stays.
pub(super) fn outfit(
    wardrobe: &Wardrobe,
    known: &MemberWardrobe,
    catalogue: &Catalogue,
    traits: PersonTraits,
    lasting: Source,
    here: Source,
) -> Outfit {
    let (lasting, here) = (lasting.random_if(wardrobe.enabled), here.random_if(wardrobe.enabled));
    let drawing = Drawing { known, catalogue, lasting, here };
    let row = drawing.row(wardrobe, traits);
    let shoes = &wardrobe.shoes;
    Outfit {
        top: drawing.top(&wardrobe.top, row),
        bottom: drawing.bottom(&wardrobe.bottom, row),
        outer: drawing.outer(&wardrobe.outer, row),
        shoes: Shoes {
            kind: drawing.kind(known.shoes.kind, &shoes.kind, &row.shoes, keys::SHOE_KIND),
            color: known
                .shoes
                .color
                .map_or_else(|| color(&shoes.color, here.of(keys::SHOE_COLOR)), FixedColor::linear),
            socks: known
                .shoes
                .socks
                .unwrap_or_else(|| number(&shoes.socks, lasting.of(keys::SOCKS))),
            sock_color: known.shoes.sock_color.map_or_else(
                || color(&shoes.sock_color, here.of(keys::SOCK_COLOR)),
                FixedColor::linear,
            ),
        },
    }
}

/// What one person's garments are drawn from.
struct Drawing<'a> {
    known: &'a MemberWardrobe,
    catalogue: &'a Catalogue,
    lasting: Source<'a>,
    here: Source<'a>,
}

impl Drawing<'_> {
    /// The row of the table that the person has dressed by.
    fn row<'a>(&self, wardrobe: &'a Wardrobe, traits: PersonTraits) -> &'a OutfitRow {
        let season = *item(&wardrobe.season, self.lasting.of(keys::SEASON));
        let rows = match &wardrobe.outfit {
            Auto::Auto(_) => outfit_table::rows(),
            Auto::Given(rows) => rows,
        };
        let fits = |row: &OutfitRow| {
            let [from, to] = row.age_years;
            (from..=to).contains(&traits.age_years)
                && row.sex.is_none_or(|sex| sex == traits.sex)
                && (row.seasons.is_empty() || row.seasons.contains(&season))
        };
        let somebody = rows.iter().any(|row| row.weight > 0.0 && fits(row));
        let weight = |row: &OutfitRow| if !somebody || fits(row) { row.weight } else { 0.0 };
        let u = self.lasting.of(keys::OUTFIT).uniform();
        &rows[quantile::index(u, rows.iter().map(weight))]
    }

    fn kind<T: Copy>(
        &self,
        known: Option<T>,
        given: &Auto<Choice<T>>,
        table: &Choice<T>,
        key: Key,
    ) -> T {
        let choice = match given {
            Auto::Auto(_) => table,
            Auto::Given(choice) => choice,
        };
        known.unwrap_or_else(|| *item(choice, self.lasting.of(key)))
    }

    fn top(&self, top: &document::Top, row: &OutfitRow) -> Top {
        let known = &self.known.top;
        let kind = self.kind(known.kind, &top.kind, &row.top, keys::TOP_KIND);
        let cut = |key| self.lasting.of(key);
        let pattern = self.here.of(keys::TOP_PATTERN);
        let [sleeve, neckline, looseness_m] = top_cut(kind);
        Top {
            kind,
            sleeve: known
                .sleeve
                .unwrap_or_else(|| given_or(&top.sleeve, &sleeve, cut(keys::TOP_SLEEVE))),
            neckline: known
                .neckline
                .unwrap_or_else(|| given_or(&top.neckline, &neckline, cut(keys::TOP_NECKLINE))),
            looseness_m: known.looseness_m.unwrap_or_else(|| {
                given_or(&top.looseness_m, &looseness_m, cut(keys::TOP_LOOSENESS))
            }),
            color: self.dye(known.color, &top.color, &CLOTH, keys::TOP_COLOR),
            texture: printed(known.pattern.as_ref(), || {
                asset(&top.pattern, &self.catalogue.cloth_patterns, pattern).or_else(|| {
                    // What is not printed is knitted.
                    let knitted: Vec<_> = self
                        .catalogue
                        .cloth_patterns
                        .iter()
                        .filter(|id| id.contains("/knit/"))
                        .collect();
                    let at = pattern.lane(2).uniform() * knitted.len() as f64;
                    let id = knitted.get(at as usize).filter(|_| kind == TopKind::Sweater);
                    id.map(|id| (*id).clone())
                })
            }),
            relief: self.relief(known.relief.as_ref(), &top.relief, keys::TOP_RELIEF),
            finish: self.finish(known.finish.as_ref(), &top.finish, keys::TOP_FINISH),
            hue_offset_deg: known
                .hue_offset_deg
                .unwrap_or_else(|| number(&top.hue_offset_deg, self.here.of(keys::TOP_HUE))),
        }
    }

    fn bottom(&self, bottom: &document::Bottom, row: &OutfitRow) -> Bottom {
        let known = &self.known.bottom;
        let kind = self.kind(known.kind, &bottom.kind, &row.bottom, keys::BOTTOM_KIND);
        let cut = |key| self.lasting.of(key);
        let skirt = |from, to| {
            given_or(&bottom.skirt_length, &Param::uniform(from, to), cut(keys::BOTTOM_SKIRT))
        };
        let length = match kind {
            BottomKind::Trousers | BottomKind::Jeans | BottomKind::Leggings => {
                number(&bottom.trousers_length, cut(keys::BOTTOM_TROUSERS))
            }
            BottomKind::Shorts => number(&bottom.shorts_length, cut(keys::BOTTOM_SHORTS)),
            BottomKind::SkirtShort | BottomKind::DressShort => skirt(0.28, 0.48),
            BottomKind::SkirtLong | BottomKind::DressLong => skirt(0.58, 0.92),
        };
        let loose = match kind {
            BottomKind::Trousers => Param::uniform(0.006, 0.016),
            BottomKind::Jeans => Param::uniform(0.004, 0.010),
            BottomKind::Leggings => Param::Constant(0.001),
            BottomKind::Shorts => Param::uniform(0.006, 0.018),
            _ => Param::uniform(0.004, 0.012),
        };
        let jeans = kind == BottomKind::Jeans;
        // Denim is denim, whatever other cloths are printed with.
        let texture = printed(known.pattern.as_ref(), || {
            if jeans {
                self.catalogue.cloth_patterns.iter().find(|id| id.contains("/denim/")).cloned()
            } else {
                asset(
                    &bottom.pattern,
                    &self.catalogue.cloth_patterns,
                    self.here.of(keys::BOTTOM_PATTERN),
                )
            }
        });
        let colors = if jeans { &DENIM } else { &CLOTH };
        Bottom {
            kind,
            length: known.length.unwrap_or(length),
            flare: known.flare.unwrap_or_else(|| number(&bottom.flare, cut(keys::BOTTOM_FLARE))),
            looseness_m: known.looseness_m.unwrap_or_else(|| {
                given_or(&bottom.looseness_m, &loose, cut(keys::BOTTOM_LOOSENESS))
            }),
            color: self.dye(known.color, &bottom.color, colors, keys::BOTTOM_COLOR),
            texture,
            // Denim is denim here, too.
            relief: self
                .relief(known.relief.as_ref(), &bottom.relief, keys::BOTTOM_RELIEF)
                .filter(|_| !jeans),
            finish: self.finish(known.finish.as_ref(), &bottom.finish, keys::BOTTOM_FINISH),
            hue_offset_deg: known
                .hue_offset_deg
                .unwrap_or_else(|| number(&bottom.hue_offset_deg, self.here.of(keys::BOTTOM_HUE))),
        }
    }

    fn outer(&self, outer: &document::Outer, row: &OutfitRow) -> Outer {
        let known = &self.known.outer;
        let kind = self.kind(known.kind, &outer.kind, &row.outer, keys::OUTER_KIND);
        let loose = match kind {
            OuterKind::Coat => Param::uniform(0.008, 0.018),
            _ => Param::uniform(0.006, 0.014),
        };
        Outer {
            kind,
            open: known
                .open
                .unwrap_or_else(|| flag(&outer.open, self.lasting.of(keys::OUTER_OPEN))),
            looseness_m: known.looseness_m.unwrap_or_else(|| {
                given_or(&outer.looseness_m, &loose, self.lasting.of(keys::OUTER_LOOSENESS))
            }),
            color: self.dye(known.color, &outer.color, &COAT, keys::OUTER_COLOR),
            texture: printed(known.pattern.as_ref(), || {
                asset(
                    &outer.pattern,
                    &self.catalogue.cloth_patterns,
                    self.here.of(keys::OUTER_PATTERN),
                )
            }),
            relief: self.relief(known.relief.as_ref(), &outer.relief, keys::OUTER_RELIEF),
            finish: self.finish(known.finish.as_ref(), &outer.finish, keys::OUTER_FINISH),
            hue_offset_deg: known
                .hue_offset_deg
                .unwrap_or_else(|| number(&outer.hue_offset_deg, self.here.of(keys::OUTER_HUE))),
        }
    }

    fn relief(&self, known: Option<&String>, given: &Choice<String>, key: Key) -> Option<String> {
        printed(known, || asset(given, &self.catalogue.cloth_reliefs, self.here.of(key)))
    }

    fn finish(&self, known: Option<&String>, given: &Choice<String>, key: Key) -> Option<String> {
        printed(known, || asset(given, &self.catalogue.cloth_finishes, self.here.of(key)))
    }

    fn dye(
        &self,
        known: Option<FixedColor>,
        given: &Auto<Color>,
        otherwise: &Color,
        key: Key,
    ) -> [f64; 3] {
        let law = match given {
            Auto::Auto(_) => otherwise,
            Auto::Given(law) => law,
        };
        known.map_or_else(|| color(law, self.here.of(key)), FixedColor::linear)
    }
}

/// The pattern, relief or finish of a cloth, if any: the known one, or else one that is drawn.
fn printed(known: Option<&String>, drawn: impl FnOnce() -> Option<String>) -> Option<String> {
    known.map_or_else(drawn, |id| Some(id.clone()).filter(|id| id != PLAIN))
}

fn given_or(given: &Auto<Param>, otherwise: &Param, draw: Draw) -> f64 {
    match given {
        Auto::Auto(_) => number(otherwise, draw),
        Auto::Given(param) => number(param, draw),
    }
}

/// Sleeve, neckline and looseness (metres) of a kind of top.
fn top_cut(kind: TopKind) -> [Param; 3] {
    let range = Param::uniform;
    match kind {
        TopKind::TShirt => [range(0.22, 0.42), range(0.05, 0.5), range(0.005, 0.016)],
        TopKind::LongSleeve => [range(0.92, 1.0), range(0.05, 0.5), range(0.003, 0.011)],
        TopKind::Shirt => {
            let sleeve = Param::mix([
                (0.65, range(0.94, 1.0)),
                (0.15, range(0.5, 0.62)),
                (0.2, range(0.26, 0.4)),
            ]);
            [sleeve, Param::Constant(0.0), range(0.006, 0.014)]
        }
        TopKind::Polo => [range(0.25, 0.38), Param::Constant(0.0), range(0.005, 0.012)],
        TopKind::TankTop => [Param::Constant(0.0), range(0.45, 0.9), range(0.002, 0.009)],
        TopKind::Hoodie => [range(0.95, 1.0), range(0.05, 0.15), range(0.012, 0.024)],
        TopKind::Sweater => [range(0.94, 1.0), range(0.0, 0.4), range(0.009, 0.02)],
    }
}

/// Hue in degrees, saturation and value, each evenly between two numbers, with a weight.
type HsvRange = (f64, [f64; 2], [f64; 2], [f64; 2]);

fn hsv_mix(parts: &[HsvRange]) -> Color {
    let range = |r: [f64; 2]| Param::uniform(r[0], r[1]);
    let part = |&(weight, h, s, v): &HsvRange| {
        (weight, Color::Other(ColorLaw::Hsv([range(h), range(s), range(v)])))
    };
    Color::Other(ColorLaw::Mix(parts.iter().map(part).collect()))
}

/// Mostly darks and neutrals, navy, muted tones and the odd strong colour.
static CLOTH: LazyLock<Color> = LazyLock::new(|| {
    hsv_mix(&[
        (0.22, [0.0, 360.0], [0.0, 0.25], [0.06, 0.25]),
        (0.18, [20.0, 60.0], [0.0, 0.15], [0.35, 0.92]),
        (0.16, [208.0, 228.0], [0.35, 0.7], [0.2, 0.5]),
        (0.14, [20.0, 50.0], [0.2, 0.5], [0.25, 0.7]),
        (0.22, [0.0, 360.0], [0.2, 0.55], [0.35, 0.8]),
        (0.08, [0.0, 360.0], [0.6, 0.85], [0.5, 0.85]),
    ])
});

/// Indigo from raw to washed out, black and grey.
static DENIM: LazyLock<Color> = LazyLock::new(|| {
    hsv_mix(&[
        (0.45, [212.0, 222.0], [0.5, 0.68], [0.28, 0.45]),
        (0.3, [210.0, 218.0], [0.3, 0.5], [0.5, 0.7]),
        (0.18, [210.0, 230.0], [0.02, 0.15], [0.08, 0.18]),
        (0.07, [210.0, 230.0], [0.02, 0.1], [0.4, 0.6]),
    ])
});

/// Black, navy, grey, camel and olive, rarely more.
static COAT: LazyLock<Color> = LazyLock::new(|| {
    hsv_mix(&[
        (0.35, [200.0, 240.0], [0.0, 0.2], [0.06, 0.2]),
        (0.2, [212.0, 228.0], [0.35, 0.6], [0.15, 0.35]),
        (0.15, [20.0, 60.0], [0.0, 0.1], [0.3, 0.6]),
        (0.15, [28.0, 38.0], [0.35, 0.55], [0.4, 0.7]),
        (0.1, [60.0, 110.0], [0.2, 0.4], [0.2, 0.4]),
        (0.05, [0.0, 360.0], [0.5, 0.8], [0.35, 0.75]),
    ])
});
