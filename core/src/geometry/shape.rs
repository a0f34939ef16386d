//! Primitive shapes as meshes.
//!
//! In: [`Shape`] and a level of detail. Out: a shared mesh inside the unit cube round the model's
//! origin, closed, with outward normals, split along hard edges. Texture coordinates follow the
//! surface's own measure, about one repeat per unit length, so that a picture keeps its
//! proportions on every shape. Placement and scale are the scene's.

use std::sync::{Arc, OnceLock};

use crate::library::mesh::{Mesh, Triangle};
use crate::scene::Shape;

/// How finely a shape is divided; each level has about a quarter of the triangles of the one above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Detail {
    /// About 50 sides, 1,500 to 3,000 triangles on curved shapes.
    High,
    /// About 24 sides.
    Medium,
    /// About 12 sides.
    Low,
}

impl Detail {
    /// All levels, finest first.
    pub const ALL: [Self; 3] = [Self::High, Self::Medium, Self::Low];

    /// Segments of a full circle, a multiple of four.
    #[must_use]
    pub const fn circle_segments(self) -> usize {
        match self {
            Self::High => 48,
            Self::Medium => 24,
            Self::Low => 12,
        }
    }
}

impl Detail {
    /// How far a circle leaves its polygon at most, as a share of the shape's size.
    #[must_use]
    pub fn chord_error(self) -> f64 {
        0.5 * (1.0 - libm::cos(std::f64::consts::PI / self.circle_segments() as f64))
    }
}

/// All shapes.
const SHAPES: [Shape; 6] =
    [Shape::Cube, Shape::Cylinder, Shape::Sphere, Shape::Capsule, Shape::Cone, Shape::Torus];

/// The mesh of a shape; made once, then shared.
#[must_use]
pub fn shape_mesh(shape: Shape, detail: Detail) -> Arc<Mesh> {
    static MESHES: OnceLock<Vec<Arc<Mesh>>> = OnceLock::new();
    let meshes = MESHES.get_or_init(|| {
        SHAPES
            .iter()
            .flat_map(|&shape| Detail::ALL.map(|detail| Arc::new(build(shape, detail))))
            .collect()
    });
    Arc::clone(&meshes[shape as usize * Detail::ALL.len() + detail as usize])
}

fn build(shape: Shape, detail: Detail) -> Mesh {
    let circle = Circle::new(detail.circle_segments());
    let mut b = Builder::default();
    match shape {
        Shape::Cube => cube(&mut b),
        Shape::Cylinder => cylinder(&mut b, &circle),
        Shape::Sphere => sphere(&mut b, 2 * (circle.segments() / 8 + 1)),
        Shape::Capsule => capsule(&mut b, &circle),
        Shape::Cone => cone(&mut b, &circle),
        Shape::Torus => torus(&mut b, &circle),
    }
    b.finish()
}

/// Cosine and sine of the corners of a regular polygon. The last corner is the first again, with
/// the same bits, and the four quarters are exact: neighbouring surfaces share their points.
struct Circle(Vec<[f64; 2]>);

impl Circle {
    fn new(segments: usize) -> Self {
        let quarter = segments / 4;
        let mut corners: Vec<[f64; 2]> = (0..quarter)
            .map(|i| {
                let angle = i as f64 / segments as f64 * std::f64::consts::TAU;
                if i == 0 { [1.0, 0.0] } else { [libm::cos(angle), libm::sin(angle)] }
            })
            .collect();
        for i in 0..segments - quarter {
            let [c, s] = corners[i];
            corners.push([-s, c]);
        }
        corners.push(corners[0]);
        Self(corners)
    }

    fn segments(&self) -> usize {
        self.0.len() - 1
    }
}

/// One corner of a surface.
#[derive(Clone, Copy)]
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
    uv: [f64; 2],
}

/// Collects surfaces.
#[derive(Default)]
struct Builder {
    mesh: Mesh,
}

impl Builder {
    fn vertex(&mut self, v: Vertex) -> u32 {
        let length = v.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        // Adding zero turns -0 into 0, so that equal points have equal bits.
        let position = v.position.map(|x| x as f32 + 0.0);
        let normal = v.normal.map(|n| (n / length) as f32);
        self.mesh.push(position, normal, v.uv.map(|x| x as f32))
    }

    /// A grid of `columns` by `rows` cells. Seen from outside, columns run to the right and rows
    /// downwards. Triangles without area, at poles, are left out.
    fn grid(&mut self, columns: usize, rows: usize, vertex: impl Fn(usize, usize) -> Vertex) {
        let first = self.mesh.positions.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                self.vertex(vertex(column, row));
            }
        }
        let at = |column: usize, row: usize| first + (row * (columns + 1) + column) as u32;
        for row in 0..rows {
            for column in 0..columns {
                let [a, b] = [at(column, row), at(column + 1, row)];
                let [c, d] = [at(column, row + 1), at(column + 1, row + 1)];
                self.triangle([a, c, d]);
                self.triangle([a, d, b]);
            }
        }
    }

    fn triangle(&mut self, t: [u32; 3]) {
        let [a, b, c] = t.map(|i| self.mesh.positions[i as usize]);
        if a != b && b != c && c != a {
            self.mesh.triangles.push(Triangle::new(t));
        }
    }

    /// A flat disc of radius 0.5 at a height, facing up (`up` = 1) or down (-1).
    fn cap(&mut self, circle: &Circle, y: f64, up: f64) {
        let at = |x: f64, z: f64| Vertex {
            position: [x, y, z],
            normal: [0.0, up, 0.0],
            uv: [0.5 + x, 0.5 + z * up],
        };
        let center = self.vertex(at(0.0, 0.0));
        let ring: Vec<u32> =
            circle.0.iter().map(|&[c, s]| self.vertex(at(0.5 * c, 0.5 * s))).collect();
        for pair in ring.windows(2) {
            let triangle =
                if up > 0.0 { [center, pair[1], pair[0]] } else { [center, pair[0], pair[1]] };
            self.triangle(triangle);
        }
    }

    /// Sets the bounding sphere, which is centred on the model's origin as all shapes are.
    fn finish(mut self) -> Mesh {
        let farthest = self
            .mesh
            .positions
            .iter()
            .map(|p| p.iter().map(|&x| f64::from(x) * f64::from(x)).sum::<f64>())
            .fold(0.0, f64::max);
        // Up to the next single-precision number, so that no vertex stands outside.
        self.mesh.radius_m = (farthest.sqrt() as f32).next_up();
        self.mesh
    }
}

/// The faces of a cube: outward normal, and the directions right and down on the face.
const CUBE_FACES: [[[f64; 3]; 3]; 6] = [
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]],
    [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
    [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
    [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
];

/// `n + s right + t down`, per axis; exact where all are 0 or +-1.
fn on_face([n, right, down]: [[f64; 3]; 3], s: f64, t: f64) -> [f64; 3] {
    std::array::from_fn(|k| n[k] + s * right[k] + t * down[k])
}

fn cube(b: &mut Builder) {
    for face in CUBE_FACES {
        b.grid(1, 1, |column, row| {
            let (u, v) = (column as f64, row as f64);
            Vertex {
                position: on_face(face, 2.0 * u - 1.0, 2.0 * v - 1.0).map(|x| 0.5 * x),
                normal: face[0],
                uv: [u, v],
            }
        });
    }
}

/// A cube blown up, lines at equal angles: no poles, and each face shows a whole picture.
/// `cells`, along an edge of the cube, is even, so that the six outermost points are vertices.
fn sphere(b: &mut Builder, cells: usize) {
    // Mirror-symmetric to the bit, so that the edges of neighbouring faces coincide.
    let line = |i: usize| -> f64 {
        let tangent =
            |steps: usize| libm::tan(std::f64::consts::FRAC_PI_4 * (steps as f64 / cells as f64));
        match i {
            0 => -1.0,
            _ if i == cells => 1.0,
            _ if 2 * i >= cells => tangent(2 * i - cells),
            _ => -tangent(cells - 2 * i),
        }
    };
    for face in CUBE_FACES {
        b.grid(cells, cells, |column, row| {
            let p = on_face(face, line(column), line(row));
            let mut squares = p.map(|x| x * x);
            // The same sum for the same point, whichever face it is reached from.
            squares.sort_by(f64::total_cmp);
            let length = (squares[0] + squares[1] + squares[2]).sqrt();
            let uv = [column, row].map(|i| i as f64 / cells as f64);
            Vertex { position: p.map(|x| 0.5 * (x / length)), normal: p, uv }
        });
    }
}

fn cylinder(b: &mut Builder, circle: &Circle) {
    let n = circle.segments();
    b.grid(n, 1, |column, row| {
        // Seen from outside, the angle from x towards z grows to the left.
        let [c, s] = circle.0[n - column];
        Vertex {
            position: [0.5 * c, 0.5 - row as f64, 0.5 * s],
            normal: [c, 0.0, s],
            // Three repeats round a circumference of 3.14.
            uv: [3.0 * column as f64 / n as f64, row as f64],
        }
    });
    b.cap(circle, 0.5, 1.0);
    b.cap(circle, -0.5, -1.0);
}

/// Two half spheres of radius 0.25 and a tube of length 0.5.
fn capsule(b: &mut Builder, circle: &Circle) {
    const RADIUS: f64 = 0.25;
    let n = circle.segments();
    let quarter = n / 4;
    let rows = 2 * quarter + 1;
    b.grid(n, rows, |column, row| {
        let [c, s] = circle.0[n - column];
        // Sine and cosine of the angle from the pole; row `quarter` and the next are the tube.
        let (step, middle_y) = if row <= quarter { (row, 0.25) } else { (row - 1, -0.25) };
        let [cos, sin] = circle.0[step];
        let along = RADIUS * std::f64::consts::TAU * (step as f64 / n as f64)
            + if row <= quarter { 0.0 } else { 0.5 };
        Vertex {
            position: [RADIUS * sin * c, middle_y + RADIUS * cos, RADIUS * sin * s],
            normal: [sin * c, cos, sin * s],
            // Two repeats round the circumference, the same measure along it.
            uv: [2.0 * column as f64 / n as f64, along * 2.0 / (std::f64::consts::TAU * RADIUS)],
        }
    });
}

/// The mantle unrolls to a sector, so its texture is nowhere stretched.
fn cone(b: &mut Builder, circle: &Circle) {
    const SLANT: f64 = 1.118_033_988_749_895; // sqrt(0.5^2 + 1^2)
    let n = circle.segments();
    let rows = (n / 8).max(2);
    let sector = std::f64::consts::TAU * 0.5 / SLANT;
    b.grid(n, rows, |column, row| {
        let [c, s] = circle.0[n - column];
        let t = row as f64 / rows as f64;
        // The tip has no normal of its own; there each triangle takes that of its middle.
        let [nc, ns] = if row == 0 {
            let half = (n - column) as f64 - 0.5;
            let angle = half / n as f64 * std::f64::consts::TAU;
            [libm::cos(angle), libm::sin(angle)]
        } else {
            [c, s]
        };
        let at_tip = if row == 0 { 0.5 } else { 0.0 };
        let turn = ((column as f64 + at_tip) / n as f64 - 0.5) * sector;
        Vertex {
            position: [0.5 * t * c, 0.5 - t, 0.5 * t * s],
            normal: [nc, 0.5, ns],
            uv: [0.5 + SLANT * t * libm::sin(turn), SLANT * t * libm::cos(turn)],
        }
    });
    b.cap(circle, -0.5, -1.0);
}

/// Radius of the middle line 0.35, of the tube 0.15.
fn torus(b: &mut Builder, circle: &Circle) {
    let n = circle.segments();
    let tube = Circle::new((n / 2).next_multiple_of(4));
    let m = tube.segments();
    b.grid(n, m, |column, row| {
        let [c, s] = circle.0[n - column];
        // From the outer equator downwards and round.
        let [out, up] = tube.0[m - row];
        let radius = 0.35 + 0.15 * out;
        Vertex {
            position: [radius * c, 0.15 * up, radius * s],
            normal: [out * c, up, out * s],
            uv: [2.0 * column as f64 / n as f64, row as f64 / m as f64],
        }
    });
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::f64::consts::PI;

    use glam::{DVec3, Vec3};

    use super::*;

    fn all() -> impl Iterator<Item = (Shape, Detail, Arc<Mesh>)> {
        SHAPES
            .into_iter()
            .flat_map(|s| Detail::ALL.into_iter().map(move |d| (s, d, shape_mesh(s, d))))
    }

    fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        mesh.triangles
            .iter()
            .map(|t| t.get().map(|i| Vec3::from_array(mesh.positions[i as usize]).as_dvec3()))
    }

    fn volume(mesh: &Mesh) -> f64 {
        corners(mesh).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    fn area(mesh: &Mesh) -> f64 {
        corners(mesh).map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
    }

    #[test]
    fn the_list_of_shapes_is_in_the_order_of_their_numbers() {
        assert!(SHAPES.iter().enumerate().all(|(i, &s)| s as usize == i));
    }

    #[test]
    fn volumes_and_areas_come_from_below_to_the_closed_forms() {
        let slant = 1.25f64.sqrt();
        for (shape, v, a) in [
            (Shape::Cube, 1.0, 6.0),
            (Shape::Cylinder, PI / 4.0, 1.5 * PI),
            (Shape::Sphere, PI / 6.0, PI),
            (Shape::Capsule, PI / 16.0 * 0.5 + PI / 48.0, PI * 0.25 + PI * 0.25),
            (Shape::Cone, PI / 12.0, PI * 0.5 * slant + PI / 4.0),
            (Shape::Torus, 2.0 * PI * PI * 0.35 * 0.15 * 0.15, 4.0 * PI * PI * 0.35 * 0.15),
        ] {
            for (detail, within) in Detail::ALL.into_iter().zip([0.02, 0.07, 0.25]) {
                let mesh = shape_mesh(shape, detail);
                let (got_v, got_a) = (volume(&mesh), area(&mesh));
                assert!(
                    got_v < v * (1.0 + 1e-6) && got_v > v * (1.0 - within),
                    "{shape:?} {got_v} {v}"
                );
                assert!(
                    got_a < a * (1.0 + 1e-6) && got_a > a * (1.0 - within),
                    "{shape:?} {got_a} {a}"
                );
            }
        }
    }

    #[test]
    fn prisms_have_exactly_the_volume_of_their_polygon() {
        for detail in Detail::ALL {
            let n = detail.circle_segments() as f64;
            let base = n / 2.0 * 0.25 * libm::sin(2.0 * PI / n);
            assert!((volume(&shape_mesh(Shape::Cylinder, detail)) - base).abs() < 1e-6);
            assert!((volume(&shape_mesh(Shape::Cone, detail)) - base / 3.0).abs() < 1e-6);
        }
        assert!((volume(&shape_mesh(Shape::Cube, Detail::Low)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_edge_is_walked_once_in_each_direction() {
        for (shape, detail, mesh) in all() {
            let key = |i: u32| mesh.positions[i as usize].map(f32::to_bits);
            let mut edges: BTreeMap<_, u32> = BTreeMap::new();
            for t in mesh.triangles.iter().map(|t| t.get()) {
                for k in 0..3 {
                    *edges.entry((key(t[k]), key(t[(k + 1) % 3]))).or_default() += 1;
                }
            }
            for (&(a, b), &count) in &edges {
                assert_eq!(count, 1, "{shape:?} {detail:?}");
                assert!(edges.contains_key(&(b, a)), "{shape:?} {detail:?} is open");
            }
            let points: std::collections::BTreeSet<_> =
                mesh.positions.iter().map(|p| p.map(f32::to_bits)).collect();
            let euler = points.len() as i64 - edges.len() as i64 / 2 + mesh.triangles.len() as i64;
            assert_eq!(euler, if shape == Shape::Torus { 0 } else { 2 }, "{shape:?} {detail:?}");
        }
    }

    #[test]
    fn normals_are_unit_and_on_the_outer_side_of_their_triangles() {
        for (shape, detail, mesh) in all() {
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            assert_eq!(mesh.positions.len(), mesh.uvs.len());
            for n in &mesh.normals {
                assert!((Vec3::from_array(n.unit()).length() - 1.0).abs() < 1e-6, "{shape:?}");
            }
            for (t, [a, b, c]) in mesh.triangles.iter().zip(corners(&mesh)) {
                let face = (b - a).cross(c - a).normalize();
                for i in t.get() {
                    let n = Vec3::from_array(mesh.normals[i as usize].unit()).as_dvec3();
                    assert!(n.dot(face) > 0.75, "{shape:?} {detail:?} {n} {face}");
                }
            }
        }
    }

    #[test]
    fn shapes_fill_the_unit_cube_and_their_bounding_sphere() {
        for (shape, detail, mesh) in all() {
            let reach = mesh.positions.iter().flatten().fold(0.0f32, |m, x| m.max(x.abs()));
            assert_eq!(reach, 0.5, "{shape:?} {detail:?}");
            let farthest = mesh
                .positions
                .iter()
                .map(|&p| Vec3::from_array(p).as_dvec3().length())
                .fold(0.0, f64::max);
            let radius = f64::from(mesh.radius_m);
            assert!(
                farthest <= radius && farthest > 0.999 * radius,
                "{shape:?} {farthest} {radius}"
            );
        }
    }

    #[test]
    fn textures_keep_their_measure() {
        for (shape, detail, mesh) in all() {
            let mut texels = 0.0;
            for (t, [a, b, c]) in mesh.triangles.iter().zip(corners(&mesh)) {
                let uv = t.get().map(|i| mesh.uvs[i as usize].map(f64::from));
                assert!(uv.iter().flatten().all(|x| (-1.2..=3.2).contains(x)), "{shape:?} {uv:?}");
                let [[ax, ay], [bx, by], [cx, cy]] = uv;
                let signed = ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2.0;
                // v runs downwards: a picture that is not mirrored turns clockwise there.
                let tip = shape == Shape::Capsule && signed == 0.0;
                assert!(signed < 0.0 || tip, "{shape:?} {detail:?} is mirrored or flat: {uv:?}");
                let density = -signed / ((b - a).cross(c - a).length() / 2.0);
                assert!(density > 0.3, "{shape:?} {detail:?} {density}");
                texels += -signed;
            }
            let mean = texels / area(&mesh);
            assert!((0.6..2.7).contains(&mean), "{shape:?} {detail:?} {mean}");
        }
    }

    #[test]
    fn meshes_are_shared_and_of_the_promised_size() {
        let a = shape_mesh(Shape::Sphere, Detail::High);
        assert!(Arc::ptr_eq(&a, &shape_mesh(Shape::Sphere, Detail::High)));
        assert!((1000..3000).contains(&a.triangles.len()), "{}", a.triangles.len());
        for (shape, _, mesh) in all() {
            assert!(mesh.triangles.len() <= 3000, "{shape:?}");
        }
    }
}
