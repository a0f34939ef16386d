//! Glasses: two rims before the eyes, a bridge, and temples back to the ears.
//!
//! Lengths in metres on an adult. Colours are not decided here.

use std::ops::Range;

use glam::Vec3;

use super::hair::Head;
use super::hair::scalp::{COLUMNS, ROWS};
use super::hair::strand::{Path, push, sin_cos_turns, tube};
use crate::library::mesh::{Mesh, Triangle};
use crate::scene::Glasses;

/// Half the lens's width and height, power of its outline (2 an ellipse, more a rectangle), and
/// radius of the frame's tube.
const fn form(kind: Glasses) -> (f32, f32, f32, f32) {
    match kind {
        Glasses::Sunglasses => (0.0262, 0.0190, 2.7, 0.0015),
        Glasses::Thick => (0.0262, 0.0200, 3.4, 0.0021),
        Glasses::Thin | Glasses::None => (0.0250, 0.0205, 2.4, 0.0010),
    }
}

/// Adds glasses: the ranges of frame and lenses. `eyes` are the vertices of both eyeballs.
pub(super) fn add(mesh: &mut Mesh, head: &Head, kind: Glasses, eyes: &[Vec3]) -> [Range<u32>; 2] {
    let start = mesh.triangles.len() as u32;
    let fit = Fit::new(head, kind, eyes);
    let sides = [6, 5, 4, 3, 3][head.lod];
    let around = [28, 18, 12, 8, 8][head.lod];
    let skin = head.on_head();
    for side in [1.0, -1.0] {
        let rim = fit.rim(side, around);
        tube(mesh, &rim, sides, |_| fit.tube_m, &|_| skin);
        tube(mesh, &fit.temple(side), sides, |_| 1.1 * fit.tube_m, &|_| skin);
    }
    tube(mesh, &fit.bridge(), sides, |_| fit.tube_m, &|_| skin);
    let frame = start..mesh.triangles.len() as u32;
    if kind == Glasses::Sunglasses {
        for side in [1.0, -1.0] {
            // As many corners as the rim has, which thereby covers the edge.
            fit.lens(mesh, side, around);
        }
    }
    [frame.clone(), frame.end..mesh.triangles.len() as u32]
}

/// Where the glasses of one person sit.
struct Fit<'a> {
    head: &'a Head,
    s: f32,
    /// Middle of the left lens.
    middle: Vec3,
    half: [f32; 2],
    power: f32,
    tube_m: f32,
}

impl<'a> Fit<'a> {
    fn new(head: &'a Head, kind: Glasses, eyes: &[Vec3]) -> Self {
        let s = head.scalp.frame.scale;
        let (a, b, power, tube_m) = form(kind);
        let left: Vec<Vec3> = eyes.iter().map(|p| Vec3::new(p.x.abs(), p.y, p.z)).collect();
        let center = left.iter().sum::<Vec3>() / left.len().max(1) as f32;
        let front = left.iter().map(|p| p.z).fold(f32::MIN, f32::max);
        let middle = Vec3::new(center.x + 0.0015 * s, center.y - 0.003 * s, front + 0.011 * s);
        let mut fit = Self { head, s, middle, half: [a * s, b * s], power, tube_m: tube_m * s };
        // Forwards until brows and cheeks are clear.
        for _ in 0..12 {
            let rim = fit.rim(1.0, 20);
            let gap = |p: &Vec3| head.near.surface(*p).map_or(1.0, |found| found.0);
            let least = rim.points.iter().map(gap).fold(1.0, f32::min);
            if least > 0.0015 * s {
                break;
            }
            fit.middle.z += 0.0012 * s;
        }
        fit
    }

    /// A point of the left rim: superellipse, bent back at its outer side; mirrored for the right.
    fn at(&self, side: f32, turn: f32, share: f32) -> Vec3 {
        let (sin, cos) = sin_cos_turns(turn);
        let bulge = |v: f32| v.signum() * libm::powf(v.abs(), 2.0 / self.power);
        let x = share * self.half[0] * bulge(cos);
        // Lower corners are drawn in.
        let y = share * self.half[1] * bulge(sin);
        let narrow = if y < 0.0 { 1.0 + 0.16 * y / self.half[1] } else { 1.0 };
        let x = x * narrow;
        let back = 0.16 * (x + self.half[0]) * (x + self.half[0]) / (2.0 * self.half[0]);
        let p = self.middle + Vec3::new(x, y, -back);
        Vec3::new(p.x * side, p.y, p.z)
    }

    fn rim(&self, side: f32, count: usize) -> Path {
        let points: Vec<Vec3> =
            (0..=count).map(|i| self.at(side, i as f32 / count as f32, 1.0)).collect();
        Path { outward: vec![Vec3::Z; points.len()], points }
    }

    fn bridge(&self) -> Path {
        let a = self.at(1.0, 0.44, 1.0);
        let points: Vec<Vec3> = (0..=6)
            .map(|i| {
                let t = i as f32 / 3.0 - 1.0;
                let arch = 1.0 - t * t;
                Vec3::new(a.x * t, a.y + 0.003 * self.s * arch, a.z + 0.003 * self.s * arch)
            })
            .collect();
        Path { outward: vec![Vec3::Z; points.len()], points }
    }

    /// From the rim's outer upper corner to behind the ear, along the side of the head.
    fn temple(&self, side: f32) -> Path {
        let a = self.at(side, 0.05, 1.0);
        // The hairline passes over the ear a little behind the head's middle.
        let column = if side > 0.0 { 18.0 } else { COLUMNS as f32 - 18.0 };
        let over = self.head.scalp.at(ROWS as f32, column);
        let over_ear = over.p + Vec3::new(0.0025 * side, -0.001, 0.0) * self.s;
        let end = over_ear + Vec3::new(-0.003 * side, -0.024, -0.016) * self.s;
        let mut points: Vec<Vec3> = (0..=6).map(|i| a.lerp(over_ear, i as f32 / 6.0)).collect();
        points.push(end);
        Path { outward: vec![Vec3::Y; points.len()], points }
    }

    /// A slightly domed pane.
    fn lens(&self, mesh: &mut Mesh, side: f32, count: usize) {
        let skin = self.head.on_head();
        let normal = |p: Vec3| {
            let away = (p - Vec3::new(self.middle.x * side, self.middle.y, self.middle.z)) / self.s;
            Vec3::new(away.x * 9.0, away.y * 9.0, 1.0).normalize_or(Vec3::Z)
        };
        let middle = self.at(side, 0.25, 0.0) + Vec3::Z * (0.001 * self.s);
        let center = push(mesh, middle, normal(middle), [0.5; 2], skin);
        let ring: Vec<u32> = (0..=count)
            .map(|i| {
                let p = self.at(side, i as f32 / count as f32, 1.0);
                push(mesh, p, normal(p), [0.0; 2], skin)
            })
            .collect();
        for pair in ring.windows(2) {
            let outwards = if side > 0.0 { [pair[0], pair[1]] } else { [pair[1], pair[0]] };
            mesh.triangles.push(Triangle::new([center, outwards[0], outwards[1]]));
        }
    }
}
