//! Skin: model space to view space, by linear blend skinning or by one rigid transform.
//!
//! Reads meshes, the palette and the objects' transforms; writes placed vertices and their
//! projection into the camera. Object after object, each padded to a multiple of eight vertices.

use rayon::prelude::*;

use super::project::{Projection, ScreenVertex, Vertex};
use super::simd::{F32x8, LANES, Level, Vec3x8, kernel};
use crate::draw::DrawList;
use crate::engine::EngineError;
use crate::library::mesh::{Mesh, SkinVertex};

/// Vertices that one thread takes at a time, a multiple of eight.
const BATCH: usize = 4096;

/// A transform by columns: three axes and the translation; the fourth number pads.
pub(super) type Columns = [[f32; 4]; 4];

/// Placed and projected vertices of all objects.
#[derive(Default)]
pub(super) struct Placed {
    /// View space.
    pub(super) vertices: Vec<Vertex>,
    /// Camera projection.
    pub(super) screen: Vec<ScreenVertex>,
    /// First vertex of each object, then the end of the last.
    pub(super) first_vertex: Vec<usize>,
    /// Whether an object's transform turns its triangles inside out.
    pub(super) mirrored: Vec<bool>,
    /// How far each vertex goes until the shutter closes, view space; of what moves alone.
    pub(super) ways: Vec<[f32; 3]>,
    palette: Vec<Columns>,
}

/// How the vertices of an object are moved.
pub(super) enum Motion<'a> {
    /// Transform of positions and of normals.
    Rigid(Columns, Columns),
    /// Palette and joints of each vertex.
    Skinned(&'a [Columns], &'a [SkinVertex]),
}

/// One thread's share.
struct Batch<'a> {
    object: u32,
    first: usize,
    vertices: &'a mut [Vertex],
    screen: &'a mut [ScreenVertex],
}

impl Placed {
    /// Places the vertices of all objects that `wanted` names; of the others only room is kept.
    pub(super) fn place(
        &mut self,
        level: Level,
        list: &DrawList,
        projection: &Projection,
        wanted: &[bool],
        with_normals: bool,
    ) -> Result<(), EngineError> {
        self.lay_out(list, wanted);
        self.palette.clear();
        self.palette.extend(list.palette.iter().map(columns));
        let palette = &self.palette;
        // Cutouts need texture coordinates, which come with the normals.
        let mut whole = vec![with_normals; list.objects.len()];
        for draw in list.draws.iter().filter(|draw| draw.cutout.is_some()) {
            whole[draw.object as usize] = true;
        }
        let batches = batches(&self.first_vertex, &mut self.vertices, &mut self.screen);
        let bad = batches
            .into_par_iter()
            .filter_map(|batch| {
                let object = &list.objects[batch.object as usize];
                let motion = if object.mesh.skin.is_empty() {
                    Motion::Rigid(
                        columns(&object.view_from_model),
                        normal_columns(&object.view_from_model),
                    )
                } else {
                    let range = object.palette.start as usize..object.palette.end as usize;
                    Motion::Skinned(&palette[range], &object.mesh.skin)
                };
                let (mesh, first) = (&*object.mesh, batch.first);
                let finite = if whole[batch.object as usize] {
                    move_all::<true>(
                        level,
                        mesh,
                        &motion,
                        first,
                        projection,
                        batch.vertices,
                        batch.screen,
                    )
                } else {
                    move_all::<false>(
                        level,
                        mesh,
                        &motion,
                        first,
                        projection,
                        batch.vertices,
                        batch.screen,
                    )
                };
                (!finite).then_some(batch.object)
            })
            .min();
        match bad {
            Some(object) => Err(EngineError::NotFinite { object, what: "a placed vertex" }),
            None => Ok(()),
        }
    }

    /// Finds how far the placed vertices of the wanted objects go until the shutter closes.
    pub(super) fn take_ways(
        &mut self,
        list: &DrawList,
        wanted: &[bool],
    ) -> Result<(), EngineError> {
        self.ways.resize(self.vertices.len(), [0.0; 3]);
        let (palette, mut rest) = (&self.palette, &mut self.ways[..]);
        let mut batches = Vec::new();
        for (object, span) in self.first_vertex.windows(2).enumerate() {
            let (own, after) = rest.split_at_mut(span[1] - span[0]);
            rest = after;
            if let Some(end) = list.objects[object].end.as_ref().filter(|_| wanted[object]) {
                let parts =
                    self.vertices[span[0]..span[1]].chunks(BATCH).zip(own.chunks_mut(BATCH));
                let firsts = (0..).step_by(BATCH);
                batches.extend(firsts.zip(parts).map(|(first, part)| (object, end, first, part)));
            }
        }
        let bad = batches
            .into_par_iter()
            .filter_map(|(object, end, first, (vertices, ways))| {
                let mesh = &*list.objects[object].mesh;
                let motion = if mesh.skin.is_empty() {
                    let columns = columns(&end.view_from_model);
                    Motion::Rigid(columns, columns)
                } else {
                    let range = end.palette.start as usize..end.palette.end as usize;
                    Motion::Skinned(&palette[range], &mesh.skin)
                };
                let finite = find_ways(mesh, &motion, first, vertices, ways);
                (!finite).then_some(object as u32)
            })
            .min();
        match bad {
            Some(object) => Err(EngineError::NotFinite { object, what: "a moved vertex" }),
            None => Ok(()),
        }
    }

    fn lay_out(&mut self, list: &DrawList, wanted: &[bool]) {
        self.first_vertex.clear();
        self.mirrored.clear();
        let mut end = 0;
        for (object, wanted) in list.objects.iter().zip(wanted) {
            self.first_vertex.push(end);
            if *wanted {
                end += object.mesh.positions.len().next_multiple_of(LANES);
            }
            let rigid = object.mesh.skin.is_empty();
            self.mirrored.push(rigid && determinant(&object.view_from_model) < 0.0);
        }
        self.first_vertex.push(end);
        // Exactly: the largest frame yet is seldom followed by one twice as large.
        self.vertices.reserve_exact(end.saturating_sub(self.vertices.len()));
        self.vertices.resize(end, Vertex::default());
        self.screen.reserve_exact(end.saturating_sub(self.screen.len()));
        self.screen.resize(end, ScreenVertex::default());
    }
}

/// Cuts the vertex buffers into batches that never span two objects.
fn batches<'a>(
    first_vertex: &[usize],
    mut vertices: &'a mut [Vertex],
    mut screen: &'a mut [ScreenVertex],
) -> Vec<Batch<'a>> {
    let mut batches = Vec::new();
    for (object, span) in first_vertex.windows(2).enumerate() {
        let count = span[1] - span[0];
        let mut first = 0;
        while first < count {
            let n = BATCH.min(count - first);
            let (v, rest_v) = vertices.split_at_mut(n);
            let (s, rest_s) = screen.split_at_mut(n);
            (vertices, screen) = (rest_v, rest_s);
            batches.push(Batch { object: object as u32, first, vertices: v, screen: s });
            first += n;
        }
    }
    batches
}

fn columns(rows: &[[f32; 4]; 3]) -> Columns {
    std::array::from_fn(|c| [rows[0][c], rows[1][c], rows[2][c], 0.0])
}

fn determinant(m: &[[f32; 4]; 3]) -> f64 {
    let d = |r: usize, c: usize| f64::from(m[r][c]);
    d(0, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1))
        - d(0, 1) * (d(1, 0) * d(2, 2) - d(1, 2) * d(2, 0))
        + d(0, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0))
}

/// The inverse transpose of the linear part but for a positive factor: its cofactors, with the
/// determinant's sign. Normals are normalised after it.
fn normal_columns(m: &[[f32; 4]; 3]) -> Columns {
    let sign = if determinant(m) < 0.0 { -1.0 } else { 1.0 };
    let largest = m.iter().flat_map(|r| &r[..3]).fold(0.0f32, |a, v| a.max(v.abs()));
    let scale = if largest > 0.0 { 1.0 / f64::from(largest) } else { 1.0 };
    let d = |r: usize, c: usize| f64::from(m[r % 3][c % 3]) * scale;
    let cofactor = |r: usize, c: usize| {
        (sign * (d(r + 1, c + 1) * d(r + 2, c + 2) - d(r + 1, c + 2) * d(r + 2, c + 1))) as f32
    };
    let column = |c: usize| [cofactor(0, c), cofactor(1, c), cofactor(2, c), 0.0];
    [column(0), column(1), column(2), [0.0; 4]]
}

kernel! {
    /// Moves and projects a batch; false if a result is not finite.
    fn move_all[const NORMALS: bool](
        mesh: &Mesh,
        motion: &Motion<'_>,
        first: usize,
        projection: &Projection,
        vertices: &mut [Vertex],
        screen: &mut [ScreenVertex],
    ) -> bool = move_body
}

#[inline(always)]
fn move_body<const AVX2: bool, const NORMALS: bool>(
    mesh: &Mesh,
    motion: &Motion<'_>,
    first: usize,
    projection: &Projection,
    vertices: &mut [Vertex],
    screen: &mut [ScreenVertex],
) -> bool {
    let last = mesh.positions.len() - 1;
    // Zero times anything finite: a number that is not stays visible in the sum.
    let mut zero = F32x8::<AVX2>::ZERO;
    let blocks = vertices.chunks_exact_mut(LANES).zip(screen.chunks_exact_mut(LANES));
    for (block, (vertices, screen)) in blocks.enumerate() {
        let (mut p, mut n) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for lane in 0..LANES {
            // Padding repeats the last vertex.
            let i = (first + block * LANES + lane).min(last);
            let blended;
            let (position, normal) = match motion {
                Motion::Rigid(position, normal) => (position, normal),
                Motion::Skinned(palette, skin) => {
                    blended = blend(palette, &skin[i]);
                    (&blended, &blended)
                }
            };
            let moved = transform(position, mesh.positions[i], 1.0);
            for axis in 0..3 {
                p[axis][lane] = moved[axis];
            }
            if NORMALS {
                let moved = transform(normal, mesh.normals[i].direction(), 0.0);
                for axis in 0..3 {
                    n[axis][lane] = moved[axis];
                }
            }
        }
        let position = Vec3x8::new(F32x8(p[0]), F32x8(p[1]), F32x8(p[2]));
        zero = zero + position.scale(F32x8::ZERO).dot(Vec3x8::splat([1.0; 3]));
        projection.project8(position, screen);
        let mut normal = Vec3x8::new(F32x8(n[0]), F32x8(n[1]), F32x8(n[2]));
        if NORMALS {
            normal = normal.normalized();
            zero = zero + normal.scale(F32x8::ZERO).dot(Vec3x8::splat([1.0; 3]));
        }
        for (lane, vertex) in vertices.iter_mut().enumerate() {
            let (mut uv, mut n) = ([0.0; 2], [0.0; 3]);
            if NORMALS {
                uv = mesh.uvs[(first + block * LANES + lane).min(last)];
                n = [normal.x.0[lane], normal.y.0[lane], normal.z.0[lane]];
            }
            let p = [position.x.0[lane], position.y.0[lane], position.z.0[lane]];
            *vertex = Vertex([p[0], p[1], p[2], uv[0], n[0], n[1], n[2], uv[1]]);
        }
    }
    zero.0.iter().all(|&z| z == 0.0)
}

/// How far vertices go to where a motion takes them; false if a result is not finite.
fn find_ways(
    mesh: &Mesh,
    motion: &Motion<'_>,
    first: usize,
    vertices: &[Vertex],
    ways: &mut [[f32; 3]],
) -> bool {
    let last = mesh.positions.len() - 1;
    let mut finite = true;
    for (i, (vertex, way)) in (first..).zip(vertices.iter().zip(ways)) {
        let i = i.min(last);
        let to = match motion {
            Motion::Rigid(position, _) => transform(position, mesh.positions[i], 1.0),
            Motion::Skinned(palette, skin) => {
                transform(&blend(palette, &skin[i]), mesh.positions[i], 1.0)
            }
        };
        let from = vertex.position();
        *way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        finite &= way.iter().all(|v| v.is_finite());
    }
    finite
}

/// The weighted mean of up to four transforms.
#[inline(always)]
fn blend(palette: &[Columns], skin: &SkinVertex) -> Columns {
    let mut sum = [[0.0; 4]; 4];
    for (joint, weight) in skin.joints.iter().zip(skin.weights) {
        let m = &palette[usize::from(*joint)];
        let w = f32::from(weight) / 255.0;
        for c in 0..4 {
            for r in 0..4 {
                sum[c][r] += m[c][r] * w;
            }
        }
    }
    sum
}

/// A vector through a transform; `w` is 1 for points and 0 for directions.
#[inline(always)]
fn transform(m: &Columns, v: [f32; 3], w: f32) -> [f32; 4] {
    let mut out = [0.0; 4];
    for r in 0..4 {
        out[r] = m[0][r] * v[0] + m[1][r] * v[1] + m[2][r] * v[2] + m[3][r] * w;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_stay_perpendicular_under_uneven_and_mirrored_scale() {
        let m = [[3.0, 0.5, 0.0, 1.0], [0.0, 0.25, 0.1, 2.0], [0.2, 0.0, -2.0, 3.0]];
        let (position, normal) = (columns(&m), normal_columns(&m));
        let (a, b) = ([1.0, 2.0, -1.0], [0.5, -1.0, 2.0]);
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let moved = transform(&normal, cross(a, b), 0.0);
        for tangent in [a, b] {
            let t = transform(&position, tangent, 0.0);
            let dot: f32 = (0..3).map(|i| moved[i] * t[i]).sum();
            assert!(dot.abs() < 1e-5, "{dot}");
        }
        // Points on the outer side stay on the outer side, also when mirrored.
        assert!(determinant(&m) < 0.0);
        let out = transform(&position, cross(a, b), 0.0);
        assert!((0..3).map(|i| moved[i] * out[i]).sum::<f32>() > 0.0);
    }
}
