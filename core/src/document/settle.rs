//! Documents that need no other files: what they name is read and put in its place.
//!
//! People come from files of the cast, numbers from tables. What follows, the copy beside a data set
//! included, knows nothing of files. Names start at the config's folder or at one of `assets`.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use super::file::{self, Loaded, MAX_BYTES, Problems};
use super::{Distribution, Document, Empirical, Problem, cast, measured, params, validate};
use crate::base::hash::content_hash;

/// A file that something was read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// As the config names it.
    pub name: String,
    /// What it holds.
    pub kind: SourceKind,
    /// BLAKE3 hash of its content, 64 hexadecimal digits.
    pub content_hash: String,
}

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// People.
    People,
    /// Numbers that were measured.
    Numbers,
}

/// A document with everything in it, and the files that some of it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The document.
    pub document: Document,
    /// Each file once: those of people, then those of numbers, in the order of the document.
    pub sources: Vec<Source>,
}

/// Reads the files that a document names.
///
/// # Errors
/// When a file is missing, cannot be read or does not hold what it should, and when the document
/// makes no sense with what they hold. Each problem names the field and the file.
pub fn read_all(loaded: Loaded) -> Result<Settled, Problems> {
    let folders: Vec<PathBuf> =
        std::iter::once(loaded.folder.clone()).chain(loaded.asset_folders()).collect();
    let mut files = Files { folders, sources: Vec::new() };
    let mut document = loaded.document;
    let mut problems = cast::file::fill(&mut document.people.cast, &mut files);
    document = tables(document, &mut files, &mut problems);
    if problems.is_empty() {
        problems = validate(&document);
    }
    let sources = files.sources;
    if problems.is_empty() { Ok(Settled { document, sources }) } else { Err(Problems(problems)) }
}

/// Where files are looked for, and those that were found.
pub(super) struct Files {
    pub(super) folders: Vec<PathBuf>,
    pub(super) sources: Vec<Source>,
}

impl Files {
    /// A file that exists, by the name that the config has for it.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, String> {
        let candidates: Vec<PathBuf> = self.folders.iter().map(|f| f.join(name)).collect();
        candidates.iter().find(|path| path.exists()).cloned().ok_or_else(|| {
            let tried: Vec<String> = candidates.iter().map(|p| p.display().to_string()).collect();
            format!(
                "there is no such file ({}); a path starts at the config's folder or at a folder of \
                 `assets`",
                tried.join(", ")
            )
        })
    }

    /// Keeps a file that was read.
    pub(super) fn add(&mut self, name: &str, kind: SourceKind, content_hash: String) {
        if self.sources.iter().all(|s| (s.name.as_str(), s.kind) != (name, kind)) {
            self.sources.push(Source { name: name.to_owned(), kind, content_hash });
        }
    }
}

/// The bytes of a file that was found. `expected` says what it should be, `otherwise` what to do if
/// it is too large.
pub(super) fn bytes(path: &Path, expected: &str, otherwise: &str) -> Result<Vec<u8>, String> {
    if path.is_dir() {
        return Err(format!("is a folder; expected {expected}"));
    }
    match file::read(path) {
        Ok(Some(bytes)) => Ok(bytes),
        Ok(None) => Err(format!("has more than {MAX_BYTES} bytes; {otherwise}")),
        Err(e) => Err(format!("cannot be read: {e}")),
    }
}

/// The document with every table that it names in it.
fn tables(document: Document, files: &mut Files, problems: &mut Vec<Problem>) -> Document {
    let named = |law: &Distribution| matches!(law, Distribution::Empirical(_));
    if !params(&document).values().any(|p| p.laws("").iter().any(|(_, law)| named(law))) {
        return document;
    }
    // Parameters stand everywhere in a document; as JSON they all look alike.
    let mut value = serde_json::to_value(&document).expect("a document has only text keys");
    fill(&mut value, "", files, problems);
    serde_json::from_value(value).unwrap_or_else(|e| {
        problems.push(Problem::new("", format!("cannot hold what its files hold: {e}")));
        document
    })
}

/// Puts laws in the place of the tables that a value names.
fn fill(value: &mut Value, path: &str, files: &mut Files, problems: &mut Vec<Problem>) {
    match value {
        Value::Object(map) => {
            let named = map.get("empirical").filter(|_| map.len() == 1);
            if let Some(empirical) = named.and_then(|v| Empirical::deserialize(v).ok()) {
                match read(&empirical, files) {
                    Ok(law) => *value = law,
                    Err(what) => problems.push(Problem::new(format!("{path}.empirical"), what)),
                }
                return;
            }
            for (name, inner) in map {
                let dot = if path.is_empty() { "" } else { "." };
                fill(inner, &format!("{path}{dot}{name}"), files, problems);
            }
        }
        Value::Array(items) => {
            for (i, item) in items.iter_mut().enumerate() {
                fill(item, &format!("{path}[{i}]"), files, problems);
            }
        }
        _ => {}
    }
}

/// The law in a table, as it stands in a document.
fn read(empirical: &Empirical, files: &mut Files) -> Result<Value, String> {
    let name = &empirical.file;
    let path = files.find(name)?;
    let in_file = |what: String| format!("{}: {what}", path.display());
    let bytes = bytes(&path, "a table such as ages.csv", "write a histogram instead");
    let bytes = bytes.map_err(in_file)?;
    let law = measured::law(empirical, &bytes).map_err(in_file)?;
    files.add(name, SourceKind::Numbers, content_hash(&bytes));
    Ok(serde_json::to_value(law).expect("a law has only text keys"))
}

#[cfg(test)]
pub(in crate::document) mod tests {
    use std::fs;

    use super::*;
    use crate::document::Param;

    /// A folder with a config whose people's ages are a law, and files beside it; what loading it
    /// says.
    fn load(age: &str, files: &[(&str, &str)]) -> Result<Settled, Problems> {
        load_people(&format!(r#""body": {{"age_years": {age}}}"#), files)
    }

    /// The same with fields of `people`.
    pub fn load_people(fields: &str, files: &[(&str, &str)]) -> Result<Settled, Problems> {
        let dir = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = dir.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let config = dir.path().join("config.json");
        let text = format!(r#"{{"version": 1, "assets": ["more"], "people": {{{fields}}}}}"#);
        fs::write(&config, text).unwrap();
        read_all(file::load(&config).unwrap())
    }

    #[test]
    fn tables_are_found_and_stand_in_the_document() {
        let table = "age\n30\n20\n30\n";
        let age = r#"{"mix": [[1, {"empirical": {"file": "ages.csv", "column": "age"}}], [1, 7]]}"#;
        let Settled { document, sources } = load(age, &[("more/ages.csv", table)]).unwrap();
        let expected = r#"{"mix": [[1, {"choice": [[20, 1], [30, 2]]}], [1, 7]]}"#;
        let expected: Param = serde_json::from_str(expected).unwrap();
        assert_eq!(document.people.body.age_years, expected);
        let mut rest = document.clone();
        rest.people.body.age_years = Document::default().people.body.age_years;
        rest.assets.folders.clear();
        assert_eq!(rest, Document::default());
        let [source] = sources.as_slice() else { panic!("{sources:?}") };
        assert_eq!((source.name.as_str(), source.kind), ("ages.csv", SourceKind::Numbers));
        assert_eq!(source.content_hash, content_hash(table.as_bytes()));
        // What is written beside a data set needs no other file.
        assert_eq!(file::parse(&file::text(&document)).unwrap(), document);
    }

    #[test]
    fn tables_that_do_not_serve_are_refused_by_field_and_file() {
        let age = r#"{"empirical": {"file": "ages.csv", "column": "age"}}"#;
        let of = |files: &[(&str, &str)]| load(age, files).unwrap_err().to_string();
        let at = "people.body.age_years.empirical: ";
        let missing = of(&[]);
        assert!(missing.starts_with(&format!("{at}there is no such file (")), "{missing}");
        assert!(missing.contains("more/ages.csv"), "{missing}");
        let folder = of(&[("ages.csv/x", "")]);
        assert!(folder.contains("ages.csv: is a folder; expected a table"), "{folder}");
        let word = of(&[("ages.csv", "age\n30\nold\n")]);
        assert!(word.starts_with(at), "{word}");
        assert!(word.ends_with("ages.csv: line 3, column \"age\": expected a number, got \"old\""));
        // What the field may be shows only now.
        let range = of(&[("ages.csv", "age\n30\n130\n")]);
        assert!(range.starts_with("people.body.age_years: must be <= 90, but values"), "{range}");
    }
}
