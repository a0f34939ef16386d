//! Lashes of the upper lids: thin pointed triangles along their edges.
//!
//! A face's skin and eyes flow in, triangles flow out. They are drawn where a lash spans a good
//! part of a pixel; farther away the dark line along the lid stands for them.

use std::ops::Range;

use glam::Vec3;

use super::cut::{Surface, mix_skin};
use super::hair::strand::push;
use crate::library::figure::{Figure, GroupId, upper_lid_y};
use crate::library::mesh::{Mesh, Triangle};

/// Places along the lid's edge at which vertices are looked for: distance from the middle of the
/// face on the template, metres.
const ALONG_M: [f32; 7] = [0.0235, 0.0272, 0.0311, 0.0348, 0.0383, 0.0409, 0.0430];
/// Lashes from one of those places to the next.
const BETWEEN: usize = 4;
/// Length of the longest ones and half the width at the root, for an eyeball of [`EYE_M`].
const LENGTH_M: f32 = 0.0085;
const HALF_M: f32 = 0.00042;
/// Radius of the template's eyeball.
const EYE_M: f32 = 0.0138;

/// Adds the lashes of both eyes; `skin` and `eyes` at the finest level.
pub(super) fn add(
    mesh: &mut Mesh,
    figure: &Figure,
    skin: &Surface<'_>,
    eyes: &[Vec3],
) -> Range<u32> {
    let start = mesh.triangles.len() as u32;
    let middle = eyes.iter().sum::<Vec3>() / eyes.len().max(1) as f32;
    let round_eyes = round_eyes(figure, skin.positions.len());
    for side in [1.0, -1.0] {
        let ball: Vec<Vec3> =
            eyes.iter().copied().filter(|p| (p.x - middle.x) * side > 0.0).collect();
        if ball.is_empty() {
            continue;
        }
        let center = ball.iter().sum::<Vec3>() / ball.len() as f32;
        let radius = ball.iter().map(|p| (*p - center).length()).sum::<f32>() / ball.len() as f32;
        let roots: Vec<usize> =
            ALONG_M.iter().filter_map(|x| edge_vertex(figure, &round_eyes, side * x)).collect();
        row(mesh, skin, &roots, (center, side, radius / EYE_M));
    }
    start..mesh.triangles.len() as u32
}

/// The vertices about the eyes, among the first `count` of the skin's.
fn round_eyes(figure: &Figure, count: usize) -> Vec<usize> {
    let t = figure.template();
    let first = figure.group(GroupId::Skin).first as usize;
    let near = |v: &usize| {
        let (x, y) = (t.x[first + v].abs(), t.y[first + v]);
        (0.70..0.77).contains(&y) && (0.02..0.05).contains(&x)
    };
    (0..count).filter(near).collect()
}

/// The vertex in front on the edge of the upper lid, at a place to the figure's left or right.
fn edge_vertex(figure: &Figure, near: &[usize], x: f32) -> Option<usize> {
    const REACH_M: [f32; 2] = [0.0012, 0.0009];
    let t = figure.template();
    let first = figure.group(GroupId::Skin).first as usize;
    let edge_y = upper_lid_y(x.abs())?;
    let on_edge = |v: &usize| {
        let (dx, dy) = (t.x[first + v] - x, t.y[first + v] - edge_y);
        dx.abs() < REACH_M[0] && dy.abs() < REACH_M[1]
    };
    let all = near.iter().copied().filter(on_edge);
    all.max_by(|a, b| t.z[first + a].total_cmp(&t.z[first + b]))
}

/// Lashes along a row of vertices, from the nose outwards.
fn row(
    mesh: &mut Mesh,
    skin: &Surface<'_>,
    roots: &[usize],
    (center, side, size): (Vec3, f32, f32),
) {
    let last = (roots.len().max(1) - 1) * BETWEEN;
    for i in 0..=last {
        let (k, t) = (i / BETWEEN, (i % BETWEEN) as f32 / BETWEEN as f32);
        let (Some(&a), Some(&b)) = (roots.get(k), roots.get(k + 1).or(roots.get(k))) else {
            return;
        };
        let p = skin.positions[a].lerp(skin.positions[b], t);
        let share = i as f32 / last.max(1) as f32;
        let off = (p - center).normalize_or(Vec3::Z);
        // They fan out: towards the nose inside, to the temple outside, and bend upwards.
        let fan = Vec3::X * (side * (1.1 * share - 0.35));
        let ahead = (off + fan + Vec3::Y * 0.45).normalize_or(Vec3::Z);
        // Neighbours differ a little, the same on both sides.
        let uneven = [1.0, 0.82, 0.93, 0.76][i % 4];
        let length = size * LENGTH_M * (0.5 + 0.5 * share) * uneven;
        let across = ahead.cross(off).normalize_or(Vec3::X) * (size * HALF_M);
        let joints = mix_skin(skin.skin[a], skin.skin[b], t);
        let tip = p + ahead * length + Vec3::Y * (0.12 * length);
        let [left, right, tip] =
            [p - across, p + across, tip].map(|q| push(mesh, q, off, [0.0; 2], joints));
        mesh.triangles.push(Triangle::new([left, right, tip]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::body::rest_body;
    use crate::geometry::person::Evaluated;
    use crate::geometry::phenotype::tests::average;
    use crate::scene::Sex;

    #[test]
    fn lashes_stand_out_of_the_upper_lids_on_both_sides() {
        let figure = Figure::built_in().unwrap();
        for age_years in [2.0, 30.0, 85.0] {
            let body = crate::scene::Body { age_years, ..average(Sex::Female) };
            let rest = rest_body(&figure, &body, &[]).unwrap();
            let skin = Evaluated::new(&figure, &rest, GroupId::Skin, 0);
            let eyes = Evaluated::new(&figure, &rest, GroupId::Eyes, 0);
            let mut mesh = Mesh::default();
            let range = add(&mut mesh, &figure, &skin.surface(), &eyes.positions);
            let each = (ALONG_M.len() - 1) * BETWEEN + 1;
            assert_eq!(range.len(), 2 * each);
            let at = |v: u32| Vec3::from_array(mesh.positions[v as usize]);
            let front = eyes.positions.iter().map(|p| p.z).fold(f32::MIN, f32::max);
            let middle = eyes.positions.iter().sum::<Vec3>().y / eyes.positions.len() as f32;
            for (i, [left, _, tip]) in mesh.triangles.iter().map(|t| t.get()).enumerate() {
                let (root, tip) = (at(left), at(tip));
                assert!(tip.y > root.y && root.y > middle - 0.001, "{i} {root} {tip}");
                assert!(tip.z > root.z - 0.002 && root.z > front - 0.010, "{i} {root} {tip}");
                let other = at(mesh.triangles[(i + each) % (2 * each)].get()[2]);
                assert!((tip * Vec3::new(-1.0, 1.0, 1.0) - other).length() < 1e-4, "{i}");
            }
        }
    }
}
