//! Documents as files: load, save and migrate.
//!
//! Text in, a checked [`Document`] out, and back. The folder of the file is kept beside it, because
//! the document's asset folders may be relative to it.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde_json::Value;

use super::{Document, Problem, VERSION, check, format, schema, validate};

/// Larger files are refused unread.
pub const MAX_BYTES: u64 = 16 << 20;

/// A document from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The document.
    pub document: Document,
    /// The folder of its file, where its relative asset folders start.
    pub folder: PathBuf,
}

impl Loaded {
    /// The document's asset folders, as paths from here.
    #[must_use]
    pub fn asset_folders(&self) -> Vec<PathBuf> {
        self.document.assets.folders.iter().map(|a| self.folder.join(a)).collect()
    }
}

/// Why a document could not be loaded or saved.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file system refused.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// What was tried.
        doing: &'static str,
        /// Where.
        path: PathBuf,
        /// What it said.
        source: std::io::Error,
    },
    /// A folder where a file was expected.
    #[error("{} is a folder; expected a config file such as starter.json", .0.display())]
    Folder(PathBuf),
    /// Not a config, by its size.
    #[error("{} has {bytes} bytes; a config has at most {MAX_BYTES}", path.display())]
    TooLarge {
        /// Where.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// The text is no valid config.
    #[error("{}: {problems}", path.display())]
    Invalid {
        /// Where.
        path: PathBuf,
        /// What is wrong with it.
        problems: Problems,
    },
}

/// At least one problem.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problems(pub Vec<Problem>);

impl std::fmt::Display for Problems {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0.as_slice() {
            [problem] => write!(f, "{problem}"),
            problems => {
                write!(f, "{} problems", problems.len())?;
                problems.iter().try_for_each(|p| write!(f, "\n  {p}"))
            }
        }
    }
}

/// Reads a config file, migrates it to this program's version and checks it.
///
/// # Errors
/// When the file cannot be read, is a folder or too large, or holds no valid config.
pub fn load(path: &Path) -> Result<Loaded, FileError> {
    let io = |source| FileError::Io { doing: "read", path: path.to_owned(), source };
    let invalid =
        |problems| FileError::Invalid { path: path.to_owned(), problems: Problems(problems) };
    if std::fs::metadata(path).map_err(io)?.is_dir() {
        return Err(FileError::Folder(path.to_owned()));
    }
    let Some(bytes) = read(path).map_err(io)? else {
        let bytes = std::fs::metadata(path).map_err(io)?.len().max(MAX_BYTES + 1);
        return Err(FileError::TooLarge { path: path.to_owned(), bytes });
    };
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        invalid(vec![Problem::new("", format!("not UTF-8 text (byte {at}); expected JSON"))])
    })?;
    let document = parse(&text).map_err(|Problems(problems)| invalid(problems))?;
    let folder = path.parent().map(Path::to_owned).unwrap_or_default();
    Ok(Loaded { document, folder })
}

/// The bytes of a file that people write by hand; `None` where it is larger than [`MAX_BYTES`], of
/// which no more is read than that.
///
/// # Errors
/// When the file system refuses.
pub fn read(path: &Path) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    // Read rather than trust the stated size: pipes and devices have none.
    std::fs::File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= MAX_BYTES).then_some(bytes))
}

/// A document from its text, migrated and checked.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse(text: &str) -> Result<Document, Problems> {
    static SCHEMA: LazyLock<Value> = LazyLock::new(schema);
    let one = |problem| Problems(vec![problem]);
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let not_json = |e: serde_json::Error| {
        let what = if text.trim().is_empty() {
            "empty; expected a JSON object".to_owned()
        } else if e.is_eof() {
            format!("the text ends too early, at line {}: {e}", e.line())
        } else {
            format!("not valid JSON: {e}")
        };
        one(Problem::new("", what))
    };
    let value: Value = serde_json::from_str(text).map_err(not_json)?;
    let migrated = migrate(value.clone()).map_err(one)?;
    let problems = check::check(&migrated, &SCHEMA);
    if !problems.is_empty() {
        return Err(Problems(problems));
    }
    // From the text where possible: it shows a field that is given twice, a value does not.
    let document: Document = if migrated == value {
        serde_json::from_str(text).map_err(|e| one(Problem::new("", e.to_string())))?
    } else {
        serde_json::from_value(migrated).map_err(|e| one(Problem::new("", e.to_string())))?
    };
    let problems = validate(&document);
    if problems.is_empty() { Ok(document) } else { Err(Problems(problems)) }
}

/// Steps from each older version to the next; the first one is from version 1.
const MIGRATIONS: [fn(Value) -> Value; VERSION as usize - 1] = [];

/// Brings a config of an older version up to this program's.
fn migrate(value: Value) -> Result<Value, Problem> {
    let at_version = |message: String| Problem::new("version", message);
    let Some(map) = value.as_object() else {
        return Err(Problem::new("", "expected a JSON object { } with the config's fields"));
    };
    if map.contains_key("randomizers") && map.contains_key("constants") {
        let what =
            "this is a Unity Perception scenario; turn it into a config with `figurant import`";
        return Err(Problem::new("", what));
    }
    let Some(version) = map.get("version") else {
        return Err(at_version(format!("missing; add \"version\": {VERSION}")));
    };
    let newest = u64::from(VERSION);
    match version.as_u64() {
        Some(v) if v > newest => Err(at_version(format!(
            "{v} was written by a newer Figurant; this one reads up to {VERSION}: update it"
        ))),
        Some(v) if v >= 1 => {
            Ok(MIGRATIONS.iter().skip(v as usize - 1).fold(value, |value, step| step(value)))
        }
        _ => Err(at_version(format!("expected a whole number from 1 to {VERSION}, got {version}"))),
    }
}

/// The text of a document, with every field.
#[must_use]
pub fn text(document: &Document) -> String {
    let compact = serde_json::to_string(document).expect("a document has only string keys");
    format::pretty(&compact)
}

/// Writes a document under a temporary name, syncs it and renames it: what stands there is always
/// a whole file.
///
/// # Errors
/// When the folder does not exist or cannot be written to.
pub fn save(document: &Document, path: &Path) -> Result<(), FileError> {
    let io = |source| FileError::Io { doing: "write", path: path.to_owned(), source };
    if path.is_dir() {
        return Err(FileError::Folder(path.to_owned()));
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    // Temporary files are private; a config is as readable as any other file of its owner.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(io)?;
    file.write_all(text(document).as_bytes()).map_err(io)?;
    file.as_file().sync_all().map_err(io)?;
    file.persist(path).map_err(|e| io(e.error))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        parse(text).unwrap_err().to_string()
    }

    #[test]
    fn a_saved_document_loads_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        let mut document = Document { name: "Zoë \"1\"".to_owned(), ..Document::default() };
        document.seed = u64::MAX;
        document.quality.lod_error_px = 0.1 + 0.2;
        document.assets.folders = vec!["textures".to_owned(), "/abs".to_owned()];
        save(&document, &path).unwrap();
        save(&document, &path).unwrap();
        let loaded = load(&path).unwrap();
        assert_eq!(loaded.document, document);
        let expected = [folder.path().join("textures"), PathBuf::from("/abs")];
        assert_eq!(loaded.asset_folders(), expected);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "temporary files left");
    }

    #[test]
    fn a_short_document_is_filled_with_defaults() {
        assert_eq!(parse(r#"{"version": 1}"#).unwrap(), Document::default());
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let missing = load(&folder.path().join("none.json")).unwrap_err();
        assert!(matches!(missing, FileError::Io { .. }), "{missing}");
        assert!(missing.to_string().contains("none.json"), "{missing}");
        assert!(matches!(load(folder.path()), Err(FileError::Folder(_))));
        assert!(matches!(save(&Document::default(), folder.path()), Err(FileError::Folder(_))));
        let nowhere = folder.path().join("no/such/folder.json");
        assert!(matches!(save(&Document::default(), &nowhere), Err(FileError::Io { .. })));

        let large = folder.path().join("large.json");
        std::fs::File::create(&large).unwrap().set_len(MAX_BYTES + 5).unwrap();
        let error = load(&large).unwrap_err();
        assert!(matches!(error, FileError::TooLarge { bytes, .. } if bytes == MAX_BYTES + 5));

        let binary = folder.path().join("binary.json");
        std::fs::write(&binary, [0x7b, 0xff, 0xd8]).unwrap();
        assert!(load(&binary).unwrap_err().to_string().contains("not UTF-8"));
    }

    #[test]
    fn what_is_no_config_says_why() {
        assert!(message("").contains("empty"));
        assert!(message("{\"version\": 1, \"name\": \"a").contains("ends too early"));
        assert!(message("version: 1").contains("not valid JSON"));
        assert!(message("[]").contains("expected a JSON object"));
        assert!(message("{\"version\": 1, \"frames\": 1e999}").contains("out of range"));
        assert!(message("{\"version\": 1, \"frames\": NaN}").contains("not valid JSON"));
        assert!(
            message("{\"version\": 1, \"name\": \"a\", \"name\": \"b\"}").contains("duplicate")
        );
        assert!(message("{\"constants\": {}, \"randomizers\": {}}").contains("figurant import"));
        let deep = "[".repeat(100_000);
        assert!(message(&deep).contains("recursion"));
    }

    #[test]
    fn other_versions_are_refused_clearly() {
        assert!(message("{}").starts_with("version: missing"));
        assert!(message("{\"version\": 2}").contains("newer Figurant"));
        for bad in ["0", "-1", "1.5", "\"1\"", "null"] {
            let text = format!("{{\"version\": {bad}}}");
            assert!(message(&text).starts_with("version: expected a whole number"), "{bad}");
        }
    }
}
