//! One file for each command: arguments in, streams and an exit status out.

use std::num::NonZeroUsize;
use std::path::Path;

use crate::args::Changes;
use crate::road::{LoadError, Wishes};
use crate::{Exit, Failure};

pub mod bench;
pub mod doctor;
pub mod export;
pub mod frame;
pub mod gallery;
pub mod import;
pub mod people;
pub mod schema;
pub mod validate;
pub mod window;

impl From<&Changes> for Wishes {
    fn from(changes: &Changes) -> Self {
        Self {
            seed: changes.seed,
            size: changes.size,
            engine: changes.engine(),
            simd: changes.simd,
            outputs: None,
        }
    }
}

/// A config that cannot be used, as the commands report it.
fn not_loaded(config: &Path, error: LoadError) -> Failure {
    match error {
        LoadError::Unreadable(text) => Failure::input(text),
        LoadError::NoEngine(text) => Failure::new(Exit::NoEngine, text),
        LoadError::Invalid(problems) => Failure::input(listed(config, &problems)),
    }
}

/// The problems of a config, one a line.
fn listed(config: &Path, problems: &[String]) -> String {
    let (config, n) = (config.display(), problems.len());
    let lines = problems.iter().map(|p| format!("\n  {p}")).collect::<String>();
    let noun = if n == 1 { "problem" } else { "problems" };
    format!("{config}: {n} {noun} in the config:{lines}")
}

/// How many threads the program may run at once.
pub fn processors() -> NonZeroUsize {
    std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}
