//! Skin, hair, eyes and faces. Where the document says `"auto"` they follow ancestry, age and sex.

use std::collections::{BTreeMap, BTreeSet};

use super::expression::face_units;
use super::keys;
use super::linked::Draw;
use super::people::{PersonTraits, Source};
use super::quantile;
use super::style;
use super::value::{color, flag, item, linear, number};
use crate::base::rng::Stream;
use crate::document::cast::{FixedColor, MemberLook};
use crate::document::{self, Auto, Choice};
use crate::scene::{Headwear, Look};

/// Skin from light to dark, sRGB. Ancestry sets the place on this row.
const SKIN_SRGB: [[f64; 3]; 6] = [
    [0.93, 0.77, 0.68],
    [0.87, 0.69, 0.58],
    [0.80, 0.62, 0.50],
    [0.68, 0.48, 0.36],
    [0.50, 0.34, 0.25],
    [0.36, 0.23, 0.17],
];
/// The middle of each ancestry on that row.
const SKIN_PLACE: [f64; 3] = [4.5, 1.6, 0.7];
const SKIN_PLACE_STD: f64 = 0.4;

/// Hair of mostly European people: black, dark brown, brown, fair, red; sRGB with weights.
const HAIR_EUROPEAN: [([f64; 3], f64); 5] = [
    ([0.06, 0.05, 0.05], 0.12),
    ([0.14, 0.09, 0.06], 0.32),
    ([0.26, 0.16, 0.09], 0.32),
    ([0.52, 0.38, 0.20], 0.18),
    ([0.40, 0.17, 0.07], 0.06),
];
/// Everybody else's.
const HAIR_OTHERS: [([f64; 3], f64); 2] = [([0.05, 0.04, 0.04], 0.7), ([0.12, 0.08, 0.05], 0.3)];
const HAIR_GREY: [f64; 3] = [0.62, 0.61, 0.59];
/// Age at which hair begins to turn grey, and how long it takes.
const GREYING_YEARS: (f64, f64, f64) = (46.0, 8.0, 22.0);

/// From this age on hair is dyed.
const DYED_FROM_YEARS: f64 = 14.0;
/// Dyes: pink, magenta, red, orange, green, turquoise, blue, violet; sRGB.
const DYES_SRGB: [[f64; 3]; 8] = [
    [0.90, 0.45, 0.62],
    [0.72, 0.14, 0.48],
    [0.74, 0.08, 0.10],
    [0.88, 0.40, 0.10],
    [0.24, 0.56, 0.22],
    [0.16, 0.60, 0.62],
    [0.14, 0.30, 0.72],
    [0.45, 0.24, 0.66],
];

/// Hats, caps and scarves: dark, grey, navy, beige, brown, red, green, white; sRGB with weights.
const HEADWEAR_SRGB: [([f64; 3], f64); 8] = [
    ([0.07, 0.07, 0.08], 0.24),
    ([0.38, 0.38, 0.39], 0.12),
    ([0.11, 0.15, 0.28], 0.16),
    ([0.70, 0.62, 0.50], 0.12),
    ([0.34, 0.24, 0.17], 0.10),
    ([0.55, 0.12, 0.13], 0.09),
    ([0.22, 0.32, 0.22], 0.07),
    ([0.84, 0.83, 0.80], 0.10),
];

/// Irises of mostly European people: brown, hazel, green, blue, grey; sRGB with weights.
const IRIS_EUROPEAN: [([f64; 3], f64); 5] = [
    ([0.30, 0.18, 0.09], 0.40),
    ([0.42, 0.31, 0.15], 0.15),
    ([0.34, 0.42, 0.25], 0.10),
    ([0.32, 0.47, 0.62], 0.28),
    ([0.45, 0.50, 0.53], 0.07),
];
/// Everybody else's.
const IRIS_OTHERS: [([f64; 3], f64); 2] = [([0.18, 0.10, 0.06], 0.6), ([0.28, 0.17, 0.09], 0.4)];

/// What faces differ by most. A face has one of each, of those whose names begin like this, before
/// it has any other: breadth and outline of the head; length, breadth and depth of the nose; breadth,
/// height and depth of the mouth; chin; distance and height of the eyes; cheeks. They are the main
/// measures of Farkas, "Anthropometry of the Head and Face" (2nd ed., 1994).
const MAIN: [&[&str]; 12] = [
    &["head-scale-horiz"],
    &[
        "head-oval",
        "head-round",
        "head-rectangular",
        "head-square",
        "head-diamond",
        "head-triangular",
        "head-fat",
    ],
    &["nose-scale-vert"],
    &["nose-scale-horiz", "nose-width3"],
    &["nose-scale-depth"],
    &["mouth-scale-horiz"],
    &["l-eye-trans-in", "l-eye-trans-out"],
    &["mouth-trans-up", "mouth-trans-down"],
    &["chin-bones", "chin-width", "chin-height"],
    &["mouth-trans-forward", "mouth-trans-backward", "chin-prognathism"],
    &["l-eye-trans-up", "l-eye-trans-down", "forehead-trans"],
    &["l-cheek"],
];

/// These face targets change so much that they get a smaller standard deviation.
const STRONG: [&str; 10] = [
    "pointed",
    "triangle",
    "head-age",
    "head-trans",
    "neck-trans",
    "nubian",
    "head-scale-vert",
    "neck-scale-vert",
    "invertedtriangular",
    "asym",
];
const STRONG_STD: f64 = 0.12;

/// Face targets that are one shape.
#[derive(Clone, Debug)]
pub(super) struct FaceShape {
    /// A single one, or those of the left and the right side.
    names: Vec<String>,
    /// Bit k: it belongs to the k-th group of [`MAIN`].
    main: u16,
    /// It changes as much as those of [`STRONG`].
    strong: bool,
}

impl FaceShape {
    fn new(names: Vec<String>) -> Self {
        let is_of = |group: &[&str]| group.iter().any(|start| names[0].starts_with(start));
        let bits = MAIN.iter().enumerate().map(|(k, group)| u16::from(is_of(group)) << k);
        let main = bits.fold(0, |all, bit| all | bit);
        let strong = names.iter().any(|name| STRONG.iter().any(|s| name.contains(s)));
        Self { names, main, strong }
    }
}

pub(super) fn face_shapes(targets: &[String]) -> Vec<FaceShape> {
    let known: BTreeSet<&str> = targets.iter().map(String::as_str).collect();
    // `folder/l-name` and `folder/r-name`.
    let other_side = |name: &str, from: &str, to: &str| {
        let file = name.rfind('/').map_or(0, |slash| slash + 1);
        let stem = name[file..].strip_prefix(from)?;
        known.get(format!("{}{to}{stem}", &name[..file]).as_str()).copied()
    };
    let mut shapes = Vec::new();
    for name in targets {
        if other_side(name, "r-", "l-").is_none() {
            let sides = std::iter::once(name.as_str()).chain(other_side(name, "l-", "r-"));
            shapes.push(FaceShape::new(sides.map(str::to_owned).collect()));
        }
    }
    shapes
}

/// What is known of a person stays, the rest is drawn.
pub(super) fn look(
    look: &document::Look,
    known: &MemberLook,
    faces: &[FaceShape],
    traits: PersonTraits,
    source: Source,
) -> Look {
    let of = |key| source.random_if(look.enabled).of(key);
    let given = |known: Option<FixedColor>,
                 auto: &Auto<document::Color>,
                 key,
                 otherwise: &dyn Fn(Draw) -> [f64; 3]| match (known, auto) {
        (Some(known), _) => known.linear(),
        (None, Auto::Auto(_)) => otherwise(of(key)),
        (None, Auto::Given(law)) => color(law, of(key)),
    };
    let greying = of(keys::GREYING);
    let dyed = traits.age_years >= DYED_FROM_YEARS && flag(&look.dyed, of(keys::DYED));
    let skin_color = given(known.skin, &look.skin, keys::SKIN, &|draw| skin(traits, draw));
    let hair_color = given(known.hair_color, &look.hair_color, keys::HAIR_COLOR, &|draw| {
        if dyed { dye(of(keys::DYE)) } else { hair_color(traits, draw, greying) }
    });
    Look {
        skin_color,
        hair: chosen(known.hair, &look.hair, of(keys::HAIR), &|draw| style::hair(traits, draw)),
        hair_color,
        beard: chosen(known.beard, &look.beard, of(keys::BEARD), &|draw| {
            style::beard(traits, draw)
        }),
        headwear: Headwear {
            kind: chosen(known.headwear, &look.headwear, of(keys::HEADWEAR), &|draw| {
                style::headwear(traits, draw)
            }),
            color: given(
                known.headwear_color,
                &look.headwear_color,
                keys::HEADWEAR_COLOR,
                &|draw| felt(draw),
            ),
        },
        glasses: chosen(known.glasses, &look.glasses, of(keys::GLASSES), &|draw| {
            style::glasses(traits, draw)
        }),
        iris_color: given(known.iris_color, &look.iris_color, keys::IRIS, &|draw| {
            iris(traits, draw)
        }),
        freckles: known.freckles.unwrap_or_else(|| {
            freckles(skin_color, hair_color, traits.age_years, of(keys::FRECKLES))
        }),
        flush: known.flush.unwrap_or_else(|| flush(traits.age_years, of(keys::FLUSH))),
        face: face(look, known, faces, source),
    }
}

/// What is known, what is given, or what follows from the person.
fn chosen<T: Copy>(
    known: Option<T>,
    given: &Auto<Choice<T>>,
    draw: Draw,
    otherwise: &dyn Fn(Draw) -> T,
) -> T {
    match (known, given) {
        (Some(known), _) => known,
        (None, Auto::Auto(_)) => otherwise(draw),
        (None, Auto::Given(choice)) => *item(choice, draw),
    }
}

/// A colour on the row of skins, a little lighter or darker than it.
fn skin(traits: PersonTraits, draw: Draw) -> [f64; 3] {
    let middle: f64 =
        traits.ancestry.iter().zip(SKIN_PLACE).map(|(share, place)| share * place).sum();
    let last = SKIN_SRGB.len() - 1;
    let place = middle + SKIN_PLACE_STD * quantile::normal(draw.uniform());
    let place = place.clamp(0.0, last as f64);
    let (i, t) = (place as usize, place.fract());
    let next = SKIN_SRGB[(i + 1).min(last)];
    let lighter = 1.0 + 0.02 * quantile::normal(draw.lane(1).uniform()).clamp(-2.5, 2.5);
    let channel = |c: usize| (SKIN_SRGB[i][c] + t * (next[c] - SKIN_SRGB[i][c])) * lighter;
    linear([channel(0), channel(1), channel(2)].map(|v| v.clamp(0.02, 0.98)))
}

/// Whether a trait of mostly European people shows: rarely where the share is small.
fn european(traits: PersonTraits, draw: Draw) -> bool {
    let share = traits.ancestry[2];
    draw.lane(1).uniform() < share * share
}

fn pick(colors: &[([f64; 3], f64)], draw: Draw) -> [f64; 3] {
    let chosen = colors[quantile::index(draw.uniform(), colors.iter().map(|c| c.1))].0;
    let lighter = 0.85 + 0.3 * draw.lane(2).uniform();
    chosen.map(|v| (v * lighter).min(1.0))
}

fn hair_color(traits: PersonTraits, draw: Draw, greying: Draw) -> [f64; 3] {
    let young =
        if european(traits, draw) { pick(&HAIR_EUROPEAN, draw) } else { pick(&HAIR_OTHERS, draw) };
    let (mean, std, years) = GREYING_YEARS;
    let begins = mean + std * quantile::normal(greying.uniform());
    let grey = ((traits.age_years - begins) / years).clamp(0.0, 1.0);
    linear([0, 1, 2].map(|i| young[i] + grey * (HAIR_GREY[i] - young[i])))
}

fn iris(traits: PersonTraits, draw: Draw) -> [f64; 3] {
    let colors: &[_] = if european(traits, draw) { &IRIS_EUROPEAN } else { &IRIS_OTHERS };
    linear(pick(colors, draw))
}

/// Freckles of light skin: most often with red hair, with which they share a gene (Bastiaens and
/// others, "The melanocortin-1-receptor gene is the major freckle gene", Human Molecular Genetics
/// 10, 2001), rarely with dark hair, and none before school age. The shares are estimates.
fn freckles(skin: [f64; 3], hair: [f64; 3], age_years: f64, draw: Draw) -> f64 {
    let light = ((skin[1] - 0.25) / 0.2).clamp(0.0, 1.0);
    // Red hair is much redder than green, and not dark; fair hair is light.
    let red = ((hair[0] / hair[1].max(1e-3) - 3.0) / 2.0).clamp(0.0, 1.0)
        * (hair[0] / 0.08).clamp(0.0, 1.0);
    let fair = (hair[1] / 0.1).clamp(0.0, 1.0) * (1.0 - red);
    let young = ((age_years - 4.0) / 4.0).clamp(0.0, 1.0)
        * (1.0 - (age_years - 40.0) / 60.0).clamp(0.3, 1.0);
    let chance = light * young * (0.07 + 0.60 * red + 0.13 * fair);
    let u = draw.uniform();
    // The rarer half of them has many.
    if u < chance { 0.25 + 0.75 * (1.0 - u / chance) } else { 0.0 }
}

/// How strongly blood shows through; more so in children and old people.
fn flush(age_years: f64, draw: Draw) -> f64 {
    let more = 0.15 * ((18.0 - age_years) / 10.0).clamp(0.0, 1.0)
        + 0.15 * ((age_years - 50.0) / 25.0).clamp(0.0, 1.0);
    let spread = 0.22 * quantile::normal(draw.uniform()).clamp(-2.0, 2.0);
    (0.42 + more + spread).clamp(0.0, 1.0)
}

/// A strong colour that no hair has by itself.
fn dye(draw: Draw) -> [f64; 3] {
    linear(DYES_SRGB[quantile::index(draw.uniform(), DYES_SRGB.iter().map(|_| 1.0))])
}

/// Colour of a hat.
fn felt(draw: Draw) -> [f64; 3] {
    linear(pick(&HEADWEAR_SRGB, draw))
}

/// The shape and the expression of a face, by name.
fn face(
    look: &document::Look,
    known: &MemberLook,
    shapes: &[FaceShape],
    source: Source,
) -> Vec<(String, f64)> {
    let listed = |amounts: &BTreeMap<String, f64>| -> Vec<(String, f64)> {
        amounts.iter().map(|(name, amount)| (name.clone(), *amount)).collect()
    };
    let mut face = match &known.face {
        Some(amounts) => listed(amounts),
        None if look.enabled => face_shape(look, shapes, source),
        None => Vec::new(),
    };
    face.extend(match &known.expression {
        Some(amounts) => listed(amounts),
        None if look.enabled => face_units(&look.expression, source),
        None => Vec::new(),
    });
    face.sort_by(|a, b| a.0.cmp(&b.0));
    face
}

/// Some shapes, the main ones first, each with the absolute value of a normal.
fn face_shape(look: &document::Look, shapes: &[FaceShape], source: Source) -> Vec<(String, f64)> {
    let wanted = number(&look.face_targets, source.of(keys::FACE_COUNT)).round() as usize;
    let mut order: Stream = source.of(keys::FACE_ORDER).stream();
    let mut rest: Vec<usize> = (0..shapes.len()).collect();
    let mut chosen = Vec::new();
    for group in 0..MAIN.len().min(wanted) {
        let is_of = |shape: usize| shapes[shape].main >> group & 1 == 1;
        let of: Vec<usize> = (0..rest.len()).filter(|i| is_of(rest[*i])).collect();
        if !of.is_empty() {
            chosen.push(rest.swap_remove(of[order.below(of.len())]));
        }
    }
    while chosen.len() < wanted.min(shapes.len()) {
        chosen.push(rest.swap_remove(order.below(rest.len())));
    }
    let mut face = Vec::new();
    for shape in chosen {
        // By the shape's own number: which others were chosen changes nothing.
        let u = source.of(keys::FACE_AMOUNT).lane(shape as u16).uniform();
        let shape = &shapes[shape];
        let std = if shape.strong { look.face_std.min(STRONG_STD) } else { look.face_std };
        let amount = (std * quantile::normal(u)).abs().min(look.face_max);
        face.extend(shape.names.iter().map(|name| (name.clone(), amount)));
    }
    face
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Key;
    use crate::sampling::linked::Draws;
    use crate::scene::Sex;

    fn traits(sex: Sex, age_years: f64, ancestry: [f64; 3]) -> PersonTraits {
        PersonTraits { sex, age_years, ancestry }
    }

    fn draws() -> impl Iterator<Item = Draw<'static>> {
        (0..5000).map(|i| Draws::new(8, i).of(Key::new("test"), 0))
    }

    fn mean(values: impl Iterator<Item = f64>) -> f64 {
        values.sum::<f64>() / 5000.0
    }

    #[test]
    fn skin_darkens_along_the_row() {
        let of = |ancestry| mean(draws().map(|d| skin(traits(Sex::Male, 30.0, ancestry), d)[1]));
        let (african, asian, european) =
            (of([1.0, 0.0, 0.0]), of([0.0, 1.0, 0.0]), of([0.0, 0.0, 1.0]));
        assert!(african < 0.5 * asian && asian < european, "{african} {asian} {european}");
        for d in draws() {
            let [r, g, b] = skin(traits(Sex::Male, 30.0, [0.3, 0.3, 0.4]), d);
            assert!(0.0 < b && b < g && g < r && r < 1.0, "{r} {g} {b}");
        }
    }

    #[test]
    fn hair_turns_grey_with_age() {
        let of =
            |age| {
                mean(draws().map(|d| {
                    hair_color(traits(Sex::Female, age, [0.0, 1.0, 0.0]), d, d.lane(9))[0]
                }))
            };
        assert!(of(20.0) < 0.02 && of(55.0) > 2.0 * of(20.0) && of(85.0) > 0.3);
    }

    #[test]
    fn dyed_hair_is_brighter_than_natural_hair() {
        let strength = |c: [f64; 3]| {
            c.into_iter().fold(f64::MIN, f64::max) - c.into_iter().fold(f64::MAX, f64::min)
        };
        let anyone = traits(Sex::Female, 30.0, [0.3, 0.3, 0.4]);
        let natural = mean(draws().map(|d| strength(hair_color(anyone, d, d.lane(9)))));
        assert!(natural < 0.05, "{natural}");
        assert!(draws().all(|d| strength(dye(d)) > 4.0 * natural));
    }

    #[test]
    fn freckles_come_with_light_skin_and_red_hair() {
        let share = |skin: [f64; 3], hair: [f64; 3], age| {
            mean(draws().map(|d| f64::from(u8::from(freckles(skin, hair, age, d) > 0.0))))
        };
        let (light, dark) = (linear(SKIN_SRGB[0]), linear(SKIN_SRGB[5]));
        let [black, _, brown, fair, red] = HAIR_EUROPEAN.map(|h| linear(h.0));
        assert!(share(light, red, 25.0) > 0.5);
        assert!((0.1..0.3).contains(&share(light, fair, 25.0)));
        assert!(share(light, brown, 25.0) < 0.2 && share(light, black, 25.0) < 0.1);
        assert_eq!(share(dark, red, 25.0), 0.0);
        assert_eq!(share(light, red, 3.0), 0.0);
    }

    #[test]
    fn every_face_has_one_of_each_main_shape() {
        let figure = crate::library::figure::Figure::built_in().unwrap();
        let names: Vec<String> = figure.face_shape_names().map(str::to_owned).collect();
        let shapes = face_shapes(&names);
        let law = document::Look { face_targets: 15.0.into(), ..Default::default() };
        for frame in 0..30 {
            let face = face_shape(&law, &shapes, Source::new(Draws::new(1, frame), 0));
            for group in MAIN {
                let is_of = |name: &str| group.iter().any(|start| name.starts_with(start));
                assert!(face.iter().any(|(name, _)| is_of(name)), "{group:?} {face:?}");
            }
            let sides = face.iter().filter(|(name, _)| name.starts_with("r-")).count();
            assert_eq!(face.len() - sides, 15);
        }
    }

    #[test]
    fn left_and_right_get_the_same_amount() {
        let names =
            ["ears/l-ear-up", "ears/r-ear-up", "head-oval", "l-eye-big", "r-eye-big", "r-alone"];
        let names = names.map(str::to_owned).to_vec();
        let shapes = face_shapes(&names);
        assert_eq!(shapes.len(), 4);
        let expression = document::Expression { enabled: false, ..Default::default() };
        let law = document::Look { face_targets: 3.0.into(), expression, ..Default::default() };
        for frame in 0..50 {
            let face =
                face(&law, &MemberLook::default(), &shapes, Source::new(Draws::new(1, frame), 0));
            let of = |name: &str| face.iter().find(|f| f.0 == name).map(|f| f.1);
            assert_eq!(of("ears/l-ear-up"), of("ears/r-ear-up"));
            assert_eq!(of("l-eye-big"), of("r-eye-big"));
            assert!((3..=5).contains(&face.len()));
            assert!(face.iter().all(|f| (0.0..=0.8).contains(&f.1)));
        }
    }
}
