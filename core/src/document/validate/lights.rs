//! Lights: what of sun, lamps and surroundings makes sense, each field by its path.

use super::rules::{Check, Range};
use super::{ANGLE, POSITION};
use crate::document::{Environment, Lights, MovingLight, Param, PointLight, Sun, SunDirection};

const MAX_LIGHTS: usize = 256;
/// Where the fit of the colours of glowing bodies holds.
const GLOWING_K: Range = Range::from_to(1667.0, 25_000.0);

pub(super) fn lights(c: &mut Check, lights: &Lights) {
    sun(c, &lights.sun);
    if lights.points.len() > MAX_LIGHTS {
        let got = lights.points.len();
        c.report("lights.points", format!("must hold at most {MAX_LIGHTS} lamps, got {got}"));
    }
    for (i, lamp) in lights.points.iter().enumerate() {
        let PointLight {
            enabled: _,
            on,
            position_m,
            intensity_cd,
            color,
            temperature_k,
            range_m,
            radius_m,
        } = lamp;
        let path = format!("lights.points[{i}]");
        c.flag(&format!("{path}.on"), on);
        c.vector(&format!("{path}.position_m"), position_m, POSITION);
        c.param(&format!("{path}.intensity_cd"), intensity_cd, Range::from_to(0.0, 1e9));
        c.color(&format!("{path}.color"), color);
        glowing(c, &path, temperature_k.as_ref());
        reach(c, &path, *range_m, *radius_m);
    }
    let moving: &MovingLight = &lights.moving;
    c.flag("lights.moving.on", &moving.on);
    c.vector("lights.moving.position_m", &moving.position_m, POSITION);
    c.vector("lights.moving.position_offset_m", &moving.position_offset_m, POSITION);
    c.param("lights.moving.intensity_cd", &moving.intensity_cd, Range::from_to(0.0, 1e9));
    c.color("lights.moving.color", &moving.color);
    glowing(c, "lights.moving", moving.temperature_k.as_ref());
    reach(c, "lights.moving", moving.range_m, moving.radius_m);
    environment(c, &lights.environment);
}

fn glowing(c: &mut Check, path: &str, temperature_k: Option<&Param>) {
    if let Some(temperature_k) = temperature_k {
        c.param(&format!("{path}.temperature_k"), temperature_k, GLOWING_K);
    }
}

fn reach(c: &mut Check, path: &str, range_m: f64, radius_m: f64) {
    c.number(&format!("{path}.range_m"), range_m, Range::above(0.0, 1e6));
    c.number(&format!("{path}.radius_m"), radius_m, Range::above(0.0, 1e3));
    if radius_m >= range_m && range_m > 0.0 {
        let message = format!("must be smaller than range_m ({range_m}), got {radius_m}");
        c.report(&format!("{path}.radius_m"), message);
    }
}

fn sun(c: &mut Check, sun: &Sun) {
    match &sun.direction {
        SunDirection::Clock(clock) => {
            c.param("lights.sun.direction.hour", &clock.hour, Range::from_to(0.0, 24.0));
            let day = Range::from_to(0.0, 366.0);
            c.param("lights.sun.direction.day_of_year", &clock.day_of_year, day);
            let latitude = Range::from_to(-90.0, 90.0);
            c.param("lights.sun.direction.latitude_deg", &clock.latitude_deg, latitude);
        }
        SunDirection::Angles(angles) => {
            c.param("lights.sun.direction.azimuth_deg", &angles.azimuth_deg, ANGLE);
            let elevation = Range::from_to(-90.0, 90.0);
            c.param("lights.sun.direction.elevation_deg", &angles.elevation_deg, elevation);
        }
    }
    c.param("lights.sun.illuminance_lux", &sun.illuminance_lux, Range::from_to(0.0, 1e7));
    c.color("lights.sun.color", &sun.color);
    glowing(c, "lights.sun", sun.temperature_k.as_ref());
}

fn environment(c: &mut Check, environment: &Environment) {
    let amount = Range::from_to(0.0, 1e7);
    c.param("lights.environment.sky_lux", &environment.sky_lux, amount);
    c.color("lights.environment.sky_color", &environment.sky_color);
    c.param("lights.environment.ground_lux", &environment.ground_lux, amount);
    c.color("lights.environment.ground_color", &environment.ground_color);
    c.param("lights.environment.background_nits", &environment.background_nits, amount);
    c.color("lights.environment.background_color", &environment.background_color);
    let image = &environment.image;
    c.ids("lights.environment.image.source", &image.source);
    c.param("lights.environment.image.rotation_deg", &image.rotation_deg, ANGLE);
    c.param("lights.environment.image.illuminance_lux", &image.illuminance_lux, amount);
    let turbidity = Range::from_to(1.7, 10.0);
    c.param("lights.environment.image.sky.turbidity", &image.sky.turbidity, turbidity);
    let cover = Range::from_to(0.0, 1.0);
    c.param("lights.environment.image.sky.cloud_cover", &image.sky.cloud_cover, cover);
}
