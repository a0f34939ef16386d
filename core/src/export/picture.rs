//! Pixels -> the bytes of JPEG and PNG files. Pure functions: the same pixels give the same bytes
//! on every machine.

use jpeg_encoder::{ColorType, Encoder, ImageBuffer, JpegColorType, SamplingFactor, rgb_to_ycbcr};
use png::{BitDepth, Compression, Filter};

use super::ExportError;

/// Bytes of a file.
type Encoded = Result<Vec<u8>, ExportError>;

/// How pictures are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Baseline JPEG of the given quality, 1..=100.
    Jpeg(u8),
    /// Lossless.
    Png,
}

impl PictureFormat {
    /// What COCO users expect to find: visually lossless at a quarter of a PNG's size.
    pub const DEFAULT: Self = Self::Jpeg(92);

    /// The same with a quality of the frame's own, if it has one.
    #[must_use]
    pub const fn or_quality(self, quality: Option<u8>) -> Self {
        match (self, quality) {
            (Self::Jpeg(_), Some(quality)) => Self::Jpeg(quality),
            _ => self,
        }
    }

    /// The file name's ending, without the dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Jpeg(_) => "jpg",
            Self::Png => "png",
        }
    }

    /// The bytes of a picture file. `rgb` is 8-bit sRGB, row by row, `width * height * 3` long.
    ///
    /// # Errors
    /// When the size is zero, too large for the format, or does not fit the pixels.
    pub fn encode(self, rgb: &[u8], width: u32, height: u32) -> Encoded {
        match self {
            Self::Jpeg(quality) => jpeg(rgb, width, height, quality),
            Self::Png => png_rgb(rgb, width, height),
        }
    }
}

/// A baseline JPEG: 4:2:0, as cameras and the pictures of COCO have it, and 4:4:4 from quality 95
/// up, for those who want every thin limb to keep its colour.
///
/// The encoder's SIMD feature stays off: its rounding differs from the portable path's, and a data
/// set must not depend on the processor that wrote it.
fn jpeg(rgb: &[u8], width: u32, height: u32, quality: u8) -> Encoded {
    let failed = |reason: String| ExportError::Encode { what: "JPEG", width, height, reason };
    let side = |n: u32| {
        u16::try_from(n)
            .map_err(|_| failed("a JPEG has at most 65,535 pixels a side; use PNG".to_owned()))
    };
    let (w, h) = (side(width)?, side(height)?);
    if rgb.is_empty() || rgb.len() as u64 != 3 * u64::from(width) * u64::from(height) {
        return Err(failed(format!("{} bytes do not fill it", rgb.len())));
    }
    let mut bytes = Vec::with_capacity(rgb.len() / 6);
    let mut encoder = Encoder::new(&mut bytes, quality);
    let encoded = if quality >= 95 {
        encoder.set_sampling_factor(SamplingFactor::F_1_1);
        encoder.encode(rgb, w, h, ColorType::Rgb)
    } else {
        encoder.set_sampling_factor(SamplingFactor::F_2_2);
        encoder.encode_image(MeanChroma { rgb, width: w, height: h })
    };
    encoded.map_err(|e| failed(e.to_string()))?;
    Ok(bytes)
}

/// A picture whose chroma is the mean of two by two pixels, at the first of the four, which is
/// the one that the encoder takes. Its own averaging divides once for each of them.
struct MeanChroma<'a> {
    rgb: &'a [u8],
    width: u16,
    height: u16,
}

impl ImageBuffer for MeanChroma<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        JpegColorType::Ycbcr
    }

    fn width(&self) -> u16 {
        self.width
    }

    fn height(&self) -> u16 {
        self.height
    }

    fn fill_buffers(&self, y: u16, [luma, blue, red, _]: &mut [Vec<u8>; 4]) {
        let stride = 3 * usize::from(self.width);
        let row = &self.rgb[usize::from(y) * stride..][..stride];
        luma.extend(row.as_chunks().0.iter().map(|&[r, g, b]| rgb_to_ycbcr(r, g, b).0));
        let start = blue.len();
        blue.resize(luma.len(), 0);
        red.resize(luma.len(), 0);
        // The encoder takes every other row; the last one is repeated downwards, so that it may
        // come in the place of a first one.
        let last = y + 1 == self.height;
        if y % 2 == 1 && !last {
            return;
        }
        let below = if last { row } else { &self.rgb[(usize::from(y) + 1) * stride..][..stride] };
        let places = blue[start..].chunks_mut(2).zip(red[start..].chunks_mut(2));
        let pixels = row.chunks(6).zip(below.chunks(6));
        for ((blue, red), (a, b)) in places.zip(pixels) {
            // Of the last column of an odd width there is one.
            let right = a.len() - 3;
            let mean = |c: usize| {
                let sum = [a[c], a[right + c], b[c], b[right + c]].map(u32::from);
                ((sum.iter().sum::<u32>() + 2) / 4) as u8
            };
            let (_, cb, cr) = rgb_to_ycbcr(mean(0), mean(1), mean(2));
            blue.fill(cb);
            red.fill(cr);
        }
    }
}

/// A lossless 8-bit picture. `rgb` is `width * height * 3` long.
///
/// # Errors
/// When the size is zero or does not fit the pixels.
pub fn png_rgb(rgb: &[u8], width: u32, height: u32) -> Encoded {
    // Of the fast settings the one with the smallest files.
    png("picture", rgb, [width, height], Filter::Paeth, |encoder| {
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    })
}

/// A 16-bit greyscale picture of ids.
///
/// # Errors
/// When the size is zero or does not fit the ids.
pub fn png_ids(ids: &[u16], width: u32, height: u32) -> Encoded {
    let bytes: Vec<u8> = ids.iter().flat_map(|id| id.to_be_bytes()).collect();
    png("id picture", &bytes, [width, height], Filter::Up, |encoder| {
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(BitDepth::Sixteen);
    })
}

/// A picture of palette indices: colour to those who read colours, ids to those who read indices.
///
/// # Errors
/// When the size is zero or does not fit the ids, or an id has no colour.
pub fn png_palette(ids: &[u8], width: u32, height: u32, palette: &[[u8; 3]]) -> Encoded {
    if let Some(id) = ids.iter().find(|id| usize::from(**id) >= palette.len()) {
        let reason = format!("id {id} is not one of the {} classes", palette.len());
        return Err(ExportError::Encode { what: "class picture", width, height, reason });
    }
    png("class picture", ids, [width, height], Filter::Up, |encoder| {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.concat());
    })
}

fn png(
    what: &'static str,
    data: &[u8],
    [width, height]: [u32; 2],
    filter: Filter,
    set_up: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Encoded {
    let failed =
        |e: png::EncodingError| ExportError::Encode { what, width, height, reason: e.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    set_up(&mut encoder);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(filter);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth picture with a hard edge.
    fn picture(width: u32, height: u32) -> Vec<u8> {
        let pixel = |i: u32| {
            let (x, y) = (i % width, i / width);
            let edge = if x + y > width { 90 } else { 0 };
            [(x * 150 / width) as u8 + edge, (y * 150 / height) as u8 + edge, 60 + edge]
        };
        (0..width * height).flat_map(pixel).collect()
    }

    fn decoded(bytes: &[u8], format: image::ImageFormat) -> image::DynamicImage {
        image::load_from_memory_with_format(bytes, format).unwrap()
    }

    fn psnr(a: &[u8], b: &[u8]) -> f64 {
        assert_eq!(a.len(), b.len());
        let square = |(x, y): (&u8, &u8)| (f64::from(*x) - f64::from(*y)).powi(2);
        let mse = a.iter().zip(b).map(square).sum::<f64>() / a.len() as f64;
        10.0 * libm::log10(255.0 * 255.0 / mse)
    }

    #[test]
    fn png_pictures_come_back_exactly() {
        for (w, h) in [(1, 1), (37, 20), (64, 48)] {
            let rgb = picture(w, h);
            let bytes = PictureFormat::Png.encode(&rgb, w, h).unwrap();
            assert_eq!(decoded(&bytes, image::ImageFormat::Png).into_rgb8().into_raw(), rgb);
        }
    }

    #[test]
    fn jpegs_come_back_close_and_at_any_size() {
        for (w, h) in [(1, 1), (37, 20), (64, 48), (8, 8)] {
            let rgb = picture(w, h);
            for (quality, floor) in [(100, 45.0), (95, 36.0), (92, 31.0), (75, 27.0), (1, 8.0)] {
                let bytes = PictureFormat::Jpeg(quality).encode(&rgb, w, h).unwrap();
                let back = decoded(&bytes, image::ImageFormat::Jpeg).into_rgb8();
                assert_eq!(back.dimensions(), (w, h));
                let got = psnr(&back.into_raw(), &rgb);
                assert!(got > floor, "{w} x {h} at quality {quality}: {got:.1} dB");
            }
        }
    }

    #[test]
    fn fine_patterns_keep_their_mean_colour() {
        // Columns of red and blue: the first of each four would make all of it red.
        let rgb: Vec<u8> = [200, 30, 30, 30, 30, 200].repeat(16 * 33);
        let bytes = PictureFormat::Jpeg(90).encode(&rgb, 32, 33).unwrap();
        let back = decoded(&bytes, image::ImageFormat::Jpeg).into_rgb8().into_raw();
        for c in 0..3 {
            let mean = |data: &[u8]| {
                data.iter().skip(c).step_by(3).map(|v| f64::from(*v)).sum::<f64>() / (32.0 * 33.0)
            };
            let (got, wanted) = (mean(&back), mean(&rgb));
            assert!((got - wanted).abs() < 3.0, "{c}: {got} {wanted}");
        }
    }

    #[test]
    fn ids_keep_sixteen_bits() {
        let ids: Vec<u16> = (0..35 * 20).map(|i| (i * 97 + 13) as u16).collect();
        let bytes = png_ids(&ids, 35, 20).unwrap();
        let image::DynamicImage::ImageLuma16(back) = decoded(&bytes, image::ImageFormat::Png)
        else {
            panic!("16-bit grey expected");
        };
        assert_eq!(back.into_raw(), ids);
    }

    #[test]
    fn classes_show_their_colours() {
        let palette = [[0, 0, 0], [220, 20, 60], [1, 2, 3]];
        let ids: Vec<u8> = (0..30 * 7).map(|i| (i % 3) as u8).collect();
        let bytes = png_palette(&ids, 30, 7, &palette).unwrap();
        let colors: Vec<u8> = ids.iter().flat_map(|id| palette[usize::from(*id)]).collect();
        assert_eq!(decoded(&bytes, image::ImageFormat::Png).into_rgb8().into_raw(), colors);
        let error = png_palette(&[3], 1, 1, &palette).unwrap_err().to_string();
        assert!(error.contains("id 3 is not one of the 3 classes"), "{error}");
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        for format in [PictureFormat::Png, PictureFormat::Jpeg(92)] {
            assert!(format.encode(&[0; 10], 2, 2).is_err());
            assert!(format.encode(&[], 0, 0).is_err());
        }
        let error = PictureFormat::Jpeg(92).encode(&[], 70_000, 1).unwrap_err().to_string();
        assert!(error.contains("65,535"), "{error}");
    }
}
