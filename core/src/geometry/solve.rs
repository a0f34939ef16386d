//! Sliders of the body model from measures: what stature and body mass index a body is to have.
//!
//! Body and face in, weights of the morph targets out. Stature is linear in the height slider; mass
//! is found by a few trials on a coarse skin. Where the sliders end, stature is reached by uniform
//! scale and mass as far as it goes.

use glam::DVec3;

use super::body::SOLE_M;
use super::phenotype::{
    HEAVIEST, Shape, Sliders, evaluate, extent_m, face_weights, heights, macro_weights,
};
use crate::library::figure::{Figure, FigureError, GroupId, VOLUME_LOD};
use crate::scene::Body;

/// Mean density of the living body, kg per cubic metre.
const DENSITY_KG_M3: f64 = 980.0;
/// The body mass index is met to this.
const BMI_TOLERANCE: f64 = 0.1;
/// More trials than any bracket needs.
const TRIALS: u32 = 40;

/// Weights, scale and lift that give the wanted stature and body mass index, and the size of the
/// head against the template's.
pub(super) fn solve_shape(
    figure: &Figure,
    body: &Body,
    face: &[(String, f64)],
) -> Result<(Shape, f64), FigureError> {
    let middle = Sliders { muscle: body.muscle, weight: 0.5, height: 0.5 };
    let head_scale = head_scale(figure, &plain(macro_weights(figure, body, middle)));
    let locals = face_weights(figure, face, head_scale)?;
    let shaped = |girth: f64| of_stature(figure, body, girth, &locals);
    let skin =
        figure.vertices(GroupId::Skin, figure.group(GroupId::Skin).lods[VOLUME_LOD].vertices);
    let excess = |girth: f64| {
        let mass_kg = mass_kg(figure, &evaluate(figure, &shaped(girth), skin.clone()));
        mass_kg / (body.stature_m * body.stature_m) - body.bmi_kg_m2
    };
    Ok((shaped(root(excess, HEAVIEST, BMI_TOLERANCE)), head_scale))
}

/// The body of the wanted stature at a girth: 0 the thinnest, 0.5 average, [`HEAVIEST`]. Muscle
/// gives way towards both ends, since the model's muscular bodies are neither thin nor heavy.
fn of_stature(figure: &Figure, body: &Body, girth: f64, locals: &[(usize, f32)]) -> Shape {
    let off = 2.0 * girth - 1.0;
    let muscle = body.muscle * (1.0 - off * off).max(0.0);
    let with = |height: f64| Shape {
        locals: locals.to_vec(),
        ..plain(macro_weights(figure, body, Sliders { muscle, weight: girth, height }))
    };
    let extent = |shape: &Shape| extent_m(figure, shape).map(f64::from);
    let stature = |height: f64| {
        let [top, low] = extent(&with(height));
        top - low
    };
    let (short, tall) = (stature(0.0), stature(1.0));
    let mut shape = with(((body.stature_m - short) / (tall - short)).clamp(0.0, 1.0));
    let [top, low] = extent(&shape);
    shape.scale = (body.stature_m / (top - low)) as f32;
    shape.lift_m = SOLE_M - (low as f32) * shape.scale;
    shape
}

fn plain(macros: Vec<(usize, f32)>) -> Shape {
    Shape { macros, scale: 1.0, ..Shape::default() }
}

/// Where a function that grows from 0 to `end` is 0, to a tolerance of its value; the nearer end where it
/// has one sign only. False position with halving (Dowell and Jarratt, "A modified regula falsi
/// method", BIT 11, 1971).
fn root(f: impl Fn(f64) -> f64, end: f64, tolerance: f64) -> f64 {
    let (mut a, mut b) = (0.0, end);
    let (mut fa, mut fb) = (f(a), f(b));
    if fa >= 0.0 || fb <= 0.0 {
        return if fa >= 0.0 { a } else { b };
    }
    for _ in 0..TRIALS {
        let x = b - fb * (b - a) / (fb - fa);
        let fx = f(x);
        if fx.abs() < tolerance {
            return x;
        }
        if (fx > 0.0) == (fb > 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (x, fx);
    }
    b
}

/// Height of the head's bone against the template's.
fn head_scale(figure: &Figure, shape: &Shape) -> f64 {
    let d = figure.data();
    let j = d.joint_names.iter().position(|n| n == "Head").unwrap_or(0);
    let size = |shape: &Shape| {
        let mean = |v: &[u16]| heights(figure, shape, v).iter().sum::<f32>() / v.len() as f32;
        f64::from(mean(&d.joint_tails[8 * j..8 * j + 8]) - mean(&d.joint_heads[8 * j..8 * j + 8]))
    };
    size(shape) / size(&plain(Vec::new()))
}

/// Mass of a body from its skin at the level of detail [`VOLUME_LOD`]: the signed volume inside the
/// triangles (divergence theorem), times what that level lacks.
pub(super) fn mass_kg(figure: &Figure, skin: &[[f32; 3]]) -> f64 {
    let group = figure.group(GroupId::Skin);
    let at =
        |r: u16| DVec3::from_array(skin[usize::from(group.render[usize::from(r)])].map(f64::from));
    let six: f64 = group.lods[VOLUME_LOD]
        .triangles
        .chunks_exact(3)
        .map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))))
        .sum();
    six / 6.0 * f64::from(figure.data().volume_factor[0]) * DENSITY_KG_M3
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::body::rest_body;
    use crate::geometry::phenotype::tests::average;
    use crate::scene::Sex;

    #[test]
    fn the_wanted_body_mass_index_is_met() {
        let figure = Figure::built_in().unwrap();
        for sex in [Sex::Male, Sex::Female] {
            for (age_years, stature_m, range) in [
                (4.0, 1.03, 13..=19),
                (10.0, 1.38, 14..=24),
                (16.0, 1.7, 17..=30),
                (30.0, 1.7, 18..=36),
                (80.0, 1.62, 18..=36),
            ] {
                for bmi in range.step_by(3) {
                    for muscle in [0.2, 0.5, 0.9] {
                        let bmi_kg_m2 = f64::from(bmi);
                        let body = Body { age_years, stature_m, bmi_kg_m2, muscle, ..average(sex) };
                        let rest = rest_body(&figure, &body, &[]).unwrap();
                        let got = rest.mass_kg / (stature_m * stature_m);
                        assert!((got - bmi_kg_m2).abs() < 0.11, "{body:?}: {got}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_the_model_comes_its_end() {
        assert_eq!(root(|x| x + 1.0, 1.0, 1e-3), 0.0);
        assert_eq!(root(|x| x - 7.0, 1.2, 1e-3), 1.2);
        assert!((root(|x| x * x * x - 0.2, 1.0, 1e-6) - libm::cbrt(0.2)).abs() < 1e-5);
    }
}
