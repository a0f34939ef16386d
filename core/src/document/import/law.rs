//! How a scenario draws a number: the samplers of Unity Perception, and arithmetic with them.

use crate::document::{Distribution, Flag, Normal, Param};

/// A sampler.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Law {
    /// Always this.
    Constant(f64),
    /// Evenly from the first, which is smaller, to the second.
    Uniform(f64, f64),
    /// Normal, truncated; `std` is above 0 and `min` is below `max`.
    Normal { mean: f64, std: f64, min: f64, max: f64 },
    /// Piecewise-linear density through points `(x, density)` with growing x.
    Curve(Vec<(f64, f64)>),
}

/// The shortest decimal that is the same 32-bit number. Scenarios are computed in such numbers and
/// written with all their digits (0.7300000190734863), which nobody typed.
pub(super) fn tidy(value: f64) -> f64 {
    let single = value as f32;
    if single.is_finite() { single.to_string().parse().unwrap_or(value) } else { value }
}

/// Evenly between two numbers in any order, or always one where they are the same.
fn between(a: f64, b: f64) -> Law {
    if a == b { Law::Constant(a) } else { Law::Uniform(a.min(b), a.max(b)) }
}

impl Law {
    /// The law of `factor * x + offset`.
    pub(super) fn mapped(&self, factor: f64, offset: f64) -> Self {
        let of = |x: f64| tidy(factor * x + offset);
        if factor == 0.0 {
            return Self::Constant(offset);
        }
        match self {
            Self::Constant(x) => Self::Constant(of(*x)),
            Self::Uniform(min, max) => between(of(*min), of(*max)),
            Self::Normal { mean, std, min, max } => {
                let (a, b) = (of(*min), of(*max));
                let std = tidy(std * factor.abs());
                Self::Normal { mean: of(*mean), std, min: a.min(b), max: a.max(b) }
            }
            Self::Curve(points) => {
                let mut points: Vec<_> = points.iter().map(|p| (of(p.0), p.1)).collect();
                if factor < 0.0 {
                    points.reverse();
                }
                Self::Curve(points)
            }
        }
    }

    /// The law of the opposite angle in degrees. Whole turns stay as they are written.
    pub(super) fn opposite_angle(&self) -> Self {
        match self {
            Self::Uniform(min, max) if (max - min) % 360.0 == 0.0 => self.clone(),
            _ => self.mapped(-1.0, 0.0),
        }
    }

    /// The law with its ends moved to limits where they lie beyond them.
    pub(super) fn within(&self, [low, high]: [f64; 2]) -> Self {
        let to = |x: f64| x.clamp(low, high);
        match self {
            Self::Constant(x) => Self::Constant(to(*x)),
            Self::Uniform(min, max) => between(to(*min), to(*max)),
            Self::Normal { mean, std, min, max } if to(*min) < to(*max) => {
                Self::Normal { mean: *mean, std: *std, min: to(*min), max: to(*max) }
            }
            Self::Normal { min, .. } => Self::Constant(to(*min)),
            // Cut or moved, a curve would be another one: it keeps its shape.
            Self::Curve(_) => self.clone(),
        }
    }

    /// Least and largest value.
    pub(super) fn ends(&self) -> [f64; 2] {
        match self {
            Self::Constant(x) => [*x, *x],
            Self::Uniform(min, max) | Self::Normal { min, max, .. } => [*min, *max],
            Self::Curve(points) => {
                let x = |p: Option<&(f64, f64)>| p.map_or(0.0, |p| p.0);
                [x(points.first()), x(points.last())]
            }
        }
    }

    /// Probability of a value below a limit.
    pub(super) fn share_below(&self, limit: f64) -> f64 {
        let [low, high] = self.ends();
        match self {
            Self::Constant(x) => f64::from(*x < limit),
            _ if limit <= low => 0.0,
            _ if limit >= high => 1.0,
            Self::Uniform(min, max) => (limit - min) / (max - min),
            Self::Normal { mean, std, min, max } => {
                normal_share((min - mean) / std, (limit - mean) / std, (max - mean) / std)
            }
            Self::Curve(points) => mass(points, limit) / mass(points, high),
        }
    }

    /// The law of `reach * x` whose sign is decided by another draw: positive where that one is
    /// above a half. So do the seed's cameras and lamps move.
    pub(super) fn either_way(&self, reach: f64) -> Param {
        let positive = match self {
            Self::Constant(x) => f64::from(*x > 0.5),
            _ => 1.0 - self.share_below(0.5),
        };
        let (plus, minus) = (self.mapped(reach, 0.0), self.mapped(-reach, 0.0));
        if positive >= 1.0 || plus == minus {
            return plus.param();
        }
        if positive <= 0.0 {
            return minus.param();
        }
        if let Self::Uniform(0.0, max) = self
            && positive == 0.5
        {
            return between(tidy(-reach * max), tidy(reach * max)).param();
        }
        Param::mix([(tidy(positive), plus.param()), (tidy(1.0 - positive), minus.param())])
    }

    /// Yes where a draw lies below a limit.
    pub(super) fn flag_below(&self, limit: f64) -> Flag {
        match self.share_below(limit) {
            p if p >= 1.0 => Flag::Always(true),
            p if p <= 0.0 => Flag::Always(false),
            p => Flag::with_probability(tidy(p)),
        }
    }

    /// As a config writes it.
    pub(super) fn param(&self) -> Param {
        match self {
            Self::Constant(x) => Param::Constant(*x),
            Self::Uniform(min, max) => Param::uniform(*min, *max),
            Self::Normal { mean, std, min, max } => Param::Random(Distribution::Normal(Normal {
                mean: *mean,
                std: *std,
                min: Some(*min),
                max: Some(*max),
            })),
            Self::Curve(points) => Param::Random(Distribution::Curve(points.clone())),
        }
    }
}

/// Share of a standard normal between `a` and `b` that lies below `x`.
fn normal_share(a: f64, x: f64, b: f64) -> f64 {
    // Tails are taken from the side where they are small, or nothing is left of them.
    let above = a + b > 0.0;
    let tail = |z: f64| libm::erfc(if above { z } else { -z } / std::f64::consts::SQRT_2);
    let (part, whole) = if above {
        (tail(a) - tail(x), tail(a) - tail(b))
    } else {
        (tail(x) - tail(a), tail(b) - tail(a))
    };
    if whole > 0.0 { part / whole } else { (x - a) / (b - a) }
}

/// Area below a piecewise-linear curve up to `limit`.
fn mass(points: &[(f64, f64)], limit: f64) -> f64 {
    let piece = |pair: &[(f64, f64)]| {
        let ((x0, d0), (x1, d1)) = (pair[0], pair[1]);
        let x = limit.clamp(x0, x1);
        let d = d0 + (d1 - d0) * (x - x0) / (x1 - x0);
        (x - x0) * (d0 + d) * 0.5
    };
    points.windows(2).map(piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Law = Law::Uniform(0.0, 1.0);

    #[test]
    fn numbers_lose_the_digits_that_nobody_typed() {
        assert_eq!(tidy(0.730_000_019_073_486_3), 0.73);
        assert_eq!(tidy(-0.200_000_002_980_232_24), -0.2);
        assert_eq!(tidy(1e300), 1e300);
        assert_eq!(UNIT.mapped(0.73 * 5.0, 0.0), Law::Uniform(0.0, 3.65));
    }

    #[test]
    fn a_negative_factor_turns_every_law_round() {
        assert_eq!(Law::Constant(0.0).mapped(-1.0, 0.0).param(), Param::Constant(0.0));
        assert_eq!(Law::Uniform(1.0, 3.0).mapped(-2.0, 1.0), Law::Uniform(-5.0, -1.0));
        let normal = Law::Normal { mean: 1.0, std: 2.0, min: 0.0, max: 4.0 };
        let turned = Law::Normal { mean: -1.0, std: 2.0, min: -4.0, max: 0.0 };
        assert_eq!(normal.mapped(-1.0, 0.0), turned);
        let curve = Law::Curve(vec![(0.0, 1.0), (2.0, 3.0)]);
        assert_eq!(curve.mapped(-1.0, 0.0), Law::Curve(vec![(-2.0, 3.0), (0.0, 1.0)]));
        assert_eq!(Law::Uniform(0.0, 360.0).opposite_angle(), Law::Uniform(0.0, 360.0));
        assert_eq!(Law::Uniform(0.0, 90.0).opposite_angle(), Law::Uniform(-90.0, 0.0));
    }

    #[test]
    fn shares_are_those_of_the_laws() {
        assert_eq!(UNIT.share_below(0.8), 0.8);
        assert_eq!(UNIT.share_below(-1.0), 0.0);
        assert_eq!(Law::Constant(0.8).share_below(0.8), 0.0);
        // Tables of the normal: 0.8413 of it lie below one standard deviation.
        let wide = Law::Normal { mean: 0.0, std: 1.0, min: -9.0, max: 9.0 };
        assert!((wide.share_below(1.0) - 0.841_344_746).abs() < 1e-9);
        // Far out, where the whole is 1.3e-12: Q(7.2) = 3.0106e-13 of Q(7) = 1.2798e-12 is left.
        let far = Law::Normal { mean: 0.0, std: 1.0, min: 7.0, max: 20.0 };
        assert!((far.share_below(7.2) - (1.0 - 3.0106e-13 / 1.279_812_5e-12)).abs() < 1e-4);
        let mirrored = Law::Normal { mean: 0.0, std: 1.0, min: -20.0, max: -7.0 };
        assert!((mirrored.share_below(-7.2) - 3.0106e-13 / 1.279_812_5e-12).abs() < 1e-4);
        let tent = Law::Curve(vec![(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]);
        assert!((tent.share_below(0.25) - 0.125).abs() < 1e-15);
        assert!((tent.share_below(0.75) - 0.875).abs() < 1e-15);
    }

    #[test]
    fn moves_go_either_way() {
        assert_eq!(UNIT.either_way(5.0), Param::uniform(-5.0, 5.0));
        assert_eq!(UNIT.either_way(-5.0), Param::uniform(-5.0, 5.0));
        assert_eq!(UNIT.either_way(0.0), Param::Constant(0.0));
        assert_eq!(Law::Constant(0.5).either_way(2.0), Param::Constant(-1.0));
        assert_eq!(Law::Constant(0.75).either_way(2.0), Param::Constant(1.5));
        let mostly = Law::Uniform(0.25, 1.25).either_way(2.0);
        let sides = [(0.75, Param::uniform(0.5, 2.5)), (0.25, Param::uniform(-2.5, -0.5))];
        assert_eq!(mostly, Param::mix(sides));
        assert_eq!(Law::Uniform(0.6, 1.0).either_way(1.0), Param::uniform(0.6, 1.0));
    }

    #[test]
    fn limits_move_ends() {
        let limits = [0.0, 0.5];
        assert_eq!(UNIT.within(limits), Law::Uniform(0.0, 0.5));
        assert_eq!(Law::Uniform(2.0, 3.0).within(limits), Law::Constant(0.5));
        assert_eq!(Law::Constant(-1.0).within(limits), Law::Constant(0.0));
        let normal = Law::Normal { mean: 0.0, std: 1.0, min: -1.0, max: 1.0 };
        let cut = Law::Normal { mean: 0.0, std: 1.0, min: 0.0, max: 0.5 };
        assert_eq!(normal.within(limits), cut);
        assert_eq!(normal.within([2.0, 3.0]), Law::Constant(2.0));
    }
}
