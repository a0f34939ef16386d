//! What is the same for everybody about a group's vertices: which ones triangles join.
//!
//! A group and a level of detail flow in; tables flow out that every person of that level reads.
//! Where the vertices of one person are is not known here.

use super::data::Group;

/// The vertices of a group at one level of detail as a net.
#[derive(Debug)]
pub struct Net {
    /// Corners of the level's triangles by vertex, where the group has them by render vertex.
    pub triangles: Vec<[u16; 3]>,
    /// First neighbour of each vertex, then the end of the last one's.
    start: Vec<u32>,
    neighbours: Vec<Neighbour>,
}

/// A vertex next to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Which one.
    pub vertex: u32,
    /// Its weight in the mean of the other's neighbours: those that share two triangles with it
    /// count twice. The weights of one vertex sum to 1.
    pub share: f32,
}

impl Net {
    /// The net of a level of detail.
    pub(super) fn new(group: &Group, lod: usize) -> Self {
        let level = &group.lods[lod];
        let triangles: Vec<[u16; 3]> = level
            .triangles
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]].map(|r| group.render[usize::from(r)]))
            .collect();
        let mut pairs: Vec<(u16, u16)> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (a, c), (b, c), (b, a), (c, a), (c, b)])
            .collect();
        pairs.sort_unstable();
        let mut start = Vec::with_capacity(level.vertices as usize + 1);
        let mut neighbours = Vec::with_capacity(pairs.len() / 2);
        let mut rest = &pairs[..];
        for vertex in 0..level.vertices {
            start.push(neighbours.len() as u32);
            let own = rest.partition_point(|p| u32::from(p.0) <= vertex);
            let (here, after) = rest.split_at(own);
            rest = after;
            for run in here.chunk_by(|a, b| a == b) {
                let share = run.len() as f32 / here.len() as f32;
                neighbours.push(Neighbour { vertex: u32::from(run[0].1), share });
            }
        }
        start.push(neighbours.len() as u32);
        Self { triangles, start, neighbours }
    }

    /// The neighbours of a vertex, ascending; none if no triangle has it.
    #[must_use]
    pub fn around(&self, vertex: usize) -> &[Neighbour] {
        &self.neighbours[self.start[vertex] as usize..self.start[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::figure::data::Lod;

    #[test]
    fn neighbours_count_as_often_as_they_share_a_triangle() {
        // Two triangles over the edge from 0 to 1, which a texture seam parts; 4 stands alone.
        let group = Group {
            count: 5,
            render: vec![0, 1, 2, 3, 4, 0],
            lods: vec![Lod {
                vertices: 5,
                render: 6,
                triangles: vec![0, 1, 2, 1, 5, 3],
                ..Lod::default()
            }],
            ..Group::default()
        };
        let net = Net::new(&group, 0);
        assert_eq!(net.triangles, [[0, 1, 2], [1, 0, 3]]);
        let near = |v: usize| net.around(v).iter().map(|n| (n.vertex, n.share)).collect::<Vec<_>>();
        assert_eq!(near(0), [(1, 0.5), (2, 0.25), (3, 0.25)]);
        assert_eq!(near(2), [(0, 0.5), (1, 0.5)]);
        assert_eq!(near(4), []);
    }
}
