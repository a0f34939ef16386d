//! Randomised numbers as data: how a value is distributed, not what it turns out to be.
//!
//! Written short where it can be (`2.5`) and as `{"uniform": [0, 1]}` and the like otherwise. How
//! they are drawn is `sampling`'s business, which numbers make sense is [`super::validate`]'s.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number: fixed, or drawn anew for each frame and slot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Param {
    /// Always this.
    Constant(f64),
    /// Drawn.
    Random(Distribution),
}

/// How a number is distributed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Evenly over `[min, max)`.
    Uniform([f64; 2]),
    /// Normal, truncated where bounds are given.
    Normal(Normal),
    /// The exponential of a normal, truncated where bounds are given.
    Lognormal(Lognormal),
    /// Beta, stretched over `[min, max]`.
    Beta(Beta),
    /// Triangular.
    Triangular(Triangular),
    /// 1 with this probability, else 0.
    Bernoulli(f64),
    /// Number of successes in `n` trials.
    Binomial(Binomial),
    /// Number of events where this many are expected.
    Poisson(f64),
    /// Values with their weights.
    Choice(Vec<(f64, f64)>),
    /// Piecewise-linear density through points `[x, density]`; it need not be normalised.
    Curve(Vec<(f64, f64)>),
    /// Not drawn: the first value for the first slot of the frame, the second for the second, and
    /// from the beginning again where they end.
    Each(Vec<f64>),
    /// Weights and the parameters they stand for.
    Mix(Vec<(f64, Param)>),
    /// As it was measured: values or a histogram from a file.
    Empirical(Empirical),
    /// By the value that another parameter takes in the same frame, for the same person or object.
    Given(Given),
}

/// See [`Distribution::Normal`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Mean before truncation.
    pub mean: f64,
    /// Standard deviation before truncation.
    pub std: f64,
    /// Lowest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Highest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// See [`Distribution::Lognormal`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lognormal {
    /// Median before truncation; its logarithm is the mean of the logarithm.
    pub median: f64,
    /// Standard deviation of the natural logarithm.
    pub sigma: f64,
    /// Lowest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Highest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// See [`Distribution::Beta`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beta {
    /// First shape parameter.
    pub alpha: f64,
    /// Second shape parameter.
    pub beta: f64,
    /// Lowest value.
    #[serde(default)]
    pub min: f64,
    /// Highest value.
    #[serde(default = "one")]
    pub max: f64,
}

/// See [`Distribution::Triangular`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triangular {
    /// Lowest value.
    pub min: f64,
    /// Most likely value.
    pub mode: f64,
    /// Highest value.
    pub max: f64,
}

/// See [`Distribution::Binomial`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Binomial {
    /// Trials.
    pub n: u32,
    /// Probability of success.
    pub p: f64,
}

/// A CSV file whose first line names its columns; see [`super::measured`]. [`super::settle`] puts what
/// it holds in its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Empirical {
    /// Its path, from the config's folder or from one of `assets`.
    pub file: String,
    /// The column of values. Where absent, the file is a histogram with the columns `lo` and `hi`:
    /// a bin is drawn by its weight, and the value evenly within it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// The column of weights. Where absent, every value counts as much as any other, and a histogram
    /// has its weights in `weight`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<String>,
}

/// One parameter by the value of another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// Path of the other one, as in `people.body.age_years` or `lights.points[2].intensity_cd`.
    pub of: String,
    /// From and to of its values, and what follows. Each row begins where the one before it ends;
    /// `to` itself belongs to the next row, the last one keeps it.
    pub table: Vec<(f64, f64, Param)>,
}

impl Given {
    /// What follows from a value of the other parameter: the row that holds it, or the nearest one.
    ///
    /// # Panics
    /// Where the table is empty, which validation refuses.
    #[must_use]
    pub fn row(&self, value: f64) -> &Param {
        let last = self.table.len() - 1;
        let at = self.table.iter().position(|row| value < row.1).unwrap_or(last);
        &self.table[at].2
    }
}

/// No 53-bit uniform number lies further out in a normal, in standard deviations.
const FARTHEST: f64 = 8.3;

fn one() -> f64 {
    1.0
}

impl Default for Param {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl From<f64> for Param {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl Param {
    /// Evenly over `[min, max)`.
    #[must_use]
    pub const fn uniform(min: f64, max: f64) -> Self {
        Self::Random(Distribution::Uniform([min, max]))
    }

    /// Normal, truncated to `[min, max]`.
    #[must_use]
    pub const fn normal(mean: f64, std: f64, min: f64, max: f64) -> Self {
        Self::Random(Distribution::Normal(Normal { mean, std, min: Some(min), max: Some(max) }))
    }

    /// Weighted parameters.
    #[must_use]
    pub fn mix(parts: impl IntoIterator<Item = (f64, Self)>) -> Self {
        Self::Random(Distribution::Mix(parts.into_iter().collect()))
    }

    /// An interval that holds every value it can take. Where the law itself has no bounds, they are
    /// what 53 random bits can reach: 8.3 standard deviations of a normal, and alike for a Poisson.
    /// Meaningful for parameters that pass validation.
    #[must_use]
    pub fn bounds(&self) -> (f64, f64) {
        let distribution = match self {
            Self::Constant(value) => return (*value, *value),
            Self::Random(distribution) => distribution,
        };
        match distribution {
            Distribution::Uniform([min, max]) => (*min, *max),
            Distribution::Normal(n) => {
                let reach = FARTHEST * n.std;
                let (min, max) = (n.mean - reach, n.mean + reach);
                (n.min.unwrap_or(min).max(min), n.max.unwrap_or(max).min(max))
            }
            Distribution::Lognormal(l) => {
                let factor = libm::exp(FARTHEST * l.sigma);
                let (min, max) = (l.median / factor, l.median * factor);
                (l.min.unwrap_or(min).max(min), l.max.unwrap_or(max).min(max))
            }
            Distribution::Beta(b) => (b.min, b.max),
            Distribution::Triangular(t) => (t.min, t.max),
            Distribution::Bernoulli(p) => (f64::from(*p >= 1.0), f64::from(*p > 0.0)),
            Distribution::Binomial(b) => (0.0, f64::from(b.n)),
            Distribution::Poisson(mean) => {
                (0.0, if *mean > 0.0 { (mean + 9.0 * mean.sqrt() + 30.0).floor() } else { 0.0 })
            }
            Distribution::Choice(items) => {
                hull(items.iter().filter(|i| i.1 > 0.0).map(|i| (i.0, i.0)))
            }
            Distribution::Each(values) => hull(values.iter().map(|v| (*v, *v))),
            Distribution::Curve(points) => hull(points.iter().map(|p| (p.0, p.0))),
            Distribution::Mix(parts) => {
                hull(parts.iter().filter(|p| p.0 > 0.0).map(|p| p.1.bounds()))
            }
            // Nobody knows before it is read.
            Distribution::Empirical(_) => (f64::NEG_INFINITY, f64::INFINITY),
            Distribution::Given(given) => hull(given.table.iter().map(|row| row.2.bounds())),
        }
    }

    /// The law itself and all within it, each with its path; nothing for a constant.
    #[must_use]
    pub fn laws(&self, path: &str) -> Vec<(String, &Distribution)> {
        let mut laws = Vec::new();
        self.add_laws(path, &mut laws);
        laws
    }

    fn add_laws<'a>(&'a self, path: &str, laws: &mut Vec<(String, &'a Distribution)>) {
        let Self::Random(distribution) = self else { return };
        laws.push((path.to_owned(), distribution));
        match distribution {
            Distribution::Mix(parts) => {
                for (i, (_, part)) in parts.iter().enumerate() {
                    part.add_laws(&format!("{path}.mix[{i}][1]"), laws);
                }
            }
            Distribution::Given(given) => {
                for (i, (_, _, row)) in given.table.iter().enumerate() {
                    row.add_laws(&format!("{path}.given.table[{i}][2]"), laws);
                }
            }
            _ => {}
        }
    }
}

fn hull(intervals: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    intervals
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        .unwrap_or((f64::NEG_INFINITY, f64::INFINITY))
}

/// Yes or no: fixed, or drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Flag {
    /// Always this.
    Always(bool),
    /// Drawn.
    Random(Chance),
}

/// How a yes or no is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Chance {
    /// Yes with this probability.
    Bernoulli(f64),
}

impl Flag {
    /// Yes with a probability.
    #[must_use]
    pub const fn with_probability(p: f64) -> Self {
        Self::Random(Chance::Bernoulli(p))
    }
}

/// One of several things: fixed, or drawn by weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Choice<T> {
    /// Always this.
    Always(T),
    /// Drawn.
    Random(Weighted<T>),
}

/// How one of several things is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Weighted<T> {
    /// Things with their weights.
    Choice(Vec<(T, f64)>),
    /// Not drawn: the first for the first slot of the frame, the second for the second, and from
    /// the beginning again where they end.
    Each(Vec<T>),
}

impl<T> Choice<T> {
    /// Things with their weights.
    pub fn of(items: impl IntoIterator<Item = (T, f64)>) -> Self {
        Self::Random(Weighted::Choice(items.into_iter().collect()))
    }

    /// Everything that can come up: all that have no weight or one above 0.
    pub fn possible(&self) -> Vec<&T> {
        match self {
            Self::Always(item) => vec![item],
            Self::Random(Weighted::Choice(items)) => {
                items.iter().filter(|i| i.1 > 0.0).map(|i| &i.0).collect()
            }
            Self::Random(Weighted::Each(items)) => items.iter().collect(),
        }
    }
}

/// Worked out from the person's other values, or given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Auto<T> {
    /// `"auto"`.
    Auto(AutoWord),
    /// As given.
    Given(T),
}

/// The word `"auto"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoWord {
    /// Worked out from the person's other values.
    Auto,
}

impl<T> Default for Auto<T> {
    fn default() -> Self {
        Self::Auto(AutoWord::Auto)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_reads_and_writes_the_same() {
        for text in [
            "2.5",
            r#"{"uniform":[-7.5,7.5]}"#,
            r#"{"normal":{"mean":0.0,"std":1.0,"min":-3.0,"max":3.0}}"#,
            r#"{"normal":{"mean":0.0,"std":1.0}}"#,
            r#"{"lognormal":{"median":2.0,"sigma":0.5,"max":9.0}}"#,
            r#"{"beta":{"alpha":2.0,"beta":3.0,"min":0.0,"max":1.0}}"#,
            r#"{"triangular":{"min":0.0,"mode":1.0,"max":3.0}}"#,
            r#"{"bernoulli":0.8}"#,
            r#"{"binomial":{"n":10,"p":0.3}}"#,
            r#"{"poisson":6.0}"#,
            r#"{"choice":[[1.0,3.0],[2.0,1.0]]}"#,
            r#"{"curve":[[0.0,0.0],[1.0,2.0],[4.0,0.0]]}"#,
            r#"{"mix":[[0.7,1.0],[0.3,{"uniform":[0.0,1.0]}]]}"#,
            r#"{"empirical":{"file":"ages.csv","column":"age"}}"#,
            r#"{"empirical":{"file":"ages.csv","weight":"people"}}"#,
            r#"{"given":{"of":"people.scale","table":[[0.0,1.0,2.0],[1.0,3.0,{"poisson":4.0}]]}}"#,
        ] {
            let param: Param = serde_json::from_str(text).unwrap();
            assert_eq!(serde_json::to_string(&param).unwrap(), text);
        }
    }

    #[test]
    fn bounds_hold_what_can_be_drawn() {
        let bounds = |text: &str| serde_json::from_str::<Param>(text).unwrap().bounds();
        assert_eq!(bounds(r#"{"mix":[[1,{"uniform":[3,4]}],[1,-2],[0,99]]}"#), (-2.0, 4.0));
        assert_eq!(bounds(r#"{"choice":[[5,1],[-1,0],[7,2]]}"#), (5.0, 7.0));
        assert_eq!(bounds(r#"{"bernoulli":1}"#), (1.0, 1.0));
        assert_eq!(bounds(r#"{"normal":{"mean":0,"std":1,"min":-1}}"#), (-1.0, 8.3));
        assert_eq!(bounds(r#"{"poisson":4}"#), (0.0, 52.0));
        assert_eq!(bounds(r#"{"curve":[[1,1],[2,1]]}"#), (1.0, 2.0));
        let given = r#"{"given":{"of":"a","table":[[0,1,{"uniform":[3,4]}],[1,2,-1]]}}"#;
        assert_eq!(bounds(given), (-1.0, 4.0));
    }

    #[test]
    fn a_row_holds_its_beginning_and_the_last_one_its_end() {
        let given: Given =
            serde_json::from_str(r#"{"of": "a", "table": [[0, 1, 10], [1, 2, 20]]}"#).unwrap();
        for (value, row) in [(0.0, 10.0), (0.99, 10.0), (1.0, 20.0), (2.0, 20.0), (9.0, 20.0)] {
            assert_eq!(*given.row(value), Param::Constant(row), "{value}");
        }
    }
}
