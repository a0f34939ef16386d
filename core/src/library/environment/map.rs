//! Light from all directions as the engines read it: sharp for what stands behind everything,
//! blurred by roughness for what is mirrored, and a polynomial for what falls on matt surfaces.

use std::sync::Arc;

use glam::{DMat3, DVec3, Vec3};

use super::equirect::{Equirect, uv_of};
use super::filter;

/// Levels of a map. Level k is what a surface of perceptual roughness `k / 5` mirrors; level 0 is
/// the surroundings themselves.
pub const LEVELS: usize = 6;

/// Weights of linear Rec. 709 for luminance.
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Largest number that a texel holds.
const TEXEL_MAX: f32 = 65_408.0;

/// One level of an [`EnvironmentMap`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// Index of its first texel.
    pub first: u32,
    /// log2 of its width; it is half as high.
    pub log2_width: u32,
}

/// How large the levels are, and how much is spent on them.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// log2 of the levels' widths.
    pub log2_widths: [u32; LEVELS],
    /// Directions that a blurred texel is the mean of.
    pub samples: u32,
}

impl Detail {
    /// For pictures, which are prepared once: 2048 columns.
    pub const PICTURE: Self = Self { log2_widths: [11, 7, 6, 6, 5, 5], samples: 64 };
    /// For what is computed for each frame: 1024 columns.
    pub const COMPUTED: Self = Self { log2_widths: [10, 6, 5, 5, 4, 4], samples: 32 };
}

/// Light from all directions; its mean luminance is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// Rows of all levels, each texel `r | g << 9 | b << 18 | e << 27`: 9 bits of each channel in
    /// units of `2^(e - 24)` (the shared-exponent format of EXT_texture_shared_exponent).
    pub texels: Arc<[u32]>,
    /// Where the levels stand.
    pub levels: [Level; LEVELS],
    /// What falls on a surface.
    pub irradiance: Irradiance,
}

/// Irradiance of a surface as a polynomial of its unit normal n, for each channel
/// `constant + linear . n + n . (quadratic n)`: spherical harmonics up to the second order
/// (Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment maps", 2001).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Irradiance {
    /// Channel by channel.
    pub constant: [f64; 3],
    /// Channel by channel.
    pub linear: [DVec3; 3],
    /// Symmetric, channel by channel.
    pub quadratic: [DMat3; 3],
}

impl Irradiance {
    /// The same of normals in other axes.
    #[must_use]
    pub fn rotated(&self, map_from_other: DMat3) -> Self {
        let other_from_map = map_from_other.transpose();
        Self {
            constant: self.constant,
            linear: self.linear.map(|v| other_from_map * v),
            quadratic: self.quadratic.map(|m| other_from_map * m * map_from_other),
        }
    }

    /// Of a surface that faces a unit direction, at least 0.
    #[must_use]
    pub fn of(&self, normal: DVec3) -> [f64; 3] {
        std::array::from_fn(|c| {
            let bent = normal.dot(self.quadratic[c] * normal);
            (self.constant[c] + self.linear[c].dot(normal) + bent).max(0.0)
        })
    }
}

impl EnvironmentMap {
    /// Prepares a picture; nothing if it is black.
    #[must_use]
    pub fn new(picture: Equirect, detail: Detail) -> Option<Self> {
        let mut picture = picture.resized(1 << detail.log2_widths[0]);
        let mean = mean_luminance(&picture);
        if !(mean > 0.0 && mean.is_finite()) {
            return None;
        }
        let scale = (1.0 / mean) as f32;
        picture.pixels.iter_mut().for_each(|p| *p *= scale);
        let pyramid = filter::Pyramid::new(picture);
        let mut texels = Vec::new();
        let mut levels = [Level::default(); LEVELS];
        for (k, (level, log2_width)) in levels.iter_mut().zip(detail.log2_widths).enumerate() {
            *level = Level { first: texels.len() as u32, log2_width };
            if k == 0 {
                texels.extend(pyramid.sharpest().pixels.iter().map(|p| packed(*p)));
            } else {
                let roughness = k as f64 / (LEVELS - 1) as f64;
                let blurred = pyramid.blurred(1 << log2_width, roughness, detail.samples);
                texels.extend(blurred.pixels.iter().map(|p| packed(*p)));
            }
        }
        Some(Self { texels: texels.into(), levels, irradiance: pyramid.irradiance() })
    }

    /// Bytes that the texels occupy.
    #[must_use]
    pub fn size_bytes(&self) -> usize {
        self.texels.len() * 4
    }

    /// What a level shows in a direction: bilinear, as the engines have it.
    #[must_use]
    pub fn light(&self, direction: Vec3, level: usize) -> Vec3 {
        let Level { first, log2_width } = self.levels[level];
        let width = 1 << log2_width;
        let texels = &self.texels[first as usize..][..width * width / 2];
        // Only four texels are looked at; decoding all of them would be for tests alone.
        let at = uv_of(direction);
        let (x, y) = (at[0] * width as f32 - 0.5, at[1] * (width / 2) as f32 - 0.5);
        let y = y.clamp(0.0, (width / 2 - 1) as f32);
        let texel = |i: i32, j: i32| {
            let column = (x.floor() as i32 + i).rem_euclid(width as i32) as usize;
            let row = (y.floor() as i32 + j).min(width as i32 / 2 - 1) as usize;
            unpacked(texels[row * width + column])
        };
        let across = |j| texel(0, j).lerp(texel(1, j), x - x.floor());
        across(0).lerp(across(1), y - y.floor())
    }
}

/// Mean over all directions.
fn mean_luminance(picture: &Equirect) -> f64 {
    let rows = picture.pixels.chunks_exact(picture.width).zip(picture.solid_angles());
    let sum: f64 = rows
        .map(|(row, solid_angle)| {
            solid_angle * row.iter().map(|p| p.as_dvec3().dot(LUMINANCE)).sum::<f64>()
        })
        .sum();
    sum / (4.0 * std::f64::consts::PI)
}

/// The texel of some light; negative numbers and NaN become 0.
#[must_use]
pub fn packed(light: Vec3) -> u32 {
    // In this order of the arguments NaN gives 0.
    let light = light.to_array().map(|v| 0.0_f32.max(v).min(TEXEL_MAX));
    let largest = light[0].max(light[1]).max(light[2]).max(1.0 / 32_768.0);
    // The binary exponent, and one more where rounding carries.
    let exponent = (largest.to_bits() >> 23) as i32 - 127 + 1;
    let unit = |exponent: i32| f32::from_bits(((9 - exponent + 127) as u32) << 23);
    let carries = (largest * unit(exponent)).round() >= 512.0;
    let exponent = exponent + i32::from(carries);
    let [r, g, b] = light.map(|v| (v * unit(exponent)).round() as u32);
    r | g << 9 | b << 18 | ((exponent + 15) as u32) << 27
}

/// The light of a texel.
#[must_use]
pub fn unpacked(texel: u32) -> Vec3 {
    let unit = f32::from_bits(((texel >> 27) + 127 - 24) << 23);
    let channel = |shift: u32| (texel >> shift & 511) as f32 * unit;
    Vec3::new(channel(0), channel(9), channel(18))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::environment::equirect::direction_at;

    #[test]
    fn texels_keep_light_to_a_five_hundredth_of_the_brightest_channel() {
        for i in 0..20_000 {
            let size = libm::exp2f((i as f32 / 20_000.0) * 30.0 - 14.0);
            let light = Vec3::new(size, size * 0.37, size * (i % 7) as f32 / 7.0);
            let off = (unpacked(packed(light)) - light).abs().max_element();
            assert!(off <= size.max(1.0 / 32_768.0) / 511.0, "{light}: off by {off}");
        }
        for light in [Vec3::ZERO, Vec3::splat(-3.0), Vec3::NAN, Vec3::splat(1e-9)] {
            assert!(unpacked(packed(light)).max_element() < 1e-6, "{light}");
        }
        assert_eq!(unpacked(packed(Vec3::INFINITY)), Vec3::splat(TEXEL_MAX));
        assert_eq!(unpacked(packed(Vec3::splat(511.75))).x, 512.0);
    }

    #[test]
    fn white_surroundings_are_white_in_every_respect() {
        let map =
            EnvironmentMap::new(Equirect::from_fn(64, |_| Vec3::splat(7.0)), Detail::COMPUTED);
        let map = map.unwrap();
        for i in 0..100 {
            let d = direction_at(f64::from(i) / 100.0, libm::fmod(f64::from(i) * 0.618, 1.0));
            for level in 0..LEVELS {
                assert_eq!(map.light(d.as_vec3(), level), Vec3::ONE, "level {level}");
            }
            for e in map.irradiance.of(d) {
                assert!((e - std::f64::consts::PI).abs() < 2e-3, "{e}");
            }
        }
    }

    #[test]
    fn the_polynomial_turns_with_its_axes() {
        let sky = Equirect::from_fn(64, |d| (DVec3::splat(1.2) + d).as_vec3());
        let map = EnvironmentMap::new(sky, Detail::COMPUTED).unwrap();
        let map_from_view = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(-0.4);
        let turned = map.irradiance.rotated(map_from_view);
        for normal in [DVec3::X, DVec3::Y, DVec3::new(0.6, -0.64, 0.48)] {
            let (a, b) = (turned.of(normal), map.irradiance.of(map_from_view * normal));
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
        }
    }

    #[test]
    fn a_black_picture_is_no_light() {
        assert_eq!(
            EnvironmentMap::new(Equirect::from_fn(32, |_| Vec3::ZERO), Detail::COMPUTED),
            None
        );
    }
}
