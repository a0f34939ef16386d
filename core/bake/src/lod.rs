//! Levels of detail: each is a subset of the vertices of the one before.
//!
//! Simplified by meshoptimizer on the template, in a space where the head is drawn larger, so
//! that faces keep their share of triangles. Order: [`order`] sorts vertices so that each level
//! uses a prefix.

use figurant_core::library::figure::LOD_COUNT;
use glam::DVec3;

use crate::surface::{distance_squared, smoothstep};

/// Triangles of one level, as indices of render vertices, and its largest error in metres.
pub type Level = (Vec<[u32; 3]>, f32);

/// What to simplify.
pub struct Input<'a> {
    /// Vertex positions on the template.
    pub positions: &'a [DVec3],
    /// Vertex of each render vertex.
    pub render: &'a [u32],
    /// Triangles of render vertices.
    pub triangles: &'a [[u32; 3]],
    /// Share of the triangles that each level keeps; 0 leaves it empty.
    pub shares: [f64; LOD_COUNT],
}

/// All levels, finest first; the finest is the input itself.
pub fn levels(input: &Input<'_>) -> Vec<Level> {
    let warped: Vec<[f32; 3]> = input
        .render
        .iter()
        .map(|&v| enlarge_head(input.positions[v as usize]).as_vec3().to_array())
        .collect();
    let mut out = vec![(input.triangles.to_vec(), 0.0)];
    for share in &input.shares[1..] {
        let target = (input.triangles.len() as f64 * share) as usize * 3;
        let last = &out[out.len() - 1].0;
        let indices: Vec<u32> = last.iter().flatten().copied().collect();
        let fewer = if target == 0 {
            Vec::new()
        } else {
            meshopt::simplify_decoder(
                &indices,
                &warped,
                target,
                1.0,
                meshopt::SimplifyOptions::None,
                None,
            )
        };
        let tris: Vec<[u32; 3]> = fewer.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let error = if tris.is_empty() { 0.0 } else { largest_distance(input, &tris) };
        out.push((tris, error));
    }
    out
}

fn enlarge_head(p: DVec3) -> DVec3 {
    let center = DVec3::new(0.0, 0.74, 0.06);
    let factor = 1.0 + 1.4 * smoothstep(0.60, 0.68, p.y);
    center + (p - center) * factor
}

/// Largest distance of a vertex from the surface; the mouth's inside and the eye sockets, which
/// are hardly ever seen, do not count.
fn largest_distance(input: &Input<'_>, tris: &[[u32; 3]]) -> f32 {
    let at = |r: u32| input.positions[input.render[r as usize] as usize];
    let corners: Vec<[DVec3; 3]> = tris.iter().map(|t| t.map(at)).collect();
    let mut used = vec![false; input.positions.len()];
    for t in input.triangles.iter().flatten() {
        used[input.render[*t as usize] as usize] = true;
    }
    let mut worst = 0.0_f64;
    for (p, _) in input.positions.iter().zip(&used).filter(|(p, used)| **used && !is_cavity(**p)) {
        let mut best = f64::MAX;
        for c in &corners {
            // A cheap lower bound first: most triangles are far away.
            let mid = (c[0] + c[1] + c[2]) / 3.0;
            let reach = c.iter().map(|q| (*q - mid).length()).fold(0.0, f64::max);
            let gap = (*p - mid).length() - reach;
            if gap > 0.0 && gap * gap > best {
                continue;
            }
            best = best.min(distance_squared(*p, *c));
            if best <= worst * worst {
                break;
            }
        }
        worst = worst.max(best.sqrt());
    }
    worst as f32
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
