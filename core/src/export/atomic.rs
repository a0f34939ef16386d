//! Files that are there whole or not at all.
//!
//! Bytes go to a temporary name in the same folder (`.NAME.tmp`), are synced to the disk and then
//! renamed. Whoever reads the final name sees the old file or the new one, never a part.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::ExportError;

/// A file under its temporary name. Dropped before [`publish`](Self::publish), it is removed.
#[derive(Debug)]
pub struct Pending {
    file: Option<File>,
    temporary: PathBuf,
    target: PathBuf,
}

impl Pending {
    /// Writes the bytes under the temporary name.
    ///
    /// # Errors
    /// When the file cannot be created or the disk is full; nothing is left behind.
    pub fn write(target: &Path, bytes: &[u8]) -> Result<Self, ExportError> {
        let mut pending = Self::open(target)?;
        pending.append(bytes)?;
        Ok(pending)
    }

    /// An empty file under the temporary name, to be filled by [`append`](Self::append).
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn open(target: &Path) -> Result<Self, ExportError> {
        let temporary = temporary_name(target);
        let file = File::create(&temporary).map_err(ExportError::io(target, "create the file"))?;
        Ok(Self { file: Some(file), temporary, target: target.to_owned() })
    }

    /// Adds bytes at the end.
    ///
    /// # Errors
    /// When the disk is full or fails.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), ExportError> {
        self.file().write_all(bytes).map_err(ExportError::io(&self.target, "write the file"))
    }

    /// Waits until the bytes are on the disk.
    ///
    /// # Errors
    /// When the disk is full or fails.
    pub fn sync(&mut self) -> Result<(), ExportError> {
        self.file().sync_all().map_err(ExportError::io(&self.target, "sync the file to the disk"))
    }

    /// Gives the file its final name; call [`sync`](Self::sync) first.
    ///
    /// # Errors
    /// When the file cannot be renamed, for instance since a folder has its name.
    pub fn publish(mut self) -> Result<(), ExportError> {
        // Closed first: some systems do not rename open files.
        let file = self.file.take();
        drop(file);
        let renamed = fs::rename(&self.temporary, &self.target);
        if renamed.is_err() {
            remove_quietly(&self.temporary);
        }
        renamed.map_err(ExportError::io(&self.target, "give the file its final name"))
    }

    fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("the file is taken only by publish and drop, which consume it")
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            remove_quietly(&self.temporary);
        }
    }
}

/// Writes a whole file: temporary name, sync, rename.
///
/// # Errors
/// When the folder is missing or may not be written to, or the disk is full. The file that had the
/// name before is untouched then.
pub fn write(target: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    let mut pending = Pending::write(target, bytes)?;
    pending.sync()?;
    pending.publish()
}

/// Waits until the names in a folder are on the disk; without effect where systems cannot.
///
/// # Errors
/// When the disk fails.
pub fn sync_folder(folder: &Path) -> Result<(), ExportError> {
    if cfg!(unix) {
        File::open(folder)
            .and_then(|f| f.sync_all())
            .map_err(ExportError::io(folder, "sync the folder to the disk"))?;
    }
    Ok(())
}

/// Whether a file name is one of ours for a file that was not finished, and if so, of which.
pub(super) fn unfinished(name: &str) -> Option<&str> {
    name.strip_prefix('.')?.strip_suffix(".tmp")
}

fn temporary_name(target: &Path) -> PathBuf {
    let name = target.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
    target.with_file_name(format!(".{name}.tmp"))
}

/// Tidies up after an error that is reported anyway; a leftover does no harm.
fn remove_quietly(path: &Path) {
    drop(fs::remove_file(path));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let name = |e: std::io::Result<fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
        let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(name).collect();
        names.sort();
        names
    }

    #[test]
    fn the_final_name_appears_only_when_published() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.json");
        let mut pending = Pending::write(&target, b"one").unwrap();
        assert_eq!(names(dir.path()), [".a.json.tmp"]);
        pending.append(b"two").unwrap();
        pending.sync().unwrap();
        pending.publish().unwrap();
        assert_eq!(names(dir.path()), ["a.json"]);
        assert_eq!(fs::read(&target).unwrap(), b"onetwo");
    }

    #[test]
    fn a_dropped_file_leaves_the_old_one_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a.json");
        write(&target, b"old").unwrap();
        drop(Pending::write(&target, b"half of the n").unwrap());
        assert_eq!(names(dir.path()), ["a.json"]);
        assert_eq!(fs::read(&target).unwrap(), b"old");
    }

    #[test]
    fn a_folder_in_the_way_is_reported_and_nothing_is_left() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("a");
        fs::create_dir_all(target.join("full")).unwrap();
        let error = write(&target, b"x").unwrap_err();
        assert!(error.to_string().contains(target.to_str().unwrap()), "{error}");
        assert_eq!(names(dir.path()), ["a"]);
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write(Path::new("/nowhere/at/all.json"), b"x").unwrap_err().to_string();
        assert!(error.starts_with("/nowhere/at/all.json: cannot create the file"), "{error}");
        assert!(error.ends_with("the folder does not exist"), "{error}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_as_such() {
        // The kernel's device that is always full stands in for the file.
        let mut pending = Pending {
            file: Some(fs::OpenOptions::new().write(true).open("/dev/full").unwrap()),
            temporary: PathBuf::from("/nowhere/.x.tmp"),
            target: PathBuf::from("/disk/x"),
        };
        let error = pending.append(b"x").unwrap_err();
        assert!(error.is_storage());
        let text = error.to_string();
        assert!(text.starts_with("/disk/x: cannot write the file"), "{text}");
        assert!(text.ends_with("free some space or choose another disk"), "{text}");
    }
}
