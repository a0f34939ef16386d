//! Hair on the head: the scalp's grid of roots moved outwards, and the curtain of long hair.
//!
//! Thickness falls to nothing at the hairline like a quarter circle, so hair grows out of the
//! skin. The skin's scalp mask, coloured like the hair, lies under it. Colours are not decided
//! here.

use glam::Vec3;

use super::cut::smooth_normals;
use super::garment::step;
use crate::library::figure::{Figure, GroupId};
use crate::scene::HairStyle;

/// Thickness of the hair on top, distance from the hairline at which it is reached, and share of
/// the thickness that remains at the sides; metres on an adult.
fn form(style: HairStyle) -> Option<(f32, f32, f32)> {
    match style {
        HairStyle::Bald => None,
        HairStyle::Cropped => Some((0.0045, 0.014, 0.8)),
        HairStyle::Short => Some((0.021, 0.042, 0.5)),
        HairStyle::Afro => Some((0.060, 0.060, 0.85)),
        HairStyle::Long => Some((0.017, 0.040, 0.85)),
    }
}

/// Whether a style has hair that hangs down.
pub(super) fn has_curtain(style: HairStyle) -> bool {
    style == HairStyle::Long
}

/// Outer surface of the hair and its normals, from the roots; nothing for a bald head.
pub(super) fn cap(
    figure: &Figure,
    style: HairStyle,
    lod: usize,
    head_scale: f32,
    roots: &[Vec3],
) -> Option<(Vec<Vec3>, Vec<Vec3>)> {
    /// Roots start a little under the skin.
    const SUNK_M: f32 = 0.0012;
    let (thick, taper, side) = form(style)?;
    let group = figure.group(GroupId::HairCap);
    let triangles = &group.lods[lod].triangles;
    let normals = smooth_normals(roots, &group.render, triangles);
    let template = figure.template();
    let out: Vec<Vec3> = roots
        .iter()
        .zip(&normals)
        .enumerate()
        .map(|(i, (p, n))| {
            let v = group.first as usize + i;
            let left = 1.0 - (figure.data().hair_depth[i] / taper).min(1.0);
            let rise = (1.0 - left * left).max(0.0).sqrt();
            let top = side + (1.0 - side) * n.y.max(0.0);
            // Under the curtain the cap lies close.
            let free = if has_curtain(style) {
                0.2 + 0.8 * step(0.735, 0.778, template.y[v])
            } else {
                1.0
            };
            let lump = lump(Vec3::new(template.x[v], template.y[v], template.z[v]));
            *p + *n * (head_scale * (thick * free * rise * top * (1.0 + 0.14 * lump) - SUNK_M))
        })
        .collect();
    let normals = smooth_normals(&out, &group.render, triangles);
    Some((out, normals))
}

/// Gentle unevenness in -1..1.
fn lump(p: Vec3) -> f32 {
    let wave = |a: f32, b: f32, c: f32, d: f32| libm::sinf(p.x * a + p.y * b + p.z * c + d);
    (wave(61.0, 37.0, -23.0, 0.3) + wave(-29.0, 71.0, 53.0, 1.9) + wave(83.0, -17.0, 67.0, 4.1))
        / 3.0
}
