//! Display: exposed light to the 8-bit picture.
//!
//! Tone curve: Narkowicz, "ACES filmic tone mapping curve" (2015). Transfer: sRGB (IEC 61966-2-1),
//! in a polynomial of the fourth root that is within 0.01 of a step of 255 of it.

use super::samples::TILE;
use super::shade::TileColor;
use super::simd::{F32x8, I32x8, LANES, kernel};

/// Exposed light to linear display light, 0..1.
#[inline(always)]
pub(super) fn tone_map<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    let s = F32x8::splat;
    let x = v.clamp(0.0, 1e4);
    let y = (x * (x * s(2.51) + s(0.03))) / (x * (x * s(2.43) + s(0.59)) + s(0.14));
    y.clamp(0.0, 1.0)
}

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

/// Linear display light to a byte of sRGB.
#[inline(always)]
fn byte<const AVX2: bool>(v: F32x8<AVX2>) -> I32x8<AVX2> {
    (srgb(v.clamp(0.0, 1.0)) * F32x8::splat(255.0)).clamp(0.0, 255.0).round_i32()
}

kernel! {
    /// Encodes a tile's colours: red, green and blue bytes of each pixel slot.
    fn encode(color: &TileColor, bytes: &mut [[u8; 3]; TILE * TILE]) = encode_body
}

#[inline(always)]
fn encode_body<const AVX2: bool>(color: &TileColor, bytes: &mut [[u8; 3]; TILE * TILE]) {
    for (from, bytes) in bytes.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
        let from = from * LANES;
        let red = byte::<AVX2>(F32x8::load(&color[0][from..from + LANES]));
        let green = byte::<AVX2>(F32x8::load(&color[1][from..from + LANES]));
        let blue = byte::<AVX2>(F32x8::load(&color[2][from..from + LANES]));
        let pixels = red | (green << 8) | (blue << 16);
        // Four bytes at a time; the fourth is overwritten by the next pixel's first.
        let bytes = bytes.as_flattened_mut();
        for (lane, pixel) in pixels.0[..LANES - 1].iter().enumerate() {
            bytes[lane * 3..lane * 3 + 4].copy_from_slice(&pixel.to_le_bytes());
        }
        bytes[(LANES - 1) * 3..].copy_from_slice(&pixels.0[LANES - 1].to_le_bytes()[..3]);
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
        encode(crate::engine::cpu::simd::Level::BASELINE, &color, &mut bytes);
        for byte in 0..256 {
            assert_eq!(usize::from(bytes[byte][0]), byte);
        }
    }

    #[test]
    fn the_tone_curve_rises_from_0_to_1() {
        let at = |x: f32| tone_map(F32x8::<false>::splat(x)).0[0];
        assert_eq!(at(0.0), 0.0);
        assert!(at(1e3) > 0.999 && at(f32::MAX) <= 1.0 && at(f32::NAN) == 0.0);
        assert!((1..1000).all(|i| at(i as f32 * 0.01) >= at((i - 1) as f32 * 0.01)));
    }
}
