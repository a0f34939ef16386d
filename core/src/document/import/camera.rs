//! Randomizers of the camera and of what happens behind its lens.

use super::fields::Fields;
use super::law::Law;
use super::light::moved;
use crate::document::{Document, Param, Vector};

/// Vertical field of view of the camera in the seed's scene, degrees.
const SCENE_FOV_DEG: f64 = 60.0;

pub(super) fn camera(fields: &mut Fields<'_>, document: &mut Document) {
    let camera = &mut document.camera;
    camera.enabled = true;
    let fov = fields.law("cameraFieldOfViewParameter", "camera.fov_vertical_deg");
    match (fields.flag("useVariableFieldOfView"), fov) {
        (Some(false), _) => {
            camera.fov_vertical_deg = Param::Constant(SCENE_FOV_DEG);
            fields.note("useVariableFieldOfView is false: the field of view is that of the scene");
        }
        (_, Some(law)) => camera.fov_vertical_deg = law.param(),
        (_, None) => {}
    }
    let why = "the camera of PeopleSansPeople is not in physical mode: the focal length changes \
        its depth of field alone";
    fields.left_out("usePhysicalCamera", why);
    let focal_length = "camera.depth_of_field.focal_length_mm";
    if let Some(law) = fields.law("cameraFocalLengthParameter", focal_length) {
        camera.depth_of_field.focal_length_mm = Some(law.param());
    }
    let (position, rotation) = ("camera.position_offset_m", "camera.rotation_offset_deg");
    let moves = fields.flag("useMovingCamera").unwrap_or(true);
    let turns = fields.flag("useRotatingCamera").unwrap_or(true);
    fields.shared("randomFloat", rotation);
    let amount = fields.law("randomFloat", position).unwrap_or(Law::Uniform(0.0, 1.0));
    fields.shared("multiplyFactor", rotation);
    let factor = fields.number("multiplyFactor", position).unwrap_or(5.0);
    let move_m = fields.number("changeCameraPosition", position).unwrap_or(1.0);
    let turn_deg = fields.number("changeCameraRotation", rotation).unwrap_or(1.0);
    camera.position_offset_m = moved(&amount, if moves { move_m * factor } else { 0.0 });
    // The seed's camera looks down -Z by a half turn about y; ours does unturned. Mirrored in x,
    // pitch and yaw then have the opposite sense and roll keeps its own.
    let reach = if turns { turn_deg * factor } else { 0.0 };
    camera.rotation_offset_deg = [-reach, -reach, reach].map(|reach| amount.either_way(reach));
}

/// As it stands in the seed's scene.
pub(super) fn camera_off(document: &mut Document) {
    let camera = &mut document.camera;
    camera.enabled = false;
    camera.fov_vertical_deg = Param::Constant(SCENE_FOV_DEG);
    camera.position_offset_m = Vector::constant(0.0, 0.0, 0.0);
    camera.rotation_offset_deg = [0.0; 3].map(Param::Constant);
}

pub(super) fn post_process(fields: &mut Fields<'_>, document: &mut Document) {
    let post = &mut document.post;
    post.enabled = true;
    let white_balance = &mut post.white_balance_temperature;
    let mapped = [
        ("fixedExposureParameter", "post.exposure_ev", &mut post.exposure_ev),
        ("vignetteIntensityParameter", "post.vignette", &mut post.vignette),
        ("whiteBalanceTemperatureParameter", "post.white_balance_temperature", white_balance),
        ("contrastParameter", "post.contrast", &mut post.contrast),
        ("saturationParameter", "post.saturation", &mut post.saturation),
    ];
    for (theirs, ours, param) in mapped {
        if let Some(law) = fields.law(theirs, ours) {
            *param = law.param();
        }
    }
    let inactive =
        |what| format!("{what} is not active in the scene of PeopleSansPeople: no effect");
    fields.left_out("filmGrainIntensityParameter", &inactive("film grain"));
    fields.left_out("lensDistortionIntensityParameter", &inactive("lens distortion"));
    let focus = "camera.depth_of_field.focus_distance_m";
    if let Some(law) = fields.law("focusDistanceParameter", focus) {
        document.camera.depth_of_field.focus_distance_m = law.param();
    }
}

/// As the seed's scene has it.
pub(super) fn post_process_off(document: &mut Document) {
    let post = &mut document.post;
    post.exposure_ev = Param::Constant(10.0);
    document.camera.depth_of_field.focus_distance_m = Param::Constant(3.0);
    let post = &mut document.post;
    for param in [
        &mut post.vignette,
        &mut post.white_balance_temperature,
        &mut post.contrast,
        &mut post.saturation,
    ] {
        *param = Param::Constant(0.0);
    }
}
