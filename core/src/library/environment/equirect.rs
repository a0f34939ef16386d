//! Pictures of all directions: longitude to the right, latitude down.
//!
//! A direction (x, y, z), y up, stands at `u = 1/2 + atan2(x, -z) / 2 pi`, `v = acos(y) / pi` of the
//! width and the height: the middle shows what lies along -Z, to the right of it what lies towards
//! +X. The left border continues at the right one.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};

/// A picture of all directions, linear light, twice as wide as high.
#[derive(Clone, Debug, PartialEq)]
pub struct Equirect {
    /// Columns; there are half as many rows.
    pub width: usize,
    /// Rows from the zenith down, `width * width / 2` pixels.
    pub pixels: Vec<Vec3>,
}

/// Coefficients of [`atan`], of odd powers from the first on; off by at most 2e-6 on -1..1.
pub const ATAN: [f32; 8] = [
    0.999_999_3,
    -0.333_298_56,
    0.199_465_36,
    -0.139_085_33,
    0.096_420_04,
    -0.055_909_886,
    0.021_861_23,
    -0.004_054_058,
];

/// Arc tangent on -1..1 (Hastings, "Approximations for digital computers", 1955, sheet 13).
fn atan(t: f32) -> f32 {
    let t2 = t * t;
    ATAN.iter().rev().fold(0.0, |sum, c| sum * t2 + c) * t
}

/// Angle of the vector (x, y), -pi..pi.
fn atan2(y: f32, x: f32) -> f32 {
    let (small, large) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    let angle = atan(small / large.max(f32::MIN_POSITIVE));
    let angle = if y.abs() > x.abs() { FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// Where a direction of any length stands, both 0..1.
#[must_use]
pub fn uv_of(direction: Vec3) -> [f32; 2] {
    let Vec3 { x, y, z } = direction;
    [0.5 + atan2(x, -z) * (0.5 / PI), atan2((x * x + z * z).sqrt(), y) * (1.0 / PI)]
}

/// The unit direction that stands at a place.
#[must_use]
pub fn direction_at(u: f64, v: f64) -> DVec3 {
    let (longitude, polar) = ((u - 0.5) * std::f64::consts::TAU, v * std::f64::consts::PI);
    let level = libm::sin(polar);
    DVec3::new(level * libm::sin(longitude), libm::cos(polar), -level * libm::cos(longitude))
}

impl Equirect {
    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.width / 2
    }

    /// A picture whose pixels are a function of the direction of their middles.
    #[must_use]
    pub fn from_fn(width: usize, mut light: impl FnMut(DVec3) -> Vec3) -> Self {
        let height = width / 2;
        let share = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        // On the horizon; rows differ from it by two factors.
        let level: Vec<DVec3> = (0..width).map(|x| direction_at(share(x, width), 0.5)).collect();
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let polar = std::f64::consts::PI * share(y, height);
            let (around, up) = (libm::sin(polar), libm::cos(polar));
            pixels.extend(level.iter().map(|d| light(DVec3::new(d.x * around, up, d.z * around))));
        }
        Self { width, pixels }
    }

    /// Solid angle of a pixel of each row, steradians; together with all columns 4 pi.
    pub fn solid_angles(&self) -> impl Iterator<Item = f64> + '_ {
        let height = self.height() as f64;
        let border = move |y: usize| libm::cos(std::f64::consts::PI * y as f64 / height);
        let column = std::f64::consts::TAU / self.width as f64;
        (0..self.height()).map(move |y| column * (border(y) - border(y + 1)))
    }

    /// A picture of half the width: means of four.
    #[must_use]
    pub fn halved(&self) -> Self {
        let width = self.width / 2;
        let rows = self.pixels.chunks_exact(2 * self.width);
        let pixels = rows.flat_map(|two| {
            let (upper, lower) = two.split_at(self.width);
            upper
                .chunks_exact(2)
                .zip(lower.chunks_exact(2))
                .map(|(a, b)| (a[0] + a[1] + (b[0] + b[1])) * 0.25)
        });
        Self { width, pixels: pixels.take(width * width / 2).collect() }
    }

    /// A picture of another width: where it grows, by cubic B-splines, which neither overshoot nor
    /// show the pixels' corners; where it shrinks, by halving until the rest grows.
    #[must_use]
    pub fn resized(self, width: usize) -> Self {
        let mut picture = self;
        while picture.width >= 2 * width {
            picture = picture.halved();
        }
        if picture.width == width {
            return picture;
        }
        let (from_width, from_height) = (picture.width, picture.height());
        let height = width / 2;
        let columns = Taps::all(from_width, width, |x| x.rem_euclid(from_width as i64) as usize);
        let rows = Taps::all(from_height, height, |y| y.clamp(0, from_height as i64 - 1) as usize);
        let wide: Vec<Vec3> = picture
            .pixels
            .chunks_exact(from_width)
            .flat_map(|row| columns.iter().map(|taps| taps.of(|x| row[x])))
            .collect();
        let pixels = rows
            .iter()
            .flat_map(|taps| (0..width).map(|x| taps.of(|y| wide[y * width + x])))
            .collect();
        Self { width, pixels }
    }

    /// The light at a place, bilinear.
    #[must_use]
    pub fn at(&self, uv: [f32; 2]) -> Vec3 {
        let (width, height) = (self.width as i32, self.height() as i32);
        let x = uv[0] * width as f32 - 0.5;
        let y = (uv[1] * height as f32 - 0.5).clamp(0.0, (height - 1) as f32);
        let (left, top) = (x.floor(), y.floor());
        let (right_share, lower_share) = (x - left, y - top);
        let column = |i: i32| (left as i32 + i).rem_euclid(width) as usize;
        let row = |i: i32| (top as i32 + i).min(height - 1) as usize * self.width;
        let mixed = |row: usize| {
            self.pixels[row + column(0)].lerp(self.pixels[row + column(1)], right_share)
        };
        mixed(row(0)).lerp(mixed(row(1)), lower_share)
    }
}

/// Four pixels and their weights.
struct Taps {
    at: [usize; 4],
    weight: [f32; 4],
}

impl Taps {
    /// Those of each of `to` pixels, made of `from`.
    fn all(from: usize, to: usize, place: impl Fn(i64) -> usize) -> Vec<Self> {
        let scale = from as f64 / to as f64;
        let taps = |i: usize| {
            let x = (i as f64 + 0.5) * scale - 0.5;
            let first = x.floor();
            Self {
                at: [-1, 0, 1, 2].map(|k| place(first as i64 + k)),
                weight: b_spline((x - first) as f32),
            }
        };
        (0..to).map(taps).collect()
    }

    fn of(&self, pixel: impl Fn(usize) -> Vec3) -> Vec3 {
        let weighted = self.at.iter().zip(self.weight).map(|(at, weight)| pixel(*at) * weight);
        weighted.fold(Vec3::ZERO, |sum, v| sum + v)
    }
}

/// Weights of the uniform cubic B-spline at a share between the two middle points.
fn b_spline(t: f32) -> [f32; 4] {
    let (s, t2) = (1.0 - t, t * t);
    let t3 = t2 * t;
    [s * s * s, 3.0 * t3 - 6.0 * t2 + 4.0, 3.0 * (t + t2 - t3) + 1.0, t3].map(|w| w / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_stand_where_they_are_found() {
        for i in 0..2_000 {
            let (u, v) =
                ((f64::from(i) + 0.5) / 2_000.0, libm::fmod(f64::from(i) * 0.618_034, 1.0));
            let got = uv_of((direction_at(u, v) * 3.0).as_vec3());
            // Longitudes lie close together near the poles.
            let level = libm::sin(v * std::f64::consts::PI);
            assert!((f64::from(got[0]) - u).abs() * level < 1e-6, "{u} {v}: {got:?}");
            assert!((f64::from(got[1]) - v).abs() < 2e-6, "{u} {v}: {got:?}");
        }
        for (direction, uv) in [
            (Vec3::NEG_Z, [0.5, 0.5]),
            (Vec3::X, [0.75, 0.5]),
            (Vec3::NEG_X, [0.25, 0.5]),
            (Vec3::new(-1e-6, 0.0, 1.0), [0.0, 0.5]),
        ] {
            let got = uv_of(direction);
            assert!(
                (got[0] - uv[0]).abs() < 1e-5 && (got[1] - uv[1]).abs() < 1e-5,
                "{direction}: {got:?}"
            );
        }
        assert!(uv_of(Vec3::Y)[1] < 1e-5 && uv_of(Vec3::NEG_Y)[1] > 1.0 - 1e-5);
        assert!(uv_of(Vec3::ZERO).iter().all(|v| v.is_finite()));
    }

    #[test]
    fn solid_angles_fill_the_sphere() {
        let picture = Equirect::from_fn(64, |_| Vec3::ONE);
        let sum: f64 = picture.solid_angles().sum::<f64>() * 64.0;
        assert!((sum - 4.0 * std::f64::consts::PI).abs() < 1e-12);
    }

    #[test]
    fn a_smooth_picture_keeps_its_values_at_another_size() {
        let light = |d: DVec3| (d * 0.5 + DVec3::splat(0.6)).as_vec3();
        let picture = Equirect::from_fn(64, light);
        for width in [16, 32, 48, 64, 256] {
            let other = picture.clone().resized(width);
            assert_eq!((other.width, other.pixels.len()), (width, width * width / 2));
            for i in 0..200 {
                let d = direction_at(f64::from(i) / 200.0, libm::fmod(f64::from(i) * 0.618, 1.0));
                let off = (other.at(uv_of(d.as_vec3())) - light(d)).abs().max_element();
                // Half a pixel round the poles holds one value.
                assert!(off < 2.0 / width.min(64) as f32, "{width}: {off}");
            }
        }
    }

    #[test]
    fn what_is_the_same_all_round_stays_so() {
        let picture = Equirect::from_fn(32, |_| Vec3::new(1.0, 2.0, 3.0)).resized(128);
        assert!(
            picture
                .pixels
                .iter()
                .all(|p| (*p - Vec3::new(1.0, 2.0, 3.0)).abs().max_element() < 2e-6)
        );
    }
}
