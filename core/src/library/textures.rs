//! All textures by id: the computed ones, and pictures in users' folders.
//!
//! | ids | what |
//! |---|---|
//! | `procedural/<family>/<nn>` | colour, tiles: for walls, floors and objects |
//! | `cloth/<family>/<nn>` | colour, tiles, light: multiplied by a garment's colour |
//! | `detail/<skin, hair, curls, cloth, folds>` | plain numbers round 0.5, tiles |
//! | `finish/<family>/<variant>` | where the hue of cloth is turned and where it shines |
//! | `relief/<family>/<variant>` | the same of cloth by how it is woven, with a normal map |
//! | `normal/<...>` | plain numbers, normals of the computed texture of that name |
//! | `folder/<folder>/<file>` | colour, a user's JPEG or PNG by its path below the folder |
//!
//! Nothing is computed or opened before it is asked for; what was used last is kept up to a limit
//! of memory. A texture's pixels do not depend on what was asked for before.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use super::folder;
use super::procedural::{self, Kind};
use super::texture::Texture;
use crate::base::cache::Cache;
use crate::base::hash::content_hash;

/// Default of [`TextureLibrary::with_memory_limit`]: about 380 textures of 512 x 512.
const DEFAULT_LIMIT_BYTES: usize = 512 << 20;
/// Default of [`TextureLibrary::with_max_size`]: 512 x 512.
const DEFAULT_LOG2_SIZE: u32 = 9;
/// No texture is larger than 4096 x 4096.
const LARGEST_LOG2_SIZE: u32 = 12;

/// Kinds of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureGroup {
    /// Computed, for walls, floors and objects.
    Procedural,
    /// Computed, for garments.
    Cloth,
    /// Computed fine structure, plain numbers.
    Detail,
    /// Computed weaves of cloth, plain numbers.
    Relief,
    /// Computed finishes of cloth, plain numbers.
    Finish,
    /// Computed normal maps, plain numbers.
    Normal,
    /// Users' pictures.
    Folder,
}

/// What can be wrong with textures.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TextureError {
    #[error("there is no texture \"{id}\"{}", suggestion(nearest))]
    Unknown { id: String, nearest: Option<String> },
    #[error("there are no surroundings \"{id}\"{}", suggestion(nearest))]
    UnknownEnvironment { id: String, nearest: Option<String> },
    #[error("texture folder {} does not exist; check the path", path.display())]
    Missing { path: PathBuf },
    #[error("texture folder {} is not a folder; name the folder that holds the pictures", path.display())]
    NotAFolder { path: PathBuf },
    #[error("texture folder {} holds no .jpg, .jpeg, .png, .hdr or .exr file, and neither a .json file of poses or people nor a .csv table; add some or drop the folder", path.display())]
    Empty { path: PathBuf },
    #[error("{} cannot be read: {source}", path.display())]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{} is not a usable picture: {what}; replace or remove it", path.display())]
    Broken { path: PathBuf, what: String },
    #[error("{} is too large: {what}; scale it down", path.display())]
    TooLarge { path: PathBuf, what: String },
}

fn suggestion(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |id| format!("; did you mean \"{id}\"?"))
}

/// All textures by id.
///
/// Shared by reference between threads; ids do not change over its life.
#[derive(Debug)]
pub struct TextureLibrary {
    procedural: Vec<String>,
    cloth: Vec<String>,
    detail: Vec<String>,
    relief: Vec<String>,
    finish: Vec<String>,
    normal: Vec<String>,
    folder: Vec<String>,
    paths: BTreeMap<String, PathBuf>,
    max_log2_size: u32,
    cache: Cache<String, Texture>,
    /// Content hashes of pictures that were read, as 64 hexadecimal digits.
    hashes: Mutex<BTreeMap<String, String>>,
}

impl TextureLibrary {
    /// The computed textures, and the pictures below some folders, listed by name and not opened.
    ///
    /// # Errors
    /// When a folder is missing, is none, cannot be read, or holds no picture and no poses or people.
    pub fn new(folders: &[PathBuf]) -> Result<Self, TextureError> {
        let mut paths = folder::named(folders)?;
        paths.retain(|id, _| folder::is_texture(id));
        Ok(Self {
            procedural: procedural::ids(Kind::Procedural),
            cloth: procedural::ids(Kind::Cloth),
            detail: procedural::ids(Kind::Detail),
            relief: procedural::ids(Kind::Relief),
            finish: procedural::ids(Kind::Finish),
            normal: procedural::normal_ids(),
            folder: paths.keys().cloned().collect(),
            paths,
            max_log2_size: DEFAULT_LOG2_SIZE,
            cache: Cache::new(DEFAULT_LIMIT_BYTES),
            hashes: Mutex::default(),
        })
    }

    /// Sets how much memory textures may occupy before the one used longest ago is dropped, bytes.
    /// The last one always stays.
    #[must_use]
    pub fn with_memory_limit(self, bytes: usize) -> Self {
        Self { cache: Cache::new(bytes), ..self }
    }

    /// Sets the largest side of users' pictures as textures, as its log2, at most 12.
    #[must_use]
    pub fn with_max_size(mut self, log2_size: u32) -> Self {
        self.max_log2_size = log2_size.min(LARGEST_LOG2_SIZE);
        self
    }

    /// All ids of a group, in order.
    #[must_use]
    pub fn ids(&self, group: TextureGroup) -> &[String] {
        match group {
            TextureGroup::Procedural => &self.procedural,
            TextureGroup::Cloth => &self.cloth,
            TextureGroup::Detail => &self.detail,
            TextureGroup::Relief => &self.relief,
            TextureGroup::Finish => &self.finish,
            TextureGroup::Normal => &self.normal,
            TextureGroup::Folder => &self.folder,
        }
    }

    /// Whether there is a texture of that id.
    #[must_use]
    pub fn contains(&self, id: &str) -> bool {
        self.all_groups().any(|ids| ids.binary_search_by(|known| known.as_str().cmp(id)).is_ok())
    }

    /// The id of the normal map that belongs to a texture, where there is one.
    #[must_use]
    pub fn normal_map(&self, id: &str) -> Option<String> {
        procedural::normal_id(id)
    }

    /// The texture of an id.
    ///
    /// # Errors
    /// When there is none of that id, or its file cannot be read or used.
    pub fn get(&self, id: &str) -> Result<Arc<Texture>, TextureError> {
        let mut normals = None;
        let texture = self.cache.get_or_make(&id.to_owned(), Texture::size_bytes, || {
            if let Some(path) = self.paths.get(id) {
                let bytes = folder::read(path)?;
                self.remember(id, content_hash(&bytes));
                return folder::decode(path, &bytes, self.max_log2_size);
            }
            let (texture, its_normals) =
                procedural::generate(id).ok_or_else(|| self.unknown(id))?;
            normals = its_normals;
            Ok(texture)
        })?;
        // A painting's height is there with its colours: painting it again would cost the same.
        if let (Some(normals), Some(id)) = (normals, self.normal_map(id)) {
            self.cache.get_or_make(&id, Texture::size_bytes, || Ok::<_, TextureError>(normals))?;
        }
        Ok(texture)
    }

    /// What identifies a texture's content whatever its path: the BLAKE3 hash of a picture file as
    /// 64 hexadecimal digits, the id itself of a computed texture.
    ///
    /// # Errors
    /// When there is none of that id, or its file cannot be read.
    pub fn content_hash(&self, id: &str) -> Result<String, TextureError> {
        let Some(path) = self.paths.get(id) else {
            return if self.contains(id) { Ok(id.to_owned()) } else { Err(self.unknown(id)) };
        };
        if let Some(hash) = self.hashes.lock().unwrap_or_else(PoisonError::into_inner).get(id) {
            return Ok(hash.clone());
        }
        let hash = content_hash(&folder::read(path)?);
        self.remember(id, hash.clone());
        Ok(hash)
    }

    fn remember(&self, id: &str, hash: String) {
        self.hashes.lock().unwrap_or_else(PoisonError::into_inner).insert(id.to_owned(), hash);
    }

    /// Bytes that the kept textures occupy.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.cache.size_bytes()
    }

    fn all_groups(&self) -> impl Iterator<Item = &[String]> {
        let of_cloth = [&self.cloth, &self.detail, &self.relief, &self.finish];
        let others = [&self.procedural, &self.normal, &self.folder];
        of_cloth.into_iter().chain(others).map(Vec::as_slice)
    }

    fn unknown(&self, id: &str) -> TextureError {
        // By score, then by place in the list: the first of equals.
        let mut best = (0.7, None);
        for known in self.all_groups().flatten() {
            let score = strsim::jaro_winkler(id, known);
            if score > best.0 {
                best = (score, Some(known.clone()));
            }
        }
        TextureError::Unknown { id: id.to_owned(), nearest: best.1 }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::path::Path;

    use image::{DynamicImage, ImageFormat};

    use super::*;
    use crate::base::color::srgb_from_linear;
    use crate::library::texture::{color_from_srgb8, linear_from_color};

    fn library(folders: &[&Path]) -> Result<TextureLibrary, TextureError> {
        TextureLibrary::new(&folders.iter().map(|p| p.to_path_buf()).collect::<Vec<_>>())
    }

    fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn picture(width: u32, height: u32) -> DynamicImage {
        image::RgbImage::from_fn(width, height, |x, y| image::Rgb([x as u8, y as u8, 77])).into()
    }

    /// A folder of files and what the library says of one of them.
    fn get(name: &str, bytes: &[u8]) -> Result<Arc<Texture>, TextureError> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join(name), bytes).unwrap();
        let library = library(&[dir.path()]).unwrap();
        library.get(&library.ids(TextureGroup::Folder)[0].clone())
    }

    #[test]
    fn groups_hold_what_their_names_say_and_everything_listed_can_be_had() {
        let library = library(&[]).unwrap();
        for (group, prefix) in [
            (TextureGroup::Procedural, "procedural/"),
            (TextureGroup::Cloth, "cloth/"),
            (TextureGroup::Detail, "detail/"),
            (TextureGroup::Relief, "relief/"),
            (TextureGroup::Finish, "finish/"),
            (TextureGroup::Normal, "normal/"),
        ] {
            let ids = library.ids(group);
            assert!(ids.iter().all(|id| id.starts_with(prefix) && library.contains(id)));
            for id in ids.iter().step_by(53) {
                library.get(id).unwrap();
            }
        }
        assert!(library.ids(TextureGroup::Folder).is_empty());
        let error = library.get("procedural/brik/01").unwrap_err().to_string();
        assert!(error.contains("did you mean \"procedural/brick/01\""), "{error}");
        for id in library.ids(TextureGroup::Procedural) {
            if let Some(normal) = library.normal_map(id) {
                assert!(library.contains(&normal), "{normal}");
            }
        }
    }

    #[test]
    fn textures_are_shared_and_the_longest_unused_go_first() {
        let one = library(&[]).unwrap().get("detail/skin").unwrap().size_bytes();
        let library = library(&[]).unwrap().with_memory_limit(2 * one);
        let skin = library.get("detail/skin").unwrap();
        let plain = library.get("cloth/plain/00").unwrap();
        assert!(Arc::ptr_eq(&skin, &library.get("detail/skin").unwrap()));
        library.get("detail/cloth").unwrap();
        assert_eq!(library.memory_bytes(), 2 * one);
        assert!(Arc::ptr_eq(&skin, &library.get("detail/skin").unwrap()));
        let again = library.get("cloth/plain/00").unwrap();
        assert!(!Arc::ptr_eq(&plain, &again), "it was dropped");
        assert_eq!(plain, again, "and is the same again");
    }

    #[test]
    fn threads_that_ask_at_once_get_one_texture() {
        let library = library(&[]).unwrap();
        let got: Vec<_> = std::thread::scope(|scope| {
            let asked: Vec<_> =
                (0..4).map(|_| scope.spawn(|| library.get("cloth/plain/00").unwrap())).collect();
            asked.into_iter().map(|t| t.join().unwrap()).collect()
        });
        let kept = library.get("cloth/plain/00").unwrap();
        assert!(got.iter().all(|t| Arc::ptr_eq(t, &kept)));
    }

    #[test]
    fn folders_are_listed_in_order_by_relative_path_and_not_opened() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("photos");
        std::fs::create_dir_all(root.join("sub")).unwrap();
        for name in ["b.JPG", "a.png", "sub/c.jpeg", "notes.txt", ".hidden.png"] {
            std::fs::write(root.join(name), b"not read").unwrap();
        }
        let other = dir.path().join("more/photos");
        std::fs::create_dir_all(&other).unwrap();
        std::fs::write(other.join("d.png"), encoded(&picture(5, 3), ImageFormat::Png)).unwrap();
        let library = library(&[&root, &other]).unwrap();
        assert_eq!(
            library.ids(TextureGroup::Folder),
            [
                "folder/photos/a.png",
                "folder/photos/b.JPG",
                "folder/photos/sub/c.jpeg",
                "folder/photos~2/d.png"
            ]
        );
        assert_eq!(library.get("folder/photos~2/d.png").unwrap().log2_size, 3);
        let hash = library.content_hash("folder/photos~2/d.png").unwrap();
        assert_eq!(hash, content_hash(&encoded(&picture(5, 3), ImageFormat::Png)));
        assert!(matches!(library.get("folder/photos/a.png"), Err(TextureError::Broken { .. })));
        assert_eq!(library.content_hash("cloth/plain/00").unwrap(), "cloth/plain/00");
    }

    #[test]
    fn folders_that_cannot_be_used_are_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file.png");
        assert!(matches!(library(&[&dir.path().join("gone")]), Err(TextureError::Missing { .. })));
        assert!(matches!(library(&[dir.path()]), Err(TextureError::Empty { .. })));
        std::fs::write(&file, b"x").unwrap();
        let error = library(&[&file]).unwrap_err();
        assert!(matches!(error, TextureError::NotAFolder { .. }));
        assert!(error.to_string().contains("file.png"), "{error}");
    }

    #[test]
    fn pictures_of_all_kinds_are_read() {
        let plain = picture(64, 64);
        for (format, name) in
            [(ImageFormat::Png, "a.png"), (ImageFormat::Jpeg, "a.jpg"), (ImageFormat::Png, "a.jpg")]
        {
            let t = get(name, &encoded(&plain, format)).unwrap();
            assert_eq!(t.log2_size, 6);
            let light = linear_from_color(t.texels[10 * 64 + 50]);
            for (light, byte) in light.into_iter().zip([50.0, 10.0, 77.0]) {
                assert!((srgb_from_linear(light) * 255.0 - byte).abs() < 8.0, "{light} {byte}");
            }
        }
        let grey = DynamicImage::from(plain.to_luma8());
        assert!(get("a.png", &encoded(&grey, ImageFormat::Png)).is_ok());
        assert!(get("a.jpg", &encoded(&grey, ImageFormat::Jpeg)).is_ok());
        let deep = DynamicImage::from(plain.to_rgb16());
        let t = get("a.png", &encoded(&deep, ImageFormat::Png)).unwrap();
        assert_eq!(t.texels[10 * 64 + 50], color_from_srgb8([50, 10, 77]));
        let clear = DynamicImage::from(plain.to_rgba16());
        assert!(get("a.png", &encoded(&clear, ImageFormat::Png)).is_ok());
        // Four inks, as printers write them.
        let mut cmyk = Vec::new();
        jpeg_encoder::Encoder::new(&mut cmyk, 95)
            .encode(&[128; 4 * 64 * 64], 64, 64, jpeg_encoder::ColorType::Cmyk)
            .unwrap();
        let t = get("a.jpg", &cmyk).unwrap();
        assert_eq!(t.log2_size, 6);
    }

    #[test]
    fn damaged_and_oversized_pictures_are_refused_by_name() {
        for (format, name) in [(ImageFormat::Png, "cut.png"), (ImageFormat::Jpeg, "cut.jpg")] {
            let whole = encoded(&picture(100, 80), format);
            assert!(get(name, &whole).is_ok());
            for part in [0, 1, 10, whole.len() / 2, whole.len() - 2] {
                // The last bytes of a PNG are a chunk without content.
                if format == ImageFormat::Png && part == whole.len() - 2 {
                    continue;
                }
                let error = get(name, &whole[..part]).expect_err(&format!("{name} cut to {part}"));
                assert!(matches!(error, TextureError::Broken { .. }), "{error}");
                assert!(error.to_string().contains(name), "{error}");
            }
        }
        assert!(matches!(get("text.png", b"hello, world"), Err(TextureError::Broken { .. })));
        let long = DynamicImage::new_luma8(folder::MAX_SIDE + 1, 1);
        let error = get("long.png", &encoded(&long, ImageFormat::Png)).unwrap_err();
        assert!(matches!(error, TextureError::TooLarge { .. }), "{error}");
    }
}
