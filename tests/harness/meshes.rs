//! Meshes for tests, made here so that tests of an engine do not rest on the product's shapes.

use std::f64::consts::{PI, TAU};

use figurant_core::library::mesh::{Mesh, SkinVertex, Triangle};
use glam::DVec3;

/// Numbers that look random and are the same in every run (a linear congruential generator).
pub struct Dice(u64);

impl Dice {
    /// Starts a sequence.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678)
    }

    /// 0..1
    pub fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// low..high
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// 0..n
    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// In the cube from -1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0))
    }

    /// Of unit length.
    pub fn direction(&mut self) -> DVec3 {
        (self.vector() + DVec3::splat(1e-3)).normalize()
    }
}

/// A grid of points `p(u, v)` for u and v in 0..1, with normals from the neighbouring points.
fn surface(
    columns: usize,
    rows: usize,
    p: impl Fn(f64, f64) -> DVec3,
    n: impl Fn(f64, f64) -> DVec3,
) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (column as f64 / columns as f64, row as f64 / rows as f64);
            let (p, n) = (p(u, v).as_vec3(), n(u, v).normalize().as_vec3());
            mesh.push(p.to_array(), n.to_array(), [u as f32, v as f32]);
        }
    }
    let w = columns as u32 + 1;
    for row in 0..rows as u32 {
        for column in 0..columns as u32 {
            let a = row * w + column;
            mesh.triangles.push(Triangle::new([a, a + w, a + 1]));
            mesh.triangles.push(Triangle::new([a + 1, a + w, a + w + 1]));
        }
    }
    mesh
}

/// A sphere of radius 1.
pub fn sphere(columns: usize, rows: usize) -> Mesh {
    let at = |u: f64, v: f64| {
        let (a, b) = (u * TAU, v * PI);
        DVec3::new(b.sin() * a.sin(), b.cos(), b.sin() * a.cos())
    };
    surface(columns, rows, at, at)
}

/// A ring of radius 1 round y with a tube of radius `tube`.
pub fn torus(columns: usize, rows: usize, tube: f64) -> Mesh {
    let normal = |u: f64, v: f64| {
        let (a, b) = (u * TAU, -v * TAU);
        DVec3::new(b.cos() * a.sin(), b.sin(), b.cos() * a.cos())
    };
    let at = |u: f64, v: f64| {
        let a = u * TAU;
        DVec3::new(a.sin(), 0.0, a.cos()) + normal(u, v) * tube
    };
    surface(columns, rows, at, normal)
}

/// A square from -1 to 1 in x and y that faces +z.
pub fn square() -> Mesh {
    surface(1, 1, |u, v| DVec3::new(u * 2.0 - 1.0, 1.0 - v * 2.0, 0.0), |_, _| DVec3::Z)
}

/// A box from -1 to 1 with flat faces.
pub fn cuboid() -> Mesh {
    let mut mesh = Mesh::default();
    for (n, up) in [
        (DVec3::X, DVec3::Y),
        (-DVec3::X, DVec3::Y),
        (DVec3::Y, DVec3::Z),
        (-DVec3::Y, DVec3::Z),
        (DVec3::Z, DVec3::Y),
        (-DVec3::Z, DVec3::Y),
    ] {
        let right = up.cross(n);
        let first = mesh.positions.len() as u32;
        for (x, y) in [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)] {
            let p = (n + right * x + up * y).as_vec3();
            let uv = [(x * 0.5 + 0.5) as f32, (0.5 - y * 0.5) as f32];
            mesh.push(p.to_array(), n.as_vec3().to_array(), uv);
        }
        mesh.triangles.push(Triangle::new([first, first + 1, first + 2]));
        mesh.triangles.push(Triangle::new([first, first + 2, first + 3]));
    }
    mesh
}

/// Unconnected triangles in the cube from -1 to 1, of about the given size.
pub fn soup(dice: &mut Dice, count: usize, size: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for _ in 0..count {
        let center = dice.vector();
        let first = mesh.positions.len() as u32;
        for _ in 0..3 {
            let p = (center + dice.vector() * size).as_vec3().to_array();
            let n = dice.direction().as_vec3().to_array();
            mesh.push(p, n, [dice.unit() as f32, dice.unit() as f32]);
        }
        mesh.triangles.push(Triangle::new([first, first + 1, first + 2]));
    }
    mesh
}

/// A sphere stretched along y, its vertices bound to up to four of `joints` joints.
pub fn skinned_body(dice: &mut Dice, columns: usize, rows: usize, joints: usize) -> Mesh {
    let mut mesh = sphere(columns, rows);
    for p in &mut mesh.positions {
        p[1] *= 2.0;
    }
    mesh.skin = mesh
        .positions
        .iter()
        .map(|p| {
            let along = f64::from(p[1] * 0.25 + 0.5) * (joints - 1) as f64;
            let near = |offset: usize| (along as usize + offset).min(joints - 1) as u8;
            let first = 100 + (dice.unit() * 100.0) as u8;
            let second = ((255 - first) as f64 * dice.unit()) as u8;
            let third = ((255 - first - second) as f64 * dice.unit()) as u8;
            SkinVertex {
                joints: [near(0), near(1), near(2), near(3)],
                weights: [first, second, third, 255 - first - second - third],
            }
        })
        .collect();
    mesh
}
