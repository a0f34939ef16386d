//! Lights in view space.

use glam::DAffine3;

use super::abi;
use crate::scene::Scene;

/// The scene's lights, with colour and strength multiplied.
pub fn in_view(scene: &Scene, view_from_world: &DAffine3) -> abi::Lights {
    let scaled = |color: [f64; 3], by: f64| color.map(|c| (c * by) as f32);
    let lights = &scene.lights;
    abi::Lights {
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
    }
}
