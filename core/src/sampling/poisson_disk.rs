//! Saturated Poisson-disk patterns (Bridson, "Fast Poisson disk sampling in arbitrary dimensions",
//! SIGGRAPH sketches 2007), with the seed's details: one candidate in each of 30 sectors, and a
//! margin that is cut off so that the edge is as dense as the middle.

use crate::base::rng::Stream;

const SECTORS: u32 = 30;

/// Points in `[0, width) x [0, height)` at least `radius` apart.
pub(super) fn poisson_disk(
    width: f64,
    height: f64,
    radius: f64,
    stream: &mut Stream,
) -> Vec<[f64; 2]> {
    let size = [width + 2.0 * radius, height + 2.0 * radius];
    let mut pattern = Pattern::new(size, radius);
    pattern.add([stream.uniform() * size[0], stream.uniform() * size[1]]);
    let mut active = vec![0];
    while !active.is_empty() {
        let chosen = stream.below(active.len());
        let from = pattern.points[active[chosen]];
        match candidate(&pattern, from, stream) {
            Some(point) => active.push(pattern.add(point)),
            None => {
                active.swap_remove(chosen);
            }
        }
    }
    let inside = |p: &[f64; 2]| (0.0..width).contains(&p[0]) && (0.0..height).contains(&p[1]);
    let moved = pattern.points.iter().map(|p| [p[0] - radius, p[1] - radius]);
    moved.filter(inside).collect()
}

/// The first of a point's candidates that keeps its distance. All points begin with the same sector,
/// as the seed does: it packs them by two in a hundred denser than a random one.
fn candidate(pattern: &Pattern, from: [f64; 2], stream: &mut Stream) -> Option<[f64; 2]> {
    let sector = std::f64::consts::TAU / f64::from(SECTORS);
    (0..SECTORS).find_map(|k| {
        let angle = (f64::from(k) + stream.uniform()) * sector;
        let distance = pattern.radius * (1.0 + stream.uniform());
        let point = [from[0] + distance * libm::cos(angle), from[1] + distance * libm::sin(angle)];
        pattern.has_room(point).then_some(point)
    })
}

struct Pattern {
    size: [f64; 2],
    radius: f64,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Index of the point in each cell plus one; a cell has room for one.
    cells: Vec<u32>,
    points: Vec<[f64; 2]>,
}

impl Pattern {
    fn new(size: [f64; 2], radius: f64) -> Self {
        let cell = radius * std::f64::consts::FRAC_1_SQRT_2;
        let [columns, rows] = size.map(|s| (s / cell).ceil() as usize);
        Self {
            size,
            radius,
            cell,
            columns,
            rows,
            cells: vec![0; columns * rows],
            points: Vec::new(),
        }
    }

    fn cell_of(&self, point: [f64; 2]) -> (usize, usize) {
        let index = |v: f64, count: usize| ((v / self.cell) as usize).min(count - 1);
        (index(point[0], self.columns), index(point[1], self.rows))
    }

    fn add(&mut self, point: [f64; 2]) -> usize {
        let (column, row) = self.cell_of(point);
        self.points.push(point);
        self.cells[row * self.columns + column] = self.points.len() as u32;
        self.points.len() - 1
    }

    fn has_room(&self, point: [f64; 2]) -> bool {
        if !(0..2).all(|i| (0.0..self.size[i]).contains(&point[i])) {
            return false;
        }
        let (column, row) = self.cell_of(point);
        let near = |i: usize, count: usize| i.saturating_sub(2)..(i + 3).min(count);
        !near(row, self.rows).any(|row| {
            near(column, self.columns).any(|column| {
                let index = self.cells[row * self.columns + column];
                index > 0 && {
                    let other = self.points[index as usize - 1];
                    let (dx, dy) = (other[0] - point[0], other[1] - point[1]);
                    dx * dx + dy * dy < self.radius * self.radius
                }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Draws, Key};

    fn pattern(frame: u32, width: f64, height: f64, radius: f64) -> Vec<[f64; 2]> {
        let mut stream = Draws::new(11, frame).of(Key::new("test"), 0).stream();
        poisson_disk(width, height, radius, &mut stream)
    }

    fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
        ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
    }

    #[test]
    fn points_keep_their_distance_and_leave_no_hole() {
        for frame in 0..20 {
            let points = pattern(frame, 15.0, 9.0, 1.0);
            for (i, a) in points.iter().enumerate() {
                assert!((0.0..15.0).contains(&a[0]) && (0.0..9.0).contains(&a[1]));
                assert!(points[..i].iter().all(|b| distance(*a, *b) >= 1.0));
            }
            // Saturated: away from the edge, where points were cut off, no further disc fits.
            for i in 0..200 {
                let p =
                    [1.0 + 13.0 * f64::from(i % 20) / 20.0, 1.0 + 7.0 * f64::from(i / 20) / 10.0];
                assert!(points.iter().any(|q| distance(p, *q) < 1.1), "hole at {p:?}");
            }
        }
    }

    /// Counts of the seed over a 15 m square, mean and standard deviation by separation.
    #[test]
    fn counts_are_the_seeds() {
        for (radius, mean, spread) in [(2.0, 37.4, 2.0), (2.5, 24.1, 1.7), (3.0, 16.8, 1.5)] {
            let counts: Vec<f64> =
                (0..1000).map(|frame| pattern(frame, 15.0, 15.0, radius).len() as f64).collect();
            let got = counts.iter().sum::<f64>() / 1000.0;
            let variance = counts.iter().map(|c| (c - got) * (c - got)).sum::<f64>() / 999.0;
            assert!((got - mean).abs() < 0.3, "radius {radius}: mean {got}");
            assert!(
                (variance.sqrt() - spread).abs() < 0.3,
                "radius {radius}: sd {}",
                variance.sqrt()
            );
        }
    }

    #[test]
    fn a_sliver_is_no_trouble() {
        assert!(pattern(0, 1e-6, 1e-6, 5.0).len() <= 1);
        assert!(pattern(0, 100.0, 1e-6, 1.0).len() < 100);
    }
}
