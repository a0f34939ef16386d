//! Square textures with their mip levels, and how they are made from pixels.

use std::sync::OnceLock;

use crate::base::color::{linear_from_srgb, srgb_from_linear};

/// How a texture's bytes are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// sRGB colour; filtered in linear light.
    Srgb,
    /// Plain numbers: masks, normals.
    Linear,
}

/// A square power-of-two texture of RGBA8 texels with all mip levels down to 1x1.
///
/// Level k has side `1 << (log2_size - k)` and starts at [`Texture::level_offset`] in `texels`;
/// rows run downwards. A texel is `r | g << 8 | b << 16 | a << 24`.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// log2 of the side of level 0.
    pub log2_size: u32,
    /// How the bytes are meant.
    pub encoding: Encoding,
    /// All levels, largest first.
    pub texels: Vec<u32>,
}

impl Texture {
    /// Index in `texels` of the first texel of a level.
    #[must_use]
    pub const fn level_offset(log2_size: u32, level: u32) -> usize {
        // Sum of 4^(n - k) for k in 0..level, with n = log2_size; also for the level after the last.
        ((1usize << (2 * (log2_size + 1))) - (1usize << (2 * (log2_size + 1 - level)))) / 3
    }

    /// A texture from its finest level, `4^log2_size` texels; the other levels are means of four,
    /// colours in linear light, alpha and plain numbers as they stand.
    ///
    /// # Panics
    /// When the number of texels is another.
    #[must_use]
    pub fn from_level0(log2_size: u32, encoding: Encoding, level0: Vec<u32>) -> Self {
        assert_eq!(level0.len(), 1 << (2 * log2_size), "one texel for each place of level 0");
        let mut texels = level0;
        let all = Self::level_offset(log2_size, log2_size + 1);
        texels.reserve_exact(all - texels.len());
        texels.resize(all, 0);
        let tables = Tables::get();
        for level in 1..=log2_size {
            let side = 1usize << (log2_size - level);
            let (above, below) = texels.split_at_mut(Self::level_offset(log2_size, level));
            let above = &above[Self::level_offset(log2_size, level - 1)..];
            let rows = above.chunks_exact(4 * side).zip(below.chunks_exact_mut(side));
            for (two_rows, out) in rows {
                let (upper, lower) = two_rows.split_at(2 * side);
                let fours = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
                for (out, (&[a, b], &[c, d])) in out.iter_mut().zip(fours) {
                    *out = match encoding {
                        Encoding::Srgb => tables.srgb_mean([a, b, c, d]),
                        Encoding::Linear => plain_mean([a, b, c, d]),
                    };
                }
            }
        }
        Self { log2_size, encoding, texels }
    }

    /// A texture from an RGBA8 picture of any size, `width * height * 4` bytes, rows downwards.
    ///
    /// The picture is stretched to a square whose side is the power of two at or above its longer
    /// side, but at most `1 << max_log2_size`; each texel is the mean of what it covers.
    ///
    /// # Panics
    /// When a side is 0 or the number of bytes is another.
    #[must_use]
    pub fn from_rgba8(
        width: u32,
        height: u32,
        bytes: &[u8],
        encoding: Encoding,
        max_log2_size: u32,
    ) -> Self {
        assert!(width > 0 && height > 0, "a picture has pixels");
        let (w, h) = (width as usize, height as usize);
        assert_eq!(bytes.len(), w * h * 4, "four bytes for each pixel");
        let log2_size = width.max(height).next_power_of_two().ilog2().min(max_log2_size);
        let level0 = if w == 1 << log2_size && h == 1 << log2_size {
            bytes.chunks_exact(4).map(|p| u32::from_le_bytes([p[0], p[1], p[2], p[3]])).collect()
        } else {
            resample(w, h, bytes, encoding, 1 << log2_size)
        };
        Self::from_level0(log2_size, encoding, level0)
    }

    /// Bytes that the texels occupy.
    #[must_use]
    pub const fn size_bytes(&self) -> usize {
        self.texels.len() * 4
    }
}

/// sRGB bytes to linear 16-bit numbers and back.
struct Tables {
    linear: [u16; 256],
    /// Index: linear / 4.
    srgb: Vec<u8>,
}

impl Tables {
    fn get() -> &'static Self {
        static TABLES: OnceLock<Tables> = OnceLock::new();
        TABLES.get_or_init(|| Self {
            linear: std::array::from_fn(|i| {
                (linear_from_srgb(i as f32 / 255.0) * 65535.0 + 0.5) as u16
            }),
            srgb: (0..1 << 14)
                .map(|i| {
                    (srgb_from_linear((i as f32 * 4.0 + 2.0) / 65535.0).min(1.0) * 255.0 + 0.5)
                        as u8
                })
                .collect(),
        })
    }

    /// The mean of four colours in linear light; of their alpha as it stands.
    fn srgb_mean(&self, texels: [u32; 4]) -> u32 {
        let channel = |shift: u32| {
            let linear = |texel: u32| u32::from(self.linear[(texel >> shift & 255) as usize]);
            let sum: u32 = texels.iter().map(|&texel| linear(texel)).sum();
            u32::from(self.srgb[(sum / 16) as usize]) << shift
        };
        channel(0) | channel(8) | channel(16) | plain_mean(texels) & 0xff00_0000
    }
}

/// The mean of four texels, channel by channel, rounded to nearest.
fn plain_mean(texels: [u32; 4]) -> u32 {
    // Two channels at a time, each with room for the sum of four.
    const EVEN: u32 = 0x00ff_00ff;
    let mean = |shift: u32| {
        let sum: u32 = texels.iter().map(|texel| texel >> shift & EVEN).sum();
        (sum + 0x0002_0002) >> 2 & EVEN
    };
    mean(0) | mean(8) << 8
}

/// For each place of an axis of `to` places: the first source place and the weights from there.
fn axis_weights(from: usize, to: usize) -> Vec<(usize, Vec<f32>)> {
    let ratio = from as f64 / to as f64;
    // A tent that reaches one source pixel when enlarging, and one target pixel when reducing.
    let reach = ratio.max(1.0);
    (0..to)
        .map(|i| {
            let center = (i as f64 + 0.5) * ratio;
            let first = (center - reach).floor().max(0.0) as usize;
            let last = ((center + reach).ceil() as usize).min(from);
            let raw: Vec<f64> = (first..last)
                .map(|j| (1.0 - ((j as f64 + 0.5 - center) / reach).abs()).max(0.0))
                .collect();
            let sum: f64 = raw.iter().sum();
            (first, raw.iter().map(|w| (w / sum) as f32).collect())
        })
        .collect()
}

/// Stretches a picture to a square, rows first, in linear light where it is a colour.
fn resample(w: usize, h: usize, bytes: &[u8], encoding: Encoding, side: usize) -> Vec<u32> {
    let tables = Tables::get();
    let decode = |byte: u8, channel: usize| {
        if encoding == Encoding::Srgb && channel < 3 {
            f32::from(tables.linear[usize::from(byte)])
        } else {
            f32::from(byte) * 257.0
        }
    };
    let columns = axis_weights(w, side);
    let mut narrow = vec![[0.0f32; 4]; side * h];
    let mut row = vec![[0.0f32; 4]; w];
    for y in 0..h {
        for (pixel, source) in row.iter_mut().zip(bytes[y * w * 4..][..w * 4].chunks_exact(4)) {
            *pixel = std::array::from_fn(|c| decode(source[c], c));
        }
        for (out, (first, weights)) in narrow[y * side..][..side].iter_mut().zip(&columns) {
            *out = weighted(weights, &row[*first..]);
        }
    }
    let rows = axis_weights(h, side);
    let mut out = Vec::with_capacity(side * side);
    for (first, weights) in &rows {
        for x in 0..side {
            let mut sum = [0.0f32; 4];
            for (k, &weight) in weights.iter().enumerate() {
                let pixel = narrow[(first + k) * side + x];
                for c in 0..4 {
                    sum[c] += pixel[c] * weight;
                }
            }
            out.push(u32::from_le_bytes(std::array::from_fn(|c| {
                let value = sum[c].clamp(0.0, 65535.0);
                if encoding == Encoding::Srgb && c < 3 {
                    tables.srgb[value as usize / 4]
                } else {
                    (value / 257.0 + 0.5) as u8
                }
            })));
        }
    }
    out
}

fn weighted(weights: &[f32], pixels: &[[f32; 4]]) -> [f32; 4] {
    let mut sum = [0.0; 4];
    for (&weight, pixel) in weights.iter().zip(pixels) {
        for c in 0..4 {
            sum[c] += pixel[c] * weight;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texel(texture: &Texture, level: u32, x: usize, y: usize) -> [u8; 4] {
        let side = 1 << (texture.log2_size - level);
        texture.texels[Texture::level_offset(texture.log2_size, level) + y * side + x].to_le_bytes()
    }

    #[test]
    fn a_plain_colour_stays_itself_on_all_levels() {
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            for v in 0..=255u8 {
                let color = [v, 255 - v, v / 2, v];
                let t = Texture::from_level0(2, encoding, vec![u32::from_le_bytes(color); 16]);
                assert_eq!(t.texels.len(), 21);
                assert!(t.texels.iter().all(|&t| t.to_le_bytes() == color), "{encoding:?} {v}");
            }
        }
    }

    #[test]
    fn black_and_white_make_middle_grey_in_their_own_sense() {
        let board = [0xff00_0000, 0xffff_ffff, 0xffff_ffff, 0xff00_0000].to_vec();
        let grey = |e| texel(&Texture::from_level0(1, e, board.clone()), 1, 0, 0);
        // Half the light is 0.5 linear, which is 187.5 in sRGB.
        assert!(matches!(grey(Encoding::Srgb), [187 | 188, 187 | 188, 187 | 188, 255]));
        assert_eq!(grey(Encoding::Linear), [128, 128, 128, 255]);
    }

    #[test]
    fn sides_become_powers_of_two_under_the_cap() {
        for (w, h, cap, log2) in [
            (1, 1, 9, 0),
            (3, 2, 9, 2),
            (512, 512, 9, 9),
            (300, 100, 9, 9),
            (600, 20, 9, 9),
            (600, 20, 10, 10),
        ] {
            let t =
                Texture::from_rgba8(w, h, &vec![200; (w * h * 4) as usize], Encoding::Srgb, cap);
            assert_eq!(t.log2_size, log2, "{w}x{h}");
            assert_eq!(t.texels.len(), Texture::level_offset(log2, log2) + 1);
            assert!(t.texels.iter().all(|&t| t == 0xc8c8_c8c8), "{w}x{h}");
        }
    }

    #[test]
    fn reducing_keeps_the_mean_light_and_the_orientation() {
        // Left half black, right half white, 40 x 30 -> 8 x 8.
        let bytes: Vec<u8> =
            (0..40 * 30).flat_map(|i| [if i % 40 < 20 { 0 } else { 255 }, 0, 0, 255]).collect();
        let t = Texture::from_rgba8(40, 30, &bytes, Encoding::Srgb, 3);
        assert_eq!(t.log2_size, 3);
        for y in 0..8 {
            assert_eq!(texel(&t, 0, 0, y)[0], 0);
            assert_eq!(texel(&t, 0, 7, y)[0], 255);
        }
        assert!((i32::from(texel(&t, 3, 0, 0)[0]) - 188).abs() <= 1);
    }
}
