//! The rules for single values: numbers, parameters, vectors, colours and choices.

use std::collections::BTreeMap;

use super::{ANGLE, POSITION};
use crate::document::{
    Chance, Choice, Color, ColorLaw, Distribution, Empirical, Flag, Given, JointRotation, Param,
    Problem, Region, Rotation, Towards, Vector, Weighted,
};

/// Mixtures of mixtures of mixtures... end here.
const MAX_DEPTH: u32 = 8;

/// Values that make sense.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    min: f64,
    max: f64,
    open: bool,
}

impl Range {
    pub(super) const fn from_to(min: f64, max: f64) -> Self {
        Self { min, max, open: false }
    }

    /// `min` itself is excluded.
    pub(super) const fn above(min: f64, max: f64) -> Self {
        Self { min, max, open: true }
    }

    fn holds(self, value: f64) -> bool {
        // False for NaN.
        (if self.open { value > self.min } else { value >= self.min }) && value <= self.max
    }

    /// The side that a value fails on.
    fn rule(self, value: f64) -> String {
        let sign = if self.open { ">" } else { ">=" };
        if value.is_nan() {
            "be a number".to_owned()
        } else if value > self.max {
            format!("be <= {}", self.max)
        } else {
            format!("be {sign} {}", self.min)
        }
    }
}

/// Collects problems, and every parameter by its path. Its methods say whether the value was right.
#[derive(Default)]
pub(super) struct Check {
    pub(super) problems: Vec<Problem>,
    pub(super) params: BTreeMap<String, Param>,
}

impl Check {
    pub(super) fn report(&mut self, path: &str, message: impl Into<String>) -> bool {
        self.problems.push(Problem::new(path, message));
        false
    }

    pub(super) fn number(&mut self, path: &str, value: f64, range: Range) -> bool {
        range.holds(value) || self.report(path, format!("must {}, got {value}", range.rule(value)))
    }

    pub(super) fn numbers(&mut self, path: &str, values: &[f64], range: Range) -> bool {
        let all = values.iter().enumerate();
        all.fold(true, |good, (i, v)| self.number(&format!("{path}[{i}]"), *v, range) & good)
    }

    pub(super) fn count(&mut self, path: &str, value: u32, min: u32, max: u32) -> bool {
        (min..=max).contains(&value)
            || self.report(path, format!("must be from {min} to {max}, got {value}"))
    }

    pub(super) fn interval(&mut self, path: &str, [min, max]: [f64; 2], range: Range) -> bool {
        self.numbers(path, &[min, max], range)
            && (min < max
                || self
                    .report(path, format!("must be [min, max] with min < max, got [{min}, {max}]")))
    }

    /// Weights of a choice: some, none negative, not all 0.
    pub(super) fn weights(&mut self, path: &str, weights: impl Iterator<Item = f64>) -> bool {
        let (mut sum, mut count) = (0.0, 0);
        for (i, weight) in weights.enumerate() {
            if !(0.0..=1e12).contains(&weight) {
                let path = format!("{path}[{i}]");
                return self.report(&path, format!("the weight must be >= 0, got {weight}"));
            }
            (sum, count) = (sum + weight, count + 1);
        }
        if count == 0 {
            return self.report(path, "must hold at least one item, got none");
        }
        sum > 0.0 || self.report(path, "at least one weight must be > 0")
    }

    pub(super) fn param(&mut self, path: &str, param: &Param, range: Range) -> bool {
        self.params.insert(path.to_owned(), param.clone());
        let distribution = match param {
            Param::Constant(value) => return self.number(path, *value, range),
            Param::Random(distribution) => distribution,
        };
        if !self.distribution(path, distribution, 0) {
            return false;
        }
        let unread = |law: &Distribution| matches!(law, Distribution::Empirical(_));
        if param.laws("").iter().any(|(_, law)| unread(law)) {
            // What may be drawn shows when the file has been read.
            return true;
        }
        let (min, max) = param.bounds();
        let Some(outside) = [min, max].into_iter().find(|v| !range.holds(*v)) else {
            return true;
        };
        let drawn = format!("but values from {min} to {max} can be drawn");
        self.report(path, format!("must {}, {drawn}", range.rule(outside)))
    }

    /// The form of a distribution, whatever it is for.
    fn distribution(&mut self, path: &str, distribution: &Distribution, depth: u32) -> bool {
        match distribution {
            Distribution::Uniform(range) => self.uniform(&format!("{path}.uniform"), *range),
            Distribution::Normal(n) => {
                let path = format!("{path}.normal");
                let field = |name| format!("{path}.{name}");
                self.finite(&field("mean"), n.mean)
                    && self.number(&field("std"), n.std, Range::above(0.0, 1e12))
                    && self.truncation(&path, n.min, n.max, n.mean, n.std, |x| x)
            }
            Distribution::Lognormal(l) => {
                let path = format!("{path}.lognormal");
                let field = |name| format!("{path}.{name}");
                self.number(&field("median"), l.median, Range::above(0.0, 1e12))
                    && self.number(&field("sigma"), l.sigma, Range::above(0.0, 10.0))
                    && self.truncation(&path, l.min, l.max, libm::log(l.median), l.sigma, |x| {
                        libm::log(x.max(0.0))
                    })
            }
            Distribution::Beta(b) => {
                let path = format!("{path}.beta");
                let shape = Range::from_to(0.01, 1e4);
                self.number(&format!("{path}.alpha"), b.alpha, shape)
                    & self.number(&format!("{path}.beta"), b.beta, shape)
                    & self.min_max(&path, b.min, b.max)
            }
            Distribution::Triangular(t) => {
                let path = format!("{path}.triangular");
                self.min_max(&path, t.min, t.max)
                    && self.number(&format!("{path}.mode"), t.mode, Range::from_to(t.min, t.max))
            }
            Distribution::Bernoulli(p) => self.probability(&format!("{path}.bernoulli"), *p),
            Distribution::Binomial(b) => {
                self.count(&format!("{path}.binomial.n"), b.n, 1, 1_000_000)
                    & self.probability(&format!("{path}.binomial.p"), b.p)
            }
            Distribution::Poisson(mean) => {
                self.number(&format!("{path}.poisson"), *mean, Range::from_to(0.0, 1e6))
            }
            Distribution::Choice(items) => {
                let path = format!("{path}.choice");
                items
                    .iter()
                    .enumerate()
                    .all(|(i, item)| self.finite(&format!("{path}[{i}]"), item.0))
                    && self.weights(&path, items.iter().map(|i| i.1))
            }
            Distribution::Each(values) => {
                let path = format!("{path}.each");
                self.some(&path, values)
                    && values
                        .iter()
                        .enumerate()
                        .all(|(i, v)| self.finite(&format!("{path}[{i}]"), *v))
            }
            Distribution::Curve(points) => self.curve(&format!("{path}.curve"), points),
            Distribution::Mix(parts) => {
                let path = format!("{path}.mix");
                if depth >= MAX_DEPTH {
                    return self.report(&path, format!("mixtures nest at most {MAX_DEPTH} deep"));
                }
                if !self.weights(&path, parts.iter().map(|p| p.0)) {
                    return false;
                }
                parts.iter().enumerate().fold(true, |good, (i, (_, part))| {
                    self.part(&format!("{path}[{i}][1]"), part, depth) & good
                })
            }
            Distribution::Empirical(file) => self.empirical(&format!("{path}.empirical"), file),
            Distribution::Given(given) => self.given(&format!("{path}.given"), given, depth),
        }
    }

    /// A parameter within a distribution.
    fn part(&mut self, path: &str, part: &Param, depth: u32) -> bool {
        match part {
            Param::Constant(value) => self.finite(path, *value),
            Param::Random(d) => self.distribution(path, d, depth + 1),
        }
    }

    fn empirical(&mut self, path: &str, empirical: &Empirical) -> bool {
        let Empirical { file, column, weight } = empirical;
        let names =
            [("file", Some(file)), ("column", column.as_ref()), ("weight", weight.as_ref())];
        names.into_iter().fold(true, |good, (field, name)| {
            let empty = name.is_some_and(|name| name.trim().is_empty());
            let what = "must not be an empty text";
            (!empty || self.report(&format!("{path}.{field}"), what)) & good
        })
    }

    /// Rows that follow each other without a hole. What is looked at is [`super::links`]' business.
    fn given(&mut self, path: &str, given: &Given, depth: u32) -> bool {
        if depth >= MAX_DEPTH {
            return self.report(path, format!("tables nest at most {MAX_DEPTH} deep"));
        }
        let path = format!("{path}.table");
        if !self.some(&path, &given.table) {
            return false;
        }
        let mut before: Option<f64> = None;
        given.table.iter().enumerate().fold(true, |good, (i, (from, to, row))| {
            let at = format!("{path}[{i}]");
            let last = before.replace(*to);
            let rows = self.interval(&at, [*from, *to], Range::from_to(-1e12, 1e12))
                && last.is_none_or(|end| end == *from || self.seam(&at, end, *from));
            self.part(&format!("{at}[2]"), row, depth) & rows & good
        })
    }

    fn seam(&mut self, path: &str, end: f64, from: f64) -> bool {
        let fault = if from > end { "leaves a hole after" } else { "overlaps" };
        let what = format!(
            "begins at {from} and {fault} the row before it, which ends at {end}; let it begin at {end}"
        );
        self.report(path, what)
    }

    fn finite(&mut self, path: &str, value: f64) -> bool {
        self.number(path, value, Range::from_to(-1e12, 1e12))
    }

    fn probability(&mut self, path: &str, p: f64) -> bool {
        self.number(path, p, Range::from_to(0.0, 1.0))
    }

    fn uniform(&mut self, path: &str, [min, max]: [f64; 2]) -> bool {
        if !(self.finite(path, min) && self.finite(path, max)) {
            return false;
        }
        let got = format!("got [{min}, {max}]");
        if min == max {
            return self
                .report(path, format!("the range is empty, {got}; write {min} for a constant"));
        }
        min < max || self.report(path, format!("must be [min, max] with min < max, {got}"))
    }

    fn min_max(&mut self, path: &str, min: f64, max: f64) -> bool {
        self.finite(&format!("{path}.min"), min)
            && self.finite(&format!("{path}.max"), max)
            && (min < max
                || self.report(&format!("{path}.max"), format!("must be > min ({min}), got {max}")))
    }

    /// Bounds of a normal: in order, and not so far out that nothing is left between them.
    fn truncation(
        &mut self,
        path: &str,
        min: Option<f64>,
        max: Option<f64>,
        mean: f64,
        std: f64,
        of_bound: impl Fn(f64) -> f64,
    ) -> bool {
        let (low, high) = (min.unwrap_or(-1e12), max.unwrap_or(1e12));
        if !self.finite(&format!("{path}.min"), low) || !self.min_max(path, low, high) {
            return false;
        }
        let z =
            |bound: Option<f64>, otherwise| bound.map_or(otherwise, |b| (of_bound(b) - mean) / std);
        let (a, b) = (z(min, f64::NEG_INFINITY), z(max, f64::INFINITY));
        // Beyond six standard deviations lies a billionth: the bounds were meant for another mean.
        (a < 6.0 && b > -6.0)
            || self.report(path, "min and max lie more than 6 standard deviations from the middle")
    }

    fn curve(&mut self, path: &str, points: &[(f64, f64)]) -> bool {
        if !(2..=1000).contains(&points.len()) {
            return self.report(path, format!("must have 2 to 1000 points, got {}", points.len()));
        }
        for (i, &(x, density)) in points.iter().enumerate() {
            let path = format!("{path}[{i}]");
            if !self.finite(&path, x) || !self.number(&path, density, Range::from_to(0.0, 1e12)) {
                return false;
            }
            if i > 0 && x <= points[i - 1].0 {
                return self.report(&path, format!("x must grow from point to point, got {x}"));
            }
        }
        points.iter().any(|p| p.1 > 0.0) || self.report(path, "the density is 0 everywhere")
    }

    pub(super) fn axes(&mut self, path: &str, axes: &[Param; 3], range: Range) -> bool {
        let all = axes.iter().enumerate();
        all.fold(true, |good, (i, p)| self.param(&format!("{path}[{i}]"), p, range) & good)
    }

    pub(super) fn vector(&mut self, path: &str, vector: &Vector, range: Range) -> bool {
        let (name, low, high) = match vector {
            Vector::Axes(axes) => return self.axes(path, axes, range),
            Vector::Joint(Region::Sphere(s) | Region::Disk(s)) => {
                let name = if matches!(vector, Vector::Joint(Region::Disk(_))) {
                    "disk"
                } else {
                    "sphere"
                };
                return self.numbers(&format!("{path}.{name}.center"), &s.center, range)
                    & self.number(
                        &format!("{path}.{name}.radius"),
                        s.radius,
                        Range::above(0.0, 1e7),
                    );
            }
            Vector::Joint(Region::Box(b)) => ("box", b.min, b.max),
            Vector::Joint(Region::Grid(g)) => {
                for (i, nodes) in g.nodes.iter().enumerate() {
                    self.count(&format!("{path}.grid.nodes[{i}]"), *nodes, 1, 1_000_000);
                }
                ("grid", g.min, g.max)
            }
        };
        (0..3).fold(true, |good, i| {
            let at_max = format!("{path}.{name}.max[{i}]");
            let in_range = self.number(&format!("{path}.{name}.min[{i}]"), low[i], range)
                && self.number(&at_max, high[i], range);
            let ordered = low[i] <= high[i]
                || self.report(&at_max, format!("must be >= min ({}), got {}", low[i], high[i]));
            good & in_range & ordered
        })
    }

    pub(super) fn rotation(&mut self, path: &str, rotation: &Rotation) -> bool {
        match rotation {
            Rotation::Euler(axes) => self.axes(path, axes, ANGLE),
            Rotation::Joint(JointRotation::Rotation(_)) => true,
            Rotation::Joint(JointRotation::Facing(facing)) => {
                let path = format!("{path}.facing");
                let there = match &facing.towards {
                    Towards::Camera(_) => true,
                    Towards::Point(point) => {
                        self.numbers(&format!("{path}.towards"), point, POSITION)
                    }
                };
                self.param(&format!("{path}.yaw_deg"), &facing.yaw_deg, ANGLE) & there
            }
        }
    }

    pub(super) fn color(&mut self, path: &str, color: &Color) -> bool {
        self.color_at(path, color, 0)
    }

    fn color_at(&mut self, path: &str, color: &Color, depth: u32) -> bool {
        let unit = Range::from_to(0.0, 1.0);
        match color {
            Color::Srgb(axes) => self.axes(path, axes, unit),
            Color::Other(ColorLaw::Linear(axes)) => {
                self.axes(&format!("{path}.linear"), axes, unit)
            }
            Color::Other(ColorLaw::Hsv([hue, saturation, value])) => {
                self.param(&format!("{path}.hsv[0]"), hue, Range::from_to(-3600.0, 3600.0))
                    & self.param(&format!("{path}.hsv[1]"), saturation, unit)
                    & self.param(&format!("{path}.hsv[2]"), value, unit)
            }
            Color::Other(ColorLaw::Palette(items)) => {
                let path = format!("{path}.palette");
                self.weights(&path, items.iter().map(|i| i.1))
                    && items.iter().enumerate().fold(true, |good, (i, (rgb, _))| {
                        self.numbers(&format!("{path}[{i}][0]"), rgb, unit) & good
                    })
            }
            Color::Other(ColorLaw::Mix(parts)) => {
                let path = format!("{path}.mix");
                if depth >= MAX_DEPTH {
                    return self.report(&path, format!("mixtures nest at most {MAX_DEPTH} deep"));
                }
                self.weights(&path, parts.iter().map(|p| p.0))
                    && parts.iter().enumerate().fold(true, |good, (i, (_, part))| {
                        self.color_at(&format!("{path}[{i}][1]"), part, depth + 1) & good
                    })
            }
        }
    }

    pub(super) fn flag(&mut self, path: &str, flag: &Flag) -> bool {
        match flag {
            Flag::Always(_) => true,
            Flag::Random(Chance::Bernoulli(p)) => {
                self.probability(&format!("{path}.bernoulli"), *p)
            }
        }
    }

    pub(super) fn choice<T>(&mut self, path: &str, choice: &Choice<T>) -> bool {
        match choice {
            Choice::Always(_) => true,
            Choice::Random(Weighted::Choice(items)) => {
                self.weights(&format!("{path}.choice"), items.iter().map(|i| i.1))
            }
            Choice::Random(Weighted::Each(items)) => self.some(&format!("{path}.each"), items),
        }
    }

    fn some<T>(&mut self, path: &str, items: &[T]) -> bool {
        !items.is_empty() || self.report(path, "must hold at least one item, got none")
    }

    pub(super) fn ids(&mut self, path: &str, choice: &Choice<String>) -> bool {
        let named = choice.possible().into_iter().all(|id| !id.is_empty());
        self.choice(path, choice) & (named || self.report(path, "must not be an empty text"))
    }
}
