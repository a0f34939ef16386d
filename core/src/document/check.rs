//! The form of a config: JSON against the schema, all problems at once, each with its path.
//!
//! A deserialiser stops at the first error and knows no path inside an untagged value; this walk
//! goes through text and schema side by side instead. What the numbers mean is [`super::validate`]'s
//! business.

use serde_json::{Map, Value};

use super::Problem;

/// Everything in which a JSON value differs from a schema as [`super::schema`] makes it.
#[must_use]
pub fn check(value: &Value, schema: &Value) -> Vec<Problem> {
    let mut walk = Walk { root: schema, problems: Vec::new() };
    walk.check(value, schema, "");
    walk.problems
}

struct Walk<'a> {
    root: &'a Value,
    problems: Vec<Problem>,
}

impl<'a> Walk<'a> {
    fn report(&mut self, path: &str, message: String) {
        self.problems.push(Problem::new(path, message));
    }

    /// The schemas that a value may follow: references resolved, unions laid out flat.
    fn alternatives(&self, schema: &'a Value, into: &mut Vec<&'a Value>) {
        if let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
            if let Some(target) = self.root.pointer(reference.trim_start_matches('#')) {
                self.alternatives(target, into);
            }
            return;
        }
        match schema.get("anyOf").or_else(|| schema.get("oneOf")).and_then(Value::as_array) {
            Some(union) => union.iter().for_each(|s| self.alternatives(s, into)),
            None => into.push(schema),
        }
    }

    fn check(&mut self, value: &Value, schema: &'a Value, path: &str) {
        let mut all = Vec::new();
        self.alternatives(schema, &mut all);
        let kind = kind_of(value);
        let fits: Vec<&'a Value> = all.iter().copied().filter(|s| allows(s, kind)).collect();
        if fits.is_empty() {
            self.report(path, format!("expected {}, got {}", describe(&all), show(value)));
            return;
        }
        match value {
            Value::Object(map) => self.check_object(map, &fits, path),
            Value::Array(items) => self.check_array(items, &fits, path),
            Value::String(word) => self.check_word(word, &fits, path),
            Value::Number(number) => self.check_number(number, &fits, path),
            Value::Bool(_) | Value::Null => {}
        }
    }

    fn check_object(&mut self, map: &Map<String, Value>, fits: &[&'a Value], path: &str) {
        if let [schema] = fits
            && !is_tagged(schema)
            && tag_of(schema).is_none()
        {
            self.check_fields(map, schema, path);
            return;
        }
        if let Some(tag) = fits.iter().find_map(|s| tag_of(s)) {
            self.check_mode(map, tag, fits, path);
            return;
        }
        // A union of `{"name": ...}`: exactly one name, which says what follows.
        let names: Vec<&str> = fits.iter().flat_map(|s| field_names(s)).collect();
        let mut keys = map.keys();
        let (Some(name), None) = (keys.next(), keys.next()) else {
            let got = map.keys().map(|k| format!("\"{k}\"")).collect::<Vec<_>>().join(", ");
            let got = if got.is_empty() { "none".to_owned() } else { got };
            self.report(path, format!("expected exactly one of {}, got {got}", list(&names)));
            return;
        };
        let schema = fits.iter().find_map(|s| s.get("properties").and_then(|p| p.get(name)));
        match schema {
            Some(schema) => self.check(&map[name], schema, &join(path, name)),
            None => {
                let message = format!("unknown, expected one of {}", list(&names));
                let problem = Problem::new(join(path, name), message);
                self.problems.push(problem.did_you_mean(name, names.iter().copied()));
            }
        }
    }

    /// A union of objects that hold their name in a field.
    fn check_mode(&mut self, map: &Map<String, Value>, tag: &str, fits: &[&'a Value], path: &str) {
        let name_of = |s: &&'a Value| s["properties"][tag]["const"].as_str();
        let names: Vec<&str> = fits.iter().filter_map(name_of).collect();
        let Some(name) = map.get(tag) else {
            self.report(&join(path, tag), format!("missing, expected one of {}", list(&names)));
            return;
        };
        match fits.iter().find(|s| name_of(s) == name.as_str()) {
            Some(schema) => self.check_fields(map, schema, path),
            None => {
                let message = format!("expected one of {}, got {}", list(&names), show(name));
                let problem = Problem::new(join(path, tag), message);
                self.problems.push(problem.did_you_mean(name.as_str().unwrap_or(""), names));
            }
        }
    }

    fn check_fields(&mut self, map: &Map<String, Value>, schema: &'a Value, path: &str) {
        let properties = schema.get("properties").and_then(Value::as_object);
        for (name, value) in map {
            match properties.and_then(|p| p.get(name)) {
                Some(field) => self.check(value, field, &join(path, name)),
                // A map by free names: each value has the same form.
                None if schema.get("additionalProperties").is_some_and(Value::is_object) => {
                    self.check(value, &schema["additionalProperties"], &join(path, name));
                }
                None => {
                    let names = field_names(schema);
                    let message = format!("unknown field, known here are {}", list(&names));
                    let problem = Problem::new(join(path, name), message);
                    self.problems.push(problem.did_you_mean(name, names));
                }
            }
        }
        for name in schema.get("required").and_then(Value::as_array).into_iter().flatten() {
            if let Some(name) = name.as_str()
                && !map.contains_key(name)
            {
                self.report(&join(path, name), "missing, it has no default".to_owned());
            }
        }
    }

    fn check_array(&mut self, items: &[Value], fits: &[&'a Value], path: &str) {
        let schema = fits[0];
        let bound = |name: &str| schema.get(name).and_then(Value::as_u64);
        let count = items.len() as u64;
        let (min, max) = (bound("minItems").unwrap_or(0), bound("maxItems").unwrap_or(u64::MAX));
        if count < min || count > max {
            let want = if min == max { format!("{min}") } else { format!("{min} to {max}") };
            self.report(path, format!("expected {want} values in [ ], got {count}"));
            return;
        }
        let first = schema.get("prefixItems").and_then(Value::as_array);
        for (i, item) in items.iter().enumerate() {
            let of_item = first.and_then(|f| f.get(i)).or_else(|| schema.get("items"));
            if let Some(of_item) = of_item {
                self.check(item, of_item, &format!("{path}[{i}]"));
            }
        }
    }

    fn check_word(&mut self, word: &str, fits: &[&'a Value], path: &str) {
        let words: Vec<&str> = fits.iter().flat_map(|s| words_of(s)).collect();
        let free = fits.iter().any(|s| words_of(s).is_empty());
        if !free && !words.contains(&word) {
            let message = format!("expected one of {}, got \"{word}\"", list(&words));
            self.problems.push(Problem::new(path, message).did_you_mean(word, words));
        }
    }

    fn check_number(&mut self, number: &serde_json::Number, fits: &[&'a Value], path: &str) {
        if fits.iter().any(|s| types_of(s).any(|t| t == "number")) {
            return;
        }
        let (min, max) = integer_range(fits[0]);
        let fits = match (number.as_u64(), number.as_i64()) {
            (Some(n), _) => n <= max,
            (None, Some(n)) => min < 0 && n >= min,
            (None, None) => false,
        };
        if !fits {
            self.report(path, format!("expected a whole number from {min} to {max}, got {number}"));
        }
    }
}

fn integer_range(schema: &Value) -> (i64, u64) {
    let of_format = match schema.get("format").and_then(Value::as_str) {
        Some("uint8") => (0, u64::from(u8::MAX)),
        Some("uint16") => (0, u64::from(u16::MAX)),
        Some("uint32") => (0, u64::from(u32::MAX)),
        Some("int32") => (i64::from(i32::MIN), i32::MAX as u64),
        Some("int64") => (i64::MIN, i64::MAX as u64),
        _ => (0, u64::MAX),
    };
    let min = schema.get("minimum").and_then(Value::as_i64).unwrap_or(of_format.0);
    let max = schema.get("maximum").and_then(Value::as_u64).unwrap_or(of_format.1);
    (min, max)
}

fn kind_of(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}

fn types_of(schema: &Value) -> impl Iterator<Item = &str> {
    let types = schema.get("type");
    let many = types.and_then(Value::as_array).into_iter().flatten();
    types.into_iter().chain(many).filter_map(Value::as_str)
}

fn allows(schema: &Value, kind: &str) -> bool {
    types_of(schema).any(|t| t == kind || (t == "integer" && kind == "number"))
}

/// Whether an object schema is one variant of a tagged union: a single, required field.
fn is_tagged(schema: &Value) -> bool {
    let size = |name: &str| match schema.get(name) {
        Some(Value::Object(map)) => map.len(),
        Some(Value::Array(items)) => items.len(),
        _ => 0,
    };
    size("properties") == 1 && size("required") == 1
}

/// The field that holds the name of an object schema in a union.
fn tag_of(schema: &Value) -> Option<&str> {
    let fields = schema.get("properties")?.as_object()?;
    fields.iter().find(|(_, field)| field.get("const").is_some()).map(|(name, _)| name.as_str())
}

fn field_names(schema: &Value) -> Vec<&str> {
    let fields = schema.get("properties").and_then(Value::as_object);
    fields.into_iter().flat_map(|f| f.keys().map(String::as_str)).collect()
}

fn words_of(schema: &Value) -> Vec<&str> {
    let single = schema.get("const").and_then(Value::as_str);
    let many = schema.get("enum").and_then(Value::as_array).into_iter().flatten();
    single.into_iter().chain(many.filter_map(Value::as_str)).collect()
}

fn describe(all: &[&Value]) -> String {
    let mut parts: Vec<String> = Vec::new();
    let mut names = Vec::new();
    for schema in all {
        for kind in types_of(schema) {
            let part = match kind {
                "object" if is_tagged(schema) => {
                    names.extend(field_names(schema));
                    continue;
                }
                "string" if !words_of(schema).is_empty() => list(&words_of(schema)),
                "number" => "a number".to_owned(),
                "integer" => "a whole number".to_owned(),
                "string" => "a text".to_owned(),
                "boolean" => "true or false".to_owned(),
                "array" => match schema.get("minItems").and_then(Value::as_u64) {
                    Some(n) => format!("a list [ ] of {n}"),
                    None => "a list [ ]".to_owned(),
                },
                "null" => "null".to_owned(),
                _ => "an object { }".to_owned(),
            };
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
    }
    if !names.is_empty() {
        parts.push(format!("an object with one of {}", list(&names)));
    }
    parts.join(" or ")
}

fn list(names: &[&str]) -> String {
    names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}

pub(super) fn show(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= 40 {
        return text;
    }
    let start: String = text.chars().take(37).collect();
    format!("{start}...")
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::document::{Document, schema};

    fn problems(value: &Value) -> Vec<String> {
        check(value, &schema()).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn the_default_document_has_the_schemas_form() {
        let value = serde_json::to_value(Document::default()).unwrap();
        assert_eq!(problems(&value), Vec::<String>::new());
    }

    #[test]
    fn a_misspelt_field_is_named_with_what_was_meant() {
        let found = problems(&json!({"people": {"placment": {}}}));
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("people.placment: unknown field"), "{found:?}");
        assert!(found[0].ends_with("did you mean `placement`?"), "{found:?}");
    }

    #[test]
    fn every_problem_is_reported_with_its_path() {
        let found = check(
            &json!({
                "seed": -1,
                "frames": 1.5,
                "name": 3,
                "people": {
                    "scale": {"unifrom": [0, 1]},
                    "placement": {"mode": "poisson_disk", "separation_m": 3},
                    "body": {"sex": {"choice": [["femal", 1]]}, "stature_m": "automatic"},
                    "pose": {"mirrored": 1}
                },
                "occluders": {"shape": "cubes", "scale": {"uniform": [0]}},
                "lights": {
                    "points": [{}, {"color": [1, 2]}],
                    "sun": {"direction": {"mode": "clok"}},
                    "environment": {"sky_lux": {}}
                },
                "camera": {"rotation_deg": {"rotation": "haar"}},
                "background": {"wall": {"hue_offset_deg": {"given": {}}}}
            }),
            &schema(),
        );
        let paths: Vec<&str> = found.iter().map(|p| p.path.as_str()).collect();
        let expected = [
            "background.wall.hue_offset_deg.given.of",
            "background.wall.hue_offset_deg.given.table",
            "camera.rotation_deg.rotation",
            "frames",
            "lights.environment.sky_lux",
            "lights.points[1].color",
            "lights.sun.direction.mode",
            "name",
            "occluders.scale.uniform",
            "occluders.shape",
            "people.body.sex.choice[0][0]",
            "people.body.stature_m",
            "people.placement.depth_m",
            "people.pose.mirrored",
            "people.scale.unifrom",
            "seed",
        ];
        let mut sorted = paths.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, expected, "{found:#?}");
        let suggestion = |path| found.iter().find(|p| p.path == path).unwrap().suggestion.clone();
        assert_eq!(suggestion("people.scale.unifrom").as_deref(), Some("uniform"));
        assert_eq!(suggestion("lights.sun.direction.mode").as_deref(), Some("clock"));
        assert_eq!(suggestion("occluders.shape").as_deref(), Some("cube"));
        assert_eq!(suggestion("people.body.sex.choice[0][0]").as_deref(), Some("female"));
        assert_eq!(suggestion("people.body.stature_m").as_deref(), Some("auto"));
    }

    #[test]
    fn what_the_walk_accepts_deserialises() {
        let words = ["\"auto\"", "1", "true", "null", "[]", "[1,2,3]", "{}", "{\"uniform\":[0,1]}"];
        let fields = ["age_years", "sex", "stature_m", "ancestry", "muscle"];
        for field in fields {
            for word in words {
                let text = format!("{{\"people\":{{\"body\":{{\"{field}\":{word}}}}}}}");
                let value: Value = serde_json::from_str(&text).unwrap();
                let ours = check(&value, &schema()).is_empty();
                assert_eq!(ours, serde_json::from_str::<Document>(&text).is_ok(), "{text}");
            }
        }
    }
}
