//! What surfaces make of the light around them: mirrored with a roughness, or scattered.

use glam::{DMat3, DVec3, Vec3};

use super::equirect::{Equirect, direction_at, uv_of};
use super::map::Irradiance;

/// Narrowest picture of a pyramid.
const NARROWEST: usize = 16;

/// Width of the picture that irradiance is summed from.
const IRRADIANCE_WIDTH: usize = 64;

/// A picture and its halves, quarters ...
pub struct Pyramid(Vec<Equirect>);

/// A direction that a rough mirror looks in, about its normal z.
struct Sample {
    direction: DVec3,
    weight: f32,
    /// Level of the pyramid whose pixels are as large as the sample's share of the sphere.
    level: f32,
}

impl Pyramid {
    pub fn new(sharpest: Equirect) -> Self {
        let mut all = vec![sharpest];
        while let Some(last) = all.last().filter(|p| p.width >= 2 * NARROWEST) {
            all.push(last.halved());
        }
        Self(all)
    }

    pub fn sharpest(&self) -> &Equirect {
        &self.0[0]
    }

    /// What a surface of a perceptual roughness mirrors to a viewer along its normal, by importance
    /// sampling of its GGX lobe, each sample as blurred as it is rare (Krivanek and Colbert,
    /// "Real-time shading with filtered importance sampling", 2008; Karis, "Real shading in Unreal
    /// Engine 4", 2013, for the normal as the viewer's direction).
    pub fn blurred(&self, width: usize, roughness: f64, samples: u32) -> Equirect {
        let samples = self.samples(roughness, samples);
        Equirect::from_fn(width, |normal| {
            let helper = if normal.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
            let right = helper.cross(normal).normalize();
            let world = DMat3::from_cols(right, normal.cross(right), normal);
            let mut sum = Vec3::ZERO;
            for sample in &samples {
                sum += self.at((world * sample.direction).as_vec3(), sample.level) * sample.weight;
            }
            sum
        })
    }

    fn samples(&self, roughness: f64, count: u32) -> Vec<Sample> {
        use std::f64::consts::{PI, TAU};
        let alpha2 = roughness.powi(4);
        let pixel = 4.0 * PI / self.sharpest().pixels.len() as f64;
        let mut samples: Vec<Sample> = (0..count)
            .map(|i| {
                // Hammersley points.
                let [a, b] = [(f64::from(i) + 0.5) / f64::from(count), radical_inverse(i)];
                let cos2 = (1.0 - a) / (1.0 + (alpha2 - 1.0) * a);
                let (cosine, sine) = (cos2.sqrt(), (1.0 - cos2).max(0.0).sqrt());
                let (x, y) = (sine * libm::cos(TAU * b), sine * libm::sin(TAU * b));
                // The normal z mirrored at the halfway vector.
                let direction = DVec3::new(2.0 * cosine * x, 2.0 * cosine * y, 2.0 * cos2 - 1.0);
                let lobe = cos2 * (alpha2 - 1.0) + 1.0;
                let density = alpha2 / (PI * lobe * lobe) / 4.0;
                let solid_angle = 1.0 / (f64::from(count) * density);
                let level = (0.5 * libm::log2(solid_angle / pixel) + 1.0).max(0.0);
                Sample { direction, weight: direction.z.max(0.0) as f32, level: level as f32 }
            })
            .filter(|sample| sample.weight > 0.0)
            .collect();
        let sum: f32 = samples.iter().map(|s| s.weight).sum();
        samples.iter_mut().for_each(|s| s.weight /= sum);
        samples
    }

    /// The light in a direction, trilinear.
    fn at(&self, direction: Vec3, level: f32) -> Vec3 {
        let uv = uv_of(direction);
        let level = level.min((self.0.len() - 1) as f32);
        let lower = level as usize;
        let near = self.0[lower].at(uv);
        let share = level - lower as f32;
        if share == 0.0 { near } else { near.lerp(self.0[lower + 1].at(uv), share) }
    }

    /// The light's first nine spherical harmonics, each times that of the cosine lobe.
    pub fn irradiance(&self) -> Irradiance {
        let fits = |p: &&Equirect| p.width <= IRRADIANCE_WIDTH;
        let picture = self.0.iter().find(fits).unwrap_or_else(|| self.sharpest());
        // Integrals of the light times 1, n and n n'.
        let (mut constant, mut linear, mut quadratic) =
            ([0.0; 3], [DVec3::ZERO; 3], [DMat3::ZERO; 3]);
        let (width, height) = (picture.width, picture.height());
        for (y, solid_angle) in picture.solid_angles().enumerate() {
            for x in 0..width {
                let [u, v] = [(x, width), (y, height)].map(|(i, n)| (i as f64 + 0.5) / n as f64);
                let n = direction_at(u, v);
                let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
                for (c, light) in picture.pixels[y * width + x].to_array().into_iter().enumerate() {
                    let light = f64::from(light) * solid_angle;
                    constant[c] += light;
                    linear[c] += n * light;
                    quadratic[c] += outer * light;
                }
            }
        }
        // Convolution with the cosine scales the orders by pi, 2 pi / 3 and pi / 4, and the
        // harmonics are orthonormal with 1 / 4 pi, 3 / 4 pi and 15 / 8 pi of the traceless n n'.
        Irradiance {
            constant: std::array::from_fn(|c| constant[c] / 4.0 - constant[c] * 5.0 / 32.0),
            linear: linear.map(|v| v / 2.0),
            quadratic: quadratic.map(|m| m * (15.0 / 32.0)),
        }
    }
}

/// The bits of a number behind the binary point in reverse.
fn radical_inverse(i: u32) -> f64 {
    f64::from(i.reverse_bits()) / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light that a harmonic polynomial describes is integrated exactly: 1 + y + y^2 gives
    /// pi (1 + 1/3) + 2 pi / 3 n.y + pi / 4 (n.y^2 - 1/3).
    #[test]
    fn irradiance_of_simple_skies_is_that_of_the_closed_form() {
        use std::f64::consts::PI;
        let light = |d: DVec3| Vec3::splat((1.0 + d.y + d.y * d.y) as f32);
        let irradiance = Pyramid::new(Equirect::from_fn(256, light)).irradiance();
        for i in 0..50 {
            let n = direction_at(f64::from(i) * 0.618, (f64::from(i) + 0.5) / 50.0);
            let wanted = PI * 4.0 / 3.0 + 2.0 * PI / 3.0 * n.y + PI / 4.0 * (n.y * n.y - 1.0 / 3.0);
            let got = irradiance.of(n)[1];
            assert!((got - wanted).abs() < 0.01 * wanted, "{n}: {got} and not {wanted}");
        }
    }

    /// Half a white sky: E = pi (1 + n.y) / 2, which second order has exactly.
    #[test]
    fn half_a_sky_lights_by_the_view_factor() {
        let light = |d: DVec3| Vec3::splat(f32::from(u8::from(d.y > 0.0)));
        let irradiance = Pyramid::new(Equirect::from_fn(256, light)).irradiance();
        for y in [-1.0, -0.5, 0.0, 0.3, 1.0_f64] {
            let n = DVec3::new((1.0 - y * y).sqrt(), y, 0.0);
            let wanted = std::f64::consts::FRAC_PI_2 * (1.0 + y);
            let got = irradiance.of(n)[0];
            assert!((got - wanted).abs() < 0.02, "{y}: {got} and not {wanted}");
        }
    }

    /// A lamp of one degree and a mirror of roughness 0.4: the lobe of the halfway vector, that is
    /// D (n.l) normalised, compared by its ratio 10 and 20 degrees off.
    #[test]
    fn a_small_lamp_is_blurred_to_the_shape_of_the_lobe() {
        let lamp = DVec3::X;
        let light = |d: DVec3| Vec3::splat(if d.dot(lamp) > 0.9998 { 1e3 } else { 0.0 });
        let pyramid = Pyramid::new(Equirect::from_fn(512, light));
        let blurred = pyramid.blurred(128, 0.4, 1024);
        let at = |deg: f64| {
            let n = DVec3::new(libm::cos(deg.to_radians()), 0.0, libm::sin(deg.to_radians()));
            f64::from(blurred.at(uv_of(n.as_vec3())).x)
        };
        let lobe = |deg: f64| {
            let (l, h) = (libm::cos(deg.to_radians()), libm::cos((0.5 * deg).to_radians()));
            let alpha2 = 0.4_f64.powi(4);
            let d = h * h * (alpha2 - 1.0) + 1.0;
            l / (d * d)
        };
        for deg in [10.0, 20.0, 30.0] {
            let (got, wanted) = (at(deg) / at(0.0), lobe(deg) / lobe(0.0));
            assert!((got - wanted).abs() < 0.05, "{deg}: {got} and not {wanted}");
        }
    }
}
