//! The body as hair meets it: a distance and a normal anywhere near the skin.
//!
//! An implicit surface through the vertices of a coarse level of the skin: the weighted mean of the
//! distances to their tangent planes, near ones counting most (after Kolluri, "Provably good moving
//! least squares", SODA 2005). A coarse level of the skin serves the finer ones as well, so that hair
//! hangs alike on them.

use glam::Vec3;

use super::scalp::Frame;
use crate::geometry::cut::net_normals;
use crate::geometry::wide::wide;
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
    /// The samples' places and normals, axis by axis, and some that pad: eight are read at a time.
    places: [Vec<f32>; 3],
    normals: [Vec<f32>; 3],
}

const LANES: usize = 8;

impl Near {
    /// Skin above a height on the template, from the skin's vertices at a level of detail, pushed out
    /// by what clothes take at a place on the template.
    pub fn new(
        figure: &Figure,
        frame: &Frame,
        lod: usize,
        skin: &[Vec3],
        above_y: f32,
        clothes_m: &dyn Fn(Vec3) -> f32,
    ) -> Self {
        let lod = lod.max(FINEST);
        let group = figure.group(GroupId::Skin);
        let level = &group.lods[lod];
        let at = &skin[..level.vertices as usize];
        let net = figure.net(GroupId::Skin, lod);
        let normals = net_normals(at, net);
        let mut used = vec![false; at.len()];
        net.triangles.as_flattened().iter().for_each(|v| used[usize::from(*v)] = true);
        let t = figure.template();
        let mut samples = Vec::new();
        for (i, v) in figure.vertices(GroupId::Skin, level.vertices).enumerate() {
            let q = Vec3::new(t.x[v], t.y[v], t.z[v]);
            let n = normals[i];
            if used[i] && q.y > above_y && !is_inside(q) && !faces_the_head(q, n) {
                samples.push(Sample { p: at[i] + n * clothes_m(q), n });
            }
        }
        Self::sorted(samples, CELL_M[lod] * frame.scale)
    }

    fn sorted(samples: Vec<Sample>, cell_m: f32) -> Self {
        let low = samples.iter().fold(Vec3::splat(f32::MAX), |a, s| a.min(s.p));
        let high = samples.iter().fold(Vec3::splat(f32::MIN), |a, s| a.max(s.p));
        let size = ((high - low) / cell_m).to_array().map(|x| (x.max(0.0) as usize).min(255) + 1);
        let (places, normals) = Default::default();
        let mut out = Self { low, cell_m, size, start: Vec::new(), places, normals };
        let cell = |s: &Sample| out.index(out.cell(s.p).map(|x| x as usize));
        let mut keyed: Vec<(usize, Sample)> = samples.into_iter().map(|s| (cell(&s), s)).collect();
        keyed.sort_by_key(|k| k.0);
        let count = size.iter().product::<usize>();
        let start = (0..=count).map(|c| keyed.partition_point(|k| k.0 < c) as u32).collect();
        out.start = start;
        for axis in 0..3 {
            let padded = |of: fn(&Sample) -> Vec3| {
                let own = keyed.iter().map(|k| of(&k.1)[axis]);
                own.chain([0.0; LANES]).collect()
            };
            out.places[axis] = padded(|s| s.p);
            out.normals[axis] = padded(|s| s.n);
        }
        out
    }

    fn cell(&self, p: Vec3) -> [i32; 3] {
        let c = ((p - self.low) / self.cell_m).to_array().map(|x| {
            let towards_zero = x as i32;
            towards_zero - i32::from(x < towards_zero as f32)
        });
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
        wide_within(self, p, cells)
    }

    #[inline(always)]
    fn within_body(&self, p: Vec3, cells: i32) -> Option<(f32, Vec3)> {
        let reach = self.cell_m * cells as f32;
        let (reach2, soft2) = (reach * reach, 0.1 * self.cell_m * self.cell_m);
        let center = self.cell(p);
        let mut sums = Sums::default();
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
                let mut first = from;
                while first < to {
                    self.add_eight(&mut sums, p, (first, to - first), (1.0 / reach2, soft2));
                    first += LANES;
                }
            }
        }
        let [weight, distance, x, y, z] = sums.0.map(|lanes| lanes.iter().sum::<f32>());
        let normal = Vec3::new(x, y, z);
        (weight > 0.0).then(|| (distance / weight, normal.normalize_or(Vec3::Y)))
    }

    /// Adds the samples from `first` on, at most `count` and eight, with their weights. Lanes are
    /// plain arrays that the compiler makes vectors of.
    #[inline(always)]
    fn add_eight(
        &self,
        sums: &mut Sums,
        p: Vec3,
        (first, count): (usize, usize),
        (per_reach2, soft2): (f32, f32),
    ) {
        let eight = |of: &[f32]| -> [f32; LANES] {
            let mut out = [0.0; LANES];
            out.copy_from_slice(&of[first..first + LANES]);
            out
        };
        let [x, y, z] = [0, 1, 2].map(|axis| eight(&self.places[axis]));
        let n = [0, 1, 2].map(|axis| eight(&self.normals[axis]));
        for i in 0..LANES {
            let (dx, dy, dz) = (p.x - x[i], p.y - y[i], p.z - z[i]);
            let d2 = dx * dx + dy * dy + dz * dz;
            let near = 1.0 - d2 * per_reach2;
            let counts = near > 0.0 && i < count;
            let w = if counts { near * near / (d2 + soft2) } else { 0.0 };
            sums.0[0][i] += w;
            sums.0[1][i] += w * (dx * n[0][i] + dy * n[1][i] + dz * n[2][i]);
            sums.0[2][i] += w * n[0][i];
            sums.0[3][i] += w * n[1][i];
            sums.0[4][i] += w * n[2][i];
        }
    }
}

wide! {
    fn wide_within(near: &Near, p: Vec3, cells: i32) -> Option<(f32, Vec3)> = Near::within_body
}

/// Weights, weighted distances and the weighted normals' three axes, lane by lane.
#[derive(Default)]
struct Sums([[f32; LANES]; 5]);

/// Mouth cavity and eye sockets on the template.
fn is_inside(p: Vec3) -> bool {
    let mouth = (0.64..0.71).contains(&p.y) && (0.05..0.145).contains(&p.z) && p.x.abs() < 0.030;
    mouth || p.distance(Vec3::new(p.x.signum() * 0.0308, 0.7284, 0.1235)) < 0.0155
}

/// The backs of the ears: hair lies over them, not between them and the head.
fn faces_the_head(p: Vec3, n: Vec3) -> bool {
    (0.68..0.77).contains(&p.y) && p.x.abs() > 0.070 && n.x * p.x.signum() < 0.1
}
