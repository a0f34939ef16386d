//! Who wears what together, where the document does not say: by age, sex and season.
//!
//! The shares are our own estimate of a street in a temperate city; a document brings its own
//! table in the same form where another place is wanted.

use std::sync::LazyLock;

use crate::document::{Choice, OutfitRow, Season};
use crate::scene::BottomKind::{
    DressLong, DressShort, Jeans, Leggings, Shorts, SkirtLong, SkirtShort, Trousers,
};
use crate::scene::OuterKind::{self, Coat, Jacket};
use crate::scene::ShoeKind::{self, Barefoot, Boots, Sandals, Shoes, Sneakers};
use crate::scene::TopKind::{self, Hoodie, LongSleeve, Polo, Shirt, Sweater, TShirt, TankTop};
use crate::scene::{BottomKind, Sex};

const MILD: [Season; 2] = [Season::Spring, Season::Autumn];
const WARM: [Season; 1] = [Season::Summer];
const COLD: [Season; 1] = [Season::Winter];
const CHILD: [f64; 2] = [0.0, 15.0];
const YOUNG: [f64; 2] = [15.0, 35.0];
const GROWN: [f64; 2] = [15.0, 200.0];
const OLD: [f64; 2] = [55.0, 200.0];

/// Kinds with their weights.
type Kinds<T> = &'static [(T, f64)];

/// A row in short.
struct Row {
    weight: f64,
    sex: Option<Sex>,
    age_years: [f64; 2],
    seasons: &'static [Season],
    top: Kinds<TopKind>,
    bottom: Kinds<BottomKind>,
    outer: Kinds<OuterKind>,
    shoes: Kinds<ShoeKind>,
}

const NONE: Kinds<OuterKind> = &[(OuterKind::None, 1.0)];
const SOME_JACKET: Kinds<OuterKind> = &[(OuterKind::None, 2.0), (Jacket, 1.0)];
const COATS: Kinds<OuterKind> = &[(OuterKind::None, 1.0), (Jacket, 3.0), (Coat, 2.0)];
const SPORTY: Kinds<ShoeKind> = &[(Sneakers, 3.0), (Shoes, 1.0)];
const STREET: Kinds<ShoeKind> = &[(Sneakers, 2.0), (Shoes, 2.0), (Boots, 0.5)];
const WINTER: Kinds<ShoeKind> = &[(Boots, 3.0), (Shoes, 1.5), (Sneakers, 1.0)];
const AIRY: Kinds<ShoeKind> = &[(Sneakers, 3.0), (Sandals, 2.0), (Shoes, 1.0), (Barefoot, 0.15)];

const ROWS: [Row; 19] = [
    // Children.
    row(
        3.0,
        None,
        CHILD,
        &WARM,
        &[(TShirt, 4.0), (TankTop, 1.0)],
        &[(Shorts, 3.0), (Trousers, 1.0)],
        NONE,
        AIRY,
    ),
    row(
        1.2,
        Some(Sex::Female),
        CHILD,
        &WARM,
        &[(TShirt, 1.0), (TankTop, 1.0)],
        &[(DressShort, 2.0), (SkirtShort, 1.0)],
        NONE,
        AIRY,
    ),
    row(
        3.0,
        None,
        CHILD,
        &MILD,
        &[(LongSleeve, 2.0), (TShirt, 2.0), (Hoodie, 2.0), (Sweater, 1.0)],
        &[(Trousers, 2.0), (Jeans, 2.0), (Leggings, 0.5)],
        SOME_JACKET,
        SPORTY,
    ),
    row(
        0.8,
        Some(Sex::Female),
        CHILD,
        &MILD,
        &[(LongSleeve, 2.0), (TShirt, 1.0)],
        &[(DressShort, 2.0), (SkirtShort, 1.0), (Leggings, 2.0)],
        NONE,
        SPORTY,
    ),
    row(
        3.0,
        None,
        CHILD,
        &COLD,
        &[(Sweater, 2.0), (Hoodie, 2.0), (LongSleeve, 1.0)],
        &[(Trousers, 2.0), (Jeans, 2.0)],
        COATS,
        WINTER,
    ),
    // Warm days.
    row(
        4.0,
        None,
        GROWN,
        &WARM,
        &[(TShirt, 5.0), (Polo, 1.5), (Shirt, 1.5)],
        &[(Shorts, 3.0), (Jeans, 2.0), (Trousers, 2.0)],
        NONE,
        AIRY,
    ),
    row(
        1.5,
        Some(Sex::Male),
        YOUNG,
        &WARM,
        &[(TankTop, 1.0), (TShirt, 2.0)],
        &[(Shorts, 1.0)],
        NONE,
        AIRY,
    ),
    row(
        2.0,
        Some(Sex::Female),
        GROWN,
        &WARM,
        &[(TankTop, 2.0), (TShirt, 2.0)],
        &[(SkirtShort, 1.0), (SkirtLong, 1.0), (Shorts, 2.0), (Leggings, 0.5)],
        NONE,
        AIRY,
    ),
    row(
        2.0,
        Some(Sex::Female),
        GROWN,
        &WARM,
        &[(TankTop, 2.0), (TShirt, 1.0)],
        &[(DressShort, 2.0), (DressLong, 1.0)],
        NONE,
        AIRY,
    ),
    // Mild days.
    row(
        3.0,
        None,
        GROWN,
        &MILD,
        &[(TShirt, 2.0), (LongSleeve, 2.0), (Hoodie, 2.0)],
        &[(Jeans, 3.0), (Trousers, 1.5)],
        SOME_JACKET,
        SPORTY,
    ),
    row(
        2.5,
        None,
        GROWN,
        &MILD,
        &[(Shirt, 3.0), (Sweater, 2.0), (Polo, 1.0)],
        &[(Trousers, 2.0), (Jeans, 2.0)],
        SOME_JACKET,
        STREET,
    ),
    row(
        1.2,
        None,
        YOUNG,
        &MILD,
        &[(Hoodie, 1.0), (TShirt, 1.0), (TankTop, 0.3)],
        &[(Leggings, 0.5), (Trousers, 1.0), (Shorts, 0.5)],
        NONE,
        SPORTY,
    ),
    row(
        1.0,
        Some(Sex::Female),
        GROWN,
        &MILD,
        &[(LongSleeve, 2.0), (Shirt, 1.0), (Sweater, 1.0)],
        &[(SkirtShort, 1.0), (SkirtLong, 1.5), (Leggings, 1.0)],
        SOME_JACKET,
        STREET,
    ),
    row(
        1.0,
        Some(Sex::Female),
        GROWN,
        &MILD,
        &[(LongSleeve, 2.0), (TShirt, 1.0)],
        &[(DressShort, 1.0), (DressLong, 1.0)],
        SOME_JACKET,
        STREET,
    ),
    row(
        1.0,
        None,
        OLD,
        &MILD,
        &[(Shirt, 2.0), (Sweater, 3.0), (Polo, 1.0)],
        &[(Trousers, 1.0)],
        SOME_JACKET,
        &[(Shoes, 1.0)],
    ),
    // Cold days.
    row(
        3.0,
        None,
        GROWN,
        &COLD,
        &[(Sweater, 2.0), (LongSleeve, 1.0), (Shirt, 1.0)],
        &[(Jeans, 2.0), (Trousers, 2.0)],
        COATS,
        WINTER,
    ),
    row(1.5, None, YOUNG, &COLD, &[(Hoodie, 1.0)], &[(Jeans, 2.0), (Trousers, 1.0)], COATS, WINTER),
    row(
        0.8,
        Some(Sex::Female),
        GROWN,
        &COLD,
        &[(Sweater, 1.0), (LongSleeve, 1.0)],
        &[(SkirtLong, 1.0), (DressLong, 1.0)],
        COATS,
        WINTER,
    ),
    row(
        0.6,
        None,
        OLD,
        &COLD,
        &[(Sweater, 1.0), (Shirt, 1.0)],
        &[(Trousers, 1.0)],
        &[(Coat, 2.0), (Jacket, 1.0)],
        &[(Shoes, 1.0), (Boots, 1.0)],
    ),
];

#[expect(clippy::too_many_arguments, reason = "a row of a table")]
const fn row(
    weight: f64,
    sex: Option<Sex>,
    age_years: [f64; 2],
    seasons: &'static [Season],
    top: Kinds<TopKind>,
    bottom: Kinds<BottomKind>,
    outer: Kinds<OuterKind>,
    shoes: Kinds<ShoeKind>,
) -> Row {
    Row { weight, sex, age_years, seasons, top, bottom, outer, shoes }
}

/// The built-in table.
pub(super) fn rows() -> &'static [OutfitRow] {
    static TABLE: LazyLock<Vec<OutfitRow>> = LazyLock::new(|| {
        let full = |row: &Row| OutfitRow {
            weight: row.weight,
            sex: row.sex,
            age_years: row.age_years,
            seasons: row.seasons.to_vec(),
            top: Choice::of(row.top.iter().copied()),
            bottom: Choice::of(row.bottom.iter().copied()),
            outer: Choice::of(row.outer.iter().copied()),
            shoes: Choice::of(row.shoes.iter().copied()),
        };
        ROWS.iter().map(full).collect()
    });
    &TABLE
}
