//! Surroundings by id: light from all directions, as pictures.
//!
//! | ids | what |
//! |---|---|
//! | `hdri/<name>` | photographs that are part of the program |
//! | `folder/<folder>/<file>` | a user's .hdr or .exr by its path below the folder |
//!
//! [`equirect`] says how such a picture stands for directions, [`map`] what engines read, `filter`
//! what surfaces make of it, [`sky`] computes one from the sun. Nothing is unpacked before it is
//! asked for; what was used last is kept up to a limit of memory.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

pub mod equirect;
mod file;
mod filter;
pub mod map;
pub mod pack;
pub mod sky;

use map::Detail;
pub use map::EnvironmentMap;

use super::folder;
use super::textures::TextureError;
use crate::base::cache::Cache;
use crate::base::hash::content_hash;

/// Memory for prepared surroundings: about 30 of them.
const LIMIT_BYTES: usize = 256 << 20;
/// In front of the names of those that are part of the program.
const BUILT_IN: &str = "hdri/";

/// All surroundings by id. Shared by reference between threads; ids do not change over its life.
#[derive(Debug)]
pub struct Environments {
    ids: Vec<String>,
    paths: BTreeMap<String, PathBuf>,
    cache: Cache<String, EnvironmentMap>,
    /// Content hashes of files that were read, as 64 hexadecimal digits.
    hashes: Mutex<BTreeMap<String, String>>,
}

impl Environments {
    /// Those of the program, and the .hdr and .exr files below some folders, not opened.
    ///
    /// # Errors
    /// When a folder is missing, is none, cannot be read, or holds nothing of use.
    pub fn new(folders: &[PathBuf]) -> Result<Self, TextureError> {
        let mut paths = folder::named(folders)?;
        paths.retain(|id, _| folder::is_environment(id));
        let mut ids: Vec<String> =
            pack::built_in().iter().map(|p| format!("{BUILT_IN}{}", p.name)).collect();
        ids.extend(paths.keys().cloned());
        ids.sort();
        Ok(Self { ids, paths, cache: Cache::new(LIMIT_BYTES), hashes: Mutex::default() })
    }

    /// All ids, in order.
    #[must_use]
    pub fn ids(&self) -> &[String] {
        &self.ids
    }

    /// The ids of users' files, in order.
    pub fn file_ids(&self) -> impl Iterator<Item = &String> {
        self.paths.keys()
    }

    /// The surroundings of an id.
    ///
    /// # Errors
    /// When there are none of that id, or their file cannot be read or used.
    pub fn get(&self, id: &str) -> Result<Arc<EnvironmentMap>, TextureError> {
        self.cache.get_or_make(&id.to_owned(), EnvironmentMap::size_bytes, || {
            let (picture, path) = if let Some(path) = self.paths.get(id) {
                let bytes = folder::read(path)?;
                self.hashes
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .insert(id.to_owned(), content_hash(&bytes));
                (file::decode(path, &bytes)?, path.clone())
            } else {
                let all = pack::built_in();
                let named = |p: &&pack::Packed| id.strip_prefix(BUILT_IN) == Some(p.name);
                let packed = all.iter().find(named).ok_or_else(|| self.unknown(id))?;
                let path = PathBuf::from("assets/environments.env");
                let damaged = || TextureError::Broken {
                    path: path.clone(),
                    what: format!("{id} is damaged"),
                };
                (packed.picture().ok_or_else(damaged)?, path)
            };
            EnvironmentMap::new(picture, Detail::PICTURE)
                .ok_or_else(|| TextureError::Broken { path, what: "it is all black".to_owned() })
        })
    }

    /// The BLAKE3 hash of a user's file, once it was read.
    #[must_use]
    pub fn content_hash(&self, id: &str) -> Option<String> {
        self.hashes.lock().unwrap_or_else(PoisonError::into_inner).get(id).cloned()
    }

    fn unknown(&self, id: &str) -> TextureError {
        let score = |known: &&String| strsim::jaro_winkler(id, known);
        let best = self.ids.iter().max_by(|a, b| score(a).total_cmp(&score(b)));
        let nearest = best.filter(|known| score(known) > 0.7).cloned();
        TextureError::UnknownEnvironment { id: id.to_owned(), nearest }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use image::codecs::hdr::HdrEncoder;
    use image::{ImageBuffer, Rgb, Rgb32FImage};

    use super::*;

    /// Bright above, dark below, in the format of an ending.
    fn sky(width: u32, height: u32, ending: &str) -> Vec<u8> {
        let light = |y: u32| if y < height / 2 { [1.5, 3.0, 6.0] } else { [0.25; 3] };
        let picture: Rgb32FImage = ImageBuffer::from_fn(width, height, |_, y| Rgb(light(y)));
        let mut bytes = std::io::Cursor::new(Vec::new());
        if ending == "hdr" {
            let pixels: Vec<Rgb<f32>> = picture.pixels().copied().collect();
            HdrEncoder::new(&mut bytes).encode(&pixels, width as usize, height as usize).unwrap();
        } else {
            picture.write_to(&mut bytes, image::ImageFormat::OpenExr).unwrap();
        }
        bytes.into_inner()
    }

    /// What becomes of a file.
    fn got(name: &str, bytes: &[u8]) -> Result<Arc<EnvironmentMap>, TextureError> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join(name), bytes).unwrap();
        let environments = Environments::new(&[dir.path().to_owned()]).unwrap();
        let id = environments.file_ids().next().cloned().unwrap();
        let map = environments.get(&id)?;
        assert_eq!(environments.content_hash(&id), Some(content_hash(bytes)));
        Ok(map)
    }

    #[test]
    fn files_of_both_formats_become_the_same_surroundings() {
        for name in ["a.hdr", "b.EXR"] {
            let ending = if name.ends_with("hdr") { "hdr" } else { "exr" };
            let map = got(name, &sky(64, 32, ending)).unwrap();
            let (above, below) = (map.light(Vec3::Y, 0), map.light(Vec3::NEG_Y, 0));
            assert!(
                (above / below - Vec3::new(6.0, 12.0, 24.0)).abs().max_element() < 0.3,
                "{name}"
            );
            // Half of it is the mean of both luminances, 1.
            let luminance = |v: Vec3| v.dot(Vec3::new(0.2126, 0.7152, 0.0722));
            let mean = 0.5 * (luminance(above) + luminance(below));
            assert!((mean - 1.0).abs() < 0.02, "{name}: {mean}");
        }
    }

    #[test]
    fn files_that_are_no_surroundings_are_refused_with_a_reason() {
        let mut cut = sky(64, 32, "exr");
        cut.truncate(cut.len() / 2);
        let endless: Rgb32FImage = ImageBuffer::from_pixel(64, 32, Rgb([f32::INFINITY; 3]));
        let mut bright = std::io::Cursor::new(Vec::new());
        endless.write_to(&mut bright, image::ImageFormat::OpenExr).unwrap();
        for (name, bytes, reason) in [
            ("empty.hdr", Vec::new(), "is empty"),
            ("text.exr", b"hello".to_vec(), "neither Radiance"),
            ("square.hdr", sky(64, 64, "hdr"), "twice as wide as high"),
            ("cut.exr", cut, "not a usable picture"),
            ("bright.exr", bright.into_inner(), "must be finite"),
        ] {
            let error = got(name, &bytes).unwrap_err().to_string();
            assert!(error.contains(name) && error.contains(reason), "{error}");
        }
    }

    #[test]
    fn everything_listed_can_be_had_and_other_ids_are_told_the_nearest() {
        let environments = Environments::new(&[]).unwrap();
        assert!(environments.ids().len() >= 12);
        let map = environments.get(&environments.ids()[3]).unwrap();
        assert_eq!(map.levels[0].log2_width, 11);
        let error = environments.get("hdri/parc").unwrap_err().to_string();
        assert!(error.contains("did you mean \"hdri/park\""), "{error}");
    }
}
