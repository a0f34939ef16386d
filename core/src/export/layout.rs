//! Where the files of a data set are.

use std::path::{Path, PathBuf};

use super::{PictureFormat, atomic};

/// Names of the files and folders of a data set below its folder.
#[derive(Clone, Debug)]
pub struct Layout {
    root: PathBuf,
}

/// Kinds of file of which there is one for each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameFile {
    /// The picture, as JPEG.
    JpegPicture,
    /// The picture, as PNG.
    PngPicture,
    /// The scene.
    Scene,
    /// 16-bit instance ids.
    Instance,
    /// Class colours.
    Semantic,
    /// The frame's part of the index, kept until the index is written.
    Fragment,
}

impl FrameFile {
    /// Every kind.
    pub const ALL: [Self; 6] = [
        Self::JpegPicture,
        Self::PngPicture,
        Self::Scene,
        Self::Instance,
        Self::Semantic,
        Self::Fragment,
    ];

    /// The kind of file that holds the picture.
    #[must_use]
    pub const fn picture(format: PictureFormat) -> Self {
        match format {
            PictureFormat::Jpeg(_) => Self::JpegPicture,
            PictureFormat::Png => Self::PngPicture,
        }
    }

    /// Folder and file ending.
    const fn place(self) -> (&'static str, &'static str) {
        match self {
            Self::JpegPicture => ("images", "jpg"),
            Self::PngPicture => ("images", "png"),
            Self::Scene => ("scenes", "json"),
            Self::Instance => ("labels/instance", "png"),
            Self::Semantic => ("labels/semantic", "png"),
            Self::Fragment => (".figurant/frames", "jsonl"),
        }
    }

    /// Folder, relative to the data set's, with `/` on every system.
    #[must_use]
    pub const fn folder(self) -> &'static str {
        self.place().0
    }

    /// Path relative to the data set's folder, with `/` on every system: what files refer to.
    #[must_use]
    pub fn relative(self, frame: u32) -> String {
        let (folder, extension) = self.place();
        format!("{folder}/{frame:06}.{extension}")
    }

    /// Whether a file of this name in this kind's folder is one of ours, finished or not.
    #[must_use]
    pub fn owns(self, name: &str) -> bool {
        let name = atomic::unfinished(name).unwrap_or(name);
        let number = name.strip_suffix(self.place().1).and_then(|n| n.strip_suffix('.'));
        // The frame number must be written as we write it: `7.jpg` is somebody else's.
        number.and_then(|n| n.parse::<u32>().ok().filter(|f| format!("{f:06}") == n)).is_some()
    }
}

impl Layout {
    /// Files of which there is one in a data set, relative to its folder.
    pub const SINGLE_FILES: [&'static str; 4] =
        ["manifest.json", "config.json", "report.json", "coco/annotations.json"];

    /// Folders that a data set may have, each before the one that it is in.
    pub const FOLDERS: [&'static str; 8] = [
        "images",
        "scenes",
        "labels/instance",
        "labels/semantic",
        "labels",
        "coco",
        ".figurant/frames",
        ".figurant",
    ];

    /// The layout below a folder.
    #[must_use]
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// The data set's folder.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// What the data set is and how far it got.
    #[must_use]
    pub fn manifest(&self) -> PathBuf {
        self.root.join("manifest.json")
    }

    /// The document.
    #[must_use]
    pub fn config(&self) -> PathBuf {
        self.root.join("config.json")
    }

    /// Frames that went wrong.
    #[must_use]
    pub fn report(&self) -> PathBuf {
        self.root.join("report.json")
    }

    /// The index.
    #[must_use]
    pub fn annotations(&self) -> PathBuf {
        self.root.join("coco/annotations.json")
    }

    /// A file of a frame.
    #[must_use]
    pub fn frame_file(&self, file: FrameFile, frame: u32) -> PathBuf {
        self.root.join(file.relative(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_frames_are_known_again_and_others_are_not() {
        for frame in [0, 7, 123_456, 1_234_567, u32::MAX] {
            for file in FrameFile::ALL {
                let path = file.relative(frame);
                let (folder, name) = path.rsplit_once('/').unwrap();
                assert_eq!(folder, file.folder());
                assert!(file.owns(name) && file.owns(&format!(".{name}.tmp")), "{path}");
                assert!(Layout::FOLDERS.contains(&folder), "{path}");
            }
        }
        for foreign in [
            "7.jpg",
            "0000007.jpg",
            "000007.jpeg",
            "holiday.jpg",
            "-00007.jpg",
            "000007jpg",
            "99999999999.jpg",
        ] {
            assert!(!FrameFile::JpegPicture.owns(foreign), "{foreign}");
        }
    }
}
