//! Users' pictures of all directions: Radiance (.hdr) and OpenEXR (.exr).

use std::io::Cursor;
use std::path::Path;

use glam::Vec3;
use image::{ImageDecoder, ImageFormat, ImageReader, Limits};

use super::equirect::Equirect;
use crate::library::folder::MAX_SIDE;
use crate::library::textures::TextureError;

/// Most memory that decoding one picture may take, bytes.
const MAX_DECODED_BYTES: u64 = 2 << 30;

/// Decodes a picture of linear light. Negative numbers count as 0.
///
/// # Errors
/// When the bytes are of another format, damaged, hold NaN or infinities, or the picture is not
/// twice as wide as high, or too large.
pub fn decode(path: &Path, bytes: &[u8]) -> Result<Equirect, TextureError> {
    let broken = |what: String| TextureError::Broken { path: path.to_owned(), what };
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Hdr | ImageFormat::OpenExr)) => format,
        _ => return Err(broken("it is neither Radiance (.hdr) nor OpenEXR (.exr)".to_owned())),
    };
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|e| broken(e.to_string()))?;
    let (width, height) = decoder.dimensions();
    let size = format!("{width}x{height} pixels");
    // As decoded, then as three numbers of four bytes.
    let needed = decoder.total_bytes() + u64::from(width) * u64::from(height) * 12;
    if width > MAX_SIDE || needed > MAX_DECODED_BYTES {
        return Err(TextureError::TooLarge { path: path.to_owned(), what: size });
    }
    if width < 4 || width != height * 2 {
        return Err(broken(format!(
            "it has {size}, but a picture of all directions is twice as wide as high"
        )));
    }
    let picture = image::DynamicImage::from_decoder(decoder).map_err(|e| broken(e.to_string()))?;
    let rgb = picture.into_rgb32f().into_raw();
    if let Some(at) = rgb.iter().position(|v| !v.is_finite()) {
        let (pixel, width) = (at / 3, width as usize);
        return Err(broken(format!(
            "pixel ({}, {}) is {}, and all light must be finite",
            pixel % width,
            pixel / width,
            rgb[at]
        )));
    }
    let pixels = rgb.as_chunks().0.iter().map(|p| Vec3::from_array(*p).max(Vec3::ZERO)).collect();
    Ok(Equirect { width: width as usize, pixels })
}
