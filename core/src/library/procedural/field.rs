//! Scalar fields over the canvas: periodic noise and scattered cells.

use super::canvas::{SIDE, fade, floor};
use super::dice::Dice;

/// One number for each pixel of the canvas, wrapping at all sides.
#[derive(Clone, Debug)]
pub(in crate::library) struct Field(pub Vec<f32>);

impl Field {
    pub fn filled(value: f32) -> Self {
        Self(vec![value; SIDE * SIDE])
    }

    pub fn from_fn(mut f: impl FnMut(usize, usize) -> f32) -> Self {
        let mut values = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            for x in 0..SIDE {
                values.push(f(x, y));
            }
        }
        Self(values)
    }

    /// Gradient noise in `octaves`, the first with `columns` by `rows` cells, each further one
    /// twice as fine and `gain` times as strong. About -1..1, mean 0.
    pub fn noise(dice: &mut Dice, columns: usize, rows: usize, octaves: u32, gain: f32) -> Self {
        let mut all = Vec::new();
        let (mut amplitude, mut total) = (1.0, 0.0);
        for octave in 0..octaves {
            let (c, r) = (columns << octave, rows << octave);
            if c > SIDE / 2 || r > SIDE / 2 {
                break;
            }
            all.push(Octave::new(dice, c, r, amplitude));
            total += amplitude * amplitude;
            amplitude *= gain;
        }
        // One octave reaches 0.7; a sum of several is more often near its middle.
        let scale = 1.35 / f32::sqrt(total);
        let mut field = Self::filled(0.0);
        for (y, row) in field.0.as_chunks_mut::<SIDE>().0.iter_mut().enumerate() {
            for octave in &mut all {
                octave.add_row(y, row);
            }
            for v in row {
                *v *= scale;
            }
        }
        field
    }

    /// Noise with square cells.
    pub fn fbm(dice: &mut Dice, cells: usize, octaves: u32) -> Self {
        Self::noise(dice, cells, cells, octaves, 0.5)
    }

    /// The value at a pixel, which may lie outside the canvas.
    pub fn at(&self, x: i32, y: i32) -> f32 {
        let wrap = |v: i32| (v & (SIDE as i32 - 1)) as usize;
        self.0[wrap(y) * SIDE + wrap(x)]
    }

    /// The value between pixels.
    pub fn sample(&self, x: f32, y: f32) -> f32 {
        let (ix, iy) = (floor(x), floor(y));
        let (u, v) = (x - ix as f32, y - iy as f32);
        let top = self.at(ix, iy) + (self.at(ix + 1, iy) - self.at(ix, iy)) * u;
        let bottom = self.at(ix, iy + 1) + (self.at(ix + 1, iy + 1) - self.at(ix, iy + 1)) * u;
        top + (bottom - top) * v
    }

    /// The field read at places that two others have moved by up to `reach` pixels.
    pub fn warped(&self, by: [&Self; 2], reach: f32) -> Self {
        Self::from_fn(|x, y| {
            let i = y * SIDE + x;
            self.sample(x as f32 + reach * by[0].0[i], y as f32 + reach * by[1].0[i])
        })
    }

    pub fn map(mut self, f: impl Fn(f32) -> f32) -> Self {
        for v in &mut self.0 {
            *v = f(*v);
        }
        self
    }

    /// Shifts all values so that their mean is `mean`.
    pub fn with_mean(self, mean: f32) -> Self {
        let sum: f64 = self.0.iter().map(|&v| f64::from(v)).sum();
        let shift = mean - (sum / (SIDE * SIDE) as f64) as f32;
        self.map(|v| v + shift)
    }
}

/// One octave of gradient noise (Perlin, "Improving noise", 2002), row by row.
///
/// Within a row of cells the value is a sum of four products of a function of x and one of y: the
/// functions of x are tabulated once for the row of cells, and a pixel costs four products.
struct Octave {
    columns: usize,
    rows: usize,
    amplitude: f32,
    gradients: Vec<[f32; 2]>,
    /// For each column of pixels: its cell, where in the cell it lies, and its blend.
    across: Vec<(usize, f32, f32)>,
    /// The row of cells that is tabulated.
    tabulated: Option<usize>,
    upper: Table,
    lower: Table,
}

/// A row of gradients over all columns of pixels: the blend of what their x parts give, and of
/// their y parts.
struct Table {
    x: Box<[f32; SIDE]>,
    y: Box<[f32; SIDE]>,
}

impl Table {
    fn fill(&mut self, across: &[(usize, f32, f32)], corners: &[[f32; 2]]) {
        for ((&(cell, u, t), x), y) in across.iter().zip(self.x.iter_mut()).zip(self.y.iter_mut()) {
            let next = if cell + 1 == corners.len() { 0 } else { cell + 1 };
            let (left, right) = (corners[cell], corners[next]);
            let (from_left, from_right) = (left[0] * u, right[0] * (u - 1.0));
            *x = from_left + (from_right - from_left) * t;
            *y = left[1] + (right[1] - left[1]) * t;
        }
    }
}

/// The cell of a pixel along an axis, and where in the cell it lies, 0..1.
fn cell_of(pixel: usize, cells: usize) -> (usize, f32) {
    let p = (pixel as f32 + 0.5) * cells as f32 / SIDE as f32;
    let cell = (p as usize).min(cells - 1);
    (cell, p - cell as f32)
}

impl Octave {
    fn new(dice: &mut Dice, columns: usize, rows: usize, amplitude: f32) -> Self {
        let column = |x: usize| {
            let (cell, u) = cell_of(x, columns);
            (cell, u, fade(u))
        };
        let empty = || Table { x: Box::new([0.0; SIDE]), y: Box::new([0.0; SIDE]) };
        Self {
            columns,
            rows,
            amplitude,
            gradients: (0..columns * rows).map(|_| dice.direction()).collect(),
            across: (0..SIDE).map(column).collect(),
            tabulated: None,
            upper: empty(),
            lower: empty(),
        }
    }

    /// Tabulates the gradients above a row of cells and those below it.
    fn tabulate(&mut self, row: usize) {
        if row > 0 && self.tabulated == Some(row - 1) {
            std::mem::swap(&mut self.upper, &mut self.lower);
        } else {
            let corners = &self.gradients[row * self.columns..][..self.columns];
            self.upper.fill(&self.across, corners);
        }
        let below = (row + 1) % self.rows;
        let corners = &self.gradients[below * self.columns..][..self.columns];
        self.lower.fill(&self.across, corners);
        self.tabulated = Some(row);
    }

    fn add_row(&mut self, y: usize, out: &mut [f32; SIDE]) {
        let (cell, v) = cell_of(y, self.rows);
        if self.tabulated != Some(cell) {
            self.tabulate(cell);
        }
        let below = self.amplitude * fade(v);
        let above = self.amplitude - below;
        let (above_y, below_y) = (above * v, below * (v - 1.0));
        let (upper, lower) = (&self.upper, &self.lower);
        for (x, out) in out.iter_mut().enumerate() {
            *out += (above * upper.x[x] + above_y * upper.y[x])
                + (below * lower.x[x] + below_y * lower.y[x]);
        }
    }
}

/// Points scattered one in each cell of a square grid, and who is nearest.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    per_side: usize,
    points: Vec<[f32; 2]>,
}

/// The nearest point and the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// Which point is nearest.
    pub id: usize,
    /// Pixels to it.
    pub first: f32,
    /// Pixels to the second.
    pub second: f32,
    /// From it to here.
    pub offset: [f32; 2],
}

impl Cells {
    /// `jitter` 0 leaves all points on the grid, 1 spreads them over their whole cells.
    pub fn new(dice: &mut Dice, per_side: usize, jitter: f32) -> Self {
        let mut place = || 0.5 + jitter * (dice.unit() - 0.5);
        let points = (0..per_side * per_side).map(|_| [place(), place()]).collect();
        Self { per_side, points }
    }

    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// What lies nearest to a place on the canvas, or up to one canvas beside it.
    pub fn near(&self, x: f32, y: f32) -> Near {
        let n = self.per_side;
        let size = SIDE as f32 / n as f32;
        let (px, py) = (x * (n as f32 / SIDE as f32), y * (n as f32 / SIDE as f32));
        let (cx, cy) = (floor(px), floor(py));
        let (u, v) = (px - cx as f32, py - cy as f32);
        // The cell before, the own and the next, wrapped.
        let wrapped = |cell: i32| {
            let own = if cell < 0 {
                cell + n as i32
            } else if cell >= n as i32 {
                cell - n as i32
            } else {
                cell
            } as usize;
            let next = if own + 1 == n { 0 } else { own + 1 };
            [if own == 0 { n - 1 } else { own - 1 }, own, next]
        };
        let (columns, rows) = (wrapped(cx), wrapped(cy));
        // The order of positive floats is that of their bits; the lowest four give way to the number
        // of the neighbour, so that two integer minima keep track of everything without a branch.
        let (mut first, mut second) = (u32::MAX, u32::MAX);
        let offset = |k: u32| {
            let point = self.points[rows[k as usize / 3] * n + columns[k as usize % 3]];
            let (dx, dy) = ((k % 3) as f32 - 1.0, (k / 3) as f32 - 1.0);
            [u - dx - point[0], v - dy - point[1]]
        };
        for k in 0..9 {
            let [ox, oy] = offset(k);
            let key = (ox * ox + oy * oy).to_bits() & !15 | k;
            second = second.min(first.max(key));
            first = first.min(key);
        }
        let distance = |key: u32| f32::from_bits(key & !15).sqrt() * size;
        let k = first & 15;
        Near {
            id: rows[k as usize / 3] * n + columns[k as usize % 3],
            first: distance(first),
            second: distance(second),
            offset: offset(k).map(|o| o * size),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_wraps_fills_its_range_and_has_no_steps() {
        for (columns, rows) in [(3, 3), (8, 5), (256, 2), (1, 7)] {
            let field = Field::noise(&mut Dice::new("noise"), columns, rows, 4, 0.5);
            let side = SIDE as i32;
            let step = |a: f32, b: f32| (a - b).abs();
            let (mut inside, mut seam) = (0.0f32, 0.0f32);
            for i in 0..side {
                for k in 1..side {
                    inside = inside.max(step(field.at(k, i), field.at(k - 1, i)));
                    inside = inside.max(step(field.at(i, k), field.at(i, k - 1)));
                }
                seam = seam.max(step(field.at(0, i), field.at(side - 1, i)));
                seam = seam.max(step(field.at(i, 0), field.at(i, side - 1)));
            }
            assert!(seam <= inside, "{columns}x{rows}: {seam} {inside}");
            let reach = field.0.iter().fold(0.0f32, |m, v| m.max(v.abs()));
            assert!((0.5..2.0).contains(&reach), "{reach}");
            let mean = field.0.iter().sum::<f32>() / field.0.len() as f32;
            assert!(mean.abs() < 0.2, "{mean}");
        }
    }

    #[test]
    fn the_nearest_cell_is_the_nearest_of_all() {
        let mut dice = Dice::new("cells");
        let cells = Cells::new(&mut dice, 7, 0.8);
        let size = SIDE as f32 / 7.0;
        for _ in 0..500 {
            let [x, y] = dice.place();
            let near = cells.near(x, y);
            let distance = |id: usize| {
                let [px, py] = cells.points[id];
                let wrapped = |d: f32| {
                    let d = d.abs() % SIDE as f32;
                    d.min(SIDE as f32 - d)
                };
                let dx = wrapped(x - ((id % 7) as f32 + px) * size);
                let dy = wrapped(y - ((id / 7) as f32 + py) * size);
                (dx * dx + dy * dy).sqrt()
            };
            let best = (0..cells.len()).map(distance).fold(f32::MAX, f32::min);
            assert!((near.first - best).abs() < 1e-2, "{} {best}", near.first);
            assert!((distance(near.id) - best).abs() < 1e-2);
            assert!(near.second >= near.first);
        }
    }
}
