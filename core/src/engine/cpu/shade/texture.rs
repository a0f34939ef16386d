//! Trilinear filtering of textures, eight look-ups at a time.
//!
//! Texels are decoded before they are mixed, so that colours are filtered in linear light.

use crate::engine::cpu::simd::{F32x8, I32x8};
use crate::library::texture::{Encoding, Texture};

/// A texture ready for look-ups.
#[derive(Clone, Copy)]
pub(super) struct Sampler<'a> {
    texels: &'a [u32],
    log2_size: i32,
    color: bool,
}

impl<'a> Sampler<'a> {
    pub(super) fn new(texture: &'a Texture) -> Self {
        Self {
            texels: &texture.texels,
            log2_size: texture.log2_size as i32,
            color: texture.encoding == Encoding::Color,
        }
    }

    /// The first `C` channels at texture coordinates that wrap; `footprint` is log2 of a pixel's
    /// size in them.
    #[inline(always)]
    pub(super) fn sample<const AVX2: bool, const C: usize>(
        &self,
        uv: [F32x8<AVX2>; 2],
        footprint: F32x8<AVX2>,
    ) -> [F32x8<AVX2>; C] {
        let uv = [uv[0] - uv[0].floor(), uv[1] - uv[1].floor()];
        let top = self.log2_size as f32;
        let level = (footprint + F32x8::splat(top)).clamp(0.0, top);
        let lower = level.floor();
        let between = level - lower;
        let mut level = lower.round_i32();
        let mut out = [F32x8::ZERO; C];
        // Beyond the last level there is nothing to mix in.
        for share in [F32x8::ONE - between, between] {
            if share.gt(F32x8::ZERO).any() {
                if self.color {
                    self.add_bilinear::<AVX2, C, true>(uv, level, share, &mut out);
                } else {
                    self.add_bilinear::<AVX2, C, false>(uv, level, share, &mut out);
                }
            }
            level = level + I32x8::splat(1);
        }
        let unit = F32x8::splat(if self.color { COLOR_UNIT } else { 1.0 / 255.0 });
        for c in 0..C {
            out[c] = out[c] * unit;
        }
        out
    }

    /// Adds a share of the mean of the four texels round a point of one level, in units of the
    /// decoding.
    #[inline(always)]
    fn add_bilinear<const AVX2: bool, const C: usize, const COLOR: bool>(
        &self,
        uv: [F32x8<AVX2>; 2],
        level: I32x8<AVX2>,
        share: F32x8<AVX2>,
        out: &mut [F32x8<AVX2>; C],
    ) {
        let one = I32x8::splat(1);
        let log2_side = I32x8::splat(self.log2_size) - level;
        let side = one.shl_each(log2_side);
        let half = F32x8::splat(0.5);
        let (x, y) = (uv[0] * side.to_f32() - half, uv[1] * side.to_f32() - half);
        let (left, top) = (x.floor(), y.floor());
        let (wx, wy) = (x - left, y - top);
        let (right, lower) = (wx * share, wy * share);
        let lower_right = right * wy;
        let (upper_right, lower_left) = (right - lower_right, lower - lower_right);
        let weights = [share - right - lower_left, upper_right, lower_left, lower_right];
        let texels = self.corners(log2_side, [left.round_i32(), top.round_i32()]);
        for (texels, weight) in texels.into_iter().zip(weights) {
            for c in 0..C {
                let (bits, mask) = if COLOR { (10, 1023) } else { (8, 255) };
                let number = ((texels >> (bits * c as u32)) & I32x8::splat(mask)).to_f32();
                let value = if COLOR { number * number } else { number };
                out[c] = out[c] + value * weight;
            }
        }
    }

    /// First texel of levels, as [`Texture::level_offset`] has it.
    #[inline(always)]
    fn level_start<const AVX2: bool>(&self, log2_side: I32x8<AVX2>) -> I32x8<AVX2> {
        /// Divides multiples of 3, modulo 2^32.
        const THIRD: i32 = 0xaaaa_aaab_u32 as i32;
        let all = I32x8::splat(4 << (2 * self.log2_size));
        (all - I32x8::splat(4).shl_each(log2_side + log2_side)) * I32x8::splat(THIRD)
    }

    /// The texels at a column and a row, to the right of it, below it, and below to the right;
    /// any texel beyond the last level.
    #[inline(always)]
    fn corners<const AVX2: bool>(
        &self,
        log2_side: I32x8<AVX2>,
        [left, top]: [I32x8<AVX2>; 2],
    ) -> [I32x8<AVX2>; 4] {
        let one = I32x8::splat(1);
        let last = one.shl_each(log2_side) - one;
        let start = self.level_start(log2_side);
        let left = left & last;
        let upper = start + (top & last).shl_each(log2_side);
        let lower = start + ((top + one) & last).shl_each(log2_side);
        if left.gt(last - one).any() {
            // Right of the last column comes the first.
            let right = (left + one) & last;
            return [
                (upper + left).gather_u32(self.texels),
                (upper + right).gather_u32(self.texels),
                (lower + left).gather_u32(self.texels),
                (lower + right).gather_u32(self.texels),
            ];
        }
        let [upper_left, upper_right] = (upper + left).gather_pairs(self.texels);
        let [lower_left, lower_right] = (lower + left).gather_pairs(self.texels);
        [upper_left, upper_right, lower_left, lower_right]
    }
}

/// Linear light of a square of what a colour's channel holds.
const COLOR_UNIT: f32 = 1.0 / (1023.0 * 1023.0);

/// log2 of a pixel's size in texture coordinates, from the change of (u, v) over one pixel to the
/// right and one pixel down: the longer of the two.
#[inline(always)]
pub(super) fn footprint<const AVX2: bool>(
    d_dx: [F32x8<AVX2>; 2],
    d_dy: [F32x8<AVX2>; 2],
) -> F32x8<AVX2> {
    let x2 = d_dx[0] * d_dx[0] + d_dx[1] * d_dx[1];
    let y2 = d_dy[0] * d_dy[0] + d_dy[1] * d_dy[1];
    log2(x2.max(y2).clamp(1e-20, 1e20)) * F32x8::splat(0.5)
}

/// log2 of positive numbers, to within 0.01: the exponent, and a parabola for the mantissa.
#[inline(always)]
fn log2<const AVX2: bool>(v: F32x8<AVX2>) -> F32x8<AVX2> {
    let bits = v.to_bits();
    let exponent = ((bits >> 23) - I32x8::splat(127)).to_f32();
    let mantissa = (bits & I32x8::splat(0x7f_ffff)).to_f32() * F32x8::splat(1.0 / 8_388_608.0);
    exponent + mantissa + F32x8::splat(0.344) * mantissa * (F32x8::ONE - mantissa)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::color::linear_from_srgb;
    use crate::library::texture::color_from_srgb8;

    /// Each level of one grey, 64 steps of sRGB brighter from level to level.
    fn stepped(log2_size: u32) -> Texture {
        let mut texels = Vec::new();
        for level in 0..=log2_size {
            let side = 1usize << (log2_size - level);
            texels.resize(texels.len() + side * side, color_from_srgb8([64 * level as u8; 3]));
        }
        Texture { log2_size, encoding: Encoding::Color, texels: texels.into() }
    }

    #[test]
    fn levels_start_where_textures_put_them() {
        for log2_size in 0..14 {
            let texture = Texture { log2_size, encoding: Encoding::Linear, texels: vec![0].into() };
            let sampler = Sampler::new(&texture);
            for level in 0..=log2_size {
                let log2_side = I32x8::<false>::splat((log2_size - level) as i32);
                let start = sampler.level_start(log2_side).0[0] as usize;
                assert_eq!(start, Texture::level_offset(log2_size, level));
            }
        }
    }

    #[test]
    fn log2_is_close() {
        for v in [1e-6f32, 0.3, 1.0, 1.44, 1.99, 700.0] {
            assert!((log2(F32x8::<false>::splat(v)).0[0] - libm::log2f(v)).abs() < 0.01);
        }
    }

    #[test]
    fn levels_are_mixed_in_linear_light() {
        let texture = stepped(3);
        let sampler = Sampler::new(&texture);
        let uv = [F32x8::<false>::splat(0.3), F32x8::<false>::splat(-7.6)];
        // A pixel of 1/4 of the texture: level 1; halfway to 1/2: level 1.5.
        let at = |footprint: f32| {
            sampler.sample::<false, 1>(uv, F32x8::<false>::splat(footprint))[0].0[0]
        };
        let of = |byte: f32| linear_from_srgb(byte / 255.0);
        assert!((at(-2.0) - of(64.0)).abs() < 2e-4);
        assert!((at(-1.5) - 0.5 * (of(64.0) + of(128.0))).abs() < 4e-4);
        assert!(at(-9.0) == 0.0 && (at(9.0) - of(192.0)).abs() < 4e-4);
    }

    #[test]
    fn the_middle_of_a_texel_is_the_texel() {
        let texels: Vec<u32> = (0..16).chain(0..4).chain(0..1).collect();
        let texture = Texture { log2_size: 2, encoding: Encoding::Linear, texels: texels.into() };
        let sampler = Sampler::new(&texture);
        let uv = [F32x8::<false>::splat(2.0 + 0.625), F32x8::<false>::splat(0.375)]; // column 2, row 1
        let got = sampler.sample::<false, 1>(uv, F32x8::<false>::splat(-8.0))[0].0[0];
        assert!((got * 255.0 - 6.0).abs() < 1e-4);
    }
}
