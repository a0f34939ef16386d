//! The picture that procedural textures are painted on, and small colour maths.
//!
//! Colours are sRGB triples 0..1, mixed as painters mix on a screen. Everything wraps at the
//! canvas's sides, so every painting tiles.

use super::dice::Dice;
use super::field::Field;
use crate::library::texture::{Encoding, Texture, colors_from_srgb, steps};

/// log2 of the canvas's side.
pub(super) const LOG2_SIDE: u32 = 9;
/// Pixels along a side of the canvas.
pub(super) const SIDE: usize = 1 << LOG2_SIDE;
/// The same as a length.
pub(super) const FULL: f32 = SIDE as f32;

/// An sRGB colour, 0..1 each.
pub(super) type Rgb = [f32; 3];

pub(super) const WHITE: Rgb = [1.0; 3];
pub(super) const BLACK: Rgb = [0.0; 3];

/// `t` 0 is a, 1 is b.
pub(super) fn mix(a: Rgb, b: Rgb, t: f32) -> Rgb {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * t)
}

/// Brighter or darker.
pub(super) fn lit(a: Rgb, factor: f32) -> Rgb {
    a.map(|v| v * factor)
}

/// From 0xRRGGBB.
pub(super) const fn hex(code: u32) -> Rgb {
    [
        (code >> 16 & 255) as f32 / 255.0,
        (code >> 8 & 255) as f32 / 255.0,
        (code & 255) as f32 / 255.0,
    ]
}

/// Perlin's step without jumps in the second derivative, 0..1 -> 0..1.
pub(super) fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// 0 at and below `low`, 1 at and above `high`, smooth between.
pub(super) fn smooth(low: f32, high: f32, v: f32) -> f32 {
    let t = ((v - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The largest whole number that is not above `v`, which is within four millions of 0.
///
/// The standard function is a call on machines whose oldest models lack the instruction, and the
/// standard conversion has to look for numbers out of range.
#[inline(always)]
pub(super) fn floor(v: f32) -> i32 {
    /// 1.5 * 2^23: a sum with it has no binary places left, and the number in its lowest bits.
    const SHIFT: f32 = 12_582_912.0;
    let nearest = (v + SHIFT).to_bits().wrapping_sub(SHIFT.to_bits()) as i32;
    nearest - i32::from(nearest as f32 > v)
}

/// What is above the largest whole number that is not above `v`.
pub(super) fn fract(v: f32) -> f32 {
    v - floor(v) as f32
}

/// Sine of an angle in turns, to 0.001: a parabola, refined once.
pub(super) fn sin_turns(turns: f32) -> f32 {
    let t = turns - floor(turns + 0.5) as f32;
    let y = 8.0 * t - 16.0 * t * t.abs();
    0.225 * (y * y.abs() - y) + y
}

pub(super) fn cos_turns(turns: f32) -> f32 {
    sin_turns(turns + 0.25)
}

/// A colour on a sequence of colours, 0 the first, 1 the last.
pub(super) fn ramp(colors: &[Rgb], t: f32) -> Rgb {
    let p = t.clamp(0.0, 1.0) * (colors.len() - 1) as f32;
    let i = (p as usize).min(colors.len() - 2);
    mix(colors[i], colors[i + 1], p - i as f32)
}

/// Hue 0..1 round the circle, saturation and value 0..1.
pub(super) fn hsv(hue: f32, saturation: f32, value: f32) -> Rgb {
    [5.0, 3.0, 1.0].map(|n| {
        let k = (n + hue * 6.0).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

/// Colours that go together.
const PALETTES: [[u32; 5]; 24] = [
    [0x264653, 0x2a9d8f, 0xe9c46a, 0xf4a261, 0xe76f51],
    [0x1d3557, 0x457b9d, 0xa8dadc, 0xf1faee, 0xe63946],
    [0x0b132b, 0x1c2541, 0x3a506b, 0x5bc0be, 0xe8f1f2],
    [0x606c38, 0x283618, 0xfefae0, 0xdda15e, 0xbc6c25],
    [0x8ecae6, 0x219ebc, 0x023047, 0xffb703, 0xfb8500],
    [0xcdb4db, 0xffc8dd, 0xffafcc, 0xbde0fe, 0xa2d2ff],
    [0x2b2d42, 0x8d99ae, 0xedf2f4, 0xef233c, 0xd90429],
    [0x582f0e, 0x7f4f24, 0x936639, 0xa68a64, 0xb6ad90],
    [0x10002b, 0x3c096c, 0x7b2cbf, 0xc77dff, 0xe0aaff],
    [0x386641, 0x6a994e, 0xa7c957, 0xf2e8cf, 0xbc4749],
    [0x03071e, 0x6a040f, 0xd00000, 0xf48c06, 0xffba08],
    [0x22223b, 0x4a4e69, 0x9a8c98, 0xc9ada7, 0xf2e9e4],
    [0x05668d, 0x028090, 0x00a896, 0x02c39a, 0xf0f3bd],
    [0x5f0f40, 0x9a031e, 0xfb8b24, 0xe36414, 0x0f4c5c],
    [0xf8f9fa, 0xced4da, 0x868e96, 0x495057, 0x212529],
    [0x355070, 0x6d597a, 0xb56576, 0xe56b6f, 0xeaac8b],
    [0x006d77, 0x83c5be, 0xedf6f9, 0xffddd2, 0xe29578],
    [0x14213d, 0xfca311, 0xe5e5e5, 0xffffff, 0x000000],
    [0x4f000b, 0x720026, 0xce4257, 0xff7f51, 0xff9b54],
    [0x7400b8, 0x5e60ce, 0x4ea8de, 0x56cfe1, 0x80ffdb],
    [0x3d2c2e, 0x424c55, 0xd1ccdc, 0xf5edf0, 0x886f68],
    [0xff0054, 0x9e0059, 0x390099, 0xffbd00, 0xff5400],
    [0x1b4332, 0x2d6a4f, 0x52b788, 0xb7e4c7, 0xd8f3dc],
    [0x401f3e, 0x3f2e56, 0x453f78, 0x759aab, 0xfaf2a1],
];

/// Five colours that go together, in random order.
pub(super) fn palette(dice: &mut Dice) -> [Rgb; 5] {
    let mut colors = dice.pick(&PALETTES).map(hex);
    dice.shuffle(&mut colors);
    colors
}

/// Five colours that go together, from dark to light.
pub(super) fn shaded_palette(dice: &mut Dice) -> [Rgb; 5] {
    let mut colors = dice.pick(&PALETTES).map(hex);
    colors.sort_by(|a, b| luma(*a).total_cmp(&luma(*b)));
    colors
}

/// How bright a colour looks, 0..1.
pub(super) fn luma([r, g, b]: Rgb) -> f32 {
    0.3 * r + 0.59 * g + 0.11 * b
}

/// The picture.
#[derive(Clone, Debug)]
pub(super) struct Canvas(pub Vec<Rgb>);

impl Canvas {
    pub fn filled(color: Rgb) -> Self {
        Self(vec![color; SIDE * SIDE])
    }

    /// Each pixel by itself.
    pub fn from_fn(mut f: impl FnMut(usize, usize) -> Rgb) -> Self {
        let mut pixels = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            for x in 0..SIDE {
                pixels.push(f(x, y));
            }
        }
        Self(pixels)
    }

    /// Each pixel from the value of a field there.
    pub fn from_field(field: &Field, f: impl Fn(f32) -> Rgb) -> Self {
        Self(field.0.iter().map(|&v| f(v)).collect())
    }

    /// Each pixel anew.
    pub fn repaint(&mut self, mut f: impl FnMut(usize, usize, Rgb) -> Rgb) {
        for (i, pixel) in self.0.iter_mut().enumerate() {
            *pixel = f(i % SIDE, i / SIDE, *pixel);
        }
    }

    /// Multiplies by 1 + `strength` * field.
    pub fn shade(&mut self, field: &Field, strength: f32) {
        for (pixel, &v) in self.0.iter_mut().zip(&field.0) {
            *pixel = lit(*pixel, 1.0 + strength * v);
        }
    }

    /// Film grain: each pixel's brightness on its own, up to `strength` up or down.
    pub fn grain(&mut self, dice: &mut Dice, strength: f32) {
        for chunk in self.0.chunks_mut(4) {
            let bits = dice.bits();
            for (k, pixel) in chunk.iter_mut().enumerate() {
                let v = (bits >> (16 * k) & 0xffff) as f32 / 32768.0 - 1.0;
                *pixel = pixel.map(|c| c + strength * v);
            }
        }
    }

    fn blend(&mut self, x: i32, y: i32, color: Rgb, alpha: f32) {
        let wrap = |v: i32| (v & (SIDE as i32 - 1)) as usize;
        let pixel = &mut self.0[wrap(y) * SIDE + wrap(x)];
        *pixel = mix(*pixel, color, alpha);
    }

    /// Paints within `reach` of a place; the function gets the offset from there in pixels and
    /// gives a colour and how much of it.
    pub fn stamp(&mut self, [cx, cy]: [f32; 2], reach: f32, f: impl Fn(f32, f32) -> (Rgb, f32)) {
        self.stamp_box([cx - reach, cy - reach], [cx + reach, cy + reach], |x, y| {
            f(x - cx, y - cy)
        });
    }

    /// Paints within a box; the function gets the place.
    pub fn stamp_box(&mut self, low: [f32; 2], high: [f32; 2], f: impl Fn(f32, f32) -> (Rgb, f32)) {
        for y in low[1].floor() as i32..high[1].ceil() as i32 {
            for x in low[0].floor() as i32..high[0].ceil() as i32 {
                let (color, alpha) = f(x as f32 + 0.5, y as f32 + 0.5);
                if alpha > 0.0 {
                    self.blend(x, y, color, alpha.min(1.0));
                }
            }
        }
    }

    /// A disc with an edge of one pixel.
    pub fn disc(&mut self, center: [f32; 2], radius: f32, color: Rgb, alpha: f32) {
        self.stamp(center, radius + 1.0, |dx, dy| {
            let d = (dx * dx + dy * dy).sqrt();
            (color, alpha * (radius + 0.5 - d).clamp(0.0, 1.0))
        });
    }

    /// A rectangle with sharp edges, from its upper left corner.
    pub fn rect(&mut self, [x, y]: [f32; 2], [w, h]: [f32; 2], color: Rgb, alpha: f32) {
        self.stamp_box([x, y], [x + w, y + h], |px, py| {
            let cover = |p: f32, low: f32, size: f32| {
                ((p - low + 0.5).clamp(0.0, 1.0)) * ((low + size - p + 0.5).clamp(0.0, 1.0))
            };
            (color, alpha * cover(px, x, w) * cover(py, y, h))
        });
    }

    /// A line with round ends; `soft` pixels of its edge fade.
    pub fn stroke(
        &mut self,
        a: [f32; 2],
        b: [f32; 2],
        width: f32,
        soft: f32,
        color: Rgb,
        alpha: f32,
    ) {
        let reach = width * 0.5 + soft + 1.0;
        let d = [b[0] - a[0], b[1] - a[1]];
        let length2 = (d[0] * d[0] + d[1] * d[1]).max(1e-6);
        let low = [a[0].min(b[0]) - reach, a[1].min(b[1]) - reach];
        let high = [a[0].max(b[0]) + reach, a[1].max(b[1]) + reach];
        self.stamp_box(low, high, |x, y| {
            let p = [x - a[0], y - a[1]];
            let t = ((p[0] * d[0] + p[1] * d[1]) / length2).clamp(0.0, 1.0);
            let (ox, oy) = (p[0] - t * d[0], p[1] - t * d[1]);
            let distance = (ox * ox + oy * oy).sqrt();
            let cover = (width * 0.5 + soft * 0.5 + 0.5 - distance) / (soft + 1.0);
            (color, alpha * cover.clamp(0.0, 1.0))
        });
    }

    /// An ellipse with a direction (unit vector), half length and half width.
    pub fn ellipse(
        &mut self,
        center: [f32; 2],
        [ux, uy]: [f32; 2],
        [long, wide]: [f32; 2],
        f: impl Fn(f32, f32) -> Rgb,
    ) {
        self.stamp(center, long.max(wide) + 1.0, |dx, dy| {
            let (s, t) = ((dx * ux + dy * uy) / long, (dy * ux - dx * uy) / wide);
            let inside = 1.0 - s * s - t * t;
            (f(s, t), (inside * wide * 0.5 + 0.5).clamp(0.0, 1.0))
        });
    }

    /// The finished texture, opaque.
    pub fn into_texture(self, encoding: Encoding) -> Texture {
        let plain = |p: &Rgb| {
            let [r, g, b] = p.map(|v| steps(v, 255.0));
            r | g << 8 | b << 16 | 0xff00_0000
        };
        let texels = match encoding {
            Encoding::Color => colors_from_srgb(&self.0),
            Encoding::Linear => self.0.iter().map(plain).collect(),
        };
        Texture::from_level0(LOG2_SIDE, encoding, texels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_are_sines() {
        for i in -400..400 {
            let t = i as f32 / 97.0;
            let exact = libm::sin(f64::from(t) * std::f64::consts::TAU) as f32;
            assert!((sin_turns(t) - exact).abs() < 2e-3, "{t}");
        }
    }

    #[test]
    fn hues_go_round_the_circle() {
        for (hue, rgb) in
            [(0.0, [1.0, 0.0, 0.0]), (1.0 / 3.0, [0.0, 1.0, 0.0]), (2.0 / 3.0, [0.0, 0.0, 1.0])]
        {
            for (a, b) in hsv(hue, 1.0, 1.0).into_iter().zip(rgb) {
                assert!((a - b).abs() < 1e-5, "{hue}");
            }
        }
        assert_eq!(hsv(0.3, 0.0, 0.7), [0.7; 3]);
    }

    #[test]
    fn what_is_painted_over_one_side_comes_in_at_the_other() {
        let mut canvas = Canvas::filled(BLACK);
        canvas.disc([0.0, 0.0], 10.0, WHITE, 1.0);
        let last = SIDE - 1;
        for (x, y) in [(0, 0), (last, 0), (0, last), (last, last)] {
            assert_eq!(canvas.0[y * SIDE + x], WHITE);
        }
        let painted = canvas.0.iter().map(|p| p[0]).sum::<f32>();
        assert!((painted - std::f32::consts::PI * 100.0).abs() < 8.0, "{painted}");
    }
}
