//! The body as hair meets it: a distance and a normal anywhere near the skin.
//!
//! An implicit surface through the vertices of a coarse level of the skin: the weighted mean of the
//! distances to their tangent planes, near ones counting most (after Kolluri, "Provably good moving
//! least squares", SODA 2005). A coarse level of the skin serves the finer ones as well, so that hair
//! hangs alike on them.

use glam::Vec3;

use super::scalp::Frame;
use crate::geometry::cut::smooth_normals;
use crate::geometry::garment::step;
use crate::library::figure::{Figure, GroupId, LOD_COUNT};

/// The finest level of the skin that hair lies on: what is finer looks no better.
const FINEST: usize = 2;
/// Distance within which vertices count, by level of detail: two to three of its edges, metres.
const CELL_M: [f32; LOD_COUNT] = [0.026, 0.026, 0.026, 0.035, 0.050];

#[derive(Clone, Copy, Debug)]
struct Sample {
    p: Vec3,
    n: Vec3,
}

/// Skin and clothes from the chest up.
pub(in crate::geometry) struct Near {
    low: Vec3,
    cell_m: f32,
    size: [usize; 3],
    /// Where each cell's samples begin.
    start: Vec<u32>,
    samples: Vec<Sample>,
}

impl Near {
    /// Skin above a height on the template, from the skin's vertices at a level of detail; below the
    /// neck it is pushed out by what clothes take.
    pub fn new(
        figure: &Figure,
        frame: &Frame,
        lod: usize,
        skin: &[Vec3],
        (above_y, clothes_m): (f32, f32),
    ) -> Self {
        let lod = lod.max(FINEST);
        let group = figure.group(GroupId::Skin);
        let level = &group.lods[lod];
        let at = &skin[..level.vertices as usize];
        let normals = smooth_normals(at, &group.render, &level.triangles);
        let mut used = vec![false; at.len()];
        for r in &level.triangles {
            used[usize::from(group.render[usize::from(*r)])] = true;
        }
        let t = figure.template();
        let mut samples = Vec::new();
        for (i, v) in figure.vertices(GroupId::Skin, level.vertices).enumerate() {
            let q = Vec3::new(t.x[v], t.y[v], t.z[v]);
            let n = normals[i];
            if used[i] && q.y > above_y && !is_inside(q) && !faces_the_head(q, n) {
                let cloth = clothes_m * step(0.60, 0.56, q.y);
                samples.push(Sample { p: at[i] + n * cloth, n });
            }
        }
        Self::sorted(samples, CELL_M[lod] * frame.scale)
    }

    fn sorted(samples: Vec<Sample>, cell_m: f32) -> Self {
        let low = samples.iter().fold(Vec3::splat(f32::MAX), |a, s| a.min(s.p));
        let high = samples.iter().fold(Vec3::splat(f32::MIN), |a, s| a.max(s.p));
        let size = ((high - low) / cell_m).to_array().map(|x| (x.max(0.0) as usize).min(255) + 1);
        let mut out = Self { low, cell_m, size, start: Vec::new(), samples: Vec::new() };
        let cell = |s: &Sample| out.index(out.cell(s.p).map(|x| x as usize));
        let mut keyed: Vec<(usize, Sample)> = samples.into_iter().map(|s| (cell(&s), s)).collect();
        keyed.sort_by_key(|k| k.0);
        let count = size.iter().product::<usize>();
        let start = (0..=count).map(|c| keyed.partition_point(|k| k.0 < c) as u32).collect();
        out.start = start;
        out.samples = keyed.into_iter().map(|k| k.1).collect();
        out
    }

    fn cell(&self, p: Vec3) -> [i32; 3] {
        let c = ((p - self.low) / self.cell_m).floor().to_array().map(|x| x as i32);
        std::array::from_fn(|i| c[i].clamp(-3, self.size[i] as i32 + 2))
    }

    const fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.size[1] + y) * self.size[2] + z
    }

    /// Distance to the surface, negative inside, and its unit normal; nothing far from it.
    pub fn surface(&self, p: Vec3) -> Option<(f32, Vec3)> {
        self.within(p, 1).or_else(|| self.within(p, 2))
    }

    /// From the samples of the cells at most so far away.
    fn within(&self, p: Vec3, cells: i32) -> Option<(f32, Vec3)> {
        let reach = self.cell_m * cells as f32;
        let (reach2, soft2) = (reach * reach, 0.1 * self.cell_m * self.cell_m);
        let center = self.cell(p);
        let (mut sum, mut distance, mut normal) = (0.0f32, 0.0f32, Vec3::ZERO);
        let ends = |i: usize| {
            let (a, b) = (center[i] - cells, center[i] + cells);
            (a.max(0) as usize, (b.min(self.size[i] as i32 - 1) + 1).max(0) as usize)
        };
        let (xs, ys, zs) = (ends(0), ends(1), ends(2));
        for x in xs.0..xs.1 {
            for y in ys.0..ys.1 {
                if zs.0 >= zs.1 {
                    continue;
                }
                let from = self.start[self.index([x, y, zs.0])] as usize;
                let to = self.start[self.index([x, y, zs.1 - 1]) + 1] as usize;
                for s in &self.samples[from..to] {
                    let away = p - s.p;
                    let d2 = away.length_squared();
                    if d2 < reach2 {
                        let near = 1.0 - d2 / reach2;
                        let w = near * near / (d2 + soft2);
                        sum += w;
                        distance += w * away.dot(s.n);
                        normal += s.n * w;
                    }
                }
            }
        }
        (sum > 0.0).then(|| (distance / sum, normal.normalize_or(Vec3::Y)))
    }
}

/// Mouth cavity and eye sockets on the template.
fn is_inside(p: Vec3) -> bool {
    let mouth = (0.64..0.71).contains(&p.y) && (0.05..0.145).contains(&p.z) && p.x.abs() < 0.030;
    mouth || p.distance(Vec3::new(p.x.signum() * 0.0308, 0.7284, 0.1235)) < 0.0155
}

/// The backs of the ears: hair lies over them, not between them and the head.
fn faces_the_head(p: Vec3, n: Vec3) -> bool {
    (0.68..0.77).contains(&p.y) && p.x.abs() > 0.070 && n.x * p.x.signum() < 0.1
}
