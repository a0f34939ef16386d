//! Levels of detail: each is a subset of the vertices of the one before.
//!
//! Simplified by meshoptimizer on the template, in a space where the head is drawn larger, so
//! that faces keep their share of triangles. Order: [`order`] sorts vertices so that each level
//! uses a prefix.

use std::collections::BTreeMap;

use figurant_core::library::figure::LOD_COUNT;
use glam::DVec3;

use crate::surface::{distance_squared, smoothstep};

/// Triangles of one level, as indices of render vertices, and its largest error in metres.
pub type Level = (Vec<[u32; 3]>, f32);

/// How far the levels may leave the finest surface, metres on the template. Each step down costs
/// about half the triangles.
pub const ERRORS_M: [f64; LOD_COUNT] = [0.0, 0.001, 0.002, 0.004, 0.008];

/// What to simplify.
pub struct Input<'a> {
    /// Vertex positions on the template.
    pub positions: &'a [DVec3],
    /// Vertex of each render vertex.
    pub render: &'a [u32],
    /// Triangles of render vertices.
    pub triangles: &'a [[u32; 3]],
    /// First level that is empty.
    pub end: usize,
}

/// All levels, finest first; the finest is the input itself.
pub fn levels(input: &Input<'_>) -> Vec<Level> {
    let mut out = vec![(input.triangles.to_vec(), 0.0)];
    for level in 1..LOD_COUNT {
        out.push(if level < input.end {
            within(input, &out[level - 1].0, ERRORS_M[level])
        } else {
            (Vec::new(), 0.0)
        });
    }
    out
}

/// Simplifies until no vertex is farther from the surface than `error_m`. The simplifier bounds
/// a mean, so where a vertex ends up too far away, the corners of the triangle of the last level
/// that it lies on are kept in the next attempt.
fn within(input: &Input<'_>, last: &[[u32; 3]], error_m: f64) -> Level {
    let warped: Vec<[f32; 3]> = input
        .render
        .iter()
        .map(|&v| enlarge_head(input.positions[v as usize]).as_vec3().to_array())
        .collect();
    let indices: Vec<u32> = last.iter().flatten().copied().collect();
    let on_last = nearest(input, last);
    let mut locked = vec![false; input.render.len()];
    loop {
        let fewer = meshopt::simplify_with_locks_decoder(
            &indices,
            &warped,
            &locked,
            0,
            error_m as f32,
            meshopt::SimplifyOptions::ErrorAbsolute,
            None,
        );
        let triangles: Vec<[u32; 3]> = fewer.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let mut worst_m = 0.0_f64;
        let mut more = false;
        for (before, now) in on_last.iter().zip(nearest(input, &triangles)) {
            let (Some((_, home)), Some((distance_m, _))) = (before, now) else { continue };
            worst_m = worst_m.max(distance_m);
            let Some(home) = home.filter(|_| distance_m > error_m) else { continue };
            for r in last[home] {
                more |= !std::mem::replace(&mut locked[r as usize], true);
            }
        }
        if !more {
            return (triangles, worst_m as f32);
        }
    }
}

fn enlarge_head(p: DVec3) -> DVec3 {
    let center = DVec3::new(0.0, 0.74, 0.06);
    let factor = 1.0 + 1.4 * smoothstep(0.60, 0.68, p.y);
    center + (p - center) * factor
}

/// Distance of each used vertex from a surface and the nearest triangle, if one is near; nothing
/// for the mouth's inside and the eye sockets, which are hardly ever seen.
fn nearest(input: &Input<'_>, tris: &[[u32; 3]]) -> Vec<Option<(f64, Option<usize>)>> {
    const CELL_M: f64 = 0.03;
    const FAR_M: f64 = 0.02;
    let cell = |p: DVec3| (p / CELL_M).to_array().map(|x| x.floor() as i32);
    let at = |r: u32| input.positions[input.render[r as usize] as usize];
    let corners: Vec<[DVec3; 3]> = tris.iter().map(|t| t.map(at)).collect();
    let mut near = BTreeMap::<[i32; 3], Vec<usize>>::new();
    for (i, [a, b, c]) in corners.iter().enumerate() {
        let low = cell(a.min(*b).min(*c) - FAR_M);
        let high = cell(a.max(*b).max(*c) + FAR_M);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    near.entry([x, y, z]).or_default().push(i);
                }
            }
        }
    }
    let mut out = vec![None; input.positions.len()];
    for &r in input.triangles.iter().flatten() {
        let v = input.render[r as usize] as usize;
        let p = input.positions[v];
        if is_cavity(p) || out[v].is_some() {
            continue;
        }
        let candidates = near.get(&cell(p)).map_or(&[][..], Vec::as_slice);
        let best = candidates
            .iter()
            .map(|&i| (distance_squared(p, corners[i]).sqrt(), Some(i)))
            .fold((FAR_M, None), |a, b| if b.0 < a.0 { b } else { a });
        out[v] = Some(best);
    }
    out
}

/// Mouth cavity and eye sockets on the template.
fn is_cavity(p: DVec3) -> bool {
    let mouth = p.y > 0.64 && p.y < 0.71 && p.z < 0.145 && p.z > 0.05 && p.x.abs() < 0.035;
    let eyes = (p - DVec3::new(p.x.signum() * 0.0308, 0.7284, 0.1235)).length() < 0.0155;
    mouth || eyes
}

/// For each vertex the coarsest level that uses it, or nothing if none does.
pub fn coarsest_use(count: usize, levels: &[Level]) -> Vec<Option<usize>> {
    let mut out = vec![None; count];
    for (k, (tris, _)) in levels.iter().enumerate() {
        for &v in tris.iter().flatten() {
            out[v as usize] = Some(k);
        }
    }
    out
}
