//! The samplers of a scenario, in each spelling that Unity Perception has had for them.

use serde_json::{Map, Value};

use super::law::Law;
use super::scenario::{Reader, join};
use crate::document::check::show;

/// Numbers that a field may not leave.
type Limits = [f64; 2];

impl Reader<'_> {
    /// A sampler with its limits.
    pub(super) fn sampler(&mut self, value: &Value, path: &str) -> Option<Law> {
        const NAMES: [&str; 4] = ["uniform", "normal", "constant", "curve"];
        let map = self.object(value, path)?;
        self.known_keys(
            map,
            path,
            &["uniform", "normal", "constant", "curve", "metadata", "limits"],
        );
        let mut found = NAMES.iter().filter_map(|name| Some((*name, map.get(*name)?)));
        let (Some((name, sampler)), None) = (found.next(), found.next()) else {
            let expected = NAMES.map(|n| format!("\"{n}\"")).join(", ");
            self.log.problem(path, format!("expected exactly one sampler of {expected}"));
            return None;
        };
        let inner_path = join(path, name);
        let inner = self.object(sampler, &inner_path)?;
        let fields: &[&str] = match name {
            "uniform" => &["min", "max", "range"],
            "normal" => &["min", "max", "range", "mean", "stddev", "standardDeviation"],
            "constant" => &["value"],
            _ => &["keys"],
        };
        let limit_fields = ["limits", "minAllowed", "maxAllowed", "shouldCheckValidRange"];
        self.known_keys(inner, &inner_path, &[fields, limit_fields.as_slice()].concat());
        let law = match name {
            "uniform" => self.uniform(inner, &inner_path),
            "normal" => self.normal(inner, &inner_path),
            "constant" => self.field(inner, "value", &inner_path).map(Law::Constant),
            _ => self.curve(inner, &inner_path),
        };
        let limits = self.limits(&[(inner, inner_path.as_str()), (map, path)])?;
        Some(self.limited(law?, limits, &inner_path))
    }

    fn min_max(&mut self, map: &Map<String, Value>, path: &str) -> Option<[f64; 2]> {
        let (min, max) = (self.field(map, "min", path), self.field(map, "max", path));
        self.ordered(min?, max?, path)
    }

    fn ordered(&mut self, min: f64, max: f64, path: &str) -> Option<[f64; 2]> {
        if min > max {
            self.log.problem(path, format!("min must be <= max, got min {min} and max {max}"));
            return None;
        }
        Some([min, max])
    }

    /// The range of a sampler: its ends, or an object of them as the sampler's class spells it.
    fn range(&mut self, map: &Map<String, Value>, path: &str) -> Option<[f64; 2]> {
        let Some(range) = map.get("range") else {
            return self.min_max(map, path);
        };
        let path = join(path, "range");
        let range = self.object(range, &path)?;
        self.known_keys(range, &path, &["minimum", "maximum"]);
        let ends = ["minimum", "maximum"].map(|name| self.field(range, name, &path));
        let [Some(min), Some(max)] = ends else { return None };
        self.ordered(min, max, &path)
    }

    fn uniform(&mut self, map: &Map<String, Value>, path: &str) -> Option<Law> {
        let [min, max] = self.range(map, path)?;
        Some(if min == max { Law::Constant(min) } else { Law::Uniform(min, max) })
    }

    fn normal(&mut self, map: &Map<String, Value>, path: &str) -> Option<Law> {
        let range = self.range(map, path);
        let long = map.contains_key("standardDeviation");
        let std = if long { "standardDeviation" } else { "stddev" };
        let (mean, std) = (self.field(map, "mean", path), self.field(map, std, path));
        let ([min, max], mean, std) = (range?, mean?, std?);
        if std < 0.0 {
            let path = join(path, "stddev");
            self.log.problem(&path, format!("must be >= 0, got {std}"));
            return None;
        }
        Some(if std == 0.0 || min == max {
            Law::Constant(mean.clamp(min, max))
        } else {
            Law::Normal { mean, std, min, max }
        })
    }

    /// A curve by its keys, `{"time": x, "value": density}` or `[x, density]`.
    fn curve(&mut self, map: &Map<String, Value>, path: &str) -> Option<Law> {
        let path = join(path, "keys");
        let keys = map.get("keys").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        if keys.len() < 2 {
            let got = keys.len();
            self.log.problem(&path, format!("a curve needs two points at least, got {got}"));
            return None;
        }
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(keys.len());
        for (i, key) in keys.iter().enumerate() {
            let path = format!("{path}[{i}]");
            let (x, density) = match key.as_array().map(Vec::as_slice) {
                Some([x, density]) => (self.number(x, &path)?, self.number(density, &path)?),
                Some(_) => {
                    self.log.problem(&path, format!("expected [x, density], got {}", show(key)));
                    return None;
                }
                None => {
                    let key = self.object(key, &path)?;
                    self.known_keys(key, &path, &["time", "value"]);
                    (self.field(key, "time", &path)?, self.field(key, "value", &path)?)
                }
            };
            if density < 0.0 {
                self.log.problem(&path, format!("the density must be >= 0, got {density}"));
                return None;
            }
            if points.last().is_some_and(|last| x <= last.0) {
                self.log.problem(&path, format!("x must grow from point to point, got {x}"));
                return None;
            }
            points.push((x, density));
        }
        if points.iter().all(|p| p.1 == 0.0) {
            self.log.problem(&path, "the density is 0 everywhere");
            return None;
        }
        Some(Law::Curve(points))
    }

    /// The limits of a number: an object of their own, in the sampler or beside it, or three
    /// fields of the sampler in older files. Outer nothing where they are wrong.
    pub(super) fn limits(
        &mut self,
        places: &[(&Map<String, Value>, &str)],
    ) -> Option<Option<Limits>> {
        for (map, path) in places {
            if let Some(limits) = map.get("limits").filter(|l| !l.is_null()) {
                let path = join(path, "limits");
                let limits = self.object(limits, &path)?;
                self.known_keys(limits, &path, &["min", "max"]);
                return self.min_max(limits, &path).map(Some);
            }
            if map.get("shouldCheckValidRange").and_then(Value::as_bool) == Some(true) {
                let low = self.field(map, "minAllowed", path)?;
                let high = self.field(map, "maxAllowed", path)?;
                if low > high {
                    let message = format!("minAllowed must be <= maxAllowed, got {low} and {high}");
                    self.log.problem(path, message);
                    return None;
                }
                return Some(Some([low, high]));
            }
        }
        Some(None)
    }

    /// A law within limits; what they change is noted.
    pub(super) fn limited(&mut self, law: Law, limits: Option<Limits>, path: &str) -> Law {
        let Some([low, high]) = limits else {
            return law;
        };
        let [min, max] = law.ends();
        if min >= low && max <= high {
            return law;
        }
        let limited = law.within([low, high]);
        let [from, to] = limited.ends();
        let what = format!("{min} to {max} leaves the limits {low} to {high}");
        let what = match &limited {
            Law::Curve(_) => format!("{what}, which do not apply to a curve: it stays as it is"),
            Law::Constant(value) => format!("{what}; it is {value} now"),
            _ => format!("{what}; it is {from} to {to} now"),
        };
        self.log.note(path, what);
        limited
    }
}
