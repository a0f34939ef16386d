//! What of the skin can be seen, and only that of it as points.
//!
//! Clothes hide half of the skin of most people, whatever their bodies: which triangles remain
//! follows from the cuts alone, so that the others are neither shaped nor given normals. Hair lies on
//! the skin, seen or not, from a height on.

use glam::Vec3;

use super::body::RestBody;
use super::cut::normals_of;
use super::person::Evaluated;
use super::phenotype;
use crate::library::figure::{Figure, GroupId};

/// Normals of a coarse level need its vertices so far below, on the template, metres.
const EDGE_M: f32 = 0.07;
/// Vertices are shaped in blocks of so many: their deltas lie side by side in memory.
const BLOCK: usize = 64;

/// The part of the skin that is drawn at one level of detail.
pub(super) struct Shown {
    lod: usize,
    /// Triangles of the head, ascending.
    pub head: Vec<u32>,
    /// The other triangles, ascending.
    pub elsewhere: Vec<u32>,
    /// By vertex: its position and its normal are needed.
    pub wanted: Vec<bool>,
}

impl Shown {
    /// All triangles but those of which every vertex is hidden, and all vertices above a height on the
    /// template.
    pub fn new(figure: &Figure, lod: usize, hidden: &[bool], above_y: f32) -> Self {
        let net = figure.net(GroupId::Skin, lod);
        let corners = &figure.group(GroupId::Skin).lods[lod].triangles;
        let on_head = figure.on_head();
        let heights = &figure.template().y[figure.vertices(GroupId::Skin, hidden.len() as u32)];
        let mut wanted: Vec<bool> = heights.iter().map(|y| *y > above_y - EDGE_M).collect();
        let (mut head, mut elsewhere) = (Vec::new(), Vec::with_capacity(net.triangles.len()));
        for (t, (v, r)) in net.triangles.iter().zip(corners.chunks_exact(3)).enumerate() {
            let v = v.map(usize::from);
            if !v.iter().all(|&v| hidden[v]) {
                v.iter().for_each(|&v| wanted[v] = true);
                let list = if on_head[usize::from(r[0])] { &mut head } else { &mut elsewhere };
                list.push(t as u32);
            }
        }
        Self { lod, head, elsewhere, wanted }
    }

    /// The skin of a person where it is wanted; elsewhere there is nothing of use.
    pub fn evaluate<'a>(&self, figure: &'a Figure, rest: &RestBody) -> Evaluated<'a> {
        let net = figure.net(GroupId::Skin, self.lod);
        // Normals come from all triangles round a vertex.
        let mut blocks = vec![false; self.wanted.len().div_ceil(BLOCK)];
        let round = |t: &&[u16; 3]| t.iter().any(|&v| self.wanted[usize::from(v)]);
        let near: Vec<&[u16; 3]> = net.triangles.iter().filter(round).collect();
        for v in near.iter().copied().flatten() {
            blocks[usize::from(*v) / BLOCK] = true;
        }
        let range = figure.vertices(GroupId::Skin, self.wanted.len() as u32);
        let runs: Vec<_> = blocks
            .chunk_by(|a, b| a == b)
            .scan(0, |first, run| {
                let start = *first;
                *first += run.len();
                Some((run[0], start * BLOCK..(*first * BLOCK).min(range.len())))
            })
            .filter_map(|(is_wanted, run)| is_wanted.then_some(run))
            .collect();
        let positions: Vec<Vec3> = phenotype::evaluate_runs(figure, &rest.shape, range, &runs)
            .into_iter()
            .map(Vec3::from_array)
            .collect();
        let normals = normals_of(&positions, near.into_iter(), &self.wanted);
        Evaluated::of(figure, GroupId::Skin, self.lod, (positions, normals))
    }
}
