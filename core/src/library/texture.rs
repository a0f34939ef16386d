//! Square textures with their mip levels, and how they are made from pixels.

use std::sync::{Arc, OnceLock};

use crate::base::color::linear_from_srgb;

/// How a texture's texels are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Colour, `r | g << 10 | b << 20`: 1023 times the square root of linear light, 0..1.
    ///
    /// Light is a square away where sRGB needs a power, and 8-bit sRGB is kept to a fifth of a
    /// step. Filtered in linear light.
    Color,
    /// Plain numbers, `r | g << 8 | b << 16 | a << 24`: masks, normals.
    Linear,
}

/// A square power-of-two texture with all mip levels down to 1x1.
///
/// Level k has side `1 << (log2_size - k)` and starts at [`Texture::level_offset`] in `texels`;
/// rows run downwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// log2 of the side of level 0.
    pub log2_size: u32,
    /// How the texels are meant.
    pub encoding: Encoding,
    /// All levels, largest first.
    pub texels: Arc<[u32]>,
}

impl Texture {
    /// Index in `texels` of the first texel of a level.
    #[must_use]
    pub const fn level_offset(log2_size: u32, level: u32) -> usize {
        // Sum of 4^(n - k) for k in 0..level, with n = log2_size; also for the level after the last.
        ((1usize << (2 * (log2_size + 1))) - (1usize << (2 * (log2_size + 1 - level)))) / 3
    }

    /// A texture from its finest level, `4^log2_size` texels; the other levels are means of four,
    /// colours in linear light, plain numbers as they stand.
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
        let mut squares = vec![0.0; 1 << log2_size];
        for level in 1..=log2_size {
            let side = 1usize << (log2_size - level);
            let (above, below) = texels.split_at_mut(Self::level_offset(log2_size, level));
            let above = &above[Self::level_offset(log2_size, level - 1)..];
            let rows = above.chunks_exact(4 * side).zip(below.chunks_exact_mut(side));
            for (two_rows, out) in rows {
                let two_rows = two_rows.split_at(2 * side);
                match encoding {
                    Encoding::Color => color_means(two_rows, out, &mut squares),
                    Encoding::Linear => plain_means(two_rows, out),
                }
            }
        }
        Self { log2_size, encoding, texels: texels.into() }
    }

    /// A texture from an RGBA8 picture of any size, `width * height * 4` bytes, rows downwards;
    /// where it becomes a colour texture its colours are sRGB, and its alpha is dropped.
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
            let texel = |p: &[u8; 4]| match encoding {
                Encoding::Color => color_from_srgb8([p[0], p[1], p[2]]),
                Encoding::Linear => u32::from_le_bytes(*p),
            };
            bytes.as_chunks().0.iter().map(texel).collect()
        } else {
            resample(w, h, bytes, encoding, 1 << log2_size)
        };
        Self::from_level0(log2_size, encoding, level0)
    }

    /// The texture without its finest level; one texel stays as it is.
    #[must_use]
    pub fn halved(self) -> Self {
        let Some(log2_size) = self.log2_size.checked_sub(1) else { return self };
        let texels = self.texels[Self::level_offset(self.log2_size, 1)..].into();
        Self { log2_size, encoding: self.encoding, texels }
    }

    /// Bytes that the texels occupy.
    #[must_use]
    pub fn size_bytes(&self) -> usize {
        self.texels.len() * 4
    }
}

/// Largest number of a colour's channel.
const COLOR_MAX: f32 = 1023.0;
/// Finer than 8-bit sRGB by this factor are the steps that colours are painted in.
const SUB_STEPS: usize = 16;

/// The colour texels of sRGB colours 0..1, which may be out of range; to a sixteenth of an 8-bit
/// step.
#[must_use]
pub fn colors_from_srgb(pixels: &[[f32; 3]]) -> Vec<u32> {
    const SCALE: f32 = (255 * SUB_STEPS) as f32;
    /// Pixels at a time, so that all their steps are found together.
    const BLOCK: usize = 64;
    let roots = roots();
    let mut texels = Vec::with_capacity(pixels.len());
    let mut block = [0; 3 * BLOCK];
    for pixels in pixels.chunks(BLOCK) {
        for (step, v) in block.iter_mut().zip(pixels.as_flattened()) {
            *step = steps(*v, SCALE);
        }
        let rgb = block[..3 * pixels.len()].as_chunks().0;
        texels.extend(rgb.iter().map(|rgb| pack(roots, *rgb)));
    }
    texels
}

/// A number 0..1, or the nearest to it, in steps of which there are `count`, below 2^22: rounded
/// to nearest. The standard conversion has to look for numbers out of range.
#[inline(always)]
pub fn steps(v: f32, count: f32) -> u32 {
    let v = if v > 0.0 { v } else { 0.0 };
    let v = if v < 1.0 { v } else { 1.0 };
    round(v * count)
}

/// A number 0..2^22 rounded to nearest: a sum with 2^23 has no binary places left.
#[inline(always)]
fn round(v: f32) -> u32 {
    (v + 8_388_608.0).to_bits() & 0x003f_ffff
}

/// The colour texel of an 8-bit sRGB colour.
#[must_use]
pub fn color_from_srgb8(rgb: [u8; 3]) -> u32 {
    pack(roots(), rgb.map(|v| u32::from(v) * SUB_STEPS as u32))
}

/// What a channel holds for each step of sRGB; the steps beyond the last are not used.
type Roots = [u16; 256 * SUB_STEPS];

/// The colour texel of sRGB in steps.
#[inline(always)]
fn pack(roots: &Roots, rgb: [u32; 3]) -> u32 {
    let [r, g, b] = rgb.map(|step| u32::from(roots[step as usize % roots.len()]));
    r | g << 10 | b << 20
}

fn roots() -> &'static Roots {
    static ROOTS: OnceLock<Roots> = OnceLock::new();
    ROOTS.get_or_init(|| {
        let light = |step: usize| linear_from_srgb(step as f32 / (255 * SUB_STEPS) as f32);
        std::array::from_fn(|step| root_of_light(light(step).min(1.0)) as u16)
    })
}

/// What a channel holds for linear light 0..1, rounded to nearest.
fn root_of_light(light: f32) -> u32 {
    round(light.sqrt() * COLOR_MAX)
}

/// The colour texel of linear light, which may be out of range.
#[must_use]
pub fn color_from_linear(light: [f32; 3]) -> u32 {
    let [r, g, b] = light.map(|v| root_of_light(v.clamp(0.0, 1.0)));
    r | g << 10 | b << 20
}

/// Linear light of a colour texel.
#[must_use]
pub fn linear_from_color(texel: u32) -> [f32; 3] {
    [0, 10, 20].map(|shift| {
        let root = (texel >> shift & 1023) as f32 / COLOR_MAX;
        root * root
    })
}

/// Makes a row of colours from two of twice the length: the mean light of four.
fn color_means((upper, lower): (&[u32], &[u32]), out: &mut [u32], squares: &mut [f32]) {
    out.fill(0);
    for shift in [0, 10, 20] {
        // Sums stay below 2^24, so they are exact; by way of i32, which converts fastest.
        let square = |texel: u32| {
            let root = (texel >> shift & 1023) as i32 as f32;
            root * root
        };
        for ((sum, &a), &b) in squares.iter_mut().zip(upper).zip(lower) {
            *sum = square(a) + square(b);
        }
        for (out, [a, b]) in out.iter_mut().zip(squares.as_chunks().0) {
            *out |= round(((a + b) * 0.25).sqrt()) << shift;
        }
    }
}

/// Makes a row of plain texels from two of twice the length: the mean of four, channel by channel,
/// rounded to nearest.
fn plain_means((upper, lower): (&[u32], &[u32]), out: &mut [u32]) {
    // Two channels at a time, each with room for the sum of four.
    const EVEN: u32 = 0x00ff_00ff;
    let fours = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
    for (out, (&[a, b], &[c, d])) in out.iter_mut().zip(fours) {
        let mean = |shift: u32| {
            let sum: u32 = [a, b, c, d].iter().map(|texel| texel >> shift & EVEN).sum();
            (sum + 0x0002_0002) >> 2 & EVEN
        };
        *out = mean(0) | mean(8) << 8;
    }
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
    let light: [f32; 256] = std::array::from_fn(|i| linear_from_srgb(i as f32 / 255.0));
    let decode = |byte: u8| match encoding {
        Encoding::Color => light[usize::from(byte)],
        Encoding::Linear => f32::from(byte) / 255.0,
    };
    let encode = |v: [f32; 4]| match encoding {
        Encoding::Color => color_from_linear([v[0], v[1], v[2]]),
        Encoding::Linear => u32::from_le_bytes(v.map(|v| steps(v, 255.0) as u8)),
    };
    let columns = axis_weights(w, side);
    let mut narrow = vec![[0.0f32; 4]; side * h];
    let mut row = vec![[0.0f32; 4]; w];
    for y in 0..h {
        for (pixel, source) in row.iter_mut().zip(bytes[y * w * 4..][..w * 4].as_chunks().0) {
            let source: &[u8; 4] = source;
            *pixel = source.map(decode);
        }
        for (out, (first, weights)) in narrow[y * side..][..side].iter_mut().zip(&columns) {
            *out = weighted(weights, &row[*first..]);
        }
    }
    let mut out = Vec::with_capacity(side * side);
    for (first, weights) in &axis_weights(h, side) {
        for x in 0..side {
            let mut sum = [0.0f32; 4];
            for (k, &weight) in weights.iter().enumerate() {
                let pixel = narrow[(first + k) * side + x];
                for c in 0..4 {
                    sum[c] += pixel[c] * weight;
                }
            }
            out.push(encode(sum));
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

    #[test]
    fn halved_is_what_the_other_levels_are() {
        let whole = Texture::from_level0(1, Encoding::Linear, vec![0, 4, 8, 16]);
        let half = whole.halved();
        assert_eq!((half.log2_size, &half.texels[..]), (0, &[7][..]));
        assert_eq!(half.clone().halved(), half);
    }
    use crate::base::color::srgb_from_linear;

    fn texel(texture: &Texture, level: u32, x: usize, y: usize) -> u32 {
        let side = 1 << (texture.log2_size - level);
        texture.texels[Texture::level_offset(texture.log2_size, level) + y * side + x]
    }

    /// As 8-bit sRGB, not rounded.
    fn srgb8(texel: u32) -> [f32; 3] {
        linear_from_color(texel).map(|v| srgb_from_linear(v) * 255.0)
    }

    #[test]
    fn colours_are_kept_to_a_fifth_of_a_step() {
        for v in 0..=255u8 {
            let color = [v, 255 - v, v / 2];
            let kept = srgb8(color_from_srgb8(color));
            let painted = srgb8(colors_from_srgb(&[color.map(|v| f32::from(v) / 255.0)])[0]);
            for c in 0..3 {
                assert!((kept[c] - f32::from(color[c])).abs() < 0.2, "{color:?} {kept:?}");
                assert!((painted[c] - kept[c]).abs() < 1e-3, "{color:?} {painted:?}");
            }
        }
        assert_eq!(colors_from_srgb(&[[-3.0, 0.0, 7.0]]), [1023 << 20]);
        assert_eq!(color_from_linear([1.5, -1.0, 0.25]), 1023 | 512 << 20);
    }

    #[test]
    fn a_plain_colour_stays_itself_on_all_levels() {
        for encoding in [Encoding::Color, Encoding::Linear] {
            for v in 0..=255u8 {
                let color = match encoding {
                    Encoding::Color => color_from_srgb8([v, 255 - v, v / 2]),
                    Encoding::Linear => u32::from_le_bytes([v, 255 - v, v / 2, v]),
                };
                let t = Texture::from_level0(2, encoding, vec![color; 16]);
                assert_eq!(t.texels.len(), 21);
                assert!(t.texels.iter().all(|&t| t == color), "{encoding:?} {v}");
            }
        }
    }

    #[test]
    fn black_and_white_make_middle_grey_in_their_own_sense() {
        let (black, white) = (0, color_from_srgb8([255; 3]));
        let board = vec![black, white, white, black];
        let grey = texel(&Texture::from_level0(1, Encoding::Color, board), 1, 0, 0);
        // Half the light is 0.5 linear, which is 187.5 in sRGB.
        assert!(srgb8(grey).iter().all(|v| (v - 187.5).abs() < 0.2), "{:?}", srgb8(grey));
        let board = vec![0xff00_0000, 0xffff_ffff, 0xffff_ffff, 0xff00_0000];
        let grey = texel(&Texture::from_level0(1, Encoding::Linear, board), 1, 0, 0);
        assert_eq!(grey.to_le_bytes(), [128, 128, 128, 255]);
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
                Texture::from_rgba8(w, h, &vec![200; (w * h * 4) as usize], Encoding::Color, cap);
            assert_eq!(t.log2_size, log2, "{w}x{h}");
            assert_eq!(t.texels.len(), Texture::level_offset(log2, log2) + 1);
            let grey = color_from_srgb8([200; 3]);
            assert!(t.texels.iter().all(|&t| t == grey), "{w}x{h}");
        }
    }

    #[test]
    fn reducing_keeps_the_mean_light_and_the_orientation() {
        // Left half black, right half white, 40 x 30 -> 8 x 8.
        let bytes: Vec<u8> =
            (0..40 * 30).flat_map(|i| [if i % 40 < 20 { 0 } else { 255 }, 0, 0, 255]).collect();
        let t = Texture::from_rgba8(40, 30, &bytes, Encoding::Color, 3);
        assert_eq!(t.log2_size, 3);
        for y in 0..8 {
            assert!(texel(&t, 0, 0, y) == 0 && texel(&t, 0, 7, y) == 1023);
        }
        assert!((srgb8(texel(&t, 3, 0, 0))[0] - 187.5).abs() < 1.0);
    }
}
