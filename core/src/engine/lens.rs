//! Where the samples of a picture lie behind a lens: what both engines must agree on.
//!
//! The raster works in the plane of a pinhole, in which edges are straight. Behind a lens the samples
//! of the picture are carried back into that plane, each rounded to the raster's grid, and everything
//! else is as it was: edges that triangles share stay shared, and picture, ids, boxes and counts come
//! from the same samples. The plane is as large as the way back reaches; where that is more than a
//! picture may be, its pixels are larger than the picture's.
//!
//! Newton's method in `f64` with operations that are exactly rounded, so that positions are the same
//! on every machine; [`crate::base::lens`] has the formulas.

use std::sync::Arc;

use super::input::MAX_SIDE;
use super::pattern::RASTER_BITS;
use crate::base::lens::{LensGrid, Polynomial};
use crate::draw::DrawList;
use crate::draw::abi::View;

/// Side of the squares of pixels that [`Squares`] tells of.
pub(super) const SQUARE: u32 = 8;
/// Pixels that are solved for together.
pub(super) const EIGHT: usize = 8;
/// Pixels of the plane that are left free on each side.
const MARGIN_PX: f64 = 2.0;

/// Eight numbers.
type Lanes = [f64; EIGHT];

/// A picture behind a lens, and the pinhole's plane that it is rastered in.
#[derive(Clone, Debug)]
pub(super) struct LensPlane {
    grid: Arc<LensGrid>,
    polynomial: Polynomial,
    picture: View,
    /// The pinhole's plane as a picture of its own.
    pub(super) plane: View,
}

/// The way back from the centres of eight pixels.
pub(super) struct Pixels {
    v: [Lanes; 2],
    /// Change of v over a pixel: of its x to the right and down, then of its y.
    slope: [Lanes; 4],
    center_px: [Lanes; 2],
}

/// Ray through the centre of eight pixels and its change over a pixel.
pub(super) struct RaysThrough {
    /// View space, at z = -1.
    pub(super) x: [f32; EIGHT],
    /// See `x`.
    pub(super) y: [f32; EIGHT],
    /// Change of x to the right and down, then of y.
    pub(super) change: [[f32; EIGHT]; 4],
}

impl LensPlane {
    /// Behind the lens of a draw list; nothing where there is none.
    pub(super) fn new(list: &DrawList) -> Option<Self> {
        let grid = Arc::clone(list.lens.as_ref()?);
        let [low, high] = grid.extent();
        let view = list.view;
        let focal = [view.fx, view.fy].map(f64::from);
        let reach_px = [(high.x - low.x) * focal[0], (high.y - low.y) * focal[1]];
        let room_px = f64::from(MAX_SIDE) - 4.0 * MARGIN_PX;
        let scale = f64::min(1.0, room_px / reach_px[0].max(reach_px[1]));
        let side = |axis: usize, low: f64, high: f64| {
            let focal = (focal[axis] * scale) as f32;
            let center = (MARGIN_PX - low * f64::from(focal)).ceil();
            let end = (high * f64::from(focal) + center + MARGIN_PX).ceil();
            (focal, center as f32, end as u32)
        };
        let (fx, cx, width) = side(0, low.x, high.x);
        let (fy, cy, height) = side(1, low.y, high.y);
        let plane = View { width, height, fx, fy, cx, cy, ..view };
        let polynomial = grid.lens().polynomial();
        Some(Self { grid, polynomial, picture: view, plane })
    }

    /// Whether it is that of another draw list as well.
    pub(super) fn serves(&self, list: &DrawList) -> bool {
        let key = |v: &View| [v.fx, v.fy, v.cx, v.cy].map(f32::to_bits);
        let size = |v: &View| [v.width, v.height];
        list.lens.as_ref().is_some_and(|grid| {
            (Arc::ptr_eq(grid, &self.grid) || **grid == *self.grid)
                && key(&list.view) == key(&self.picture)
                && size(&list.view) == size(&self.picture)
        })
    }

    /// A position in the picture, normalised.
    #[inline(always)]
    fn normalised(&self, axis: usize, px: f64) -> f64 {
        let view = &self.picture;
        let (center, focal) = [(view.cx, view.fx), (view.cy, view.fy)][axis];
        (px - f64::from(center)) / f64::from(focal)
    }

    /// The way back from eight pixels; those beyond the border take what stands on it.
    #[inline(always)]
    pub(super) fn pixels(&self, columns: [u32; EIGHT], rows: [u32; EIGHT]) -> Pixels {
        let (mut center_px, mut target) = ([[0.0; EIGHT]; 2], [[0.0; EIGHT]; 2]);
        let mut v = [[0.0; EIGHT]; 2];
        for i in 0..EIGHT {
            let x = f64::from(columns[i].min(self.picture.width - 1)) + 0.5;
            let y = f64::from(rows[i].min(self.picture.height - 1)) + 0.5;
            (center_px[0][i], center_px[1][i]) = (x, y);
            (target[0][i], target[1][i]) = (self.normalised(0, x), self.normalised(1, y));
            [v[0][i], v[1][i]] = self.grid.near(x, y).to_array();
        }
        for _ in 0..4 {
            step(&self.polynomial, &target, &mut v);
        }
        let mut slope = [[0.0; EIGHT]; 4];
        let focal = [self.picture.fx, self.picture.fy].map(f64::from);
        for i in 0..EIGHT {
            let At { a, b, d, .. } = at(&self.polynomial, v[0][i], v[1][i]);
            let inverse = 1.0 / (a * d - b * b);
            slope[0][i] = d * inverse / focal[0];
            slope[1][i] = -b * inverse / focal[1];
            slope[2][i] = -b * inverse / focal[0];
            slope[3][i] = a * inverse / focal[1];
        }
        Pixels { v, slope, center_px }
    }

    /// Where in the plane one sample of each of eight pixels lies, raster units; its position in a
    /// pixel is given in 1/16.
    #[inline(always)]
    pub(super) fn samples(&self, pixels: &Pixels, position: [i32; 2]) -> [[i32; EIGHT]; 2] {
        let offset = position.map(|p| f64::from(p - 8) / 16.0);
        let (mut target, mut v) = ([[0.0; EIGHT]; 2], [[0.0; EIGHT]; 2]);
        for i in 0..EIGHT {
            for axis in 0..2 {
                let px = pixels.center_px[axis][i] + offset[axis];
                target[axis][i] = self.normalised(axis, px);
                v[axis][i] = pixels.v[axis][i]
                    + pixels.slope[2 * axis][i] * offset[0]
                    + pixels.slope[2 * axis + 1][i] * offset[1];
            }
        }
        for _ in 0..2 {
            step(&self.polynomial, &target, &mut v);
        }
        let mut places = [[0; EIGHT]; 2];
        let units = f64::from(1 << RASTER_BITS);
        let focal = [self.plane.fx, self.plane.fy].map(|f| f64::from(f) * units);
        let center = [self.plane.cx, self.plane.cy].map(|c| f64::from(c) * units);
        for i in 0..EIGHT {
            let lengthening = self.lengthening(v[0][i], v[1][i]);
            for axis in 0..2 {
                places[axis][i] = rounded(v[axis][i] * lengthening * focal[axis] + center[axis]);
            }
        }
        places
    }

    /// Rays through the centres of eight pixels.
    #[inline(always)]
    pub(super) fn rays(&self, pixels: &Pixels) -> RaysThrough {
        let mut rays = RaysThrough { x: [0.0; EIGHT], y: [0.0; EIGHT], change: [[0.0; EIGHT]; 4] };
        for i in 0..EIGHT {
            let (vx, vy) = (pixels.v[0][i], pixels.v[1][i]);
            let t = self.lengthening(vx, vy);
            let bend = if self.polynomial.of_angle { bend(vx * vx + vy * vy) } else { 0.0 };
            // u = t v, and t changes by `bend` times the change of v along v.
            let (xx, xy, yy) = (t + bend * vx * vx, bend * vx * vy, t + bend * vy * vy);
            let slope = [0, 1, 2, 3].map(|k: usize| pixels.slope[k][i]);
            (rays.x[i], rays.y[i]) = ((vx * t) as f32, (-vy * t) as f32);
            rays.change[0][i] = (xx * slope[0] + xy * slope[2]) as f32;
            rays.change[1][i] = (xx * slope[1] + xy * slope[3]) as f32;
            rays.change[2][i] = -(xy * slope[0] + yy * slope[2]) as f32;
            rays.change[3][i] = -(xy * slope[1] + yy * slope[3]) as f32;
        }
        rays
    }

    /// By how much the pinhole's position is longer than v.
    #[inline(always)]
    fn lengthening(&self, x: f64, y: f64) -> f64 {
        if !self.polynomial.of_angle {
            return 1.0;
        }
        let s = x * x + y * y;
        series(&SINE, s) / series(&COSINE, s)
    }
}

/// To nearest, by way of a number so large that its last binary digit is worth one.
#[inline(always)]
fn rounded(v: f64) -> i32 {
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
    (v + ROUND).to_bits() as i32
}

/// Change of tan(a)/a with a's square, twice: what a tangent grows by along the radius beyond what it
/// does across it, over the square.
#[inline(always)]
fn bend(s: f64) -> f64 {
    let (sine, cosine) = (series(&SINE, s), series(&COSINE, s));
    let exact = (1.0 / (cosine * cosine) - sine / cosine) / s.max(1e-300);
    // Next to the axis nothing but rounding would be left.
    if s > 1e-4 { exact } else { 2.0 / 3.0 + s * (8.0 / 15.0) }
}

/// sin(a) / a by powers of -a^2.
const SINE: [f64; 12] = reciprocal_factorials(1);
/// cos(a), likewise.
const COSINE: [f64; 12] = reciprocal_factorials(0);

/// 1 / (2 n + first)!.
const fn reciprocal_factorials(first: u32) -> [f64; 12] {
    let mut all = [0.0; 12];
    let (mut factorial, mut k, mut n) = (1.0, first, 0);
    while n < 12 {
        all[n] = 1.0 / factorial;
        factorial *= ((k + 1) * (k + 2)) as f64;
        k += 2;
        n += 1;
    }
    all
}

/// A power series in -s. Below 80 degrees its rest is less than a double tells.
#[inline(always)]
fn series(coefficients: &[f64; 12], s: f64) -> f64 {
    let mut sum = coefficients[11];
    let mut n = 11;
    while n > 0 {
        n -= 1;
        sum = coefficients[n] - s * sum;
    }
    sum
}

/// A polynomial's value and its Jacobian, which is symmetric.
struct At {
    x: f64,
    y: f64,
    a: f64,
    b: f64,
    d: f64,
}

/// As [`Polynomial::distort`] and [`Polynomial::jacobian`], together.
#[inline(always)]
fn at(p: &Polynomial, x: f64, y: f64) -> At {
    let ([c0, c1, c2, c3], [p1, p2]) = (p.radial, p.tangential);
    let (xx, xy, yy) = (x * x, x * y, y * y);
    let s = xx + yy;
    let radial = 1.0 + s * (c0 + s * (c1 + s * (c2 + s * c3)));
    let slope = 2.0 * (c0 + s * (2.0 * c1 + s * (3.0 * c2 + s * (4.0 * c3))));
    let (tx, ty) = (2.0 * (p1 * y + p2 * x), 2.0 * (p1 * x + p2 * y));
    At {
        x: x * radial + p1 * (2.0 * xy) + p2 * (s + 2.0 * xx),
        y: y * radial + p1 * (s + 2.0 * yy) + p2 * (2.0 * xy),
        a: radial + xx * slope + tx + 4.0 * p2 * x,
        b: xy * slope + ty,
        d: radial + yy * slope + tx + 4.0 * p1 * y,
    }
}

/// One step of Newton's method towards eight targets.
#[inline(always)]
fn step(p: &Polynomial, target: &[Lanes; 2], v: &mut [Lanes; 2]) {
    for i in 0..EIGHT {
        let (x, y) = (v[0][i], v[1][i]);
        let At { x: is_x, y: is_y, a, b, d } = at(p, x, y);
        let (ex, ey) = (target[0][i] - is_x, target[1][i] - is_y);
        let inverse = 1.0 / (a * d - b * b);
        v[0][i] = x + (d * ex - b * ey) * inverse;
        v[1][i] = y + (a * ey - b * ex) * inverse;
    }
}
