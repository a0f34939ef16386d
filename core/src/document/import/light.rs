//! Randomizers of sun and lamps. What the scenario's file does not hold (which lamps there are, how
//! strong they can be) is that of the scene of PeopleSansPeople.

use super::fields::Fields;
use super::law::Law;
use crate::document::{Clock, Color, Document, Flag, Param, SunAngles, SunDirection, Vector};

/// Range that the seed's lamps are tagged with, cd.
const INTENSITY_CD: [f64; 2] = [5_000.0, 50_000.0];
/// What they are tagged with as well: on where a draw lies below this.
const ON_BELOW: f64 = 0.8;
/// 20,000 lm in all directions, which they have in the scene.
const SCENE_INTENSITY_CD: f64 = 1591.55;

pub(super) fn sun(fields: &mut Fields<'_>, document: &mut Document) {
    let direction = &mut document.lights.sun.direction;
    let mut clock = match direction {
        SunDirection::Clock(clock) => clock.clone(),
        SunDirection::Angles(_) => Clock::default(),
    };
    if let Some(law) = fields.law("hour", "lights.sun.direction.hour") {
        clock.hour = law.param();
    }
    if let Some(law) = fields.law("dayOfTheYear", "lights.sun.direction.day_of_year") {
        clock.day_of_year = law.param();
    }
    if let Some(law) = fields.law("latitude", "lights.sun.direction.latitude_deg") {
        clock.latitude_deg = law.param();
    }
    *direction = SunDirection::Clock(clock);
}

/// As it stands in the seed's scene: turned by Euler angles of 45 and -246.02 degrees.
pub(super) fn sun_off(document: &mut Document) {
    let (azimuth_deg, elevation_deg) = (293.98.into(), 45.0.into());
    document.lights.sun.direction = SunDirection::Angles(SunAngles { azimuth_deg, elevation_deg });
}

pub(super) fn lamps(fields: &mut Fields<'_>, document: &mut Document) {
    let [low, high] = INTENSITY_CD;
    let intensity = fields.law("lightIntensityParameter", "lights.moving.intensity_cd");
    let intensity = intensity.map(|law| law.mapped(high - low, low).param());
    let parts = ["red", "green", "blue"];
    let channels = fields.color("lightColorParameter", parts, "lights.moving.color");
    let on = fields.law("auxParameter", "lights.moving.on").map(|law| law.flag_below(ON_BELOW));
    for_each_lamp(document, |lamp_on, intensity_cd, color| {
        if let Some(on) = on {
            *lamp_on = on;
        }
        if let Some(intensity) = &intensity {
            intensity_cd.clone_from(intensity);
        }
        if let Color::Srgb(old) = color {
            for (old, new) in old.iter_mut().zip(&channels) {
                if let Some(law) = new {
                    *old = law.param();
                }
            }
        }
    });
}

pub(super) fn lamps_off(document: &mut Document) {
    for_each_lamp(document, |on, intensity_cd, color| {
        *on = Flag::Always(true);
        *intensity_cd = Param::Constant(SCENE_INTENSITY_CD);
        *color = Color::WHITE;
    });
}

/// All seven: six that stand still and the moving one.
fn for_each_lamp(
    document: &mut Document,
    mut change: impl FnMut(&mut Flag, &mut Param, &mut Color),
) {
    for lamp in &mut document.lights.points {
        change(&mut lamp.on, &mut lamp.intensity_cd, &mut lamp.color);
    }
    let moving = &mut document.lights.moving;
    change(&mut moving.on, &mut moving.intensity_cd, &mut moving.color);
}

pub(super) fn moving_lamp(fields: &mut Fields<'_>, document: &mut Document) {
    let offset = "lights.moving.position_offset_m";
    let moves = fields.flag("useMovingLight").unwrap_or(true);
    let amount = fields.law("randomFloat", offset).unwrap_or(Law::Uniform(0.0, 1.0));
    let factor = fields.number("multiplyFactor", offset).unwrap_or(5.0);
    let change = fields.number("changeLightPosition", offset).unwrap_or(0.73);
    let why = "a lamp that shines to all sides looks the same however it is turned: no effect";
    fields.left_out("useRotatingLight", why);
    fields.left_out("changeLightRotation", why);
    let lamp = &mut document.lights.moving;
    // The randomizer moves it here, whatever the scene says.
    lamp.position_m = Vector::constant(0.0, 7.0, 2.0);
    lamp.position_offset_m = moved(&amount, if moves { change * factor } else { 0.0 });
}

pub(super) fn moving_lamp_off(document: &mut Document) {
    let lamp = &mut document.lights.moving;
    lamp.position_m = Vector::constant(0.0, 7.0, 5.5);
    lamp.position_offset_m = Vector::constant(0.0, 0.0, 0.0);
}

/// Moves to both sides of each axis by a law, at most by so many metres if it goes up to 1. Mirrored
/// in x.
pub(super) fn moved(amount: &Law, reach_m: f64) -> Vector {
    Vector::Axes([-reach_m, reach_m, reach_m].map(|reach| amount.either_way(reach)))
}
