//! Lights in view space.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::{DrawError, abi};
use crate::base::math::rotation_from_euler_deg;
use crate::library::Library;
use crate::library::environment::EnvironmentMap;
use crate::library::environment::map::Irradiance;
use crate::library::environment::sky::Sky;
use crate::scene::{EnvironmentImage, EnvironmentSource, Scene};

/// The scene's lights, with colour and strength multiplied.
///
/// # Errors
/// When the scene names surroundings that the library does not hold or cannot read.
pub fn in_view(
    scene: &Scene,
    library: &Library,
    view_from_world: &DAffine3,
) -> Result<abi::Lights, DrawError> {
    let scaled = |color: [f64; 3], by: f64| color.map(|c| (c * by) as f32);
    let lights = &scene.lights;
    let image = lights.environment.image.as_ref();
    let world_from_view = view_from_world.matrix3.transpose();
    let surroundings =
        image.map(|image| surroundings(image, library, world_from_view)).transpose()?;
    Ok(abi::Lights {
        sun: lights.sun.as_ref().map(|sun| abi::Sun {
            direction_to_sun: view_from_world
                .transform_vector3(sun.direction_to_sun)
                .normalize()
                .as_vec3()
                .to_array(),
            color_lux: scaled(sun.color, sun.illuminance_lux),
            shadow: sun.shadow,
        }),
        points: lights
            .points
            .iter()
            .map(|p| abi::PointLight {
                position: view_from_world.transform_point3(p.position_m).as_vec3().to_array(),
                range_m: p.range_m as f32,
                color_cd: scaled(p.color, p.intensity_cd),
                radius_m: p.radius_m as f32,
            })
            .collect(),
        sky_lux: scaled(lights.environment.sky_lux, 1.0),
        ground_lux: scaled(lights.environment.ground_lux, 1.0),
        background_nits: scaled(lights.environment.background_nits, 1.0),
        surroundings,
    })
}

/// A picture of all directions, turned and scaled.
fn surroundings(
    image: &EnvironmentImage,
    library: &Library,
    world_from_view: DMat3,
) -> Result<abi::Surroundings, DrawError> {
    let (map, rotation_deg) = match &image.source {
        EnvironmentSource::Picture(id) => (library.environments.get(id)?, image.rotation_deg),
        EnvironmentSource::Sky(sky) => {
            let sky = Sky {
                direction_to_sun: sky.direction_to_sun,
                turbidity: sky.turbidity,
                cloud_cover: sky.cloud_cover,
                cloud_place: sky.cloud_place,
                ground: sky.ground_color,
            };
            (Arc::new(sky.map().ok_or(DrawError::BlackSky)?), 0.0)
        }
    };
    let map_from_world = DMat3::from_quat(rotation_from_euler_deg(0.0, -rotation_deg, 0.0));
    // The map's mean luminance is 1, and light of 1 nit from all around gives pi lux.
    let nits_per_unit = image.illuminance_lux / PI;
    Ok(abi::Surroundings::new(map, map_from_world * world_from_view, nits_per_unit))
}

impl abi::Surroundings {
    /// A picture of all directions, turned by a rotation and scaled.
    #[must_use]
    pub fn new(map: Arc<EnvironmentMap>, map_from_view: DMat3, nits_per_unit: f64) -> Self {
        let irradiance = map.irradiance.rotated(map_from_view);
        Self {
            map_from_view: [0, 1, 2].map(|r| map_from_view.row(r).as_vec3().to_array()),
            nits_per_unit: nits_per_unit as f32,
            irradiance_lux: terms(&irradiance)
                .map(|term| (term * nits_per_unit).as_vec3().to_array()),
            map,
        }
    }
}

/// Factors of 1, x, y, z, xx, yy, zz, xy, yz and zx, all channels of each.
fn terms(irradiance: &Irradiance) -> [DVec3; 10] {
    let Irradiance { constant, linear, quadratic } = irradiance;
    let channels = |of: &dyn Fn(usize) -> f64| DVec3::new(of(0), of(1), of(2));
    let first = |k: usize| channels(&|c| linear[c][k]);
    let second = |i: usize, j: usize| channels(&|c| quadratic[c].col(j)[i]);
    [
        DVec3::from_array(*constant),
        first(0),
        first(1),
        first(2),
        second(0, 0),
        second(1, 1),
        second(2, 2),
        2.0 * second(0, 1),
        2.0 * second(1, 2),
        2.0 * second(2, 0),
    ]
}
