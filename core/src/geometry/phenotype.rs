//! Body shape: from sliders to the weights of the figure's targets, and from weights to vertices.
//!
//! A vertex is the template plus the weighted deltas of some 46 macro targets and the chosen face
//! targets, times a uniform scale, lifted to stand on the ground. A target's weight is the product
//! of the weights of the keywords in its name; the keywords of one slider share its value between
//! the two neighbouring anchors ("hat" functions), as in MakeHuman and Anny (NAVER, 2025).
//! Which vertices are needed is decided by the callers.

use std::collections::BTreeMap;
use std::ops::Range;

use super::wide::wide;
use crate::library::figure::data::{DELTA_UNIT_M, KEYWORDS, NO_KEYWORD};
use crate::library::figure::{Figure, FigureError};
use crate::scene::{Body, Sex};

/// A body's shape: what is added to the template.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Macro targets and their weights, ascending.
    pub macros: Vec<(usize, f32)>,
    /// Face targets and their amounts, in the order given.
    pub locals: Vec<(usize, f32)>,
    /// Uniform scale; 1 unless the stature is beyond the height slider.
    pub scale: f32,
    /// Added to y after scaling, metres.
    pub lift_m: f32,
}

/// Age slider of an age in years: 0 newborn, 1/3 child, 2/3 young adult, 1 very old; piecewise
/// linear (growth data behind Anny's population model).
#[must_use]
pub fn age_slider(age_years: f64) -> f64 {
    const MAP: [(f64, f64); 8] = [
        (0.0, 0.0),
        (1.0, 0.05),
        (4.0, 0.215),
        (11.0, 0.415),
        (16.0, 0.67),
        (18.0, 0.77),
        (64.0, 0.83),
        (110.0, 1.0),
    ];
    let i = MAP.iter().skip(1).position(|p| age_years <= p.0).unwrap_or(MAP.len() - 2);
    let (a, b) = (MAP[i], MAP[i + 1]);
    let t = ((age_years - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
    a.1 + (b.1 - a.1) * t
}

/// Largest weight slider: a quarter beyond the model's own end people still look like people, and
/// all but one in a thousand adults are within.
pub const HEAVIEST: f64 = 1.25;

/// Sliders of the body model that are solved for, 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliders {
    /// As the body says, or less.
    pub muscle: f64,
    /// Solved for the body mass index; up to [`HEAVIEST`], where the morphs are carried on.
    pub weight: f64,
    /// Solved for the stature.
    pub height: f64,
}

/// Weights of all keywords for a body, with the given age slider.
fn keyword_weights(body: &Body, age: f64, sliders: Sliders) -> [f64; KEYWORDS.len()] {
    let mut out = [0.0; KEYWORDS.len()];
    let mut hat = |first: &str, anchors: usize, value: f64| {
        let at = KEYWORDS.iter().position(|k| *k == first).expect("keywords are constants");
        let x = value.max(0.0) * (anchors - 1) as f64;
        let i = (x as usize).min(anchors - 2);
        out[at + i] = 1.0 - (x - i as f64);
        out[at + i + 1] = x - i as f64;
    };
    hat("baby", 4, age.min(1.0));
    hat("minmuscle", 3, sliders.muscle.min(1.0));
    hat("minweight", 3, sliders.weight.min(HEAVIEST));
    hat("minheight", 2, sliders.height.min(1.0));
    hat("idealproportions", 2, body.proportions.min(1.0));
    hat("mincup", 3, body.cup.min(1.0));
    hat("minfirmness", 3, body.firmness.min(1.0));
    hat("male", 2, if body.sex == Sex::Male { 0.0 } else { 1.0 });
    let ancestry = body.ancestry.map(|a| a.max(0.0));
    let sum: f64 = ancestry.iter().sum();
    for (slot, a) in out.iter_mut().zip(ancestry) {
        *slot = if sum > 0.0 { a / sum } else { 1.0 / 3.0 };
    }
    out
}

/// Rows of the figure with a weight, in the file's order: target and weight.
fn weighted_rows(figure: &Figure, keywords: &[f64]) -> Vec<(usize, f64)> {
    figure
        .macro_rows()
        .filter_map(|row| {
            let mut weight = 1.0;
            for &k in row.keywords.iter().take_while(|&&k| k != NO_KEYWORD) {
                weight *= keywords[usize::from(k)];
            }
            // Beyond a slider's end one neighbour counts negative.
            (weight != 0.0).then_some((row.target, weight))
        })
        .collect()
}

/// Macro weights of a body; rows that share a target are added up.
#[must_use]
pub fn macro_weights(figure: &Figure, body: &Body, sliders: Sliders) -> Vec<(usize, f32)> {
    macro_weights_at(figure, body, age_slider(body.age_years), sliders)
}

fn macro_weights_at(figure: &Figure, body: &Body, age: f64, sliders: Sliders) -> Vec<(usize, f32)> {
    let mut sums = BTreeMap::new();
    for (target, weight) in weighted_rows(figure, &keyword_weights(body, age, sliders)) {
        *sums.entry(target).or_insert(0.0) += weight;
    }
    sums.into_iter().map(|(t, w)| (t, w as f32)).collect()
}

/// Face targets by name.
///
/// # Errors
/// [`FigureError::UnknownFaceTarget`].
pub fn face_weights(
    figure: &Figure,
    face: &[(String, f64)],
    head_scale: f64,
) -> Result<Vec<(usize, f32)>, FigureError> {
    face.iter()
        .filter(|(_, amount)| *amount != 0.0)
        .map(|(name, amount)| Ok((figure.face_target(name)?, (amount * head_scale) as f32)))
        .collect()
}

/// Vertices taken at a time: their sums stay near the processor, and every target is read in runs
/// that are long enough to be fetched ahead.
const CHUNK: usize = 1024;

/// Model-space positions of a range of vertices, metres. A vertex gets the same bits whatever
/// range it is part of.
#[must_use]
pub fn evaluate(figure: &Figure, shape: &Shape, range: Range<usize>) -> Vec<[f32; 3]> {
    let all = 0..range.len();
    evaluate_runs(figure, shape, range, &[all])
}

/// The same for some runs of a range, ascending and counted from its beginning; where there is no
/// run there is no use in the position.
pub(super) fn evaluate_runs(
    figure: &Figure,
    shape: &Shape,
    range: Range<usize>,
    runs: &[Range<usize>],
) -> Vec<[f32; 3]> {
    let base = figure.template();
    let mut out = vec![[0.0; 3]; range.len()];
    let (mut x, mut y, mut z) = ([0.0; CHUNK], [0.0; CHUNK], [0.0; CHUNK]);
    for run in runs {
        for (i, out) in out[run.clone()].chunks_mut(CHUNK).enumerate() {
            let (start, n) = (range.start + run.start + i * CHUNK, out.len());
            let part = start..start + n;
            x[..n].copy_from_slice(&base.x[part.clone()]);
            y[..n].copy_from_slice(&base.y[part.clone()]);
            z[..n].copy_from_slice(&base.z[part.clone()]);
            for &(target, weight) in &shape.macros {
                let d = figure.macro_target(target);
                let deltas = [&d.x[part.clone()], &d.y[part.clone()], &d.z[part.clone()]];
                add_deltas([&mut x[..n], &mut y[..n], &mut z[..n]], deltas, weight * DELTA_UNIT_M);
            }
            for (out, ((x, y), z)) in out.iter_mut().zip(x.iter().zip(&y).zip(&z)) {
                *out = [*x, *y, *z];
            }
        }
    }
    for &(target, weight) in &shape.locals {
        let (vertices, d) = figure.face_deltas(target);
        let w = weight * DELTA_UNIT_M;
        let from = vertices.partition_point(|&v| usize::from(v) < range.start);
        let to = vertices.partition_point(|&v| usize::from(v) < range.end);
        for i in from..to {
            let p = &mut out[usize::from(vertices[i]) - range.start];
            p[0] += w * f32::from(d.x[i]);
            p[1] += w * f32::from(d.y[i]);
            p[2] += w * f32::from(d.z[i]);
        }
    }
    for p in &mut out {
        *p = [p[0] * shape.scale, p[1] * shape.scale + shape.lift_m, p[2] * shape.scale];
    }
    out
}

wide! {
    /// Adds weighted deltas along three axes. Most of the time that a new body takes is spent here.
    fn add_deltas(sums: [&mut [f32]; 3], deltas: [&[i16]; 3], weight: f32) = add_deltas_body
}

#[inline(always)]
fn add_deltas_body(sums: [&mut [f32]; 3], deltas: [&[i16]; 3], weight: f32) {
    for (sums, deltas) in sums.into_iter().zip(deltas) {
        add_run(sums, deltas, weight);
    }
}

#[inline(always)]
fn add_run(sums: &mut [f32], deltas: &[i16], weight: f32) {
    for (s, &d) in sums.iter_mut().zip(deltas) {
        *s += weight * f32::from(d);
    }
}

/// Height of a body's crown and of its lowest vertex, metres.
pub(super) fn extent_m(figure: &Figure, shape: &Shape) -> [f32; 2] {
    let tall = figure.tallness();
    let mut y = tall.template_y.clone();
    for &(target, weight) in &shape.macros {
        add_run(&mut y, tall.macro_dy(target), weight * DELTA_UNIT_M);
    }
    for &(target, weight) in &shape.locals {
        for &(i, dy) in tall.local_dy(target) {
            y[i] += weight * DELTA_UNIT_M * f32::from(dy);
        }
    }
    let (crown, feet) = y.split_at(tall.crown);
    let top = crown.iter().copied().fold(f32::MIN, f32::max);
    let low = feet.iter().copied().fold(f32::MAX, f32::min);
    [top, low].map(|y| y * shape.scale + shape.lift_m)
}

/// Heights of single vertices, metres.
pub(super) fn heights(figure: &Figure, shape: &Shape, vertices: &[u16]) -> Vec<f32> {
    let mut out: Vec<f32> = vertices.iter().map(|&v| figure.template().y[usize::from(v)]).collect();
    for &(target, weight) in &shape.macros {
        let d = figure.macro_target(target).y;
        let w = weight * DELTA_UNIT_M;
        for (o, &v) in out.iter_mut().zip(vertices) {
            *o += w * f32::from(d[usize::from(v)]);
        }
    }
    for &(target, weight) in &shape.locals {
        let (moved, d) = figure.face_deltas(target);
        let w = weight * DELTA_UNIT_M;
        for (o, v) in out.iter_mut().zip(vertices) {
            if let Ok(i) = moved.binary_search(v) {
                *o += w * f32::from(d.y[i]);
            }
        }
    }
    out.iter().map(|y| y * shape.scale + shape.lift_m).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    const MIDDLE: Sliders = Sliders { muscle: 0.5, weight: 0.5, height: 0.5 };

    pub(crate) fn average(sex: Sex) -> Body {
        Body {
            sex,
            age_years: 30.0,
            stature_m: if sex == Sex::Male { 1.78 } else { 1.65 },
            bmi_kg_m2: 22.0,
            muscle: 0.5,
            proportions: 0.5,
            ancestry: [1.0 / 3.0; 3],
            cup: 0.5,
            firmness: 0.5,
        }
    }

    #[test]
    fn deltas_add_up_to_the_same_bits_with_any_instruction_set() {
        let deltas: Vec<i16> = (0..259).map(|i| (i * 7919 % 65_521 - 32_760) as i16).collect();
        let sums: Vec<f32> = (0..259).map(|i| 0.37 / (i as f32 + 0.3)).collect();
        type Add = fn([&mut [f32]; 3], [&[i16]; 3], f32);
        let run = |add: Add| {
            let mut out = [sums.clone(), sums.clone(), sums.clone()];
            let [x, y, z] = &mut out;
            add([x, y, z], [&deltas, &deltas[1..], &deltas[2..]], 0.000_123_4);
            out.map(|axis| axis.into_iter().map(f32::to_bits).collect::<Vec<_>>())
        };
        assert_eq!(run(add_deltas), run(add_deltas_body));
    }

    #[test]
    fn ages_map_through_their_anchors() {
        for (years, slider) in
            [(1.0, 0.05), (4.0, 0.215), (18.0, 0.77), (64.0, 0.83), (2.5, 0.1325)]
        {
            assert!((age_slider(years) - slider).abs() < 1e-12, "{years}");
        }
    }

    #[test]
    fn keyword_weights_share_each_slider_between_two_neighbours() {
        let sliders = Sliders { muscle: 0.3, weight: 0.9, height: 0.25 };
        let w = keyword_weights(&average(Sex::Female), 0.5, sliders);
        let of = |k: &str| w[KEYWORDS.iter().position(|n| *n == k).unwrap()];
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        near(of("minmuscle"), 0.4);
        near(of("averagemuscle"), 0.6);
        near(of("maxmuscle"), 0.0);
        near(of("averageweight"), 0.2);
        near(of("maxweight"), 0.8);
        near(of("child"), 0.5);
        near(of("young"), 0.5);
        near(of("minheight"), 0.75);
        near(of("female"), 1.0);
        near(of("african") + of("asian") + of("caucasian"), 1.0);
    }

    #[test]
    fn an_adult_of_mixed_ancestry_needs_46_targets_two_of_them_empty() {
        let figure = Figure::built_in().unwrap();
        let sliders = Sliders { muscle: 0.4, weight: 0.7, height: 0.5 };
        let rows = weighted_rows(&figure, &keyword_weights(&average(Sex::Male), 0.75, sliders));
        assert_eq!(rows.len(), 46 - 2, "the two empty ones are not in the file");
    }

    #[test]
    fn statures_at_the_middle_of_the_sliders() {
        let figure = Figure::built_in().unwrap();
        for (sex, stature_m) in [(Sex::Male, 1.909), (Sex::Female, 1.769)] {
            let macros = macro_weights_at(&figure, &average(sex), 2.0 / 3.0, MIDDLE);
            let shape = Shape { macros, scale: 1.0, ..Shape::default() };
            let [top, low] = extent_m(&figure, &shape);
            assert!((f64::from(top - low) - stature_m).abs() < 6e-4, "{sex:?} {}", top - low);
        }
    }

    #[test]
    fn a_vertex_does_not_depend_on_the_range_that_asks_for_it() {
        let figure = Figure::built_in().unwrap();
        let shape = Shape {
            macros: macro_weights(
                &figure,
                &average(Sex::Female),
                Sliders { height: 0.4, ..MIDDLE },
            ),
            locals: vec![(3, 0.7), (40, 0.3)],
            scale: 1.01,
            lift_m: 0.8,
        };
        let all = evaluate(&figure, &shape, 0..figure.data().vertex_count());
        assert_eq!(evaluate(&figure, &shape, 777..1900), all[777..1900]);
        let some = [5u16, 900, 4000];
        let y = heights(&figure, &shape, &some);
        for (v, y) in some.iter().zip(y) {
            assert_eq!(all[usize::from(*v)][1].to_bits(), y.to_bits());
        }
    }
}
