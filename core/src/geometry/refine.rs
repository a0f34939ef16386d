//! Makes a piece of a surface ready to be cut: the triangles that count, finer where the cut runs.
//!
//! A surface and a field over its vertices flow in, a smaller surface and its field flow out.
//! Where the cut runs inside its triangles is decided in [`super::cut`].

use glam::Vec3;

use super::cut::{Surface, mix_skin};
use super::lookup::{Lookup, edge};
use crate::library::mesh::SkinVertex;

/// The part of a surface that a cut keeps, with vertices of its own and a field over them.
pub(super) struct Refined {
    render: Vec<u16>,
    uvs: Vec<f32>,
    triangles: Vec<u16>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    skin: Vec<SkinVertex>,
    /// By vertex.
    pub field: Vec<f32>,
    /// The old surface's vertices, for those that are not new.
    pub origin: Vec<u16>,
}

const NONE: u16 = u16::MAX;

impl Refined {
    /// Some triangles of a surface with their part of a field (by vertex).
    pub fn new(s: &Surface<'_>, field: &[f32], triangles: &[u32]) -> Self {
        // A closed surface has half as many vertices, and pieces have edges and seams.
        let room = triangles.len() * 2 / 3;
        let mut out = Self {
            render: Vec::with_capacity(room),
            uvs: Vec::with_capacity(2 * room),
            triangles: Vec::with_capacity(3 * triangles.len()),
            positions: Vec::with_capacity(room),
            normals: Vec::with_capacity(room),
            skin: Vec::with_capacity(room),
            field: Vec::with_capacity(room),
            origin: Vec::with_capacity(room),
        };
        let (mut vertices, mut corners) =
            (vec![NONE; s.positions.len()], vec![NONE; s.render.len()]);
        let all = s.triangles.as_chunks::<3>().0;
        for t in triangles.iter().map(|t| all[*t as usize]) {
            for r in t {
                let slot = usize::from(r);
                if corners[slot] == NONE {
                    let v = usize::from(s.render[slot]);
                    if vertices[v] == NONE {
                        vertices[v] = out.positions.len() as u16;
                        out.positions.push(s.positions[v]);
                        out.normals.push(s.normals[v]);
                        out.skin.push(s.skin[v]);
                        out.field.push(field[v]);
                        out.origin.push(v as u16);
                    }
                    corners[slot] = out.render.len() as u16;
                    out.render.push(vertices[v]);
                    out.uvs.extend_from_slice(&s.uvs[2 * slot..2 * slot + 2]);
                }
                out.triangles.push(corners[slot]);
            }
        }
        out
    }

    /// Splits every triangle that the field's zero crosses into four, so that the cut follows a
    /// curved line, and its neighbours at the edges they share, so that no gap opens when the
    /// surface is posed. New vertices lie on the old edges, where `between` gives the field from
    /// vertices of the old surface.
    pub fn refine(&mut self, between: impl Fn(usize, usize) -> f32) {
        let (vertices, touched) = self.split_crossed(between);
        let mut corners = Lookup::<u16>::default();
        let before = std::mem::take(&mut self.triangles);
        self.triangles.reserve(before.len() + 1024);
        for t in before.chunks_exact(3) {
            let r = [t[0], t[1], t[2]];
            let v = r.map(|r| self.render[usize::from(r)]);
            // The vertices of an edge that was split are both touched.
            if v.iter().filter(|&&v| touched[usize::from(v)]).count() < 2 {
                self.triangles.extend(r);
                continue;
            }
            let middle: [Option<u16>; 3] = std::array::from_fn(|i| {
                let j = (i + 1) % 3;
                let vertex = *vertices.get(&edge(v[i], v[j]))?;
                let key = edge(r[i], r[j]);
                let new = || self.corner(vertex, r[i].min(r[j]), r[i].max(r[j]));
                Some(*corners.entry(key).or_insert_with(new))
            });
            self.divide(r, middle);
        }
    }

    /// New vertices in the middle of all edges of crossed triangles, by edge; and which old
    /// vertices have such an edge.
    fn split_crossed(&mut self, between: impl Fn(usize, usize) -> f32) -> (Lookup<u16>, Vec<bool>) {
        let mut vertices = Lookup::default();
        let mut touched = vec![false; self.positions.len()];
        for i in 0..self.triangles.len() / 3 {
            let t = [0, 1, 2].map(|k| self.triangles[3 * i + k]);
            let v = t.map(|r| self.render[usize::from(r)]);
            let inside = v.map(|v| self.field[usize::from(v)] >= 0.0);
            if inside[0] == inside[1] && inside[1] == inside[2] {
                continue;
            }
            for i in 0..3 {
                let (a, b) = (v[i], v[(i + 1) % 3]);
                let halve = || self.split((a.min(b), a.max(b)), &between);
                vertices.entry(edge(a, b)).or_insert_with(halve);
                touched[usize::from(a)] = true;
            }
        }
        (vertices, touched)
    }

    /// A render vertex half way between two others.
    fn corner(&mut self, vertex: u16, a: u16, b: u16) -> u16 {
        self.render.push(vertex);
        for k in 0..2 {
            let (x, y) = (2 * usize::from(a) + k, 2 * usize::from(b) + k);
            self.uvs.push((self.uvs[x] + self.uvs[y]) * 0.5);
        }
        self.render.len() as u16 - 1
    }

    /// A triangle with new corners in the middle of some of its edges (first to second, second to
    /// third, third to first).
    fn divide(&mut self, [a, b, c]: [u16; 3], middle: [Option<u16>; 3]) {
        match middle {
            [None, None, None] => self.triangles.extend([a, b, c]),
            [Some(m), Some(n), Some(o)] => {
                self.triangles.extend([a, m, o, m, b, n, o, n, c, m, n, o]);
            }
            [Some(m), None, None] => self.triangles.extend([a, m, c, m, b, c]),
            [Some(m), Some(n), None] => self.triangles.extend([m, b, n, a, m, n, a, n, c]),
            // The other cases are these, turned.
            [m, n, o] => self.divide([b, c, a], [n, o, m]),
        }
    }

    fn split(&mut self, (a, b): (u16, u16), between: &impl Fn(usize, usize) -> f32) -> u16 {
        let (i, j) = (usize::from(a), usize::from(b));
        self.positions.push((self.positions[i] + self.positions[j]) * 0.5);
        self.normals.push((self.normals[i] + self.normals[j]).normalize_or(Vec3::Y));
        self.skin.push(mix_skin(self.skin[i], self.skin[j], 0.5));
        self.field.push(between(usize::from(self.origin[i]), usize::from(self.origin[j])));
        self.positions.len() as u16 - 1
    }

    pub fn surface(&self) -> Surface<'_> {
        Surface {
            render: &self.render,
            uvs: &self.uvs,
            triangles: &self.triangles,
            positions: &self.positions,
            normals: &self.normals,
            skin: &self.skin,
        }
    }
}
