//! Making room for a data set without harming what is somebody else's.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::layout::{FrameFile, Layout};
use super::{ExportError, atomic};

/// What to do with a folder that is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// Leave it alone and fail.
    Refuse,
    /// Replace the data set in it and keep all other files.
    Overwrite,
}

/// Makes the folder, or checks that it may be written to. Removes nothing yet.
///
/// # Errors
/// When the path is a file, cannot be made, is not empty and may not be overwritten, or holds files
/// under our names that may not be ours.
pub(super) fn prepare(layout: &Layout, existing: Existing) -> Result<(), ExportError> {
    let root = layout.root();
    match fs::metadata(root) {
        Err(e) if e.kind() == ErrorKind::NotFound => {
            return fs::create_dir_all(root).map_err(ExportError::io(root, "create the folder"));
        }
        Err(e) => return Err(ExportError::io(root, "look at the folder")(e)),
        Ok(meta) if !meta.is_dir() => return Err(ExportError::NotAFolder(root.to_owned())),
        Ok(_) => {}
    }
    let mut entries = fs::read_dir(root).map_err(ExportError::io(root, "list the folder"))?;
    if entries.next().is_none() {
        return Ok(());
    }
    if existing == Existing::Refuse {
        return Err(ExportError::NotEmpty(root.to_owned()));
    }
    let ours = is_our_manifest(&layout.manifest());
    match own_files(layout)?.into_iter().next() {
        Some(path) if !ours => Err(ExportError::NotOurs(path)),
        _ => Ok(()),
    }
}

/// Removes the files of an earlier data set, but for the manifest, and its folders where they are
/// empty then.
///
/// # Errors
/// When a file cannot be removed.
pub(super) fn clear(layout: &Layout) -> Result<(), ExportError> {
    for path in own_files(layout)? {
        if path != layout.manifest() {
            fs::remove_file(&path).map_err(ExportError::io(&path, "remove the old file"))?;
        }
    }
    for folder in Layout::FOLDERS {
        // Fails where somebody keeps files of his own in it, or where there is none.
        drop(fs::remove_dir(layout.root().join(folder)));
    }
    Ok(())
}

/// Whether a file is a manifest that this program wrote.
fn is_our_manifest(path: &Path) -> bool {
    let value =
        fs::read(path).ok().and_then(|b| serde_json::from_slice::<serde_json::Value>(&b).ok());
    value.is_some_and(|v| v["program"] == "figurant")
}

/// Every file in the folder that has the name of one of a data set's, in a fixed order.
fn own_files(layout: &Layout) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = Vec::new();
    for name in Layout::SINGLE_FILES {
        let path = layout.root().join(name);
        let unfinished =
            path.file_name().map(|n| path.with_file_name(format!(".{}.tmp", n.to_string_lossy())));
        files.extend([Some(path), unfinished].into_iter().flatten().filter(|p| p.is_file()));
    }
    for kind in FrameFile::ALL {
        let folder = layout.root().join(kind.folder());
        let entries = match fs::read_dir(&folder) {
            Err(e) if e.kind() == ErrorKind::NotFound => continue,
            entries => entries.map_err(ExportError::io(&folder, "list the folder"))?,
        };
        for entry in entries {
            let entry = entry.map_err(ExportError::io(&folder, "list the folder"))?;
            let path = entry.path();
            if entry.file_name().to_str().is_some_and(|n| kind.owns(n)) && path.is_file() {
                files.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Waits until the names of all files of a data set are on the disk.
///
/// # Errors
/// When the disk fails.
pub(super) fn sync(layout: &Layout) -> Result<(), ExportError> {
    let folders = Layout::FOLDERS.iter().map(|f| layout.root().join(f));
    for folder in folders.chain([layout.root().to_owned()]).filter(|f| f.is_dir()) {
        atomic::sync_folder(&folder)?;
    }
    Ok(())
}
