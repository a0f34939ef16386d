//! Cuts surfaces along the zero of a field and collects the pieces of a person into one mesh.
//!
//! A cut is exact: triangles that the zero line crosses are clipped, new vertices interpolate
//! everything, skin weights included. Hems get a small rim turned inwards, so that cloth has a
//! thickness. What is cut where is decided by the callers.

use std::ops::Range;

use glam::{Vec3, Vec3A};

use super::lookup::{Lookup, edge};
use crate::library::figure::Net;
use crate::library::mesh::{Mesh, SkinVertex, Triangle};

/// A surface to be cut: vertices of a group's prefix and triangles of its render vertices.
pub(super) struct Surface<'a> {
    /// Vertex of each render vertex.
    pub render: &'a [u16],
    /// Texture coordinates of the render vertices, u then v.
    pub uvs: &'a [f32],
    /// Three render vertices a triangle.
    pub triangles: &'a [u16],
    /// Metres, by vertex.
    pub positions: &'a [Vec3],
    /// Unit, by vertex.
    pub normals: &'a [Vec3],
    /// By vertex.
    pub skin: &'a [SkinVertex],
}

/// Smooth unit normals of vertices, weighted by area; +Y where no triangle is.
pub(super) fn smooth_normals(positions: &[Vec3], render: &[u16], triangles: &[u16]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for t in triangles.chunks_exact(3) {
        let [a, b, c] = [t[0], t[1], t[2]].map(|r| usize::from(render[usize::from(r)]));
        let n = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
        sums[a] += n;
        sums[b] += n;
        sums[c] += n;
    }
    sums.iter().map(|n| n.normalize_or(Vec3::Y)).collect()
}

/// The same of the vertices of some of a net's triangles; +Y elsewhere.
pub(super) fn normals_within(positions: &[Vec3], net: &Net, triangles: &[u32]) -> Vec<Vec3> {
    let mut wanted = vec![false; positions.len()];
    for t in triangles {
        net.triangles[*t as usize].iter().for_each(|&v| wanted[usize::from(v)] = true);
    }
    let near = net.triangles.iter().filter(|t| t.iter().any(|&v| wanted[usize::from(v)]));
    normals_of(positions, near, &wanted)
}

/// Smooth unit normals of all of a net's vertices.
pub(super) fn net_normals(positions: &[Vec3], net: &Net) -> Vec<Vec3> {
    normals_of(positions, net.triangles.iter(), &vec![true; positions.len()])
}

/// Smooth unit normals of the vertices that are wanted, from all triangles round them; +Y elsewhere.
pub(super) fn normals_of<'a>(
    positions: &[Vec3],
    triangles: impl Iterator<Item = &'a [u16; 3]>,
    wanted: &[bool],
) -> Vec<Vec3> {
    // Vectors of four numbers are added at once.
    let points: Vec<Vec3A> = positions.iter().map(|p| Vec3A::from(*p)).collect();
    let mut sums = vec![Vec3A::ZERO; points.len()];
    for t in triangles {
        let [a, b, c] = t.map(usize::from);
        let n = (points[b] - points[a]).cross(points[c] - points[a]);
        sums[a] += n;
        sums[b] += n;
        sums[c] += n;
    }
    let unit = |(n, wanted): (&Vec3A, &bool)| match wanted {
        true => Vec3::from(*n).normalize_or(Vec3::Y),
        false => Vec3::Y,
    };
    sums.iter().zip(wanted).map(unit).collect()
}

/// A hem's rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rim {
    /// How far it turns inwards, metres.
    pub thickness_m: f32,
    /// Two strips, the first half round, instead of one.
    pub round: bool,
}

/// A growing mesh.
#[derive(Default)]
pub(super) struct Builder {
    pub mesh: Mesh,
    /// Mesh vertex of each render vertex of the surface in hand.
    known: Vec<u32>,
}

const UNKNOWN: u32 = u32::MAX;

impl Builder {
    fn start(&mut self, render: usize) -> u32 {
        self.known.clear();
        self.known.resize(render, UNKNOWN);
        self.mesh.triangles.len() as u32
    }

    fn push(&mut self, p: Vec3, n: Vec3, uv: [f32; 2], s: SkinVertex) -> u32 {
        self.mesh.skin.push(s);
        self.mesh.push(p.to_array(), n.to_array(), uv)
    }

    fn keep(&mut self, s: &Surface<'_>, r: u16) -> u32 {
        let slot = usize::from(r);
        if self.known[slot] == UNKNOWN {
            let v = usize::from(s.render[slot]);
            let uv = [s.uvs[2 * slot], s.uvs[2 * slot + 1]];
            self.known[slot] = self.push(s.positions[v], s.normals[v], uv, s.skin[v]);
        }
        self.known[slot]
    }

    /// An empty mesh with room for about so many vertices and twice as many triangles.
    pub fn with_room(vertices: usize) -> Self {
        let mesh = Mesh {
            positions: Vec::with_capacity(vertices),
            normals: Vec::with_capacity(vertices),
            uvs: Vec::with_capacity(vertices),
            skin: Vec::with_capacity(vertices),
            triangles: Vec::with_capacity(2 * vertices),
            ..Mesh::default()
        };
        Self { mesh, known: Vec::new() }
    }

    /// Adds some triangles of a surface as they are; returns their range.
    pub fn add_whole(
        &mut self,
        s: &Surface<'_>,
        triangles: impl Iterator<Item = u32>,
    ) -> Range<u32> {
        let first = self.start(s.render.len());
        let corners = s.triangles.as_chunks::<3>().0;
        for t in triangles {
            let tri = corners[t as usize].map(|r| self.keep(s, r));
            self.mesh.triangles.push(Triangle::new(tri));
        }
        first..self.mesh.triangles.len() as u32
    }

    /// Adds the part of a surface where `field` (by vertex) is not negative.
    pub fn add_cut(&mut self, s: &Surface<'_>, field: &[f32], rim: Option<Rim>) -> Range<u32> {
        let first = self.start(s.render.len());
        let mut cuts = Lookup::<u32>::default();
        let mut hems = Vec::new();
        for t in s.triangles.chunks_exact(3) {
            let r = [t[0], t[1], t[2]];
            let f = r.map(|r| field[usize::from(s.render[usize::from(r)])]);
            let inside = f.map(|f| f >= 0.0);
            match inside.iter().filter(|i| **i).count() {
                0 => {}
                3 => {
                    let tri = r.map(|r| self.keep(s, r));
                    self.mesh.triangles.push(Triangle::new(tri));
                }
                kept => {
                    // The odd corner comes first; the order round the triangle is kept.
                    let odd = (0..3).find(|&i| inside[i] == (kept == 1)).unwrap_or(0);
                    let [a, b, c] = [odd, (odd + 1) % 3, (odd + 2) % 3].map(|i| r[i]);
                    let [fa, fb, fc] = [odd, (odd + 1) % 3, (odd + 2) % 3].map(|i| f[i]);
                    let p = self.cut(s, &mut cuts, (a, fa), (b, fb));
                    let q = self.cut(s, &mut cuts, (a, fa), (c, fc));
                    if kept == 1 {
                        let a = self.keep(s, a);
                        self.mesh.triangles.push(Triangle::new([a, p, q]));
                        hems.push([
                            (p, geometry_key(s, t, odd, 1)),
                            (q, geometry_key(s, t, odd, 2)),
                        ]);
                    } else {
                        let (b, c) = (self.keep(s, b), self.keep(s, c));
                        self.mesh.triangles.extend([[b, c, p], [c, q, p]].map(Triangle::new));
                        hems.push([
                            (q, geometry_key(s, t, odd, 2)),
                            (p, geometry_key(s, t, odd, 1)),
                        ]);
                    }
                }
            }
        }
        if let Some(rim) = rim {
            self.add_rim(&hems, rim);
        }
        first..self.mesh.triangles.len() as u32
    }

    /// The point of an edge where the field is 0; the same for both triangles of the edge.
    fn cut(
        &mut self,
        s: &Surface<'_>,
        cuts: &mut Lookup<u32>,
        a: (u16, f32),
        b: (u16, f32),
    ) -> u32 {
        let ((a, fa), (b, fb)) = if a.0 < b.0 { (a, b) } else { (b, a) };
        if let Some(&known) = cuts.get(&edge(a, b)) {
            return known;
        }
        let t = fa / (fa - fb);
        let (i, j) = (usize::from(s.render[usize::from(a)]), usize::from(s.render[usize::from(b)]));
        let (ua, ub) = (2 * usize::from(a), 2 * usize::from(b));
        let uv = [0, 1].map(|k| s.uvs[ua + k] + (s.uvs[ub + k] - s.uvs[ua + k]) * t);
        let new = self.push(
            s.positions[i] + (s.positions[j] - s.positions[i]) * t,
            (s.normals[i] + (s.normals[j] - s.normals[i]) * t).normalize_or(Vec3::Y),
            uv,
            mix_skin(s.skin[i], s.skin[j], t),
        );
        cuts.insert(edge(a, b), new);
        new
    }

    /// Strips along the hems' edges, each running with the cloth on its left seen from outside.
    fn add_rim(&mut self, hems: &[[(u32, u32); 2]], rim: Rim) {
        let at = |m: &Mesh, v: u32| Vec3::from_array(m.positions[v as usize]);
        let normal = |m: &Mesh, v: u32| Vec3::from_array(m.normals[v as usize].unit());
        // Directions out of the cloth, summed over the edges that meet in a point of the hem (by
        // the shell's vertices, so that texture seams do not part them).
        let mut out = Lookup::<Vec3>::default();
        for &[(p, kp), (q, kq)] in hems {
            let along = at(&self.mesh, q) - at(&self.mesh, p);
            let d = along.cross(normal(&self.mesh, p) + normal(&self.mesh, q));
            for key in [kp, kq] {
                *out.entry(key).or_default() += d;
            }
        }
        let mut rings = Lookup::<[u32; 2]>::default();
        for &[(p, kp), (q, kq)] in hems {
            let [a, b] = [(p, kp), (q, kq)].map(|(v, key)| {
                if let Some(&known) = rings.get(&v) {
                    return known;
                }
                let (x, n) = (at(&self.mesh, v), normal(&self.mesh, v));
                let d = out.get(&key).copied().unwrap_or(n).normalize_or(n);
                let (uv, s) = (self.mesh.uvs[v as usize], self.mesh.skin[v as usize]);
                let t = rim.thickness_m;
                let middle =
                    if rim.round { self.push(x + (d - n) * (0.5 * t), d, uv, s) } else { v };
                let inner = if rim.round { -n } else { d };
                let ring = [middle, self.push(x - n * t, inner, uv, s)];
                rings.insert(v, ring);
                ring
            });
            if rim.round {
                self.mesh.triangles.extend([[p, a[0], b[0]], [p, b[0], q]].map(Triangle::new));
            }
            self.mesh.triangles.extend([[a[0], a[1], b[1]], [a[0], b[1], b[0]]].map(Triangle::new));
        }
    }
}

/// Key of the vertices of the cut edge between the odd corner and the one `step` after it.
fn geometry_key(s: &Surface<'_>, t: &[u16], odd: usize, step: usize) -> u32 {
    edge(s.render[usize::from(t[odd])], s.render[usize::from(t[(odd + step) % 3])])
}

/// The four largest joints of two weighted sets, in 1/255 again.
pub(super) fn mix_skin(a: SkinVertex, b: SkinVertex, t: f32) -> SkinVertex {
    if a == b {
        return a;
    }
    let mut all = [(0u8, 0.0f32); 8];
    let mut n = 0;
    for (s, share) in [(a, 1.0 - t), (b, t)] {
        for (&j, &w) in s.joints.iter().zip(&s.weights).filter(|w| *w.1 > 0) {
            let w = f32::from(w) * share;
            if let Some(slot) = all[..n].iter_mut().find(|s| s.0 == j) {
                slot.1 += w;
            } else {
                all[n] = (j, w);
                n += 1;
            }
        }
    }
    all[..n].sort_by(|x, y| y.1.total_cmp(&x.1).then(x.0.cmp(&y.0)));
    let kept = n.min(4);
    let sum: f32 = all[..kept].iter().map(|s| s.1).sum();
    let mut out = SkinVertex::default();
    let mut left = 255u8;
    for (i, &(j, w)) in all[..kept].iter().enumerate().rev() {
        let units = if i == 0 { left } else { ((w / sum * 255.0 + 0.5) as u8).min(left) };
        (out.joints[i], out.weights[i]) = (j, units);
        left -= units;
    }
    out
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::geometry::refine::Refined;

    /// A strip of squares in the plane z = 0, x from 0 to n, y from 0 to 1.
    fn strip(n: u16) -> (Vec<Vec3>, Vec<u16>, Vec<u16>) {
        let positions =
            (0..=n).flat_map(|i| [0.0, 1.0].map(|y| Vec3::new(f32::from(i), y, 0.0))).collect();
        let triangles = (0..n)
            .flat_map(|i| {
                let a = 2 * i;
                [a, a + 2, a + 3, a, a + 3, a + 1]
            })
            .collect();
        (positions, (0..2 * n + 2).collect(), triangles)
    }

    fn cut(field: impl Fn(Vec3) -> f32, rim: Option<Rim>) -> Mesh {
        let (positions, render, triangles) = strip(4);
        let normals = smooth_normals(&positions, &render, &triangles);
        let skin: Vec<SkinVertex> = (0..10)
            .map(|i| SkinVertex { joints: [i, i + 1, 0, 0], weights: [200, 55, 0, 0] })
            .collect();
        let uvs: Vec<f32> = positions.iter().flat_map(|p| [p.x, p.y]).collect();
        let f: Vec<f32> = positions.iter().map(|&p| field(p)).collect();
        let mut b = Builder::default();
        let s = Surface {
            render: &render,
            uvs: &uvs,
            triangles: &triangles,
            positions: &positions,
            normals: &normals,
            skin: &skin,
        };
        b.add_cut(&s, &f, rim);
        b.mesh
    }

    fn area(m: &Mesh) -> f32 {
        m.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.get().map(|v| Vec3::from_array(m.positions[v as usize]));
                (b - a).cross(c - a).z * 0.5
            })
            .sum()
    }

    #[test]
    fn a_cut_keeps_exactly_the_area_on_its_side() {
        // A slanted line from (1.25, 0) to (1.75, 1): the trapezium left of it.
        let m = cut(|p| 1.25 + 0.5 * p.y - p.x, None);
        assert!((area(&m) - 1.5).abs() < 1e-5, "{}", area(&m));
        for (p, uv) in m.positions.iter().zip(&m.uvs) {
            assert!((p[0] - uv[0]).abs() < 1e-5 && (p[1] - uv[1]).abs() < 1e-5);
            assert!(p[0] <= 1.25 + 0.5 * p[1] + 1e-5);
        }
        assert!(m.skin.iter().all(|s| s.weights.iter().map(|&w| u32::from(w)).sum::<u32>() == 255));
    }

    #[test]
    fn a_refined_surface_has_no_gaps_and_follows_a_curve() {
        let (positions, render, triangles) = strip(4);
        let normals = smooth_normals(&positions, &render, &triangles);
        let skin = vec![SkinVertex { joints: [0; 4], weights: [255, 0, 0, 0] }; 10];
        let uvs: Vec<f32> = positions.iter().flat_map(|p| [p.x, p.y]).collect();
        // A parabola: the finer the cut, the nearer the area to its integral 1.5 + 1/3.
        let curve = |p: Vec3| 1.5 + p.y * p.y - p.x;
        let field: Vec<f32> = positions.iter().map(|&p| curve(p)).collect();
        let s = Surface {
            render: &render,
            uvs: &uvs,
            triangles: &triangles,
            positions: &positions,
            normals: &normals,
            skin: &skin,
        };
        // Field values say which triangles are kept: here all.
        let mut fine = Refined::new(&s, &field, &[0, 1, 2, 3, 4, 5, 6, 7]);
        fine.refine(|a, b| curve((positions[a] + positions[b]) * 0.5));
        let surface = fine.surface();
        let mut edges = BTreeMap::<[u16; 2], i32>::new();
        let mut whole = 0.0;
        for t in surface.triangles.chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { -1 };
            }
            let [a, b, c] = [t[0], t[1], t[2]].map(|r| surface.positions[usize::from(r)]);
            whole += (b - a).cross(c - a).z * 0.5;
        }
        assert!((whole - 4.0).abs() < 1e-5);
        // Every inner edge is used once each way: what is left is the strip's outline.
        for ([a, b], _) in edges.into_iter().filter(|e| e.1 != 0) {
            let [p, q] = [a, b].map(|r| surface.positions[usize::from(r)]);
            let same = |f: fn(Vec3) -> f32, x: f32| f(p) == x && f(q) == x;
            assert!(
                same(|p| p.y, 0.0)
                    || same(|p| p.y, 1.0)
                    || same(|p| p.x, 0.0)
                    || same(|p| p.x, 4.0)
            );
        }
        let area_of = |s: &Surface<'_>, f: &[f32]| {
            let mut b = Builder::default();
            b.add_cut(s, f, None);
            area(&b.mesh)
        };
        let exact = 1.5 + 1.0 / 3.0;
        let (coarse, refined) = (area_of(&s, &field), area_of(&surface, &fine.field));
        assert!((refined - exact).abs() < 0.5 * (coarse - exact).abs(), "{coarse} {refined}");
    }

    #[test]
    fn a_rim_points_out_of_the_cloth_and_turns_inwards() {
        let m = cut(|p| 2.5 - p.x, Some(Rim { thickness_m: 0.1, round: true }));
        let farthest = m.positions.iter().map(|p| p[0]).fold(f32::MIN, f32::max);
        assert!((farthest - 2.55).abs() < 1e-5, "{farthest}");
        let deepest = m.positions.iter().map(|p| p[2]).fold(f32::MAX, f32::min);
        assert!((deepest + 0.1).abs() < 1e-5, "{deepest}");
        // Seen from outside the opening the rim's faces are front faces.
        for t in &m.triangles {
            let [a, b, c] = t.get().map(|v| Vec3::from_array(m.positions[v as usize]));
            let n = (b - a).cross(c - a);
            assert!(n.z > 0.0 || n.x > 0.0, "{n}");
        }
    }

    #[test]
    fn mixed_weights_keep_the_largest_and_sum_to_255() {
        let a = SkinVertex { joints: [1, 2, 3, 4], weights: [100, 80, 50, 25] };
        let b = SkinVertex { joints: [5, 2, 6, 7], weights: [120, 100, 30, 5] };
        let m = mix_skin(a, b, 0.5);
        assert_eq!(m.joints[0], 2);
        assert_eq!(m.weights.iter().map(|&w| u32::from(w)).sum::<u32>(), 255);
        assert_eq!(mix_skin(a, b, 0.0), a);
    }
}
