//! The items of one randomizer, asked for by name. What nobody asks for is noted at the end.

use std::collections::BTreeMap;

use super::law::Law;
use super::log::Log;
use super::scenario::{Group, Item, ItemValue};

/// The items of a randomizer.
pub(super) struct Fields<'a> {
    id: String,
    path: String,
    items: BTreeMap<String, Item>,
    asked: Vec<&'static str>,
    log: &'a mut Log,
}

impl<'a> Fields<'a> {
    pub(super) fn new(group: &Group, log: &'a mut Log) -> Self {
        let (id, path, items) = (group.id.clone(), group.path.clone(), group.items.clone());
        Self { id, path, items, asked: Vec::new(), log }
    }

    fn take(&mut self, name: &'static str) -> Option<Item> {
        self.asked.push(name);
        self.items.remove(name)
    }

    /// Remembers that an item goes to another field of the config as well.
    pub(super) fn shared(&mut self, name: &str, ours: &'static str) {
        if let Some(item) = self.items.get(name) {
            self.log.origin(ours, &item.path);
        }
    }

    fn wrong(&mut self, item: &Item, expected: &str) {
        let got = match &item.value {
            ItemValue::Number(_) => "a number",
            ItemValue::Bool(_) => "true or false",
            ItemValue::Text => "a text",
            ItemValue::Param(_) => "a parameter",
        };
        self.log.problem(&item.path, format!("expected {expected}, got {got}"));
    }

    /// A number that is always the same, for a field of the config.
    pub(super) fn number(&mut self, name: &'static str, ours: &'static str) -> Option<f64> {
        let item = self.take(name)?;
        self.log.origin(ours, &item.path);
        let law = self.single(&item)?;
        if let Law::Constant(number) = law {
            return Some(number);
        }
        self.log.problem(&item.path, "expected one number: it cannot be drawn here");
        None
    }

    /// A yes or no.
    pub(super) fn flag(&mut self, name: &'static str) -> Option<bool> {
        let item = self.take(name)?;
        match item.value {
            ItemValue::Bool(flag) => Some(flag),
            _ => {
                self.wrong(&item, "a scalar {\"bool\": true} or {\"bool\": false}");
                None
            }
        }
    }

    /// How a number is drawn, for a field of the config.
    pub(super) fn law(&mut self, name: &'static str, ours: &'static str) -> Option<Law> {
        let item = self.take(name)?;
        self.log.origin(ours, &item.path);
        self.single(&item)
    }

    /// How several numbers are drawn, for a field of the config. Those that are missing keep their
    /// built-in laws.
    pub(super) fn laws<const N: usize>(
        &mut self,
        name: &'static str,
        components: [&'static str; N],
        ours: &'static str,
    ) -> [Option<Law>; N] {
        let Some(item) = self.take(name) else {
            return components.map(|_| None);
        };
        self.log.origin(ours, &item.path);
        let ItemValue::Param(mut found) = item.value else {
            self.wrong(&item, &format!("a parameter with {}", components.join(", ")));
            return components.map(|_| None);
        };
        let laws = components.map(|c| found.remove(c).map(|component| component.law));
        for (name, component) in found {
            self.log.unknown(&component.path, "component", &name, components);
        }
        laws
    }

    fn single(&mut self, item: &Item) -> Option<Law> {
        match &item.value {
            ItemValue::Number(number) => Some(Law::Constant(*number)),
            ItemValue::Param(found) => match (found.get("value"), found.len()) {
                (Some(component), 1) => Some(component.law.clone()),
                _ => {
                    let got = found.keys().map(|k| format!("\"{k}\"")).collect::<Vec<_>>();
                    let expected = "expected a parameter with the component \"value\" alone";
                    self.log.problem(&item.path, format!("{expected}, got {}", got.join(", ")));
                    None
                }
            },
            ItemValue::Bool(_) | ItemValue::Text => {
                self.wrong(item, "a number");
                None
            }
        }
    }

    /// Notes an item, if it is there, as one that changes nothing.
    pub(super) fn left_out(&mut self, name: &'static str, why: &str) {
        if let Some(item) = self.take(name) {
            self.log.note(&item.path, why);
        }
    }

    /// The three parts of a colour that make light; alpha is noted where it is not 1.
    pub(super) fn color(
        &mut self,
        name: &'static str,
        [a, b, c]: [&'static str; 3],
        ours: &'static str,
    ) -> [Option<Law>; 3] {
        let path = self.items.get(name).map(|item| item.path.clone());
        let [a, b, c, alpha] = self.laws(name, [a, b, c, "alpha"], ours);
        let opaque = alpha.is_none_or(|law| law == Law::Constant(1.0));
        if let Some(path) = path.filter(|_| !opaque) {
            self.log.note(&path, "alpha is left out: nothing here is seen through");
        }
        [a, b, c]
    }

    /// A note on the randomizer as a whole.
    pub(super) fn note(&mut self, message: impl Into<String>) {
        self.log.note(&self.path, message);
    }

    /// A problem of one of its items.
    pub(super) fn problem(&mut self, name: &str, message: impl Into<String>) {
        self.log.problem(&format!("{}.items.{name}", self.path), message);
    }

    /// Notes all items that nobody asked for.
    pub(super) fn finish(self) {
        for (name, item) in self.items {
            let what = format!("field of {}", self.id);
            self.log.unknown(&item.path, &what, &name, self.asked.iter().copied());
        }
    }
}
