//! What there is to say about a scenario while it is read.

use crate::document::{Problem, nearest};

/// Something in a scenario that was left out or changed, and why. The rest was imported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Where in the scenario's file, as in `randomizers.randomizerGroups[3].items.scale`.
    pub path: String,
    /// What became of it, and why.
    pub message: String,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.path, self.message)
    }
}

/// Collects notes and problems, and which field of the scenario each field of the config is from.
#[derive(Default)]
pub(super) struct Log {
    pub(super) notes: Vec<Note>,
    pub(super) problems: Vec<Problem>,
    origins: Vec<(&'static str, String)>,
}

impl Log {
    pub(super) fn note(&mut self, path: &str, message: impl Into<String>) {
        self.notes.push(Note { path: path.to_owned(), message: message.into() });
    }

    pub(super) fn problem(&mut self, path: &str, message: impl Into<String>) {
        self.problems.push(Problem::new(path, message));
    }

    /// Notes a name that nothing is known about.
    pub(super) fn unknown<'a>(
        &mut self,
        path: &str,
        what: &str,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) {
        let guess = nearest(name, known).map(|word| format!("; did you mean `{word}`?"));
        let guess = guess.unwrap_or_default();
        self.note(path, format!("unknown {what} `{name}` is left out{guess}"));
    }

    /// Remembers that a field of the config, with all below it, came from a place in the scenario.
    pub(super) fn origin(&mut self, ours: &'static str, theirs: &str) {
        self.origins.push((ours, theirs.to_owned()));
    }

    /// A problem of the config as one of the scenario.
    pub(super) fn traced(&self, problem: Problem) -> Problem {
        // All lamps get the same laws, which are remembered as those of the moving one.
        let lamp = problem.path.strip_prefix("lights.points[").and_then(|r| r.split_once(']'));
        let path = match lamp {
            Some((_, field)) => format!("lights.moving{field}"),
            None => problem.path.clone(),
        };
        let of_field = |ours: &str| {
            let rest = path.strip_prefix(ours);
            rest.is_some_and(|r| r.is_empty() || r.starts_with(['.', '[']))
        };
        // The last one: what is written later stands.
        let origin = self.origins.iter().rev().find(|(ours, _)| of_field(ours));
        match origin {
            Some((_, theirs)) => Problem {
                path: theirs.clone(),
                message: format!("does not fit: {} {}", problem.path, problem.message),
                suggestion: problem.suggestion,
            },
            None => problem,
        }
    }
}
