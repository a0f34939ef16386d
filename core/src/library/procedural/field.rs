//! Scalar fields over the canvas: periodic noise and scattered cells.

use super::canvas::{SIDE, fade, floor};
use super::dice::Dice;

/// One number for each pixel of the canvas, wrapping at all sides.
#[derive(Clone, Debug)]
pub(super) struct Field(pub Vec<f32>);

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
        let mut field = Self::filled(0.0);
        let (mut amplitude, mut total) = (1.0, 0.0);
        for octave in 0..octaves {
            let (c, r) = (columns << octave, rows << octave);
            if c > SIDE / 2 || r > SIDE / 2 {
                break;
            }
            field.add_octave(dice, c, r, amplitude);
            total += amplitude * amplitude;
            amplitude *= gain;
        }
        // One octave reaches 0.7; a sum of several is more often near its middle.
        let scale = 1.35 / f32::sqrt(total);
        for v in &mut field.0 {
            *v *= scale;
        }
        field
    }

    /// Noise with square cells.
    pub fn fbm(dice: &mut Dice, cells: usize, octaves: u32) -> Self {
        Self::noise(dice, cells, cells, octaves, 0.5)
    }

    /// One octave of gradient noise (Perlin, "Improving noise", 2002). In a row of a cell each
    /// corner's share is a straight line in x, so a pixel costs two of them and a blend.
    fn add_octave(&mut self, dice: &mut Dice, columns: usize, rows: usize, amplitude: f32) {
        let gradients: Vec<[f32; 2]> = (0..columns * rows).map(|_| dice.direction()).collect();
        // Where in its cell each column of pixels lies, and where each cell begins.
        let mut across = Vec::with_capacity(SIDE);
        let mut starts = Vec::with_capacity(columns + 1);
        for x in 0..SIDE {
            let p = (x as f32 + 0.5) * columns as f32 / SIDE as f32;
            let cell = (p as usize).min(columns - 1);
            let u = p - cell as f32;
            across.push([u, fade(u)]);
            if cell == starts.len() {
                starts.push(x);
            }
        }
        starts.push(SIDE);
        let mut lines = vec![[0.0f32; 2]; columns + 1];
        for y in 0..SIDE {
            let p = (y as f32 + 0.5) * rows as f32 / SIDE as f32;
            let cell = (p as usize).min(rows - 1);
            let v = p - cell as f32;
            let blend = fade(v);
            let upper = &gradients[cell * columns..][..columns];
            let lower = &gradients[(cell + 1) % rows * columns..][..columns];
            for ((line, a), b) in lines.iter_mut().zip(upper).zip(lower) {
                let (ya, yb) = (a[1] * v, b[1] * (v - 1.0));
                *line = [
                    amplitude * (ya + (yb - ya) * blend),
                    amplitude * (a[0] + (b[0] - a[0]) * blend),
                ];
            }
            lines[columns] = lines[0];
            let row = &mut self.0[y * SIDE..][..SIDE];
            for (ends, corners) in starts.windows(2).zip(lines.windows(2)) {
                let ([a0, b0], [a1, b1]) = (corners[0], corners[1]);
                let cell = ends[0]..ends[1];
                for (value, &[u, t]) in row[cell.clone()].iter_mut().zip(&across[cell]) {
                    let (left, right) = (a0 + b0 * u, a1 + b1 * (u - 1.0));
                    *value += left + (right - left) * t;
                }
            }
        }
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
