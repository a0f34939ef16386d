//! Sun, lamps and surroundings.

use glam::{DQuat, DVec3};

use super::background::asset;
use super::linked::{Draw, Draws};
use super::value::{color, flag, number, vector};
use super::{blackbody, keys};
use crate::base::math::rotation_from_euler_deg;
use crate::document;
use crate::document::{MovingLight, Param, SunDirection};
use crate::scene::{
    Environment, EnvironmentImage, EnvironmentSource, Lights, PointLight, Sky, Sun,
};

/// The slot of the moving lamp among the lamps, beyond all that a document may list.
pub(super) const MOVING: u32 = 1 << 16;
/// The id of the computed sky, beside those of pictures.
pub(super) const SKY: &str = "sky";

/// `pictures` are the ids of the library's pictures of all directions.
pub(super) fn lights(lights: &document::Lights, pictures: &[String], draws: Draws) -> Lights {
    let mut points = Vec::new();
    for (slot, lamp) in (0..).zip(&lights.points) {
        if lamp.enabled && flag(&lamp.on, draws.of(keys::LAMP_ON, slot)) {
            points.push(PointLight {
                position_m: vector(&lamp.position_m, draws.of(keys::LAMP_POSITION, slot)),
                intensity_cd: number(&lamp.intensity_cd, draws.of(keys::LAMP_INTENSITY, slot)),
                color: glowing(
                    color(&lamp.color, draws.of(keys::LAMP_COLOR, slot)),
                    lamp.temperature_k.as_ref(),
                    draws.of(keys::LAMP_TEMPERATURE, slot),
                ),
                range_m: lamp.range_m,
                radius_m: lamp.radius_m,
            });
        }
    }
    points.extend(moving(&lights.moving, draws));
    Lights {
        sun: lights.sun.enabled.then(|| sun(&lights.sun, draws)),
        points,
        environment: environment(lights, pictures, draws),
    }
}

fn moving(lamp: &MovingLight, draws: Draws) -> Option<PointLight> {
    let of = |key| draws.of(key, MOVING);
    (lamp.enabled && flag(&lamp.on, of(keys::LAMP_ON))).then(|| PointLight {
        position_m: vector(&lamp.position_m, of(keys::LAMP_POSITION))
            + vector(&lamp.position_offset_m, of(keys::LAMP_POSITION_OFFSET)),
        intensity_cd: number(&lamp.intensity_cd, of(keys::LAMP_INTENSITY)),
        color: glowing(
            color(&lamp.color, of(keys::LAMP_COLOR)),
            lamp.temperature_k.as_ref(),
            of(keys::LAMP_TEMPERATURE),
        ),
        range_m: lamp.range_m,
        radius_m: lamp.radius_m,
    })
}

/// Where the sun stands, whether it shines or not.
fn direction_to_sun(direction: &SunDirection, draws: Draws) -> DVec3 {
    let of = |key| draws.of(key, 0);
    match direction {
        SunDirection::Clock(clock) => direction_by_clock(
            number(&clock.hour, of(keys::SUN_HOUR)),
            number(&clock.day_of_year, of(keys::SUN_DAY)),
            number(&clock.latitude_deg, of(keys::SUN_LATITUDE)),
        ),
        SunDirection::Angles(angles) => direction_by_angles(
            number(&angles.azimuth_deg, of(keys::SUN_AZIMUTH)),
            number(&angles.elevation_deg, of(keys::SUN_ELEVATION)),
        ),
    }
}

fn sun(sun: &document::Sun, draws: Draws) -> Sun {
    let of = |key| draws.of(key, 0);
    Sun {
        direction_to_sun: direction_to_sun(&sun.direction, draws),
        illuminance_lux: number(&sun.illuminance_lux, of(keys::SUN_ILLUMINANCE)),
        color: glowing(
            color(&sun.color, of(keys::SUN_COLOR)),
            sun.temperature_k.as_ref(),
            of(keys::SUN_TEMPERATURE),
        ),
        shadow: sun.shadow,
    }
}

/// A colour times that of a glowing body, where a temperature is given.
fn glowing(color: [f64; 3], temperature_k: Option<&Param>, draw: Draw) -> [f64; 3] {
    let Some(temperature_k) = temperature_k else { return color };
    let tint = blackbody::tint(number(temperature_k, draw));
    [0, 1, 2].map(|i| color[i] * tint[i])
}

/// Towards a sun at an azimuth (clockwise from +Z over -X) and an elevation.
fn direction_by_angles(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (a, e) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    let level = libm::cos(e);
    DVec3::new(-libm::sin(a) * level, libm::sin(e), libm::cos(a) * level)
}

/// Towards the sun by time and place, by the seed's own model: day 0 is the northern winter
/// solstice, and the tilt of the Earth's axis wanders with the day as two Euler angles (off from
/// astronomy by 1.6 degrees on average). Computed in the seed's left-handed axes (north +Z, east
/// +X), then mirrored in x.
fn direction_by_clock(hour: f64, day_of_year: f64, latitude_deg: f64) -> DVec3 {
    let season = std::f64::consts::TAU * day_of_year / 365.0;
    let tilt = rotation_from_euler_deg(23.5 * libm::cos(season), 0.0, 23.5 * libm::sin(season));
    let spin = rotation_from_euler_deg(0.0, -(hour + 12.0) / 24.0 * 360.0, 0.0);
    let latitude = rotation_from_euler_deg(latitude_deg, 0.0, 0.0);
    let light: DQuat = rotation_from_euler_deg(90.0, 0.0, 0.0) * (tilt * spin * latitude).inverse();
    let forward = light * DVec3::Z;
    DVec3::new(forward.x, -forward.y, -forward.z).normalize()
}

fn environment(lights: &document::Lights, pictures: &[String], draws: Draws) -> Environment {
    let e = &lights.environment;
    let of = |key| draws.of(key, 0);
    let light = |amount, amount_key, tint, tint_key| {
        let amount = number(amount, of(amount_key));
        color(tint, of(tint_key)).map(|c| c * amount)
    };
    if !e.enabled {
        return Environment::default();
    }
    Environment {
        sky_lux: light(&e.sky_lux, keys::SKY, &e.sky_color, keys::SKY_COLOR),
        ground_lux: light(&e.ground_lux, keys::GROUND, &e.ground_color, keys::GROUND_COLOR),
        background_nits: light(
            &e.background_nits,
            keys::BACKGROUND,
            &e.background_color,
            keys::BACKGROUND_COLOR,
        ),
        ambient_occlusion: e.ambient_occlusion,
        image: image(lights, pictures, draws),
    }
}

/// The picture of all directions, if there is one.
fn image(lights: &document::Lights, pictures: &[String], draws: Draws) -> Option<EnvironmentImage> {
    let (e, image) = (&lights.environment, &lights.environment.image);
    let of = |key| draws.of(key, 0);
    let source = match asset(&image.source, pictures, of(keys::IMAGE))?.as_str() {
        SKY => {
            let place = of(keys::SKY_CLOUD_PLACE);
            EnvironmentSource::Sky(Sky {
                direction_to_sun: direction_to_sun(&lights.sun.direction, draws),
                turbidity: number(&image.sky.turbidity, of(keys::SKY_TURBIDITY)),
                cloud_cover: number(&image.sky.cloud_cover, of(keys::SKY_CLOUD_COVER)),
                cloud_place: [place.lane(0).uniform(), place.lane(1).uniform()],
                ground_color: color(&e.ground_color, of(keys::GROUND_COLOR)),
            })
        }
        id => EnvironmentSource::Picture(id.to_owned()),
    };
    Some(EnvironmentImage {
        source,
        rotation_deg: number(&image.rotation_deg, of(keys::IMAGE_ROTATION)),
        illuminance_lux: number(&image.illuminance_lux, of(keys::IMAGE_ILLUMINANCE)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The seed's sun: hour, day, latitude, elevation, azimuth, and where its light goes, in the
    /// seed's axes.
    #[test]
    fn the_sun_stands_where_the_seed_has_it() {
        let table = [
            (12.0, 0.0, 0.0, 66.50, Some(180.0), [0.0, -0.917, 0.399]),
            (12.0, 182.5, 0.0, 66.50, Some(0.0), [0.0, -0.917, -0.399]),
            (12.0, 91.25, 0.0, 90.00, None, [0.0, -1.0, 0.0]),
            (6.0, 91.25, 0.0, 0.00, Some(90.0), [-1.0, 0.0, 0.0]),
            (12.0, 0.0, 45.0, 21.50, Some(180.0), [0.0, -0.367, 0.930]),
            (12.0, 182.5, 45.0, 68.50, Some(180.0), [0.0, -0.930, 0.367]),
            (9.0, 182.5, 45.0, 47.77, Some(105.23), [-0.648, -0.740, 0.177]),
            (6.0, 182.5, 45.0, 16.38, Some(72.91), [-0.917, -0.282, -0.282]),
            (0.0, 0.0, 0.0, -66.50, Some(180.0), [0.0, 0.917, 0.399]),
        ];
        for (hour, day, latitude, elevation, azimuth, light) in table {
            let to_sun = direction_by_clock(hour, day, latitude);
            let label = format!("hour {hour}, day {day}, latitude {latitude}: {to_sun}");
            assert!((libm::asin(to_sun.y).to_degrees() - elevation).abs() < 0.0051, "{label}");
            if let Some(azimuth) = azimuth {
                let got = libm::atan2(-to_sun.x, to_sun.z).to_degrees().rem_euclid(360.0);
                let off = (got - azimuth + 180.0).rem_euclid(360.0) - 180.0;
                assert!(off.abs() < 0.0051, "{label}: azimuth {got}");
                let by_angles = direction_by_angles(azimuth, elevation);
                assert!((by_angles - to_sun).length() < 2e-4, "{label}");
            }
            let mirrored = DVec3::new(light[0], -light[1], -light[2]);
            assert!((to_sun - mirrored).length() < 1.2e-3, "{label}");
        }
    }

    /// With the seed's ranges: 5, 25, 50, 75 and 95 % of elevations below -59, -24, 0, 24, 59.
    #[test]
    fn elevations_have_the_seeds_quantiles() {
        let sun_of = document::Sun::default();
        let mut all: Vec<f64> = (0..20_000)
            .map(|frame| sun(&sun_of, Draws::new(3, frame)).direction_to_sun.y)
            .map(|y| libm::asin(y).to_degrees())
            .collect();
        all.sort_by(f64::total_cmp);
        for (share, elevation) in
            [(0.05, -59.0), (0.25, -24.0), (0.5, 0.0), (0.75, 24.0), (0.95, 59.0)]
        {
            let got = all[(share * 20_000.0) as usize];
            assert!((got - elevation).abs() < 1.5, "{share}: {got}");
        }
    }

    #[test]
    fn lamps_keep_their_values_when_others_go() {
        let all = document::Lights::default();
        let mut fewer = all.clone();
        fewer.points[0].enabled = false;
        fewer.points[4].on = document::Flag::Always(false);
        fewer.sun.enabled = false;
        for frame in 0..50 {
            let (a, b) = (
                lights(&all, &[], Draws::new(1, frame)),
                lights(&fewer, &[], Draws::new(1, frame)),
            );
            assert!(b.points.iter().all(|p| a.points.contains(p)));
            assert!(a.points.len() - b.points.len() <= 2);
            assert_eq!(a.environment, b.environment);
        }
    }
}
