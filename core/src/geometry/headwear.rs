//! What is worn on the head: caps, hats and scarves, fitted to the scalp.
//!
//! The edge is a plane over the template's head; what sits above it is the scalp moved outwards, so
//! it fits every skull. Hair knows the edge and lies flat above it ([`super::hair`]). Lengths in
//! metres on an adult. Colours are not decided here.

use std::ops::Range;

use glam::Vec3;

use super::garment::step;
use super::hair::scalp::{COLUMNS, ROWS};
use super::hair::strand::sin_cos_turns;
use super::hair::{Head, add_grid, lump};
use crate::library::mesh::{Mesh, Triangle};
use crate::scene::HeadwearKind;

/// Local height of the edge at a depth z; nothing if it presses no hair.
pub(super) fn edge_y(kind: HeadwearKind, z: f32) -> Option<f32> {
    let slope = |middle: f32, by: f32| Some(middle + by * (z - 0.045));
    match kind {
        HeadwearKind::None | HeadwearKind::Headscarf => None,
        HeadwearKind::Cap => slope(0.768, 0.17),
        HeadwearKind::Beanie => slope(0.756, 0.22),
        HeadwearKind::BrimmedHat => slope(0.772, 0.14),
    }
}

/// Adds what is worn; the range of its triangles.
pub(super) fn add(mesh: &mut Mesh, head: &Head) -> Range<u32> {
    let start = mesh.triangles.len() as u32;
    let hat = Hat { head, s: head.scalp.frame.scale, skip: [1, 2, 4, 8, 8][head.lod] };
    match head.headwear {
        HeadwearKind::None => {}
        HeadwearKind::Cap => hat.cap(mesh),
        HeadwearKind::Beanie => hat.beanie(mesh),
        HeadwearKind::BrimmedHat => hat.brimmed(mesh),
        HeadwearKind::Headscarf => hat.scarf(mesh),
    }
    start..mesh.triangles.len() as u32
}

struct Hat<'a> {
    head: &'a Head,
    s: f32,
    /// Every so many columns are used.
    skip: usize,
}

/// Repeats of the cloth's texture over a metre.
/// How far a scarf reaches from the middle of the head, metres.
const SCARF_M: f32 = 0.205;
const UV_PER_M: f32 = 4.0;

impl Hat<'_> {
    fn columns(&self) -> Vec<usize> {
        (0..=COLUMNS).step_by(self.skip).collect()
    }

    /// Place and direction off the head at a share of the way from the crown to the edge.
    fn under(&self, column: usize, share: f32) -> (Vec3, Vec3) {
        let scalp = &self.head.scalp;
        let edge = |z: f32| edge_y(self.head.headwear, z).unwrap_or(0.0);
        let above = |row: f32| {
            let l = scalp.at(row, column as f32).local;
            l.y - edge(l.z)
        };
        let last = ROWS as f32;
        if above(last) <= 0.0 {
            let (mut low, mut high) = (0.0, last);
            for _ in 0..12 {
                let middle = 0.5 * (low + high);
                if above(middle) > 0.0 { low = middle } else { high = middle }
            }
            let root = scalp.at(low * share, column as f32);
            return (root.p, root.n);
        }
        // The edge lies below the hairline: on along the skin.
        let (a, b) = (scalp.at(last - 2.0, column as f32), scalp.at(last, column as f32));
        let down = (b.local - a.local).normalize_or(Vec3::NEG_Y);
        let beyond = above(last) / (-down.y).max(0.3);
        let kink = 1.0 - beyond / (0.13 + beyond);
        if share <= kink {
            let root = scalp.at(last * share / kink, column as f32);
            return (root.p, root.n);
        }
        let t = (share - kink) / (1.0 - kink);
        (scalp.frame.world(b.local + down * (beyond * t)) + (b.p - scalp.frame.world(b.local)), b.n)
    }

    /// A shell over the head by rows from the crown to the edge; thickness by share and column.
    fn dome(&self, mesh: &mut Mesh, off: impl Fn(f32, usize) -> f32) {
        let rows = [12, 9, 6, 4, 3][self.head.lod];
        let columns = self.columns();
        let (mut points, mut uvs) = (Vec::new(), Vec::new());
        for row in 0..=rows {
            let share = row as f32 / rows as f32;
            for &column in &columns {
                let (p, n) = self.under(column, share);
                points.push(p + n * (self.s * off(share, column)));
                uvs.push([column as f32 / COLUMNS as f32 * 2.0, share * 0.2 * UV_PER_M]);
            }
        }
        add_grid(mesh, &points, &uvs, columns.len(), true, &|_| self.head.on_head());
    }

    /// Points of the edge, off the head by a distance.
    fn edge(&self, off_m: f32) -> Vec<Vec3> {
        let out = |&column: &usize| {
            let (p, n) = self.under(column, 1.0);
            p + Vec3::new(n.x, 0.0, n.z).normalize_or(n) * (self.s * off_m)
        };
        self.columns().iter().map(out).collect()
    }

    fn rows(&self, mesh: &mut Mesh, rows: &[Vec<Vec3>], ring: bool) {
        let across = rows[0].len();
        let points: Vec<Vec3> = rows.iter().flatten().copied().collect();
        let uvs: Vec<[f32; 2]> = (0..points.len())
            .map(|i| {
                let (row, column) = (i / across, i % across);
                [column as f32 / (across - 1) as f32 * 2.0, row as f32 * 0.02 * UV_PER_M]
            })
            .collect();
        add_grid(mesh, &points, &uvs, across, ring, &|_| self.head.on_head());
    }

    /// A cap of six panels with a visor.
    fn cap(&self, mesh: &mut Mesh) {
        self.dome(mesh, |share, column| {
            let (_, forwards) = sin_cos_turns(column as f32 / COLUMNS as f32);
            let front = forwards.max(0.0) * step(0.25, 0.6, share) * step(1.0, 0.75, share);
            0.006 + 0.008 * (1.0 - share * share) + 0.012 * front
        });
        // The visor: from temple to temple, forwards and a little down.
        let reach = COLUMNS / 6 / self.skip * self.skip;
        let columns: Vec<usize> =
            (COLUMNS - reach..=COLUMNS + reach).step_by(self.skip.min(2)).collect();
        let rows = [5, 4, 3, 2, 2][self.head.lod];
        let (mut all, mut below) = (Vec::new(), Vec::new());
        for row in 0..=rows {
            let t = row as f32 / rows as f32;
            let line = columns.iter().map(|&column| {
                let (p, n) = self.under(column % COLUMNS, if row == 0 { 0.93 } else { 1.0 });
                let off = (column as f32 - COLUMNS as f32) / (reach as f32 + 0.5);
                let out = (1.0 - off * off).max(0.0).sqrt();
                let forwards = Vec3::new(0.10 * off, -0.16 - 0.10 * t, 1.0);
                let droop = Vec3::NEG_Y * (0.020 * off * off * t);
                p + n * (self.s * 0.005) + (forwards * (0.070 * out * t) + droop) * self.s
            });
            let line: Vec<Vec3> = line.collect();
            below.push(line.iter().map(|p| *p - Vec3::Y * (0.002 * self.s)).collect());
            all.push(line);
        }
        self.rows(mesh, &all, false);
        if self.head.lod < 2 {
            self.rows(mesh, &below, false);
        }
    }

    /// A knitted cap, slack on top, with a cuff.
    fn beanie(&self, mesh: &mut Mesh) {
        let seed = self.head.seed;
        self.dome(mesh, |share, column| {
            let (sin, cos) = sin_cos_turns(column as f32 / COLUMNS as f32);
            let fold = lump(Vec3::new(2.0 * sin, 3.0 * share, 2.0 * cos), seed);
            0.007 + (0.013 + 0.004 * fold) * (1.0 - share * share)
        });
        let band = |share: f32, off_m: f32| -> Vec<Vec3> {
            let out = |&column: &usize| {
                let (p, n) = self.under(column, share);
                p + n * (self.s * off_m)
            };
            self.columns().iter().map(out).collect()
        };
        let cuff: &[(f32, f32)] = &[(0.64, 0.010), (0.66, 0.014), (0.97, 0.012), (1.0, 0.008)];
        let rows: Vec<Vec<Vec3>> = cuff.iter().map(|&(share, off)| band(share, off)).collect();
        self.rows(mesh, &rows, true);
    }

    /// A felt hat: a crown with a dent, and a brim all round.
    fn brimmed(&self, mesh: &mut Mesh) {
        let edge = self.edge(0.006);
        let ring = &edge[..edge.len() - 1];
        let middle = ring.iter().sum::<Vec3>() / ring.len() as f32;
        let level = |p: Vec3, share: f32, up_m: f32| {
            let flat = Vec3::new(p.x - middle.x, 0.0, p.z - middle.z);
            Vec3::new(middle.x, p.y, middle.z) + flat * share + Vec3::Y * (up_m * self.s)
        };
        // Share of the edge's width and height over it, from the middle of the top downwards.
        let crown: &[(f32, f32)] = &[
            (0.02, 0.083),
            (0.30, 0.084),
            (0.52, 0.091),
            (0.66, 0.092),
            (0.77, 0.083),
            (0.87, 0.060),
            (0.95, 0.030),
            (1.0, 0.0),
        ];
        let rows: Vec<Vec<Vec3>> = crown
            .iter()
            .map(|&(share, up)| edge.iter().map(|p| level(*p, share, up)).collect())
            .collect();
        self.rows(mesh, &rows, true);
        let columns = self.columns();
        let brim = |out_m: f32, t: f32| -> Vec<Vec3> {
            let at = |(p, &column): (&Vec3, &usize)| {
                let (_, n) = self.under(column, 1.0);
                let (sin, _) = sin_cos_turns(column as f32 / COLUMNS as f32);
                let out = Vec3::new(n.x, 0.0, n.z).normalize_or(Vec3::Z);
                let rise = 0.022 * sin * sin - 0.012;
                *p + (out * out_m + Vec3::Y * (rise * t * t)) * self.s
            };
            edge.iter().zip(&columns).map(at).collect()
        };
        let rows: Vec<Vec<Vec3>> = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| brim(0.064 * t, t)).to_vec();
        self.rows(mesh, &rows, true);
    }

    /// A scarf round head, neck and shoulders with an opening for the face: for directions from the
    /// middle of the head, as far out as the skin under it.
    fn scarf(&self, mesh: &mut Mesh) {
        const MIDDLE: Vec3 = Vec3::new(0.0, 0.715, 0.030);
        let (across, rows) = [(48, 22), (32, 14), (20, 9), (12, 6), (10, 5)][self.head.lod];
        let frame = &self.head.scalp.frame;
        let center = frame.world(MIDDLE);
        let mut directions = Vec::new();
        for row in 0..=rows {
            let t = row as f32 / rows as f32;
            for i in 0..=across {
                let (sin, cos) = sin_cos_turns(i as f32 / across as f32);
                // The opening is higher than wide, and ends under the chin.
                let open = 0.093 + 0.046 * sin * sin + 0.028 * (-cos).max(0.0);
                let (s, c) = sin_cos_turns(open + (0.5 - open) * t);
                directions.push(Vec3::new(s * sin, s * cos, c));
            }
        }
        let mut reach: Vec<f32> = directions.iter().map(|d| self.reach(center, *d)).collect();
        let wide = across + 1;
        // Where the skin has holes, at the eyes, a ray may stop too early.
        let traced = reach.clone();
        for (i, r) in reach.iter_mut().enumerate() {
            let (row, column) = (i - i % wide, i % wide);
            let left = traced[row + if column == 0 { across - 1 } else { column - 1 }];
            let right = traced[row + if column == across { 1 } else { column + 1 }];
            *r = r.min(left.max(right) * 1.04);
        }
        for _ in 0..[3, 2, 1, 0, 0][self.head.lod] {
            let before = reach.clone();
            for row in 1..rows {
                for i in 0..wide {
                    let at = |r: usize, c: usize| before[r * wide + c];
                    let left = at(row, if i == 0 { across - 1 } else { i - 1 });
                    let right = at(row, if i == across { 1 } else { i + 1 });
                    let mean = (left + right + at(row - 1, i) + at(row + 1, i)) / 4.0;
                    // Cloth bridges hollows.
                    reach[row * wide + i] = before[row * wide + i].max(mean);
                }
            }
        }
        let seed = self.head.seed;
        // As far out as cloth reaches the body goes on: there the scarf ends, and its hem lies on
        // what is under it.
        let ends: Vec<bool> = reach.iter().map(|r| *r >= 0.999 * SCARF_M * self.s).collect();
        let points: Vec<Vec3> = directions
            .iter()
            .zip(&reach)
            .zip(&ends)
            .map(|((d, r), ends)| {
                let low = step(0.2, -0.6, d.y);
                let fold = lump(Vec3::new(d.x * 9.0, d.y * 3.0, d.z * 5.0), seed);
                let p = center + *d * (r + self.s * (0.0015 + 0.0045 * low) * fold);
                if *ends { self.laid(p) } else { p }
            })
            .collect();
        let uvs: Vec<[f32; 2]> = (0..points.len())
            .map(|i| [(i % wide) as f32 / across as f32 * 3.0, (i / wide) as f32 / rows as f32])
            .collect();
        let first = mesh.positions.len() as u32;
        let start = mesh.triangles.len();
        add_grid(mesh, &points, &uvs, wide, true, &|i| self.head.hanging(points[i]));
        let all = mesh.triangles.split_off(start);
        let seen = |t: &Triangle| t.get().iter().any(|v| !ends[(v - first) as usize]);
        mesh.triangles.extend(all.into_iter().filter(seen));
    }

    /// A point as far out of the body as cloth that lies on it.
    fn laid(&self, p: Vec3) -> Vec3 {
        let mut p = p;
        for _ in 0..2 {
            if let Some((d, n)) = self.head.near.surface(p) {
                p += n * (self.s * 0.008 - d).max(0.0);
            }
        }
        p
    }

    /// How far from the middle of the head a scarf lies in a direction.
    fn reach(&self, center: Vec3, direction: Vec3) -> f32 {
        let clear = self.s * 0.009;
        let mut r = SCARF_M * self.s;
        for _ in 0..40 {
            match self.head.near.surface(center + direction * r) {
                Some((d, _)) if d < clear + 0.0005 => break,
                Some((d, _)) => r -= 0.7 * (d - clear),
                None => r -= 0.015 * self.s,
            }
            if r < 0.06 * self.s {
                break;
            }
        }
        r
    }
}
