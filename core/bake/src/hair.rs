//! Hair: where it grows, a cap of roots on the scalp, and a curtain of long hair.
//!
//! Both are grids on the template whose vertices are weighted means of skin vertices (plus a
//! fixed offset), so that they follow every body shape. How far the hair stands out is decided
//! when a person is dressed. Lengths in metres.

use std::f64::consts::PI;

use figurant_core::library::mesh::SkinVertex;
use glam::DVec3;

use crate::assemble::Draft;
use crate::rig::Rig;
use crate::source::{BODY_VERTICES, Source};
use crate::surface::{polyline, ray_triangle, smoothstep, triangles};

/// Middle of the head, from which the scalp is seen.
const CENTER: DVec3 = DVec3::new(0.0, 0.745, 0.045);
const CAP_COLUMNS: usize = 64;
const CAP_ROWS: usize = 15;
const CURTAIN_COLUMNS: usize = 45;

/// Height of the hairline over the azimuth (degrees from the front) on the template, metres.
/// `sharp` draws the sideburn in front of the ear, the other one passes over it.
fn hairline_y(azimuth_deg: f64, sharp: bool) -> f64 {
    const SOFT: [(f64, f64); 15] = [
        (0.0, 0.796),
        (12.0, 0.798),
        (26.0, 0.797),
        (36.0, 0.790),
        (46.0, 0.778),
        (56.0, 0.764),
        (64.0, 0.751),
        (72.0, 0.746),
        (86.0, 0.752),
        (100.0, 0.750),
        (110.0, 0.722),
        (120.0, 0.690),
        (134.0, 0.666),
        (152.0, 0.655),
        (180.0, 0.652),
    ];
    const SHARP: [(f64, f64); 9] = [
        (0.0, 0.796),
        (58.0, 0.760),
        (63.0, 0.748),
        (67.0, 0.722),
        (70.0, 0.710),
        (75.0, 0.710),
        (78.0, 0.735),
        (81.0, 0.752),
        (88.0, 0.754),
    ];
    let a = azimuth_deg.abs();
    if sharp && (58.0..=88.0).contains(&a) { polyline(&SHARP, a) } else { polyline(&SOFT, a) }
}

/// How far inside the hairline a point of the skin lies, metres; negative on bare skin.
pub fn scalp_depth(p: DVec3) -> f64 {
    if p.y < 0.62 {
        return -1.0;
    }
    let azimuth = p.x.atan2(p.z - CENTER.z).to_degrees();
    // Against steps of the line: the nearest of a few azimuths around.
    [-6.0, -3.0, 0.0, 3.0, 6.0]
        .iter()
        .map(|d| {
            let side = d / 180.0 * PI * 0.075;
            let up = p.y - hairline_y(azimuth + d, true);
            if up >= 0.0 { (up * up + side * side).sqrt() } else { up }
        })
        .fold(f64::MAX, f64::min)
}

/// A place on the scalp: position, and base vertices with weights.
type Root = (DVec3, Vec<(usize, f64)>);

/// Rays from inside the head to its skin.
struct Head<'a> {
    source: &'a Source,
    tris: Vec<[usize; 3]>,
}

impl<'a> Head<'a> {
    fn new(source: &'a Source) -> Self {
        let tris = triangles(source.quads("body"))
            .into_iter()
            .map(|t| t.map(|c| c.0))
            .filter(|t| t.iter().any(|&v| source.positions[v].y > 0.55))
            .collect();
        Self { source, tris }
    }

    /// All hits, nearest first: distance and the blend of three vertices.
    fn hits(&self, o: DVec3, d: DVec3) -> Vec<(f64, Vec<(usize, f64)>)> {
        let mut out: Vec<_> = self
            .tris
            .iter()
            .filter_map(|t| {
                let (s, w) = ray_triangle(o, d, t.map(|v| self.source.positions[v]))?;
                Some((s, t.iter().copied().zip(w).collect()))
            })
            .collect();
        out.sort_by(|a: &(f64, Vec<(usize, f64)>), b| a.0.total_cmp(&b.0));
        out
    }

    /// The scalp in a direction given by azimuth and elevation in degrees.
    fn scalp(&self, azimuth: f64, elevation: f64) -> Root {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        let d = DVec3::new(a.sin() * e.cos(), e.sin(), a.cos() * e.cos());
        let hit = self.hits(CENTER, d).into_iter().next().expect("the head is closed");
        (CENTER + d * hit.0, hit.1)
    }

    /// Elevation at which the column of an azimuth reaches the hairline.
    fn hairline_elevation(&self, azimuth: f64) -> f64 {
        let line = hairline_y(if azimuth > 180.0 { 360.0 - azimuth } else { azimuth }, false);
        let (mut low, mut high) = (-62.0, 89.0);
        for _ in 0..30 {
            let mid = 0.5 * (low + high);
            if self.scalp(azimuth, mid).0.y < line { low = mid } else { high = mid }
        }
        0.5 * (low + high)
    }
}

/// The cap, and the distance of each of its vertices to the hairline.
pub fn cap(source: &Source, rig: &Rig) -> (Draft, Vec<f64>) {
    let head = Head::new(source);
    let column = |i: usize| i as f64 * 360.0 / CAP_COLUMNS as f64;
    // The right half mirrors the left one exactly.
    let mirrored = |blend: &[(usize, f64)]| -> Vec<(usize, f64)> {
        blend.iter().map(|&(v, w)| (source.mirror[v], w)).collect()
    };
    let mut draft = Draft::default();
    let (pole, blend) = head.scalp(0.0, 89.99);
    draft.push(DVec3::new(0.0, pole.y, pole.z), blend, head_only(rig));
    let mut grid = vec![vec![(DVec3::ZERO, Vec::new()); CAP_COLUMNS]; CAP_ROWS];
    for i in 0..=CAP_COLUMNS / 2 {
        let low = head.hairline_elevation(column(i));
        for (r, row) in grid.iter_mut().enumerate() {
            let t = (r + 1) as f64 / CAP_ROWS as f64;
            let s = t + 0.5 * t * (1.0 - t);
            let (p, blend) = head.scalp(column(i), 90.0 + (low - 90.0) * s);
            let other = (CAP_COLUMNS - i) % CAP_COLUMNS;
            row[other] = (p * DVec3::new(-1.0, 1.0, 1.0), mirrored(&blend));
            row[i] = (p, blend);
        }
    }
    for (p, blend) in grid.iter().flatten() {
        draft.push(*p, blend.clone(), head_only(rig));
    }
    let line = &grid[CAP_ROWS - 1];
    let depth = draft
        .positions
        .iter()
        .map(|p| {
            (0..CAP_COLUMNS)
                .map(|i| {
                    let (a, b) = (line[i].0, line[(i + 1) % CAP_COLUMNS].0);
                    let t = ((*p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    (*p - (a + (b - a) * t)).length()
                })
                .fold(f64::MAX, f64::min)
        })
        .collect();
    cap_triangles(&mut draft, &grid);
    (draft, depth)
}

fn cap_triangles(draft: &mut Draft, grid: &[Vec<Root>]) {
    // Texture: u round the head four times, v along the hair, one repeat every 0.25 m.
    let u = |i: usize| (4.0 * i as f64 / CAP_COLUMNS as f64) as f32;
    for i in 0..CAP_COLUMNS {
        draft.render.push(0);
        draft.uvs.push([u(i), 0.0]);
    }
    let mut along = vec![0.0; CAP_COLUMNS + 1];
    let mut before = vec![draft.positions[0]; CAP_COLUMNS + 1];
    for (r, row) in grid.iter().enumerate() {
        for i in 0..=CAP_COLUMNS {
            let p = row[i % CAP_COLUMNS].0;
            along[i] += (p - before[i]).length();
            before[i] = p;
            draft.render.push((1 + r * CAP_COLUMNS + i % CAP_COLUMNS) as u32);
            draft.uvs.push([u(i), (along[i] / 0.25) as f32]);
        }
    }
    let at = |r: usize, i: usize| (CAP_COLUMNS + r * (CAP_COLUMNS + 1) + i) as u32;
    for i in 0..CAP_COLUMNS {
        draft.triangles.push([i as u32, at(0, i), at(0, i + 1)]);
        for r in 1..CAP_ROWS {
            let (a, b, c, d) = (at(r - 1, i), at(r, i), at(r, i + 1), at(r - 1, i + 1));
            draft.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}

fn joint(rig: &Rig, name: &str) -> u8 {
    rig.joints.iter().position(|j| j.name == name).expect("the rig has this joint") as u8
}

fn head_only(rig: &Rig) -> SkinVertex {
    SkinVertex { joints: [joint(rig, "Head"), 0, 0, 0], weights: [255, 0, 0, 0] }
}

/// Long hair from in front of one ear round the back to the other, closed below: an outer sheet
/// going down and an inner one coming back up.
pub fn curtain(source: &Source, rig: &Rig) -> Draft {
    // Outer rows from the top down, then inner rows back up: (share of the way down, inset).
    const ROWS: [(f64, f64); 15] = [
        (0.0, 0.0),
        (0.10, 0.0),
        (0.20, 0.0),
        (0.31, 0.0),
        (0.42, 0.0),
        (0.53, 0.0),
        (0.64, 0.0),
        (0.76, 0.0),
        (0.88, 0.0),
        (0.97, 0.003),
        (1.0, 0.009),
        (0.95, 0.015),
        (0.75, 0.018),
        (0.45, 0.018),
        (0.20, 0.014),
    ];
    const FRONT_DEG: f64 = 64.0;
    let head = Head::new(source);
    let near = neighbours(source);
    let mut draft = Draft::default();
    for i in 0..CURTAIN_COLUMNS {
        let t = i as f64 / (CURTAIN_COLUMNS - 1) as f64;
        let azimuth = FRONT_DEG + (360.0 - 2.0 * FRONT_DEG) * t;
        let folded = if azimuth > 180.0 { 360.0 - azimuth } else { azimuth };
        // The free edges are thin.
        let body = smoothstep(0.0, 14.0, folded - FRONT_DEG);
        let strand = 0.0022 * (folded * 0.42).sin() + 0.0014 * (folded * 0.97 + 1.0).sin();
        let top = 0.780 - 0.010 * (1.0 - body);
        let bottom = 0.545 + 0.040 * (1.0 - smoothstep(75.0, 150.0, folded)) + 1.2 * strand;
        let mut length = 0.0;
        let mut last = None;
        for (r, &(down, inset)) in ROWS.iter().enumerate() {
            let y = top + (bottom - top) * down;
            let radius = curtain_radius(&head, azimuth, folded, y)
                + strand * smoothstep(0.1, 0.5, down)
                - inset * body.max(0.25);
            let a = azimuth.to_radians();
            let p = DVec3::new(a.sin() * radius, y, CENTER.z + a.cos() * radius);
            length += last.map_or(0.0, |q: DVec3| (p - q).length());
            last = Some(p);
            draft.push(p, blend(source, &near, p), curtain_skin(rig, y));
            draft.render.push((i * ROWS.len() + r) as u32);
            draft.uvs.push([(azimuth / 90.0) as f32, ((0.14 + length) / 0.25) as f32]);
        }
    }
    for i in 1..CURTAIN_COLUMNS {
        for r in 1..ROWS.len() {
            let at = |i: usize, r: usize| (i * ROWS.len() + r) as u32;
            let (a, b, c, d) = (at(i - 1, r - 1), at(i - 1, r), at(i, r), at(i, r - 1));
            draft.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    draft
}

/// Radius of the outer sheet: over the scalp and the ears, then falling straight, at the back
/// leaning out over the shoulders.
fn curtain_radius(head: &Head<'_>, azimuth: f64, folded: f64, y: f64) -> f64 {
    let around = |y: f64, azimuth: f64| {
        let a = azimuth.to_radians();
        let hits = head.hits(DVec3::new(0.0, y, CENTER.z), DVec3::new(a.sin(), 0.0, a.cos()));
        hits.last().map_or(0.07, |h| h.0)
    };
    let skin = |y: f64| around(y, azimuth);
    // The ears lie under it: the farthest skin near this direction counts.
    let hang = [-12.0, -6.0, 0.0, 6.0, 12.0]
        .iter()
        .flat_map(|d| [0.70, 0.715, 0.73, 0.75].map(|y| around(y, azimuth + d)))
        .fold(0.0, f64::max)
        + 0.010;
    let close = skin(y.clamp(0.74, 0.79)) + 0.010 + 0.005 * smoothstep(0.775, 0.750, y);
    let head_part = smoothstep(0.775, 0.735, y);
    let falling = close + (hang.max(close) - close) * head_part;
    let tuck = 0.010 * smoothstep(0.70, 0.62, y) * smoothstep(150.0, 90.0, folded);
    let out = 0.028 * smoothstep(0.62, 0.55, y) * smoothstep(95.0, 150.0, folded);
    falling - tuck + out
}

/// Head above, then more and more the neck and the shoulders.
fn curtain_skin(rig: &Rig, y: f64) -> SkinVertex {
    let low = smoothstep(0.68, 0.56, y);
    let (neck, back) = ((low * 70.0).round() as u8, (low * 70.0).round() as u8);
    SkinVertex {
        joints: [joint(rig, "Head"), joint(rig, "Neck"), joint(rig, "Spine2"), 0],
        weights: [255 - neck - back, neck, back, 0],
    }
}

/// Skin vertices that long hair follows: skull, neck, shoulders and upper back.
fn neighbours(source: &Source) -> Vec<usize> {
    (0..BODY_VERTICES)
        .filter(|&v| {
            let p = source.positions[v];
            let ear_or_face = p.y > 0.64 && (p.x.abs() > 0.070 || p.z > 0.085);
            p.y > 0.48 && p.x.abs() < 0.17 && !ear_or_face
        })
        .collect()
}

/// Weights of the twelve nearest vertices, falling with distance.
fn blend(source: &Source, near: &[usize], p: DVec3) -> Vec<(usize, f64)> {
    let mut by_distance: Vec<(f64, usize)> =
        near.iter().map(|&v| ((source.positions[v] - p).length_squared(), v)).collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    by_distance.truncate(12);
    let weight = |d2: f64| 1.0 / (d2 + 1e-4);
    let sum: f64 = by_distance.iter().map(|d| weight(d.0)).sum();
    by_distance.iter().map(|&(d2, v)| (v, weight(d2) / sum)).collect()
}
