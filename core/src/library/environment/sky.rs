//! A computed sky: clear air by the sun's height, with clouds if wanted.
//!
//! Preetham, Shirley and Smits, "A practical analytic model for daylight" (1999), relative to its
//! own brightness; the sun's disc is not part of it. Clouds are a layer of fractal noise
//! high above, so that they crowd at the horizon.

use std::sync::LazyLock;

use glam::DVec3;

use super::equirect::Equirect;
use super::map::{Detail, EnvironmentMap};
use crate::base::color::linear_from_xyz;
use crate::library::procedural::{Dice, Field};

/// Lowest sun that the model is asked about: sine of two degrees.
const LOWEST_SUN: f64 = 0.035;
/// Luminance of a lit cloud over that of the zenith.
const CLOUD: f64 = 3.2;
/// Sine of the angle about the horizon within which air hides what lies behind it.
const HAZE: f64 = 0.12;
/// Thickness over which clouds begin.
const CLOUD_EDGE: f64 = 0.3;
/// What is added to it, over the height at which clouds are seen.
const CLOUD_BLUR: f64 = 0.06;
/// Side of the field of clouds, and what of it lies within 45 degrees of the zenith.
const CLOUD_SIDE: f64 = 512.0;
const CLOUD_SCALE: f64 = 110.0;

/// Thickness of a layer of clouds: noise in which every value 0..1 is as frequent as any other, so
/// that the share above a threshold is known.
static CLOUDS: LazyLock<Field> = LazyLock::new(|| {
    let noise = Field::fbm(&mut Dice::new("sky/clouds"), 5, 6);
    let mut order: Vec<usize> = (0..noise.0.len()).collect();
    order.sort_by(|a, b| noise.0[*a].total_cmp(&noise.0[*b]).then(a.cmp(b)));
    let mut ranks = noise;
    let per_place = 1.0 / order.len() as f32;
    for (rank, place) in order.into_iter().enumerate() {
        ranks.0[place] = rank as f32 * per_place;
    }
    ranks
});

/// What a sky depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Unit vector, world. A sun below the horizon counts as one on it.
    pub direction_to_sun: DVec3,
    /// 1.7 very clear .. 10 hazy.
    pub turbidity: f64,
    /// Share of the sky that clouds hide, 0..1.
    pub cloud_cover: f64,
    /// Where in a field of clouds, which repeats, the zenith is, both 0..1.
    pub cloud_place: [f64; 2],
    /// Linear colour of the ground below, which is lit by the sky.
    pub ground: [f64; 3],
}

impl Sky {
    /// The sky from all around; nothing for numbers that give none.
    #[must_use]
    pub fn map(&self) -> Option<EnvironmentMap> {
        EnvironmentMap::new(self.picture(1 << Detail::COMPUTED.log2_widths[0]), Detail::COMPUTED)
    }

    /// The sky as a picture of a width.
    #[must_use]
    pub fn picture(&self, width: usize) -> Equirect {
        let air = Air::new(self);
        // The air is smooth; only clouds need the full size.
        let coarse =
            Equirect::from_fn((width / 16).max(16), |d| air.light(d).as_vec3()).resized(width);
        let zenith = air.light(DVec3::Y);
        let horizon = air.light(DVec3::Z) + air.light(DVec3::NEG_Z);
        let ground = DVec3::from_array(self.ground) * (zenith + horizon * 0.5) * 0.5;
        let white = DVec3::splat(zenith.dot(DVec3::new(0.2126, 0.7152, 0.0722)) * CLOUD);
        let mut pixels = coarse.pixels.into_iter();
        Equirect::from_fn(width, |d| {
            let air = pixels.next().unwrap_or_default();
            if d.y < 0.0 {
                // Far ground is seen through much air.
                let near = smooth(-d.y / HAZE);
                return air.lerp(ground.as_vec3(), near as f32);
            }
            let (share, shade) = self.cloud(d);
            air.lerp((white * shade).as_vec3(), share as f32)
        })
    }

    /// How much a cloud hides in a direction, and how bright it is.
    fn cloud(&self, d: DVec3) -> (f64, f64) {
        if self.cloud_cover <= 0.0 {
            return (0.0, 0.0);
        }
        // Round the zenith as on a plane, towards the horizon as on a sphere.
        let height = d.y + 0.12;
        let at = [d.x / height * CLOUD_SCALE, d.z / height * CLOUD_SCALE];
        let [x, y] = [0, 1].map(|k| (at[k] + self.cloud_place[k] * CLOUD_SIDE) as f32);
        let thickness = f64::from(CLOUDS.sample(x, y));
        let cover = self.cloud_cover.min(1.0);
        let above = thickness - (1.0 - cover);
        // Soft edges, half of them inside, and softer towards the horizon, where clouds are smaller
        // than pixels.
        let edge = CLOUD_EDGE.min(2.0 * cover).min(2.0 * (1.0 - cover)).max(1e-6);
        let edge = edge + CLOUD_BLUR / height;
        let share = above / edge + 0.5;
        // Thick parts are darker below; those near the sun glow.
        let glow = 0.35 * d.dot(self.direction_to_sun).max(0.0).powi(8);
        let above_haze = smooth((d.y - 0.5 * HAZE) / HAZE);
        (smooth(share) * above_haze, 1.05 - 0.4 * above.max(0.0) + glow)
    }
}

/// 0 to 1 over 0..1, without corners.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The model's distribution for one sun: luminance and the two chromaticities.
struct Air {
    to_sun: DVec3,
    perez: [[f64; 5]; 3],
    /// Zenith values over the distribution at the zenith.
    zenith: [f64; 3],
}

impl Air {
    fn new(sky: &Sky) -> Self {
        let t = sky.turbidity.clamp(1.7, 10.0);
        let sun = sky.direction_to_sun;
        let to_sun = DVec3::new(sun.x, sun.y.max(LOWEST_SUN), sun.z).normalize();
        let perez = [
            [
                0.1787 * t - 1.4630,
                -0.3554 * t + 0.4275,
                -0.0227 * t + 5.3251,
                0.1206 * t - 2.5771,
                -0.0670 * t + 0.3703,
            ],
            [
                -0.0193 * t - 0.2592,
                -0.0665 * t + 0.0008,
                -0.0004 * t + 0.2125,
                -0.0641 * t - 0.8989,
                -0.0033 * t + 0.0452,
            ],
            [
                -0.0167 * t - 0.2608,
                -0.0950 * t + 0.0092,
                -0.0079 * t + 0.2102,
                -0.0441 * t - 1.6537,
                -0.0109 * t + 0.0529,
            ],
        ];
        let theta = libm::acos(to_sun.y);
        let chi = (4.0 / 9.0 - t / 120.0) * (std::f64::consts::PI - 2.0 * theta);
        let luminance = (4.0453 * t - 4.9710) * libm::tan(chi) - 0.2155 * t + 2.4192;
        let cubic = |rows: [[f64; 4]; 3]| {
            let of = |r: [f64; 4]| ((r[0] * theta + r[1]) * theta + r[2]) * theta + r[3];
            (of(rows[0]) * t + of(rows[1])) * t + of(rows[2])
        };
        let x = cubic([
            [0.001_66, -0.003_75, 0.002_09, 0.0],
            [-0.029_03, 0.063_77, -0.032_02, 0.003_94],
            [0.116_93, -0.211_96, 0.060_52, 0.258_86],
        ]);
        let y = cubic([
            [0.002_75, -0.006_10, 0.003_17, 0.0],
            [-0.042_14, 0.089_70, -0.041_53, 0.005_16],
            [0.153_46, -0.267_56, 0.066_70, 0.266_88],
        ]);
        let at_zenith = perez.map(|p| distribution(&p, 1.0, to_sun.y));
        let zenith = [luminance.max(0.05) / at_zenith[0], x / at_zenith[1], y / at_zenith[2]];
        Self { to_sun, perez, zenith }
    }

    /// Linear Rec. 709 of a direction; below the horizon as on it.
    fn light(&self, d: DVec3) -> DVec3 {
        let up = d.y.max(0.0);
        let level = DVec3::new(d.x, 0.0, d.z).normalize_or(DVec3::X) * (1.0 - up * up).sqrt();
        let d = DVec3::new(level.x, up, level.z);
        let cos_gamma = d.dot(self.to_sun).clamp(-1.0, 1.0);
        let [luminance, x, y] = std::array::from_fn(|k| {
            self.zenith[k] * distribution(&self.perez[k], up.max(0.01), cos_gamma)
        });
        let xyz = DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance;
        linear_from_xyz(xyz).max(DVec3::ZERO)
    }
}

/// Perez' function of the cosines of the angles to the zenith and to the sun.
fn distribution([a, b, c, d, e]: &[f64; 5], cos_theta: f64, cos_gamma: f64) -> f64 {
    let gamma = libm::acos(cos_gamma);
    (1.0 + a * libm::exp(b / cos_theta))
        * (1.0 + c * libm::exp(d * gamma) + e * cos_gamma * cos_gamma)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::environment::equirect::direction_at;

    fn sky(elevation_deg: f64) -> Sky {
        let e = elevation_deg.to_radians();
        Sky {
            direction_to_sun: DVec3::new(0.0, libm::sin(e), libm::cos(e)),
            turbidity: 3.0,
            cloud_cover: 0.0,
            cloud_place: [0.3, 0.8],
            ground: [0.2; 3],
        }
    }

    #[test]
    fn a_clear_sky_is_blue_above_and_brightest_round_the_sun() {
        let air = Air::new(&sky(40.0));
        let zenith = air.light(DVec3::Y);
        assert!(zenith.z > 1.3 * zenith.x, "{zenith}");
        let near_sun = air.light(DVec3::new(0.0, 0.7, 0.714));
        let opposite = air.light(DVec3::new(0.0, 0.7, -0.714));
        assert!(near_sun.y > 2.0 * opposite.y, "{near_sun} {opposite}");
    }

    #[test]
    fn any_sun_and_any_air_give_light() {
        for elevation in [-90.0, -5.0, 0.0, 0.5, 30.0, 89.9, 90.0] {
            for turbidity in [0.0, 1.7, 4.0, 10.0, 100.0] {
                for cloud_cover in [0.0, 0.5, 1.0] {
                    let sky = Sky { turbidity, cloud_cover, ..sky(elevation) };
                    let picture = sky.picture(64);
                    let light = |p: &glam::Vec3| p.is_finite() && p.min_element() >= 0.0;
                    assert!(picture.pixels.iter().all(light), "{sky:?}");
                    assert!(sky.map().is_some(), "{sky:?}");
                }
            }
        }
    }

    #[test]
    fn clouds_hide_about_the_share_they_are_asked_to() {
        for cover in [0.05, 0.25, 0.5, 0.9, 1.0] {
            let sky = Sky { cloud_cover: cover, ..sky(50.0) };
            let mut hidden = 0.0;
            for i in 0..4_000 {
                let v = (f64::from(i) + 0.5) / 8_000.0;
                let d = direction_at(libm::fmod(f64::from(i) * 0.618, 1.0), v);
                hidden += sky.cloud(d).0 / 4_000.0;
            }
            // A ninth of the places lies in the haze.
            assert!((hidden - 0.88 * cover).abs() < 0.06, "{cover}: {hidden}");
        }
    }
}
