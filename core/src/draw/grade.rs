//! Colour grading: what the scene says of it, as matrices and exponents in `f32`.
//!
//! White balance scales the responses of the eye's three cones, contrast and saturation act in the
//! wider primaries of ACEScg, as film graders have it. All that is linear is multiplied into one
//! matrix before the contrast curve and one after it.

use glam::{DMat3, DVec3};

use super::abi::{Bloom, ColorGrade, Grade};
use crate::base::color::XYZ_FROM_LINEAR;
use crate::scene::Post;

/// Cone responses of XYZ: CAT02 (CIE 159:2004), by columns.
const LMS_FROM_XYZ: DMat3 = DMat3::from_cols_array(&[
    0.7328, -0.7036, 0.0030, 0.4296, 1.6975, 0.0136, -0.1624, 0.0061, 0.9834,
]);
/// Cone responses of a white of D65.
const WHITE_LMS: DVec3 = DVec3::new(0.949_237, 1.035_42, 1.087_28);
/// ACEScg of linear Rec. 709, adapted to its white (ACES TB-2014-004 and Bradford), by columns.
const ACESCG_FROM_LINEAR: DMat3 = DMat3::from_cols_array(&[
    0.613_097, 0.070_194, 0.020_616, 0.339_523, 0.916_354, 0.109_570, 0.047_379, 0.013_452,
    0.869_815,
]);
/// Light that contrast leaves alone.
const MID_GREY: f64 = 0.18;
/// Luminance of ACEScg.
const LUMA: DVec3 = DVec3::new(0.272_228_7, 0.674_081_8, 0.053_689_5);

/// What is to be done with the light of a scene.
pub fn grade(post: &Post) -> Grade {
    Grade {
        bloom: bloom(post),
        vignette: post.vignette as f32,
        shot_noise: post.shot_noise as f32,
        read_noise: post.read_noise as f32,
        color: color(post),
        tone_curve: post.tone_curve,
        grain: post.grain as f32,
        grain_key: post.grain_key,
    }
}

/// Scattered light; nothing where there is none.
fn bloom(post: &Post) -> Option<Bloom> {
    // Those of the seed's engine.
    let share = (libm::exp2(post.bloom) - 1.0) as f32;
    let spread = (0.05 + 0.9 * post.bloom_scatter) as f32;
    (share > 0.0).then_some(Bloom { share, spread })
}

/// White balance, contrast and saturation; nothing where they do nothing.
fn color(post: &Post) -> Option<ColorGrade> {
    let Post { white_balance_temperature, white_balance_tint, contrast, saturation, .. } = *post;
    if [white_balance_temperature, white_balance_tint, contrast, saturation] == [0.0; 4] {
        return None;
    }
    let balance = white_balance(white_balance_temperature, white_balance_tint);
    let before = ACESCG_FROM_LINEAR * balance;
    let after = ACESCG_FROM_LINEAR.inverse() * saturating(1.0 + saturation / 100.0);
    let rows = |m: DMat3| [0, 1, 2].map(|r| m.row(r).as_vec3().to_array());
    // The engines leave the curve and the second matrix out where the exponent, as they have it, is 1.
    let exponent = (1.0 + contrast / 100.0) as f32;
    Some(if exponent == 1.0 {
        ColorGrade { before: rows(after * before), contrast: 1.0, after: rows(DMat3::IDENTITY) }
    } else {
        let (before, after) = (before * (1.0 / MID_GREY), after * MID_GREY);
        ColorGrade { before: rows(before), contrast: exponent, after: rows(after) }
    })
}

/// Linear Rec. 709 under another white: along the daylight locus by the temperature, across it by
/// the tint, both -100..100 and 0 for none. The seed's engine has this relation.
fn white_balance(temperature: f64, tint: f64) -> DMat3 {
    if temperature == 0.0 && tint == 0.0 {
        return DMat3::IDENTITY;
    }
    let t = temperature / 65.0;
    let x = 0.312_71 - t * if t < 0.0 { 0.1 } else { 0.05 };
    let y = 2.87 * x - 3.0 * x * x - 0.275_095_07 + tint / 65.0 * 0.05;
    let white = LMS_FROM_XYZ * DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let lms_from_linear = LMS_FROM_XYZ * XYZ_FROM_LINEAR;
    lms_from_linear.inverse() * DMat3::from_diagonal(WHITE_LMS / white) * lms_from_linear
}

/// Differences from grey times a factor, ACEScg.
fn saturating(factor: f64) -> DMat3 {
    let grey = DMat3::from_cols(DVec3::splat(LUMA.x), DVec3::splat(LUMA.y), DVec3::splat(LUMA.z));
    grey * (1.0 - factor) + DMat3::IDENTITY * factor
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the engines make of a light.
    fn applied(post: &Post, v: DVec3) -> DVec3 {
        let Some(grade) = color(post) else { return v };
        let times = |m: &[[f32; 3]; 3], v: DVec3| {
            DVec3::from_array(m.map(|r| DVec3::from_array(r.map(f64::from)).dot(v)))
        };
        let v = times(&grade.before, v);
        if grade.contrast == 1.0 {
            return v;
        }
        let curve = |x: f64| libm::pow(x.max(0.0), f64::from(grade.contrast));
        times(&grade.after, DVec3::from_array(v.to_array().map(curve)))
    }

    #[test]
    fn white_stays_white_under_contrast_and_saturation() {
        let post = Post { contrast: 30.0, saturation: -40.0, ..Post::default() };
        let grey = applied(&post, DVec3::splat(0.18));
        assert!((grey - DVec3::splat(0.18)).abs().max_element() < 1e-4, "{grey}");
        let white = applied(&post, DVec3::ONE);
        let expected = 0.18 * libm::pow(1.0 / 0.18, 1.3);
        assert!((white - DVec3::splat(expected)).abs().max_element() < 1e-3, "{white}");
    }

    #[test]
    fn without_saturation_all_is_grey() {
        let post = Post { saturation: -100.0, ..Post::default() };
        let v = applied(&post, DVec3::new(0.9, 0.2, 0.4));
        assert!(v.max_element() - v.min_element() < 1e-4, "{v}");
    }

    #[test]
    fn a_higher_temperature_is_yellower_and_no_temperature_changes_nothing() {
        let at = |t: f64| white_balance(t, 0.0) * DVec3::ONE;
        assert_eq!(at(0.0), DVec3::ONE);
        let (warm, cold) = (at(20.0), at(-20.0));
        assert!(warm.x > 1.0 && warm.z < 1.0 && cold.x < 1.0 && cold.z > 1.0);
        // The relation at 0 gives back D65 to the digits that its constants have.
        let nearly = at(1e-9);
        assert!((nearly - DVec3::ONE).abs().max_element() < 1e-3, "{nearly}");
        let purple = white_balance(0.0, 50.0) * DVec3::ONE;
        assert!(purple.x > purple.y && purple.z > purple.y, "{purple}");
    }

    #[test]
    fn what_does_nothing_is_left_out() {
        assert_eq!(color(&Post::default()), None);
    }

    #[test]
    fn next_to_no_contrast_is_next_to_none() {
        let light = DVec3::new(0.7, 0.05, 0.3);
        for contrast in [1e-9, -1e-6, 5e-6, 1e-5, -1e-3] {
            let got = applied(&Post { contrast, ..Post::default() }, light);
            assert!((got - light).abs().max_element() < 1e-4, "{contrast}: {got}");
        }
    }
}
