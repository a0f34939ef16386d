//! Pictures in users' folders: which there are, and how a file becomes a texture.
//!
//! Only the list of names is read beforehand; a file is opened when its texture is asked for.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ImageDecoder, ImageFormat, ImageReader, Limits};

use super::texture::{Encoding, Texture};
use super::textures::TextureError;

/// Longest side of a picture that is decoded, pixels.
pub(super) const MAX_SIDE: u32 = 20_000;
/// Most memory that decoding one picture may take, bytes.
const MAX_DECODED_BYTES: u64 = 1 << 30;
/// Largest file that is read, bytes.
const MAX_FILE_BYTES: u64 = 1 << 29;
/// How deep folders in folders are looked into.
const MAX_DEPTH: usize = 16;

/// All files of pictures below some folders by id: `folder/`, the name of their folder, and their path from
/// there. A second folder of the same name is called `name~2`.
///
/// # Errors
/// When a folder is missing, is none, cannot be read, or holds neither such a file nor one of
/// poses, people or numbers.
pub(super) fn named(folders: &[PathBuf]) -> Result<BTreeMap<String, PathBuf>, TextureError> {
    let mut paths = BTreeMap::new();
    let mut names: Vec<String> = Vec::new();
    for path in folders {
        let own = path
            .file_name()
            .map_or_else(|| "pictures".to_owned(), |n| n.to_string_lossy().into_owned());
        let mut name = own.clone();
        let mut count = 1;
        while names.contains(&name) {
            count += 1;
            name = format!("{own}~{count}");
        }
        for (file, path) in list(path)? {
            paths.insert(format!("folder/{name}/{file}"), path);
        }
        names.push(name);
    }
    Ok(paths)
}

/// All pictures below a folder, as (path with slashes from the folder, path), in order.
fn list(folder: &Path) -> Result<Vec<(String, PathBuf)>, TextureError> {
    let unreadable = |source| TextureError::Unreadable { path: folder.to_owned(), source };
    match std::fs::metadata(folder) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            return Err(TextureError::Missing { path: folder.to_owned() });
        }
        Err(e) => return Err(unreadable(e)),
        Ok(meta) if !meta.is_dir() => {
            return Err(TextureError::NotAFolder { path: folder.to_owned() });
        }
        Ok(_) => {}
    }
    let mut found = Vec::new();
    walk(folder, "", 0, &mut found)?;
    if found.is_empty() && !holds_other_files(folder) {
        return Err(TextureError::Empty { path: folder.to_owned() });
    }
    found.sort();
    Ok(found)
}

/// Whether files of poses or people, or tables of numbers, can be in a folder.
fn holds_other_files(folder: &Path) -> bool {
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|entry| {
        let name = entry.file_name();
        [".json", ".csv"].iter().any(|ending| name.to_string_lossy().ends_with(ending))
    })
}

fn walk(
    folder: &Path,
    prefix: &str,
    depth: usize,
    found: &mut Vec<(String, PathBuf)>,
) -> Result<(), TextureError> {
    let unreadable = |source| TextureError::Unreadable { path: folder.to_owned(), source };
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let path = entry.path();
        // Names that are not Unicode cannot stand in a scene file.
        let Some(name) = entry.file_name().to_str().map(str::to_owned) else { continue };
        if name.starts_with('.') {
            continue;
        }
        let kind = entry.file_type().map_err(unreadable)?;
        if kind.is_dir() {
            // Links to folders are not followed, so there are no circles.
            if depth < MAX_DEPTH {
                walk(&path, &format!("{prefix}{name}/"), depth + 1, found)?;
            }
        } else if is_texture(&name) || is_environment(&name) {
            found.push((format!("{prefix}{name}"), path));
        }
    }
    Ok(())
}

/// Whether a file can become a texture.
pub(super) fn is_texture(name: &str) -> bool {
    ends_with(name, &["jpg", "jpeg", "png"])
}

/// Whether a file can become surroundings.
pub(super) fn is_environment(name: &str) -> bool {
    ends_with(name, &["hdr", "exr"])
}

fn ends_with(name: &str, endings: &[&str]) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    endings.iter().any(|known| ending.eq_ignore_ascii_case(known))
}

/// The bytes of a picture file.
///
/// # Errors
/// When it cannot be read, is empty or unreasonably large.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, TextureError> {
    let unreadable = |source| TextureError::Unreadable { path: path.to_owned(), source };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size == 0 {
        return Err(broken(path, "the file is empty".to_owned()));
    }
    if size > MAX_FILE_BYTES {
        return Err(TextureError::TooLarge {
            path: path.to_owned(),
            what: format!("{size} bytes, at most {MAX_FILE_BYTES} are read"),
        });
    }
    std::fs::read(path).map_err(unreadable)
}

fn broken(path: &Path, what: String) -> TextureError {
    TextureError::Broken { path: path.to_owned(), what }
}

/// Decodes a JPEG or PNG, whatever its name says, as 8-bit sRGB.
///
/// Grey, palette, 16-bit and CMYK pictures are converted; the orientation of the camera is applied.
///
/// # Errors
/// When the bytes are of another format, damaged, cut off, or the picture is too large.
pub(super) fn decode(
    path: &Path,
    bytes: &[u8],
    max_log2_size: u32,
) -> Result<Texture, TextureError> {
    let too_large = |what: String| TextureError::TooLarge { path: path.to_owned(), what };
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Jpeg | ImageFormat::Png)) => format,
        _ => return Err(broken(path, "it is neither JPEG nor PNG".to_owned())),
    };
    if format == ImageFormat::Jpeg && !jpeg_is_whole(bytes) {
        return Err(broken(path, "the JPEG is cut off before its end".to_owned()));
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    // The sides are checked below, with a message of their own.
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(|e| broken(path, e.to_string()))?;
    let (width, height) = decoder.dimensions();
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(too_large(format!("{width}x{height} pixels, at most {MAX_SIDE} a side")));
    }
    // Pixels as they are decoded, and again as RGBA.
    let needed = decoder.total_bytes() + u64::from(width) * u64::from(height) * 4;
    if width == 0 || height == 0 {
        return Err(broken(path, "it has no pixels".to_owned()));
    }
    if needed > MAX_DECODED_BYTES {
        return Err(too_large(format!(
            "{width}x{height} pixels take {needed} bytes, at most {MAX_DECODED_BYTES} are used"
        )));
    }
    let orientation = decoder.orientation();
    let mut picture =
        image::DynamicImage::from_decoder(decoder).map_err(|e| broken(path, e.to_string()))?;
    if let Ok(orientation) = orientation {
        picture.apply_orientation(orientation);
    }
    let rgba = picture.into_rgba8();
    let (width, height) = rgba.dimensions();
    Ok(Texture::from_rgba8(width, height, rgba.as_raw(), Encoding::Color, max_log2_size))
}

/// Whether a JPEG goes on to its end marker: decoders fill what is missing with grey.
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let mut at = 2;
    loop {
        let Some(&[0xff, marker]) =
            bytes.get(at..at + 2).and_then(|b| <&[u8; 2]>::try_from(b).ok())
        else {
            return false;
        };
        match marker {
            0xd9 => return true,
            // Fill bytes before a marker.
            0xff => at += 1,
            0x01 | 0xd0..=0xd8 => at += 2,
            _ => {
                let Some(&[high, low]) =
                    bytes.get(at + 2..at + 4).and_then(|b| <&[u8; 2]>::try_from(b).ok())
                else {
                    return false;
                };
                at += 2 + usize::from(u16::from_be_bytes([high, low]));
                if marker == 0xda {
                    // Compressed data lasts up to a marker that is neither stuffing nor a restart.
                    let data = bytes.get(at..).unwrap_or_default();
                    let end = data
                        .windows(2)
                        .position(|w| w[0] == 0xff && !matches!(w[1], 0x00 | 0xd0..=0xd7));
                    let Some(end) = end else { return false };
                    at += end;
                }
            }
        }
    }
}
