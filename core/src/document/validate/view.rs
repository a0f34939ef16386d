//! The picture's size, the camera, and what happens behind its lens: what of it makes sense.

use super::rules::{Check, Range};
use super::{ANGLE, MAX_SIDE, POSITION, SHARE};
use crate::document::{Camera, Image, JointRotation, Param, Post, Rotation};

const MAX_PIXELS: u64 = 64 << 20;
const MIN_FOV_DEG: f64 = 0.1;
const MAX_FOV_DEG: f64 = 179.0;
const FOV_DEG: Range = Range::from_to(MIN_FOV_DEG, MAX_FOV_DEG);
const COEFFICIENT: Range = Range::from_to(-1e3, 1e3);

pub(super) fn image(c: &mut Check, image: &Image) {
    c.count("image.width", image.width, 1, MAX_SIDE);
    c.count("image.height", image.height, 1, MAX_SIDE);
    let pixels = u64::from(image.width) * u64::from(image.height);
    if pixels > MAX_PIXELS {
        let got = format!("{} x {} is {pixels}", image.width, image.height);
        c.report("image", format!("must have at most {MAX_PIXELS} pixels, {got}"));
    }
}

pub(super) fn camera(c: &mut Check, camera: &Camera) {
    c.number("camera.sensor_height_mm", camera.sensor_height_mm, Range::from_to(0.1, 1e3));
    match &camera.focal_length_mm {
        None => c.param("camera.fov_vertical_deg", &camera.fov_vertical_deg, FOV_DEG),
        Some(focal_length_mm) => focal_length(c, focal_length_mm, camera.sensor_height_mm),
    };
    c.vector("camera.position_m", &camera.position_m, POSITION);
    c.vector("camera.position_offset_m", &camera.position_offset_m, POSITION);
    if let Rotation::Joint(JointRotation::Facing(_)) = &camera.rotation_deg {
        let what = "only people and occluders can face something; give Euler angles";
        c.report("camera.rotation_deg.facing", what);
    }
    c.rotation("camera.rotation_deg", &camera.rotation_deg);
    c.axes("camera.rotation_offset_deg", &camera.rotation_offset_deg, ANGLE);
    c.number("camera.near_m", camera.near_m, Range::from_to(1e-4, 1e3));
    let blur = &camera.depth_of_field;
    c.param("camera.depth_of_field.f_number", &blur.f_number, Range::from_to(0.1, 1e6));
    let focus_m = Range::from_to(1e-3, 1e9);
    c.param("camera.depth_of_field.focus_distance_m", &blur.focus_distance_m, focus_m);
    if let Some(focal_length_mm) = &blur.focal_length_mm {
        let path = "camera.depth_of_field.focal_length_mm";
        c.param(path, focal_length_mm, Range::above(0.0, 1e6));
    }
    let blur = &camera.motion_blur;
    c.param("camera.motion_blur.shutter_s", &blur.shutter_s, Range::from_to(0.0, 10.0));
    c.axes("camera.motion_blur.velocity_m_s", &blur.velocity_m_s, POSITION);
    let turn = Range::from_to(-36_000.0, 36_000.0);
    c.axes("camera.motion_blur.angular_velocity_deg_s", &blur.angular_velocity_deg_s, turn);
    if let Some(distortion) = &camera.distortion {
        // Whether a picture folds over depends on its size and the field of view, and is found out
        // frame by frame.
        for (name, coefficient) in distortion.coefficients() {
            c.param(&format!("camera.distortion.{name}"), coefficient, COEFFICIENT);
        }
    }
}

/// A focal length whose angle is one that a camera may have.
fn focal_length(c: &mut Check, focal_length_mm: &Param, sensor_height_mm: f64) -> bool {
    let path = "camera.focal_length_mm";
    if !c.param(path, focal_length_mm, Range::above(0.0, 1e6)) {
        return false;
    }
    let (shortest, longest) = focal_length_mm.bounds();
    let fov_deg = |f: f64| 2.0 * libm::atan2(0.5 * sensor_height_mm, f).to_degrees();
    // The file has not been read yet where the bounds are infinite.
    let fault = [shortest, longest].into_iter().find(|f| {
        let fov_deg = fov_deg(*f);
        f.is_finite() && !(MIN_FOV_DEG..=MAX_FOV_DEG).contains(&fov_deg)
    });
    fault.is_none_or(|f| {
        let what = format!(
            "{f} mm on {sensor_height_mm} mm give {:.3} degrees, must be {MIN_FOV_DEG} to {MAX_FOV_DEG}",
            fov_deg(f)
        );
        c.report(path, what)
    })
}

pub(super) fn post(c: &mut Check, post: &Post) {
    c.param("post.exposure_ev", &post.exposure_ev, Range::from_to(-20.0, 40.0));
    c.param("post.compensation_ev", &post.compensation_ev, Range::from_to(-20.0, 20.0));
    c.param("post.bloom", &post.bloom, Range::from_to(0.0, 1.0));
    c.param("post.bloom_scatter", &post.bloom_scatter, Range::from_to(0.0, 1.0));
    c.param("post.vignette", &post.vignette, Range::from_to(0.0, 1.0));
    c.param("post.shot_noise", &post.shot_noise, SHARE);
    c.param("post.read_noise", &post.read_noise, SHARE);
    let both_ways = [
        ("post.white_balance_temperature", &post.white_balance_temperature),
        ("post.white_balance_tint", &post.white_balance_tint),
        ("post.contrast", &post.contrast),
        ("post.saturation", &post.saturation),
    ];
    for (path, param) in both_ways {
        c.param(path, param, Range::from_to(-100.0, 100.0));
    }
    c.param("post.grain", &post.grain, Range::from_to(0.0, 1.0));
}
