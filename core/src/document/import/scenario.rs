//! A scenario file as typed values, each with its path in the file.
//!
//! The form is that of Unity Perception 0.9 to 1.0 and of PeopleSansPeople (2021): constants, and
//! groups of items, each a scalar or a parameter whose components are drawn by samplers. Groups
//! stand in a list (`randomizerGroups`) or, in older files, in an object by their ids (`groups`).
//! What the groups mean is not known here.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::law::{Law, tidy};
use super::log::Log;
use crate::document::check::show;

/// A scenario.
#[derive(Debug, Default)]
pub(super) struct Scenario {
    /// Whole numbers by their names.
    pub(super) constants: BTreeMap<String, Constant>,
    /// Randomizers in the order of the file.
    pub(super) groups: Vec<Group>,
}

/// A whole number of the section `constants`.
#[derive(Clone, Debug)]
pub(super) struct Constant {
    pub(super) path: String,
    pub(super) value: u64,
}

/// A randomizer.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) path: String,
    pub(super) id: String,
    pub(super) enabled: bool,
    pub(super) items: BTreeMap<String, Item>,
}

/// A field of a randomizer.
#[derive(Clone, Debug)]
pub(super) struct Item {
    pub(super) path: String,
    pub(super) value: ItemValue,
}

#[derive(Clone, Debug)]
pub(super) enum ItemValue {
    Number(f64),
    Bool(bool),
    /// Nothing here is set by a text.
    Text,
    /// Components by their names, as in x, y and z.
    Param(BTreeMap<String, Component>),
}

/// A number of a parameter.
#[derive(Clone, Debug)]
pub(super) struct Component {
    pub(super) path: String,
    pub(super) law: Law,
}

/// Larger files are no scenarios: each randomizer stands in one once.
const MAX_GROUPS: usize = 1000;

/// Constants of all versions.
const CONSTANTS: [&str; 7] = [
    "framesPerIteration",
    "totalIterations",
    "instanceCount",
    "instanceIndex",
    "randomSeed",
    "startIteration",
    "iterationCount",
];

/// Reads a scenario; what is wrong or unknown in it goes to the log. Randomizers whose ids are not
/// known may hold anything: their items are not read.
pub(super) fn read(
    root: &Map<String, Value>,
    is_known: fn(&str) -> bool,
    log: &mut Log,
) -> Scenario {
    let mut reader = Reader { log, is_known };
    reader.known_keys(root, "", &["constants", "randomizers"]);
    let constants = root.get("constants").map(|c| reader.constants(c)).unwrap_or_default();
    let groups = root.get("randomizers").map(|r| reader.groups(r)).unwrap_or_default();
    Scenario { constants, groups }
}

/// Reads values; what it returns nothing for stands in the log.
pub(super) struct Reader<'a> {
    pub(super) log: &'a mut Log,
    is_known: fn(&str) -> bool,
}

pub(super) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

impl Reader<'_> {
    pub(super) fn object<'v>(
        &mut self,
        value: &'v Value,
        path: &str,
    ) -> Option<&'v Map<String, Value>> {
        let object = value.as_object();
        if object.is_none() {
            self.log.problem(path, format!("expected an object {{ }}, got {}", show(value)));
        }
        object
    }

    pub(super) fn known_keys(&mut self, map: &Map<String, Value>, path: &str, known: &[&str]) {
        for key in map.keys().filter(|k| !known.contains(&k.as_str())) {
            self.log.unknown(&join(path, key), "field", key, known.iter().copied());
        }
    }

    pub(super) fn number(&mut self, value: &Value, path: &str) -> Option<f64> {
        let number = value.as_f64().filter(|n| n.is_finite());
        if number.is_none() {
            self.log.problem(path, format!("expected a finite number, got {}", show(value)));
        }
        // Only what is a 32-bit number to the last bit was written by the program itself.
        number.map(|n| if f64::from(n as f32) == n { tidy(n) } else { n })
    }

    fn bool(&mut self, value: &Value, path: &str) -> Option<bool> {
        let found = value.as_bool();
        if found.is_none() {
            self.log.problem(path, format!("expected true or false, got {}", show(value)));
        }
        found
    }

    /// The number of a field that must be there.
    pub(super) fn field(
        &mut self,
        map: &Map<String, Value>,
        name: &str,
        path: &str,
    ) -> Option<f64> {
        let path = join(path, name);
        match map.get(name) {
            Some(value) => self.number(value, &path),
            None => {
                self.log.problem(&path, "missing; expected a number");
                None
            }
        }
    }

    fn constants(&mut self, value: &Value) -> BTreeMap<String, Constant> {
        let mut constants = BTreeMap::new();
        for (name, value) in self.object(value, "constants").into_iter().flatten() {
            let path = join("constants", name);
            if !CONSTANTS.contains(&name.as_str()) {
                self.log.unknown(&path, "constant", name, CONSTANTS);
                continue;
            }
            // Whole numbers may come as 100.0.
            let float = value.as_f64().filter(|f| f.fract() == 0.0 && (0.0..1e15).contains(f));
            match value.as_u64().or(float.map(|f| f as u64)) {
                Some(value) => drop(constants.insert(name.clone(), Constant { path, value })),
                None => {
                    let got = show(value);
                    self.log.problem(&path, format!("expected a whole number >= 0, got {got}"));
                }
            }
        }
        constants
    }

    fn groups(&mut self, value: &Value) -> Vec<Group> {
        let path = "randomizers";
        let Some(map) = self.object(value, path) else {
            return Vec::new();
        };
        self.known_keys(map, path, &["randomizerGroups", "groups"]);
        let groups = match (map.get("randomizerGroups"), map.get("groups")) {
            (Some(list), None) => self.listed(list),
            (None, Some(by_id)) => {
                let path = "randomizers.groups";
                let all = self.object(by_id, path);
                let all = all.filter(|all| self.few(all.len(), path)).into_iter().flatten();
                all.filter_map(|(id, group)| self.group(id.clone(), group, join(path, id)))
                    .collect()
            }
            _ => {
                let expected =
                    "expected exactly one of \"randomizerGroups\" [ ] and \"groups\" { }";
                self.log.problem(path, expected);
                Vec::new()
            }
        };
        self.refuse_twins(&groups);
        groups
    }

    fn listed(&mut self, value: &Value) -> Vec<Group> {
        let path = "randomizers.randomizerGroups";
        let Some(list) = value.as_array() else {
            self.log.problem(path, format!("expected a list [ ], got {}", show(value)));
            return Vec::new();
        };
        if !self.few(list.len(), path) {
            return Vec::new();
        }
        let mut groups = Vec::new();
        for (i, group) in list.iter().enumerate() {
            let path = format!("{path}[{i}]");
            match group.get("randomizerId").map(|id| (id, id.as_str())) {
                Some((_, Some(id))) if !id.is_empty() => {
                    groups.extend(self.group(id.to_owned(), group, path));
                }
                Some((id, _)) => {
                    let path = join(&path, "randomizerId");
                    self.log.problem(&path, format!("expected a name, got {}", show(id)));
                }
                None if group.is_object() => {
                    self.log.problem(&join(&path, "randomizerId"), "missing; expected a name");
                }
                None => {
                    let got = show(group);
                    self.log.problem(&path, format!("expected an object {{ }}, got {got}"));
                }
            }
        }
        groups
    }

    fn few(&mut self, groups: usize, path: &str) -> bool {
        if groups > MAX_GROUPS {
            let message = format!("must hold at most {MAX_GROUPS} randomizers, got {groups}");
            self.log.problem(path, message);
        }
        groups <= MAX_GROUPS
    }

    /// A scenario has one randomizer of a kind.
    fn refuse_twins(&mut self, groups: &[Group]) {
        let mut first = BTreeMap::new();
        for group in groups {
            let path = *first.entry(&group.id).or_insert(&group.path);
            if *path != group.path {
                let message = format!("{} stands already in {path}; remove one", group.id);
                self.log.problem(&group.path, message);
            }
        }
    }

    fn group(&mut self, id: String, value: &Value, path: String) -> Option<Group> {
        let map = self.object(value, &path)?;
        self.known_keys(map, &path, &["randomizerId", "metadata", "state", "items"]);
        let mut enabled = true;
        if let Some(state) = map.get("state").filter(|s| !s.is_null()) {
            let path = join(&path, "state");
            if let Some(state) = self.object(state, &path) {
                self.known_keys(state, &path, &["enabled", "canBeSwitchedByUser"]);
                if let Some(value) = state.get("enabled") {
                    enabled = self.bool(value, &join(&path, "enabled")).unwrap_or(true);
                }
            }
        }
        let mut items = BTreeMap::new();
        let is_known = (self.is_known)(&id);
        if let Some(value) = map.get("items").filter(|i| is_known && !i.is_null()) {
            let path = join(&path, "items");
            for (name, value) in self.object(value, &path).into_iter().flatten() {
                let path = join(&path, name);
                if let Some(value) = self.item(value, &path) {
                    items.insert(name.clone(), Item { path, value });
                }
            }
        }
        Some(Group { path, id, enabled, items })
    }

    fn item(&mut self, value: &Value, path: &str) -> Option<ItemValue> {
        let map = self.object(value, path)?;
        self.known_keys(map, path, &["param", "scalar"]);
        match (map.get("param"), map.get("scalar")) {
            (Some(param), None) => self.param(param, &join(path, "param")),
            (None, Some(scalar)) => self.scalar(scalar, &join(path, "scalar")),
            _ => {
                self.log.problem(path, "expected exactly one of \"param\" and \"scalar\"");
                None
            }
        }
    }

    fn scalar(&mut self, value: &Value, path: &str) -> Option<ItemValue> {
        let map = self.object(value, path)?;
        self.known_keys(map, path, &["metadata", "value", "limits"]);
        let inner_path = join(path, "value");
        let inner = match map.get("value") {
            Some(inner) => self.object(inner, &inner_path)?,
            None => {
                self.log.problem(&inner_path, "missing; expected {\"num\": ...} or the like");
                return None;
            }
        };
        self.known_keys(inner, &inner_path, &["num", "bool", "str", "limits"]);
        match (inner.get("num"), inner.get("bool"), inner.get("str")) {
            (Some(number), None, None) => {
                let number_path = join(&inner_path, "num");
                let number = self.number(number, &number_path)?;
                let limits = self.limits(&[(inner, &inner_path), (map, path)])?;
                match self.limited(Law::Constant(number), limits, &number_path) {
                    Law::Constant(number) => Some(ItemValue::Number(number)),
                    _ => None,
                }
            }
            (None, Some(flag), None) => {
                self.bool(flag, &join(&inner_path, "bool")).map(ItemValue::Bool)
            }
            (None, None, Some(Value::String(_))) => Some(ItemValue::Text),
            (None, None, Some(other)) => {
                let path = join(&inner_path, "str");
                self.log.problem(&path, format!("expected a text, got {}", show(other)));
                None
            }
            _ => {
                let expected = "expected exactly one of \"num\", \"bool\" and \"str\"";
                self.log.problem(&inner_path, expected);
                None
            }
        }
    }

    fn param(&mut self, value: &Value, path: &str) -> Option<ItemValue> {
        let map = self.object(value, path)?;
        self.known_keys(map, path, &["metadata", "items"]);
        let path = join(path, "items");
        let items = match map.get("items") {
            Some(items) => self.object(items, &path)?,
            None => &Map::new(),
        };
        if items.is_empty() {
            self.log.problem(&path, "holds no sampler; expected one at least, as in \"value\"");
            return None;
        }
        let mut components = BTreeMap::new();
        for (name, value) in items {
            let path = join(&path, name);
            if let Some(law) = self.component(value, &path) {
                components.insert(name.clone(), Component { path, law });
            }
        }
        // Half a parameter would be taken for one whose other half keeps its built-in value.
        (components.len() == items.len()).then_some(ItemValue::Param(components))
    }

    fn component(&mut self, value: &Value, path: &str) -> Option<Law> {
        let map = self.object(value, path)?;
        self.known_keys(map, path, &["samplerOptions", "scalar"]);
        match (map.get("samplerOptions"), map.get("scalar")) {
            (Some(options), None) => self.sampler(options, &join(path, "samplerOptions")),
            (None, Some(scalar)) => match self.scalar(scalar, &join(path, "scalar"))? {
                ItemValue::Number(number) => Some(Law::Constant(number)),
                ItemValue::Bool(flag) => Some(Law::Constant(f64::from(flag))),
                ItemValue::Text | ItemValue::Param(_) => {
                    self.log.problem(path, "expected a number or a sampler, got a text");
                    None
                }
            },
            _ => {
                self.log.problem(path, "missing \"samplerOptions\"; expected a sampler");
                None
            }
        }
    }
}
