//! Display: linear display light to the 8-bit picture, with grain where it is wanted.
//!
//! Transfer: sRGB (IEC 61966-2-1), in a polynomial of the fourth root that is within 0.01 of a step
//! of 255 of it.

use super::samples::{Layout, TILE};
use super::shade::TileColor;
use super::simd::{F32x8, I32x8, LANES, Vec3x8, kernel};
use crate::engine::noise::{self, GRAIN_STD, mixed};

/// Linear display light 0..1 to sRGB 0..1.
///
/// Above the linear toe a polynomial of degree 4 in the fourth root, fitted for the least largest
/// error.
#[inline(always)]
fn srgb<const AVX2: bool>(x: F32x8<AVX2>) -> F32x8<AVX2> {
    let s = F32x8::splat;
    let root = x.sqrt().sqrt();
    let curve = (((root * s(0.081_337_36) - s(0.335_520_42)) * root + s(1.122_698_9)) * root
        + s(0.196_129_22))
        * root
        - s(0.064_610_64);
    x.gt(s(0.003_130_8)).select(curve, x * s(12.92))
}

/// Linear display light to a byte of sRGB, with noise in 1/255.
#[inline(always)]
fn byte<const AVX2: bool>(v: F32x8<AVX2>, noise: F32x8<AVX2>) -> I32x8<AVX2> {
    (srgb(v.clamp(0.0, 1.0)) * F32x8::splat(255.0) + noise).clamp(0.0, 255.0).round_i32()
}

kernel! {
    /// Encodes a tile's colours: red, green and blue bytes of each pixel slot. Noise in 1/255 by
    /// pixel slot, or none.
    fn encode(color: &TileColor, noise: &[f32], bytes: &mut [[u8; 3]; TILE * TILE]) = encode_body
}

#[inline(always)]
fn encode_body<const AVX2: bool>(
    color: &TileColor,
    noise: &[f32],
    bytes: &mut [[u8; 3]; TILE * TILE],
) {
    for (from, bytes) in bytes.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
        let from = from * LANES;
        let noise = if noise.is_empty() { F32x8::ZERO } else { F32x8::load(&noise[from..]) };
        let [r, g, b] = color.each_ref().map(|plane| F32x8::<AVX2>::load(&plane[from..]));
        *bytes = self::bytes(Vec3x8::new(r, g, b), noise);
    }
}

/// Eight pixels of linear display light as bytes, with noise in 1/255.
#[inline(always)]
pub(super) fn bytes<const AVX2: bool>(color: Vec3x8<AVX2>, noise: F32x8<AVX2>) -> [[u8; 3]; LANES] {
    let (red, green, blue) = (byte(color.x, noise), byte(color.y, noise), byte(color.z, noise));
    let pixels = red | (green << 8) | (blue << 16);
    let mut out = [[0; 3]; LANES];
    // Four bytes at a time; the fourth is overwritten by the next pixel's first.
    let bytes = out.as_flattened_mut();
    for (lane, pixel) in pixels.0[..LANES - 1].iter().enumerate() {
        bytes[lane * 3..lane * 3 + 4].copy_from_slice(&pixel.to_le_bytes());
    }
    bytes[(LANES - 1) * 3..].copy_from_slice(&pixels.0[LANES - 1].to_le_bytes()[..3]);
    out
}

/// Grain of a pixel, in 1/255: the sum of four bytes of a hash, which is normally distributed but for
/// its tails, of the given standard deviation (a share of full scale). The key is mixed.
#[inline(always)]
pub(super) fn grain_of_pixel(std: f32, key: u32, [x, y]: [u32; 2]) -> f32 {
    let [a, b, c, d] = mixed(x.wrapping_add(mixed(y.wrapping_add(key)))).to_le_bytes();
    let sum = i32::from(a) + i32::from(b) + i32::from(c) + i32::from(d) - 510;
    sum as f32 * (std / GRAIN_STD * 255.0)
}

/// Grain of each pixel slot of a tile; see [`grain_of_pixel`].
pub(super) fn grain<const S: usize>(
    std: f32,
    key: u32,
    origin_px: [u32; 2],
    out: &mut [f32; TILE * TILE],
) {
    let key = mixed(key);
    for (out, xy) in out.iter_mut().zip(&Layout::<S>::SLOT_XY) {
        *out = grain_of_pixel(std, key, [0, 1].map(|axis| origin_px[axis] + u32::from(xy[axis])));
    }
}

/// The sensor's noise by pixel slot, each channel at standard deviation 1.
pub(super) fn sensor_noise<const S: usize>(key: u32, origin_px: [u32; 2], out: &mut TileColor) {
    let key = noise::sensor_key(key);
    for (slot, xy) in Layout::<S>::SLOT_XY.iter().enumerate() {
        let pixel = [0, 1].map(|axis| origin_px[axis] + u32::from(xy[axis]));
        for (channel, noise) in out.iter_mut().zip(noise::sensor_noise(key, pixel)) {
            channel[slot] = noise;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::color::srgb_from_linear;

    #[test]
    fn the_transfer_is_right_to_a_hundredth_of_a_step() {
        for i in 0..=100_000 {
            let x = i as f32 / 100_000.0;
            let error = (srgb(F32x8::<false>::splat(x)).0[0] - srgb_from_linear(x)).abs() * 255.0;
            assert!(error < 0.02, "{x}: {error}");
        }
    }

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        let mut color = Box::new([[0.0; TILE * TILE]; 3]);
        for byte in 0..256 {
            color[0][byte] = crate::base::color::linear_from_srgb(byte as f32 / 255.0);
        }
        let mut bytes = Box::new([[0; 3]; TILE * TILE]);
        encode(crate::engine::cpu::simd::Level::BASELINE, &color, &[], &mut bytes);
        for byte in 0..256 {
            assert_eq!(usize::from(bytes[byte][0]), byte);
        }
    }

    #[test]
    fn grain_has_the_wanted_spread_and_no_pattern() {
        let mut noise = [0.0; TILE * TILE];
        let (mut sum, mut squares, mut neighbours, mut count) = (0.0, 0.0, 0.0, 0.0);
        for tile in 0..64 {
            grain::<4>(0.02, 7, [tile % 8 * 32, tile / 8 * 32], &mut noise);
            for (pair, v) in noise.windows(2).zip(noise.map(f64::from)) {
                (sum, squares, count) = (sum + v, squares + v * v, count + 1.0);
                neighbours += f64::from(pair[0]) * f64::from(pair[1]);
            }
        }
        let std = (squares / count).sqrt();
        assert!((std - 5.1).abs() < 0.05, "{std}");
        assert!((sum / count).abs() < 0.06 && (neighbours / squares).abs() < 0.01);
    }
}
