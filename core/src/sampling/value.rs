//! Drawing the document's parameters: numbers, vectors, rotations, colours, choices.
//!
//! A parameter spends the uniform number of its own draw; each mixture around it one more. A linked one
//! draws what it looks at again, from that parameter's own numbers.

use glam::{DQuat, DVec3};

use super::linked::Draw;
use super::quantile;
use crate::base::color::linear_rgb;
use crate::base::math::rotation_from_euler_deg;
use crate::document::{
    Chance, Choice, Color, ColorLaw, Distribution, Flag, JointRotation, Param, Region, Rotation,
    Towards, Vector, Weighted,
};

/// The lane in which colours choose among their parts; below it are their channels.
const COLOR_PART: u16 = 3;

/// The number that a parameter takes in a draw.
pub(super) fn number(param: &Param, draw: Draw) -> f64 {
    number_at(param, draw, 0)
}

fn number_at(param: &Param, draw: Draw, index: u16) -> f64 {
    let distribution = match param {
        Param::Constant(value) => return *value,
        Param::Random(distribution) => distribution,
    };
    let u = draw.uniform_at(index);
    match distribution {
        // min + u (max - min) may round up to max.
        Distribution::Uniform([min, max]) => (min + u * (max - min)).min(max.next_down()),
        Distribution::Normal(law) => quantile::truncated_normal(u, law),
        Distribution::Lognormal(law) => quantile::lognormal(u, law),
        Distribution::Beta(law) => quantile::beta(u, law),
        Distribution::Triangular(law) => quantile::triangular(u, law),
        Distribution::Bernoulli(p) => f64::from(happens(u, *p)),
        Distribution::Binomial(law) => quantile::binomial(u, law),
        Distribution::Poisson(mean) => quantile::poisson(u, *mean),
        Distribution::Choice(items) => items[quantile::index(u, items.iter().map(|i| i.1))].0,
        Distribution::Each(values) => *in_turn(values, draw),
        Distribution::Curve(points) => quantile::curve(u, points),
        Distribution::Mix(parts) => {
            let part = quantile::index(u, parts.iter().map(|p| p.0));
            number_at(&parts[part].1, draw, index + 1)
        }
        Distribution::Given(given) => number_at(given.row(draw.value_of(&given.of)), draw, index),
        Distribution::Empirical(_) => unreachable!("files are read before anything is drawn"),
    }
}

/// Yes for the upper end of the uniform numbers, so that a draw grows with its number.
fn happens(u: f64, p: f64) -> bool {
    u >= 1.0 - p
}

/// Whether a flag is up.
pub(super) fn flag(flag: &Flag, draw: Draw) -> bool {
    match flag {
        Flag::Always(value) => *value,
        Flag::Random(Chance::Bernoulli(p)) => happens(draw.uniform(), *p),
    }
}

/// The item that a choice falls on.
pub(super) fn item<'a, T>(choice: &'a Choice<T>, draw: Draw) -> &'a T {
    match choice {
        Choice::Always(item) => item,
        Choice::Random(Weighted::Choice(items)) => {
            &items[quantile::index(draw.uniform(), items.iter().map(|i| i.1))].0
        }
        Choice::Random(Weighted::Each(items)) => in_turn(items, draw),
    }
}

/// The item whose turn it is; the middle one where nothing is to vary.
fn in_turn<'a, T>(items: &'a [T], draw: Draw) -> &'a T {
    let turn = if draw.is_middle() { items.len() / 2 } else { draw.turn() as usize };
    &items[turn % items.len()]
}

fn axes(params: &[Param; 3], draw: Draw) -> DVec3 {
    let axis = |i: u16| number(&params[usize::from(i)], draw.lane(i));
    DVec3::new(axis(0), axis(1), axis(2))
}

/// A vector; each axis, or each number that a shape needs, in its own lane.
pub(super) fn vector(vector: &Vector, draw: Draw) -> DVec3 {
    let region = match vector {
        Vector::Axes(params) => return axes(params, draw),
        Vector::Joint(region) => region,
    };
    if draw.is_middle() {
        let middle = vector.bounds().map(|(min, max)| 0.5 * (min + max));
        return DVec3::from_array(middle);
    }
    let u = |lane: u16| draw.lane(lane).uniform();
    match region {
        Region::Sphere(s) => {
            let (z, phi) = (2.0 * u(1) - 1.0, std::f64::consts::TAU * u(2));
            let across = (1.0 - z * z).max(0.0).sqrt();
            let direction = DVec3::new(across * libm::cos(phi), z, across * libm::sin(phi));
            DVec3::from_array(s.center) + s.radius * libm::cbrt(u(0)) * direction
        }
        Region::Disk(d) => {
            let phi = std::f64::consts::TAU * u(1);
            let direction = DVec3::new(libm::cos(phi), 0.0, libm::sin(phi));
            DVec3::from_array(d.center) + d.radius * u(0).sqrt() * direction
        }
        Region::Box(b) => {
            let axis = |i: usize| b.min[i] + u(i as u16) * (b.max[i] - b.min[i]);
            DVec3::new(axis(0), axis(1), axis(2))
        }
        Region::Grid(g) => {
            let axis = |i: usize| {
                let nodes = f64::from(g.nodes[i]);
                let node = (u(i as u16) * nodes).floor().min(nodes - 1.0);
                let step = if nodes > 1.0 { (g.max[i] - g.min[i]) / (nodes - 1.0) } else { 0.0 };
                g.min[i] + node * step
            };
            DVec3::new(axis(0), axis(1), axis(2))
        }
    }
}

/// An orientation, with an offset in Euler degrees: added angle by angle where the orientation is
/// given by angles itself, applied first otherwise.
pub(super) fn rotation(rotation: &Rotation, offset_deg: DVec3, draw: Draw) -> DQuat {
    let euler = |a: DVec3| rotation_from_euler_deg(a.x, a.y, a.z);
    match rotation {
        Rotation::Euler(params) => euler(axes(params, draw) + offset_deg),
        Rotation::Joint(JointRotation::Facing(facing)) => {
            euler(offset_deg + DVec3::Y * number(&facing.yaw_deg, draw))
        }
        Rotation::Joint(_) if draw.is_middle() => euler(offset_deg),
        Rotation::Joint(JointRotation::Rotation(_)) => {
            uniform_rotation([0, 1, 2].map(|i| draw.lane(i).uniform())) * euler(offset_deg)
        }
    }
}

/// The orientation of what stands somewhere. What faces something is turned about the vertical so that
/// its +Z points there; straight above or below there is no such turn, and it stays as it is.
pub(super) fn rotation_at(law: &Rotation, position_m: DVec3, camera_m: DVec3, draw: Draw) -> DQuat {
    let towards_deg = match law {
        Rotation::Joint(JointRotation::Facing(facing)) => {
            let target = match facing.towards {
                Towards::Camera(_) => camera_m,
                Towards::Point(point) => DVec3::from_array(point),
            };
            let way = target - position_m;
            libm::atan2(way.x, way.z).to_degrees()
        }
        Rotation::Euler(_) | Rotation::Joint(JointRotation::Rotation(_)) => 0.0,
    };
    rotation(law, DVec3::Y * towards_deg, draw)
}

/// Uniform on SO(3) from three uniform numbers (Shoemake, "Uniform random rotations", Graphics
/// Gems III, 1992).
fn uniform_rotation([u0, u1, u2]: [f64; 3]) -> DQuat {
    let (a, b) = (std::f64::consts::TAU * u1, std::f64::consts::TAU * u2);
    let (r, s) = ((1.0 - u0).sqrt(), u0.sqrt());
    DQuat::from_xyzw(r * libm::sin(a), r * libm::cos(a), s * libm::sin(b), s * libm::cos(b))
        .normalize()
}

/// A linear colour.
pub(super) fn color(color: &Color, draw: Draw) -> [f64; 3] {
    color_at(color, draw, 0)
}

fn color_at(color: &Color, draw: Draw, index: u16) -> [f64; 3] {
    match color {
        Color::Srgb(params) => linear(axes(params, draw).to_array()),
        Color::Other(ColorLaw::Linear(params)) => axes(params, draw).to_array(),
        Color::Other(ColorLaw::Hsv(params)) => linear(srgb_from_hsv(axes(params, draw).to_array())),
        Color::Other(ColorLaw::Palette(items)) => {
            let u = draw.lane(COLOR_PART).uniform_at(index);
            linear(items[quantile::index(u, items.iter().map(|i| i.1))].0)
        }
        Color::Other(ColorLaw::Mix(parts)) => {
            let u = draw.lane(COLOR_PART).uniform_at(index);
            let part = quantile::index(u, parts.iter().map(|p| p.0));
            color_at(&parts[part].1, draw, index + 1)
        }
    }
}

/// Linear from sRGB.
pub(super) fn linear(srgb: [f64; 3]) -> [f64; 3] {
    linear_rgb(srgb.map(|v| v as f32)).map(f64::from)
}

/// sRGB from hue in degrees (any turn), saturation and value (Smith, "Color gamut transform
/// pairs", 1978).
fn srgb_from_hsv([hue_deg, saturation, value]: [f64; 3]) -> [f64; 3] {
    let sextant = (hue_deg / 60.0).rem_euclid(6.0);
    [5.0, 3.0, 1.0].map(|n: f64| {
        let k = (n + sextant).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Key;
    use crate::sampling::linked::Draws;

    const N: u32 = 20_000;

    fn draws() -> impl Iterator<Item = Draw<'static>> {
        (0..N).map(|i| Draws::new(77, i).of(Key::new("test"), 0))
    }

    fn param(text: &str) -> Param {
        serde_json::from_str(text).unwrap()
    }

    /// Kolmogorov-Smirnov distance to a distribution function.
    fn distance(mut values: Vec<f64>, cdf: impl Fn(f64) -> f64) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let gap = |(i, x): (usize, &f64)| {
            let p = cdf(*x);
            (p - i as f64 / n).abs().max((p - (i as f64 + 1.0) / n).abs())
        };
        values.iter().enumerate().map(gap).fold(0.0, f64::max)
    }

    /// 1.95 / sqrt(n) is exceeded with probability 0.001.
    fn limit() -> f64 {
        1.95 / f64::from(N).sqrt()
    }

    fn assert_follows(text: &str, cdf: impl Fn(f64) -> f64) {
        let param = param(text);
        let values: Vec<f64> = draws().map(|d| number(&param, d)).collect();
        let (min, max) = param.bounds();
        assert!(values.iter().all(|v| (min..=max).contains(v)), "{text}: out of bounds");
        let d = distance(values, cdf);
        assert!(d < limit(), "{text}: distance {d}");
    }

    #[test]
    fn continuous_laws_follow_their_distribution_functions() {
        let phi = quantile::normal_cdf;
        assert_follows(r#"{"uniform":[-2,3]}"#, |x| (x + 2.0) / 5.0);
        assert_follows(r#"{"normal":{"mean":1,"std":2}}"#, |x| phi((x - 1.0) / 2.0));
        let (a, b) = (phi(-1.0), phi(0.5));
        assert_follows(r#"{"normal":{"mean":1,"std":2,"min":-1,"max":2}}"#, |x| {
            (phi((x - 1.0) / 2.0) - a) / (b - a)
        });
        assert_follows(r#"{"lognormal":{"median":3,"sigma":0.5}}"#, |x| {
            phi(libm::log(x / 3.0) / 0.5)
        });
        assert_follows(r#"{"triangular":{"min":0,"mode":1,"max":4}}"#, |x| {
            if x < 1.0 { x * x / 4.0 } else { 1.0 - (4.0 - x).powi(2) / 12.0 }
        });
        // Beta(2, 3): the integral of 12 x (1 - x)^2, over [0, 2].
        assert_follows(r#"{"beta":{"alpha":2,"beta":3,"max":2}}"#, |x| {
            let t = x / 2.0;
            t * t * (6.0 - 8.0 * t + 3.0 * t * t)
        });
        assert_follows(r#"{"curve":[[0,1],[1,3],[3,0]]}"#, |x| {
            let area = if x < 1.0 { x + x * x } else { 2.0 + 3.0 - 0.75 * (3.0 - x).powi(2) };
            area / 5.0
        });
        assert_follows(r#"{"mix":[[3,{"uniform":[0,1]}],[1,{"uniform":[2,4]}]]}"#, |x| {
            0.75 * x.min(1.0) + 0.125 * (x - 2.0).max(0.0)
        });
    }

    /// Chi-squared with 0.001 quantiles: 13.8, 16.3, 18.5, 20.5 for 2, 3, 4, 5 degrees of freedom.
    fn assert_shares(text: &str, shares: &[(f64, f64)], limit: f64) {
        let param = param(text);
        let mut counts = vec![0.0; shares.len()];
        for draw in draws() {
            let value = number(&param, draw);
            // The last bin takes all that lies above.
            let bin = shares.iter().position(|s| s.0 == value).unwrap_or(shares.len() - 1);
            counts[bin] += 1.0;
        }
        let term = |(count, (_, share)): (&f64, &(f64, f64))| {
            let expected = share * f64::from(N);
            (count - expected) * (count - expected) / expected
        };
        let chi2: f64 = counts.iter().zip(shares).map(term).sum();
        assert!(chi2 < limit, "{text}: chi-squared {chi2}, {counts:?}");
    }

    #[test]
    fn discrete_laws_follow_their_shares() {
        assert_shares(r#"{"bernoulli":0.3}"#, &[(0.0, 0.7), (1.0, 0.3)], 10.8);
        let binomial = [(0.0, 0.343), (1.0, 0.441), (2.0, 0.189), (3.0, 0.027)];
        assert_shares(r#"{"binomial":{"n":3,"p":0.3}}"#, &binomial, 16.3);
        let p0 = libm::exp(-2.0);
        let rest = 1.0 - p0 * (1.0 + 2.0 + 2.0 + 4.0 / 3.0);
        let poisson =
            [(0.0, p0), (1.0, 2.0 * p0), (2.0, 2.0 * p0), (3.0, 4.0 / 3.0 * p0), (4.0, rest)];
        assert_shares(r#"{"poisson":2}"#, &poisson, 18.5);
        assert_shares(r#"{"choice":[[5,1],[7,3]]}"#, &[(5.0, 0.25), (7.0, 0.75)], 10.8);
        assert_shares(
            r#"{"mix":[[1,2],[1,{"choice":[[3,1],[4,1]]}]]}"#,
            &[(2.0, 0.5), (3.0, 0.25), (4.0, 0.25)],
            13.8,
        );
    }

    #[test]
    fn regions_are_filled_evenly() {
        let vectors = |text: &str| -> Vec<DVec3> {
            let law: Vector = serde_json::from_str(text).unwrap();
            draws().map(|d| vector(&law, d)).collect()
        };
        let sphere = vectors(r#"{"sphere":{"center":[1,2,3],"radius":2}}"#);
        let center = DVec3::new(1.0, 2.0, 3.0);
        let radii = sphere.iter().map(|p| (*p - center).length() / 2.0).collect();
        assert!(distance(radii, |r| r * r * r) < limit());
        // Archimedes: each coordinate of a direction is uniform.
        for axis in 0..3 {
            let cosines = sphere.iter().map(|p| (*p - center).normalize()[axis]).collect();
            assert!(distance(cosines, |c| 0.5 * (c + 1.0)) < limit());
        }
        let disk = vectors(r#"{"disk":{"radius":3}}"#);
        assert!(disk.iter().all(|p| p.y == 0.0));
        assert!(distance(disk.iter().map(|p| p.length() / 3.0).collect(), |r| r * r) < limit());
        let grid = vectors(r#"{"grid":{"min":[0,0,5],"max":[1,2,9],"nodes":[2,3,1]}}"#);
        for node in [DVec3::new(1.0, 1.0, 5.0), DVec3::new(0.0, 2.0, 5.0)] {
            let share = grid.iter().filter(|p| **p == node).count() as f64 / f64::from(N);
            assert!((share - 1.0 / 6.0).abs() < 0.011, "{node}: {share}");
        }
        let boxed = vectors(r#"{"box":{"min":[0,0,0],"max":[1,2,3]}}"#);
        assert!(distance(boxed.iter().map(|p| p.z / 3.0).collect(), |z| z) < limit());
    }

    /// Under the Haar measure the angle has distribution function (t - sin t) / pi, and the image
    /// of any axis is uniform on the sphere.
    #[test]
    fn uniform_rotations_are_uniform() {
        let law: Rotation = serde_json::from_str(r#"{"rotation":"uniform"}"#).unwrap();
        let all: Vec<DQuat> = draws().map(|d| rotation(&law, DVec3::ZERO, d)).collect();
        let angle = |q: &DQuat| 2.0 * libm::acos(q.w.abs().min(1.0));
        let cdf = |t: f64| (t - libm::sin(t)) / std::f64::consts::PI;
        assert!(distance(all.iter().map(angle).collect(), cdf) < limit());
        for axis in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
            let heights = all.iter().map(|q| (*q * axis).y).collect();
            assert!(distance(heights, |c| 0.5 * (c + 1.0)) < limit());
        }
    }

    #[test]
    fn hues_are_where_they_should_be() {
        for (hue, srgb) in [
            (0.0, [1.0, 0.0, 0.0]),
            (60.0, [1.0, 1.0, 0.0]),
            (120.0, [0.0, 1.0, 0.0]),
            (240.0, [0.0, 0.0, 1.0]),
            (-60.0, [1.0, 0.0, 1.0]),
            (750.0, [1.0, 0.5, 0.0]),
        ] {
            let got = srgb_from_hsv([hue, 1.0, 1.0]);
            assert!(got.iter().zip(srgb).all(|(a, b)| (a - b).abs() < 1e-12), "{hue}: {got:?}");
        }
        assert_eq!(srgb_from_hsv([77.0, 0.0, 0.4]), [0.4; 3]);
    }

    #[test]
    fn the_middle_is_the_median() {
        let middle = Draws::new(1, 1).random_if(false).of(Key::new("test"), 0);
        assert_eq!(number(&param(r#"{"uniform":[2,4]}"#), middle), 3.0);
        assert!(number(&param(r#"{"normal":{"mean":3,"std":9}}"#), middle) - 3.0 < 1e-12);
        let law: Vector =
            serde_json::from_str(r#"{"sphere":{"center":[1,2,3],"radius":2}}"#).unwrap();
        assert_eq!(vector(&law, middle), DVec3::new(1.0, 2.0, 3.0));
    }
}
