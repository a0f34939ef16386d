//! Scenario files of PeopleSansPeople (Ebadi et al. 2021) and Unity Perception 0.9 to 1.0 as
//! documents.
//!
//! Text in, a [`Document`] out, with [`Note`]s on all that was left out or changed: nothing is
//! skipped silently. What a scenario does not say is as in PeopleSansPeople, whose values are the
//! defaults of a document. `scenario.rs` and `sampler.rs` know the form of the file,
//! `table.rs` what its randomizers mean.

use std::path::{Path, PathBuf};

use serde_json::Value;
use serde_json::error::Category;

use super::file::{self, MAX_BYTES};
use super::{Document, validate};
use crate::document::file::Problems;
use fields::Fields;
use log::Log;
use scenario::{Constant, Group, Scenario};
use table::{RANDOMIZERS, Randomizer};
use unique::Unique;

mod camera;
mod fields;
mod law;
mod light;
mod log;
mod place;
mod sampler;
mod scenario;
mod table;
#[cfg(test)]
mod tests;
mod unique;

pub use log::Note;

/// A scenario as a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The document; it makes sense.
    pub document: Document,
    /// What was left out or changed.
    pub notes: Vec<Note>,
}

/// Why a scenario cannot be imported.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file system refused.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// Where.
        path: PathBuf,
        /// What it said.
        source: std::io::Error,
    },
    /// A folder where a file was expected.
    #[error("{} is a folder; expected a file such as scenarioConfiguration.json", .0.display())]
    Folder(PathBuf),
    /// Not a scenario, by its size.
    #[error("a scenario has at most {MAX_BYTES} bytes; this is larger")]
    TooLarge,
    /// The text is not JSON.
    #[error("{0}")]
    NotJson(String),
    /// JSON, but something else.
    #[error("{0}")]
    NotAScenario(&'static str),
    /// Values in it are wrong. Paths are those of the scenario's file.
    #[error("{0}")]
    Invalid(Problems),
}

/// The document of a scenario's file, with the file's name without its ending.
///
/// # Errors
/// As [`scenario`](fn@scenario), and when the file cannot be read.
pub fn load(path: &Path) -> Result<Imported, ImportError> {
    let io = |source| ImportError::Io { path: path.to_owned(), source };
    if std::fs::metadata(path).map_err(io)?.is_dir() {
        return Err(ImportError::Folder(path.to_owned()));
    }
    let bytes = file::read(path).map_err(io)?.ok_or(ImportError::TooLarge)?;
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        ImportError::NotJson(format!("not UTF-8 text (byte {at}); expected JSON"))
    })?;
    let mut imported = scenario(&text)?;
    if let Some(stem) = path.file_stem() {
        imported.document.name = stem.to_string_lossy().into_owned();
    }
    Ok(imported)
}

/// The document of a scenario's text. It has no name.
///
/// # Errors
/// When the text is no scenario, a value in it has the wrong form, or the document would make no
/// sense; with the path of each such value in the scenario.
pub fn scenario(text: &str) -> Result<Imported, ImportError> {
    onto(Document::default(), text)
}

/// The same with what the scenario does not say taken from another document.
fn onto(mut document: Document, text: &str) -> Result<Imported, ImportError> {
    let root = parse(text)?;
    let mut log = Log::default();
    let scenario = scenario::read(&root, is_known, &mut log);
    constants(&scenario, &mut document, &mut log);
    randomizers(&scenario.groups, &mut document, &mut log);
    if log.problems.is_empty() {
        log.problems = validate(&document).into_iter().map(|p| log.traced(p)).collect();
        // One wrong value may spoil several fields.
        log.problems.dedup_by(|a, b| a.path == b.path);
    }
    if log.problems.is_empty() {
        Ok(Imported { document, notes: log.notes })
    } else {
        Err(ImportError::Invalid(Problems(log.problems)))
    }
}

fn parse(text: &str) -> Result<serde_json::Map<String, Value>, ImportError> {
    if text.len() as u64 > MAX_BYTES {
        return Err(ImportError::TooLarge);
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() {
        return Err(ImportError::NotJson("empty; expected a scenario as JSON".to_owned()));
    }
    let Unique(value) = serde_json::from_str(text).map_err(|e| {
        let what = match e.classify() {
            Category::Eof => "the text ends too early",
            Category::Data => "not a scenario",
            Category::Syntax | Category::Io => "not valid JSON",
        };
        ImportError::NotJson(format!("{what}: {e}"))
    })?;
    match value {
        Value::Object(map) if map.contains_key("randomizers") || map.contains_key("constants") => {
            Ok(map)
        }
        Value::Object(map) if map.contains_key("version") => Err(ImportError::NotAScenario(
            "this is a config already, not a scenario of Unity Perception; use it as it is",
        )),
        _ => Err(ImportError::NotAScenario(
            "expected a JSON object with \"constants\" and \"randomizers\", as Unity Perception \
             writes it by \"Generate JSON Config\"",
        )),
    }
}

fn constants(scenario: &Scenario, document: &mut Document, log: &mut Log) {
    let get = |name: &str| scenario.constants.get(name);
    if let Some(seed) = get("randomSeed") {
        document.seed = seed.value;
    }
    let start = get("startIteration");
    let first = start.map_or(0, |s| s.value);
    let (count, total) = (get("iterationCount"), get("totalIterations"));
    if let (Some(_), Some(total)) = (count, total) {
        log.note(&total.path, "is left out: iterationCount stands beside it");
    }
    if let Some(Constant { path, value }) = count.or(total) {
        log.origin("frames", path);
        match u32::try_from(value.saturating_add(first)) {
            Ok(frames) => document.frames = frames,
            Err(_) => log.problem(path, format!("must be at most {}, got {value}", u32::MAX)),
        }
    }
    if let Some(start) = start.filter(|s| s.value > 0) {
        let frames = document.frames;
        let how = format!("frames before it exist here; export with --frames {first}..{frames}");
        log.note(&start.path, how);
    }
    if let Some(per) = get("framesPerIteration").filter(|c| c.value != 1) {
        let why = "an iteration becomes one frame here: nothing changes within one";
        log.note(&per.path, format!("{} is left out: {why}", per.value));
    }
    for name in ["instanceCount", "instanceIndex"] {
        let usual = u64::from(name == "instanceCount");
        if let Some(part) = get(name).filter(|c| c.value != usual) {
            let why = "share the work between machines by export --frames A..B";
            log.note(&part.path, format!("{} is left out: {why}", part.value));
        }
    }
}

fn is_known(id: &str) -> bool {
    RANDOMIZERS.iter().any(|r| r.id == id)
}

/// Applies the randomizers in the order in which PeopleSansPeople runs them, whatever that of the
/// file: so does the program itself.
fn randomizers(groups: &[Group], document: &mut Document, log: &mut Log) {
    for randomizer in &RANDOMIZERS {
        if let Some(group) = groups.iter().find(|g| g.id == randomizer.id) {
            apply(randomizer, group, document, log);
        }
    }
    for group in groups {
        if !is_known(&group.id) {
            let known = RANDOMIZERS.iter().map(|r| r.id);
            log.unknown(&group.path, "randomizer", &group.id, known);
        }
    }
    let missing: Vec<&str> = RANDOMIZERS
        .iter()
        .filter(|r| r.of_seed && groups.iter().all(|g| g.id != r.id))
        .map(|r| r.id)
        .collect();
    if !missing.is_empty() {
        let what = format!(
            "these of PeopleSansPeople are not in the file, and their fields keep its values: {}",
            missing.join(", ")
        );
        log.note("randomizers", what);
    }
}

fn apply(randomizer: &Randomizer, group: &Group, document: &mut Document, log: &mut Log) {
    if !group.enabled {
        (randomizer.off)(document);
        if !randomizer.when_off.is_empty() {
            log.note(&group.path, format!("{} is off: {}", group.id, randomizer.when_off));
        }
        return;
    }
    let mut fields = Fields::new(group, log);
    (randomizer.on)(&mut fields, document);
    fields.finish();
}
