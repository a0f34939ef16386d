//! Reload: shaders read from a folder in place of the embedded ones, for those who work on them.
//!
//! Files are looked at before each frame. When one has changed, all shaders that it is part of are
//! checked, and only if every one is valid do engines take them, so that files which belong
//! together change together. Else the last good ones stay in use, and what is wrong is told once.
//! Files that the folder lacks are those of the program.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::{Debug, Display, Formatter, Result as FmtResult};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{ValidationFlags, Validator};

use super::stage::{CAPABILITIES, File, Stage};
use super::variant::Variant;

/// What is wrong with a shader of a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderProblem {
    /// The file, with its folder.
    pub file: PathBuf,
    /// Its line, from 1; absent where it is not known.
    pub line: Option<u32>,
    /// What the compiler says.
    pub message: String,
}

impl Display for ShaderProblem {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}; the last good shaders stay in use", self.message)
    }
}

/// What takes problems as they are found.
type Tell = dyn Fn(&ShaderProblem) + Send + Sync;

/// A folder laid out as that of the program's shaders. Engines that share one take its files as
/// soon as they have changed and are valid.
#[derive(Clone)]
pub struct ShaderFolder(Arc<Shared>);

struct Shared {
    path: PathBuf,
    tell: Box<Tell>,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// When each file was last written and how long it was, as of the last look.
    stamps: Option<Vec<Stamp>>,
    good: Arc<Sources>,
    /// How often `good` was replaced.
    generation: u64,
    /// What devices refused of the files as they are, so that it is told once for all engines.
    refused: Vec<ShaderProblem>,
}

type Stamp = Option<(SystemTime, u64)>;

impl ShaderFolder {
    /// A folder, and who is told of each problem in it, once; that must not ask the folder.
    #[must_use]
    pub fn new(path: PathBuf, tell: impl Fn(&ShaderProblem) + Send + Sync + 'static) -> Self {
        Self(Arc::new(Shared { path, tell: Box::new(tell), state: Mutex::default() }))
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0.path
    }

    /// Looks at the folder; how often its shaders have changed, and were valid, since it was made.
    #[must_use]
    pub fn generation(&self) -> u64 {
        self.look().generation
    }

    /// The last good texts, after a look at the folder.
    pub(super) fn sources(&self) -> Arc<Sources> {
        Arc::clone(&self.look().good)
    }

    /// Reads the folder if a file in it has changed.
    fn look(&self) -> MutexGuard<'_, State> {
        let mut state = self.0.state.lock().unwrap_or_else(PoisonError::into_inner);
        let stamps: Vec<Stamp> = files().map(|(name, _)| stamp(&self.path().join(name))).collect();
        if state.stamps.as_ref() != Some(&stamps) {
            // Before they are read: a file that is written meanwhile is read again.
            state.stamps = Some(stamps);
            state.refused.clear();
            match self.read(&state.good) {
                Ok(sources) => {
                    state.good = Arc::new(sources);
                    state.generation += 1;
                }
                Err(problem) => (self.0.tell)(&problem),
            }
        }
        state
    }

    /// Reads all files; an error if a shader that they change is not valid.
    fn read(&self, good: &Sources) -> Result<Sources, ShaderProblem> {
        let mut changed = BTreeMap::new();
        let mut found = false;
        for (name, embedded) in files() {
            let path = self.path().join(name);
            match std::fs::read_to_string(&path) {
                Ok(text) => {
                    found = true;
                    if text != embedded {
                        changed.insert(name, text);
                    }
                }
                Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
                Err(e) => {
                    let message = format!("cannot be read: {e}");
                    return Err(ShaderProblem { file: path, line: None, message });
                }
            }
        }
        if !found {
            let message = "holds none of the program's shaders".to_owned();
            return Err(ShaderProblem { file: self.path().to_owned(), line: None, message });
        }
        let sources = Sources { changed };
        for (stage, variant) in variants() {
            if stage.source(variant, &sources) != stage.source(variant, good) {
                self.check(stage, variant, &sources)?;
            }
        }
        Ok(sources)
    }

    /// Checks a shader without a device.
    fn check(
        &self,
        stage: Stage,
        variant: Variant,
        sources: &Sources,
    ) -> Result<(), ShaderProblem> {
        let source = stage.source(variant, sources);
        let problem = |line: Option<u32>, message: String| {
            let place = line.and_then(|line| stage.place(variant, sources, line));
            let (name, line) = place.map_or((stage.name_of_file(), None), |(n, l)| (n, Some(l)));
            ShaderProblem { file: self.path().join(name), line, message }
        };
        let module = wgsl::parse_str(&source).map_err(|e| {
            let line = e.location(&source).map(|l| l.line_number);
            problem(
                line,
                std::iter::once(e.message()).chain(e.notes()).collect::<Vec<_>>().join("; "),
            )
        })?;
        Validator::new(ValidationFlags::all(), CAPABILITIES).validate(&module).map(drop).map_err(
            |e| {
                let line = e.location(&source).map(|l| l.line_number);
                problem(line, chain(e.as_inner()))
            },
        )
    }

    /// Tells that a device does not take a shader which is valid in itself.
    pub(super) fn refused(&self, stage: Stage, message: &str) {
        let file = self.path().join(stage.name_of_file());
        // Drivers write over several lines.
        let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
        let problem = ShaderProblem { file, line: None, message };
        let mut state = self.0.state.lock().unwrap_or_else(PoisonError::into_inner);
        if !state.refused.contains(&problem) {
            (self.0.tell)(&problem);
            state.refused.push(problem);
        }
    }
}

impl Debug for ShaderFolder {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        f.debug_tuple("ShaderFolder").field(&self.0.path).finish()
    }
}

impl PartialEq for ShaderFolder {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for ShaderFolder {}

/// Texts of all files: the program's own, but for those that a folder has otherwise.
#[derive(Debug, Default)]
pub struct Sources {
    changed: BTreeMap<&'static str, String>,
}

impl Sources {
    /// The text of a file.
    pub fn text(&self, (name, embedded): File) -> &str {
        self.changed.get(name).map_or(embedded, String::as_str)
    }

    /// Whether all texts are the program's own.
    pub fn are_own(&self) -> bool {
        self.changed.is_empty()
    }
}

/// All files, some more than once.
fn files() -> impl Iterator<Item = File> {
    Stage::ALL.into_iter().flat_map(|s| s.files().iter().copied())
}

/// All shaders in all their variants.
fn variants() -> impl Iterator<Item = (Stage, Variant)> {
    Stage::ALL.into_iter().flat_map(|stage| Variant::all(stage).map(move |v| (stage, v)))
}

fn stamp(path: &Path) -> Stamp {
    let known = std::fs::metadata(path).ok()?;
    Some((known.modified().ok()?, known.len()))
}

/// An error with what caused it.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Receiver, channel};

    fn some(stage: Stage) -> Variant {
        Variant::all(stage).last().unwrap()
    }

    /// A folder with every file of the program, and what is told of it.
    fn folder() -> (tempfile::TempDir, ShaderFolder, Receiver<ShaderProblem>) {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir(dir.path().join("shared")).unwrap();
        for (name, text) in files() {
            std::fs::write(dir.path().join(name), text).unwrap();
        }
        let (sender, told) = channel();
        let folder = ShaderFolder::new(dir.path().to_owned(), move |p| {
            sender.send(p.clone()).unwrap();
        });
        (dir, folder, told)
    }

    fn text(folder: &ShaderFolder, name: &str) -> String {
        std::fs::read_to_string(folder.path().join(name)).unwrap()
    }

    fn write(folder: &ShaderFolder, name: &str, text: &str) {
        std::fs::write(folder.path().join(name), text).unwrap();
    }

    #[test]
    fn files_are_taken_when_they_are_valid() {
        let (_dir, folder, told) = folder();
        assert!(folder.sources().are_own());
        let good = format!("// Another.\n{}", text(&folder, "shared/edge.wgsl"));
        write(&folder, "shared/edge.wgsl", &good);
        let taken = folder.sources();
        assert!(!taken.are_own());
        assert!(Stage::Raster.source(some(Stage::Raster), &taken).contains("// Another."));
        assert!(Arc::ptr_eq(&taken, &folder.sources()), "nothing has changed since");
        std::fs::remove_file(folder.path().join("shared/edge.wgsl")).unwrap();
        assert!(folder.sources().are_own(), "what is not there is the program's own");
        assert_eq!(told.try_iter().count(), 0);
    }

    #[test]
    fn what_is_wrong_is_told_once_with_its_place() {
        let (_dir, folder, told) = folder();
        let good = folder.sources();
        let own = text(&folder, "shared/edge.wgsl");
        let lines = own.lines().count() as u32;
        // Does not parse; parses and is not valid.
        let wrong = [
            ("let = 3;", lines + 1),
            ("fn wrong() -> f32 {\n    return nothing_of_that_name;\n}", lines + 2),
            ("fn wrong() -> f32 {\n    let a = 1;\n}", lines + 1),
        ];
        for (more, line) in wrong {
            write(&folder, "shared/edge.wgsl", &format!("{own}{more}\n"));
            assert!(Arc::ptr_eq(&good, &folder.sources()), "{more}");
            assert!(Arc::ptr_eq(&good, &folder.sources()), "{more}");
            let problems: Vec<_> = told.try_iter().collect();
            assert_eq!(problems.len(), 1, "{more}: {problems:?}");
            assert_eq!(problems[0].file, folder.path().join("shared/edge.wgsl"), "{more}");
            assert_eq!(problems[0].line, Some(line), "{more}: {}", problems[0]);
            assert!(!problems[0].message.is_empty());
        }
        write(&folder, "shared/edge.wgsl", &own);
        assert!(folder.sources().are_own());
    }

    #[test]
    fn a_folder_without_shaders_is_told() {
        let (sender, told) = channel();
        let folder = ShaderFolder::new("/nowhere/at/all".into(), move |p| {
            sender.send(p.to_string()).unwrap();
        });
        assert!(folder.sources().are_own() && folder.sources().are_own());
        let told: Vec<_> = told.try_iter().collect();
        assert_eq!(told.len(), 1);
        assert!(told[0].starts_with("/nowhere/at/all: holds none"), "{}", told[0]);
    }
}
