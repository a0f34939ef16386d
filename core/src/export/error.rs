//! What can go wrong while files are written.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A file or folder that could not be written, or labels that contradict each other.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The operating system refused.
    #[error("{}: cannot {action}: {source}{}", path.display(), advice(source))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was tried, as a verb with its object.
        action: &'static str,
        /// Why not.
        source: io::Error,
    },
    /// A data set may only be written into an empty folder.
    #[error(
        "{}: the folder is not empty; choose another one, or give --overwrite to replace the \
         data set in it (files that are not part of it are kept)",
        .0.display()
    )]
    NotEmpty(PathBuf),
    /// Overwriting would destroy something that Figurant did not write.
    #[error(
        "{}: is in the way and may not be one of Figurant's files, since the folder has no \
         manifest.json of Figurant; move it or choose another folder",
        .0.display()
    )]
    NotOurs(PathBuf),
    /// The path of the data set is a file.
    #[error("{}: is a file, expected a folder; choose another path", .0.display())]
    NotAFolder(PathBuf),
    /// An encoder refused.
    #[error("the {what} of {width} x {height} pixels cannot be encoded: {reason}")]
    Encode {
        /// Which picture.
        what: &'static str,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// The encoder's words.
        reason: String,
    },
    /// The labels of a frame do not agree with each other, so none of them are written.
    #[error(
        "frame {frame}: {what}; nothing of the frame is written, since its labels are not sound"
    )]
    Unsound {
        /// Frame number.
        frame: u32,
        /// The contradiction.
        what: String,
    },
}

impl ExportError {
    /// An error of the operating system on a path.
    pub(super) fn io(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { path, action, source }
    }

    /// Whether the place that is written to is at fault, so that other frames will fail as well.
    #[must_use]
    pub const fn is_storage(&self) -> bool {
        matches!(self, Self::Io { .. } | Self::NotEmpty(_) | Self::NotOurs(_) | Self::NotAFolder(_))
    }
}

/// What a user can do about it.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "; free some space or choose another disk"
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you may write to"
        }
        ErrorKind::NotADirectory => "; a part of the path is a file",
        ErrorKind::NotFound => "; the folder does not exist",
        _ => "",
    }
}
