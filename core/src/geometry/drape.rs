//! Tubes of cloth round a limb or the trunk.
//!
//! A tube spans hollows as cloth does: each of its cross sections is convex. What hangs does not
//! follow the body inwards again below its widest place. Points flow in, distances from a line
//! flow out; which garment it is for is not known here.

use glam::Vec3;

/// How far from the line the cloth is, by place along the line and by direction round it.
pub(super) struct Tube {
    origin: Vec3,
    axis: Vec3,
    across: Vec3,
    ahead: Vec3,
    from: f32,
    step: f32,
    columns: usize,
    /// Middle of each row, along `across` and `ahead`.
    centers: Vec<[f32; 2]>,
    /// Row by row; direction k of n is k/n of a turn from `across` towards `ahead`.
    radii: Vec<f32>,
    directions: Vec<[f32; 2]>,
}

/// A place on a tube.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Distance of the tube from its line.
    pub radius: f32,
    /// Distance of the asked point.
    pub own: f32,
    /// Unit, away from the line.
    pub out: Vec3,
}

impl Tube {
    /// The convex cross sections round some points, from the first along `axis` to the last.
    /// Nothing without at least three points, or with fewer than two rows or three columns.
    pub fn new(
        (origin, axis): (Vec3, Vec3),
        ahead: Vec3,
        (rows, columns): (usize, usize),
        points: impl Iterator<Item = Vec3> + Clone,
    ) -> Option<Self> {
        let axis = axis.normalize_or(Vec3::NEG_Y);
        let ahead = (ahead - axis * ahead.dot(axis)).normalize_or(Vec3::Z);
        let across = ahead.cross(axis);
        let flat = |p: Vec3| {
            let r = p - origin;
            (r.dot(axis), [r.dot(across), r.dot(ahead)])
        };
        let (from, to, count) = points
            .clone()
            .map(|p| flat(p).0)
            .fold((f32::MAX, f32::MIN, 0), |(a, b, n), t| (a.min(t), b.max(t), n + 1));
        if count < 3 || rows < 2 || columns < 3 || to <= from {
            return None;
        }
        let turn = std::f32::consts::TAU / columns as f32;
        let directions: Vec<[f32; 2]> = (0..columns)
            .map(|k| [libm::cosf(turn * k as f32), libm::sinf(turn * k as f32)])
            .collect();
        let mut tube = Self {
            origin,
            axis,
            across,
            ahead,
            from,
            step: (to - from) / (rows - 1) as f32,
            columns,
            centers: Vec::new(),
            radii: Vec::new(),
            directions,
        };
        let flat: Vec<(usize, [f32; 2])> = points
            .map(flat)
            .map(|(t, q)| ((((t - from) / tube.step) as usize).min(rows - 2), q))
            .collect();
        tube.centers = tube.middles(&flat, rows);
        tube.radii = tube.sections(&flat, rows);
        Some(tube)
    }

    /// Rows for which a point after this row counts: those on both its sides, so that what lies
    /// between them is outside it, and as many more as it takes to meet a whole ring of vertices.
    fn near(&self, row: usize, rows: usize) -> std::ops::Range<usize> {
        const RING_M: f32 = 0.022;
        let more = (RING_M / self.step) as usize;
        row.saturating_sub(more)..(row + 2 + more).min(rows)
    }

    /// Middle of the box round each row's points, smoothed; rows without points take that of the
    /// row before.
    fn middles(&self, flat: &[(usize, [f32; 2])], rows: usize) -> Vec<[f32; 2]> {
        let mut boxes = vec![([f32::MAX; 2], [f32::MIN; 2]); rows];
        for (row, q) in flat {
            for row in self.near(*row, rows) {
                let (low, high) = &mut boxes[row];
                for c in 0..2 {
                    (low[c], high[c]) = (low[c].min(q[c]), high[c].max(q[c]));
                }
            }
        }
        let mut last = [0.0; 2];
        let rough: Vec<[f32; 2]> = boxes
            .into_iter()
            .map(|(low, high)| {
                if low[0] <= high[0] {
                    last = [(low[0] + high[0]) * 0.5, (low[1] + high[1]) * 0.5];
                }
                last
            })
            .collect();
        let mean = |row: usize, c: usize| {
            let around = &rough[row.saturating_sub(2)..(row + 3).min(rows)];
            around.iter().map(|m| m[c]).sum::<f32>() / around.len() as f32
        };
        (0..rows).map(|row| [mean(row, 0), mean(row, 1)]).collect()
    }

    /// Convex cross sections: a tangent in each direction, and where rays from the middle meet
    /// the nearest of them.
    fn sections(&self, flat: &[(usize, [f32; 2])], rows: usize) -> Vec<f32> {
        let n = self.columns;
        let [cos, sin]: [Vec<f32>; 2] =
            [0, 1].map(|axis| self.directions.iter().map(|d| d[axis]).collect());
        let mut reach = vec![f32::MIN; rows * n];
        for (row, q) in flat {
            for row in self.near(*row, rows) {
                let [a, b] = [q[0] - self.centers[row][0], q[1] - self.centers[row][1]];
                for ((h, c), s) in reach[row * n..(row + 1) * n].iter_mut().zip(&cos).zip(&sin) {
                    let along = a * c + b * s;
                    *h = if along > *h { along } else { *h };
                }
            }
        }
        let quarter = (n / 4).max(1);
        let mut radii = vec![0.0; rows * n];
        let mut round = vec![0.0; n + 2 * quarter];
        for (radii, reach) in radii.chunks_exact_mut(n).zip(reach.chunks_exact(n)) {
            if reach[0] == f32::MIN {
                continue;
            }
            // The row once round, with a quarter more at either end.
            for (i, h) in round.iter_mut().enumerate() {
                *h = reach[(i + n - quarter) % n];
            }
            radii.fill(f32::MAX);
            for (off, h) in (0..=2 * quarter).map(|k| (k.abs_diff(quarter), &round[k..k + n])) {
                let aslant = cos[off % n];
                if aslant > 0.1 {
                    let per_cos = 1.0 / aslant;
                    for (radius, h) in radii.iter_mut().zip(h) {
                        let here = h * per_cos;
                        *radius = if here < *radius { here } else { *radius };
                    }
                }
            }
        }
        fill_gaps(&mut radii, rows, n);
        radii
    }

    /// Distance from the line itself of a row's cloth in a direction, not from the row's middle.
    fn offset(&self, row: usize, k: usize) -> f32 {
        let (c, d) = (self.centers[row], self.directions[k]);
        c[0] * d[0] + c[1] * d[1]
    }

    /// Lets the cloth hang: downwards it comes nearer to the line by at most `fall` per metre, by
    /// direction. A negative fall makes it wider.
    pub fn hang(&mut self, fall: impl Fn(Vec3) -> f32) {
        let n = self.columns;
        let falls: Vec<f32> = self
            .directions
            .iter()
            .map(|d| fall(self.across * d[0] + self.ahead * d[1]) * self.step)
            .collect();
        for row in 1..self.centers.len() {
            for (k, fall) in falls.iter().enumerate() {
                let above = self.radii[(row - 1) * n + k] + self.offset(row - 1, k);
                let least = above - fall - self.offset(row, k);
                let radius = &mut self.radii[row * n + k];
                *radius = radius.max(least);
            }
        }
    }

    /// Where a point stands against the tube.
    pub fn spot(&self, p: Vec3) -> Spot {
        let r = p - self.origin;
        let last = self.centers.len() - 1;
        let row = ((r.dot(self.axis) - self.from) / self.step).clamp(0.0, last as f32);
        let (i, t) = ((row as usize).min(last - 1), row - (row as usize).min(last - 1) as f32);
        let mix = |a: f32, b: f32| a + (b - a) * t;
        let (c, d) = (self.centers[i], self.centers[i + 1]);
        let a = r.dot(self.across) - mix(c[0], d[0]);
        let b = r.dot(self.ahead) - mix(c[1], d[1]);
        let own = (a * a + b * b).sqrt();
        let n = self.columns;
        let at = turn(a, b) * n as f32;
        let (k, s) = (at as usize % n, at - (at as usize) as f32);
        let along = |row: usize| {
            let (x, y) = (self.radii[row * n + k], self.radii[row * n + (k + 1) % n]);
            x + (y - x) * s
        };
        let out = (self.across * a + self.ahead * b).normalize_or(self.ahead);
        Spot { radius: mix(along(i), along(i + 1)), own, out }
    }
}

/// The angle from the first axis towards the second, as a share of a turn, 0..1, to 2e-6: by a
/// polynomial (Abramowitz and Stegun, "Handbook of Mathematical Functions", 4.4.47).
fn turn(a: f32, b: f32) -> f32 {
    let (x, y) = (a.abs(), b.abs());
    let t = x.min(y) / x.max(y).max(f32::MIN_POSITIVE);
    let s = t * t;
    let series = 0.180_141 + s * (-0.085_133 + s * 0.020_835_1);
    let angle = t * (0.999_866 + s * (-0.330_299_5 + s * series));
    let eighth = angle * (1.0 / std::f32::consts::TAU);
    let quarter = if y > x { 0.25 - eighth } else { eighth };
    let half = if a < 0.0 { 0.5 - quarter } else { quarter };
    if b < 0.0 && half > 0.0 { 1.0 - half } else { half }
}

/// Rows without points take the radii of the row before.
fn fill_gaps(radii: &mut [f32], rows: usize, columns: usize) {
    for row in 1..rows {
        if radii[row * columns] == 0.0 {
            radii.copy_within((row - 1) * columns..row * columns, row * columns);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns side by side, 0.1 thick, 0.2 apart, from y = 1 to y = 0.
    fn two_legs() -> Vec<Vec3> {
        let ring = |i: i32| {
            let a = std::f32::consts::TAU * i as f32 / 32.0;
            Vec3::new(0.05 * libm::cosf(a), 0.0, 0.05 * libm::sinf(a))
        };
        let rows = (0..=20).map(|r| Vec3::Y * (r as f32 / 20.0));
        let all =
            |y: Vec3| (0..32).flat_map(move |i| [-0.1, 0.1].map(|x| y + ring(i) + Vec3::X * x));
        rows.flat_map(all).collect()
    }

    fn tube(points: &[Vec3]) -> Tube {
        let line = (Vec3::Y, Vec3::NEG_Y);
        Tube::new(line, Vec3::Z, (8, 32), points.iter().copied()).unwrap()
    }

    #[test]
    fn a_tube_spans_the_hollow_between_two_legs_and_holds_all_points() {
        let points = two_legs();
        let tube = tube(&points);
        for p in &points {
            let s = tube.spot(*p);
            // Between two columns the cloth is a straight piece of a round thing.
            assert!(s.own <= s.radius + 2e-3, "{p}");
        }
        let front = tube.spot(Vec3::new(0.0, 0.5, 0.02));
        assert!((front.radius - 0.05).abs() < 0.003 && front.out.z > 0.99);
        let side = tube.spot(Vec3::new(0.3, 0.5, 0.0));
        assert!((side.radius - 0.15).abs() < 0.003, "{}", side.radius);
    }

    #[test]
    fn turns_are_those_of_the_arc_tangent() {
        for i in 0..720 {
            let angle = std::f32::consts::TAU * i as f32 / 720.0;
            let found = turn(0.3 * libm::cosf(angle), 0.3 * libm::sinf(angle));
            let off = (found - i as f32 / 720.0).abs();
            assert!(off < 3e-6 || (off - 1.0).abs() < 3e-6, "{i} {found}");
            assert!((0.0..=1.0).contains(&found));
        }
        assert_eq!(turn(0.0, 0.0), 0.0);
    }

    #[test]
    fn hanging_cloth_does_not_follow_the_body_inwards() {
        let cone = two_legs().into_iter().map(|p| Vec3::new(p.x * p.y, p.y, p.z * p.y));
        let mut tube = tube(&cone.collect::<Vec<_>>());
        let low = Vec3::new(0.2, 0.1, 0.0);
        assert!(tube.spot(low).radius < 0.04);
        tube.hang(|_| 0.05);
        assert!(tube.spot(low).radius > 0.10);
        tube.hang(|out| if out.x > 0.5 { -0.2 } else { 0.05 });
        assert!(
            tube.spot(low).radius > 0.30
                && tube.spot(-low * Vec3::new(1.0, -1.0, 1.0)).radius < 0.16
        );
    }
}
