//! The mask of an eyeball, made from angles alone.
//!
//! Texture coordinates are azimuthal equidistant round the eye's axis: the centre looks forward,
//! the rim of the unit square is the back of the eye. Colours are not decided here.

use super::with_mips;
use crate::library::texture::Texture;

const LOG2_SIZE: u32 = 8;
/// Angles from the axis in degrees, after the usual proportions of a human eye (visible iris
/// 11.7 mm across on a ball of 24 mm, pupil 4 mm).
const IRIS_DEG: f32 = 28.0;
const PUPIL_DEG: f32 = 12.0;
const RIM_DEG: f32 = 3.2;
const WHITE_DEG: f32 = 62.0;

/// Red iris, green pupil and limbal ring, blue the outer white, alpha a glint.
pub(super) fn mask() -> Texture {
    let size = 1u32 << LOG2_SIZE;
    let to_unit = |i: u32| (i as f32 + 0.5) / size as f32 * 2.0 - 1.0;
    let texels = (0..size)
        .flat_map(|y| (0..size).map(move |x| (x, y)))
        .map(|(x, y)| {
            let (u, v) = (to_unit(x), to_unit(y));
            let deg = (u * u + v * v).sqrt() * 180.0;
            let iris = 1.0 - step(IRIS_DEG - 0.8, IRIS_DEG + 0.8, deg);
            let pupil = 1.0 - step(PUPIL_DEG - 1.0, PUPIL_DEG + 1.0, deg);
            let rim = step(IRIS_DEG - RIM_DEG - 2.0, IRIS_DEG - 0.5, deg)
                * (1.0 - step(IRIS_DEG - 0.5, IRIS_DEG + 2.0, deg));
            let white = step(IRIS_DEG + 2.0, WHITE_DEG, deg);
            // The glint of a window, above the pupil and to the person's left.
            let glint_deg = ((u - 0.055).powi(2) + (v + 0.065).powi(2)).sqrt() * 180.0;
            let glint = 1.0 - step(2.2, 4.6, glint_deg);
            let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
            byte(iris)
                | byte(pupil.max(rim * 0.55)) << 8
                | byte(white * 0.6) << 16
                | byte(glint * 0.8) << 24
        })
        .collect();
    with_mips(LOG2_SIZE, texels)
}

fn step(a: f32, b: f32, x: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
