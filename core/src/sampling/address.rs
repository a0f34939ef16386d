//! From the path of a parameter in the document to where its numbers come from.
//!
//! The samplers name their keys themselves; this table says the same once more by path, for those who
//! look at a parameter from elsewhere. A test holds the one against the other.

use super::keys;
use super::lights::MOVING;
use crate::base::rng::Key;

/// Where the numbers of a parameter come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Address {
    pub(super) key: Key,
    /// Of what is in a frame once: 0, or a lamp's.
    pub(super) slot: u32,
    /// Its place among the numbers of one key.
    pub(super) lane: u16,
}

/// Where the parameter at a path is drawn from.
pub(super) fn address(path: &str) -> Option<Address> {
    let (path, lane) = match path.strip_suffix(']').and_then(|p| p.rsplit_once('[')) {
        Some((base, lane)) => (base, lane.parse().ok()?),
        None => (path, 0),
    };
    let path = path.strip_suffix(".hsv").or(path.strip_suffix(".linear")).unwrap_or(path);
    let listed = path.strip_prefix("lights.points[").and_then(|rest| rest.split_once("]."));
    let (slot, field, table) = match (listed, path.strip_prefix("lights.moving.")) {
        (Some((index, field)), _) => (index.parse().ok()?, field, LAMP),
        (None, Some(field)) => (MOVING, field, LAMP),
        (None, None) => (0, path, PARAMS),
    };
    let (_, key) = table.iter().find(|(name, _)| *name == field)?;
    Some(Address { key: *key, slot, lane })
}

/// Of a lamp.
const LAMP: &[(&str, Key)] = &[
    ("position_m", keys::LAMP_POSITION),
    ("position_offset_m", keys::LAMP_POSITION_OFFSET),
    ("intensity_cd", keys::LAMP_INTENSITY),
    ("color", keys::LAMP_COLOR),
    ("temperature_k", keys::LAMP_TEMPERATURE),
];

/// Of everything else.
const PARAMS: &[(&str, Key)] = &[
    ("camera.fov_vertical_deg", keys::CAMERA_FOV),
    ("camera.focal_length_mm", keys::CAMERA_FOCAL_LENGTH),
    ("camera.position_m", keys::CAMERA_POSITION),
    ("camera.position_offset_m", keys::CAMERA_POSITION_OFFSET),
    ("camera.rotation_deg", keys::CAMERA_ROTATION),
    ("camera.rotation_offset_deg", keys::CAMERA_ROTATION_OFFSET),
    ("camera.depth_of_field.f_number", keys::F_NUMBER),
    ("camera.depth_of_field.focus_distance_m", keys::FOCUS_DISTANCE),
    ("camera.depth_of_field.focal_length_mm", keys::BLUR_FOCAL_LENGTH),
    ("camera.motion_blur.shutter_s", keys::SHUTTER),
    ("camera.motion_blur.velocity_m_s", keys::CAMERA_VELOCITY),
    ("camera.motion_blur.angular_velocity_deg_s", keys::CAMERA_TURN),
    ("camera.distortion.k1", keys::LENS_K1),
    ("camera.distortion.k2", keys::LENS_K2),
    ("camera.distortion.k3", keys::LENS_K3),
    ("camera.distortion.k4", keys::LENS_K4),
    ("camera.distortion.p1", keys::LENS_P1),
    ("camera.distortion.p2", keys::LENS_P2),
    ("lights.sun.direction.hour", keys::SUN_HOUR),
    ("lights.sun.direction.day_of_year", keys::SUN_DAY),
    ("lights.sun.direction.latitude_deg", keys::SUN_LATITUDE),
    ("lights.sun.direction.azimuth_deg", keys::SUN_AZIMUTH),
    ("lights.sun.direction.elevation_deg", keys::SUN_ELEVATION),
    ("lights.sun.illuminance_lux", keys::SUN_ILLUMINANCE),
    ("lights.sun.color", keys::SUN_COLOR),
    ("lights.sun.temperature_k", keys::SUN_TEMPERATURE),
    ("lights.environment.sky_lux", keys::SKY),
    ("lights.environment.sky_color", keys::SKY_COLOR),
    ("lights.environment.ground_lux", keys::GROUND),
    ("lights.environment.ground_color", keys::GROUND_COLOR),
    ("lights.environment.background_nits", keys::BACKGROUND),
    ("lights.environment.background_color", keys::BACKGROUND_COLOR),
    ("lights.environment.image.rotation_deg", keys::IMAGE_ROTATION),
    ("lights.environment.image.illuminance_lux", keys::IMAGE_ILLUMINANCE),
    ("lights.environment.image.sky.turbidity", keys::SKY_TURBIDITY),
    ("lights.environment.image.sky.cloud_cover", keys::SKY_CLOUD_COVER),
    ("background.wall.position_m", keys::WALL_POSITION),
    ("background.wall.color", keys::WALL_COLOR),
    ("background.wall.hue_offset_deg", keys::WALL_HUE),
    ("background.floor.position_m", keys::FLOOR_POSITION),
    ("background.floor.color", keys::FLOOR_COLOR),
    ("background.floor.hue_offset_deg", keys::FLOOR_HUE),
    ("occluders.placement.depth_m", keys::OCCLUDER_DEPTH),
    ("occluders.placement.count", keys::OCCLUDER_COUNT),
    ("occluders.rotation_deg.facing.yaw_deg", keys::OCCLUDER_ROTATION),
    ("occluders.scale", keys::OCCLUDER_SCALE),
    ("occluders.rotation_deg", keys::OCCLUDER_ROTATION),
    ("occluders.color", keys::OCCLUDER_COLOR),
    ("occluders.hue_offset_deg", keys::OCCLUDER_HUE),
    ("people.placement.depth_m", keys::PERSON_DEPTH),
    ("people.placement.count", keys::PERSON_COUNT),
    ("people.rotation_deg.facing.yaw_deg", keys::PERSON_ROTATION),
    ("people.scale", keys::PERSON_SCALE),
    ("people.rotation_deg", keys::PERSON_ROTATION),
    ("people.body.age_years", keys::AGE),
    ("people.body.stature_m", keys::STATURE),
    ("people.body.bmi_kg_m2", keys::BMI),
    ("people.body.muscle", keys::MUSCLE),
    ("people.body.proportions", keys::PROPORTIONS),
    ("people.body.cup", keys::CUP),
    ("people.body.firmness", keys::FIRMNESS),
    ("people.look.skin", keys::SKIN),
    ("people.look.hair_color", keys::HAIR_COLOR),
    ("people.look.headwear_color", keys::HEADWEAR_COLOR),
    ("people.look.iris_color", keys::IRIS),
    ("people.look.face_targets", keys::FACE_COUNT),
    ("people.look.expression.strength", keys::EXPRESSION_STRENGTH),
    ("people.look.expression.gaze_yaw_deg", keys::GAZE_YAW),
    ("people.look.expression.gaze_pitch_deg", keys::GAZE_PITCH),
    ("people.wardrobe.top.sleeve", keys::TOP_SLEEVE),
    ("people.wardrobe.top.neckline", keys::TOP_NECKLINE),
    ("people.wardrobe.top.looseness_m", keys::TOP_LOOSENESS),
    ("people.wardrobe.top.color", keys::TOP_COLOR),
    ("people.wardrobe.top.hue_offset_deg", keys::TOP_HUE),
    ("people.wardrobe.bottom.trousers_length", keys::BOTTOM_TROUSERS),
    ("people.wardrobe.bottom.shorts_length", keys::BOTTOM_SHORTS),
    ("people.wardrobe.bottom.skirt_length", keys::BOTTOM_SKIRT),
    ("people.wardrobe.bottom.flare", keys::BOTTOM_FLARE),
    ("people.wardrobe.bottom.looseness_m", keys::BOTTOM_LOOSENESS),
    ("people.wardrobe.bottom.color", keys::BOTTOM_COLOR),
    ("people.wardrobe.bottom.hue_offset_deg", keys::BOTTOM_HUE),
    ("people.wardrobe.outer.looseness_m", keys::OUTER_LOOSENESS),
    ("people.wardrobe.outer.color", keys::OUTER_COLOR),
    ("people.wardrobe.outer.hue_offset_deg", keys::OUTER_HUE),
    ("people.wardrobe.shoes.color", keys::SHOE_COLOR),
    ("people.wardrobe.shoes.socks", keys::SOCKS),
    ("people.wardrobe.shoes.sock_color", keys::SOCK_COLOR),
    ("people.pose.phase", keys::PHASE),
    ("people.pose.variation", keys::POSE_VARIATION),
    ("people.pose.blend.phase", keys::BLEND_PHASE),
    ("people.pose.blend.share", keys::BLEND_SHARE),
    ("people.pose.gaze_deg", keys::GAZE),
    ("people.seats.color", keys::SEAT_COLOR),
    ("people.seats.hue_offset_deg", keys::SEAT_HUE),
    ("materials.roughness", keys::MATERIAL_ROUGHNESS),
    ("materials.metallic", keys::MATERIAL_METALLIC),
    ("materials.normal_strength", keys::MATERIAL_NORMAL),
    ("post.exposure_ev", keys::EXPOSURE),
    ("post.compensation_ev", keys::COMPENSATION),
    ("post.bloom", keys::BLOOM),
    ("post.bloom_scatter", keys::BLOOM_SCATTER),
    ("post.vignette", keys::VIGNETTE),
    ("post.shot_noise", keys::SHOT_NOISE),
    ("post.read_noise", keys::READ_NOISE),
    ("post.white_balance_temperature", keys::TEMPERATURE),
    ("post.white_balance_tint", keys::TINT),
    ("post.contrast", keys::CONTRAST),
    ("post.saturation", keys::SATURATION),
    ("post.grain", keys::GRAIN),
    ("output.jpeg_quality", keys::JPEG_QUALITY),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, file, params, presets};

    #[test]
    fn every_parameter_has_an_address_of_its_own() {
        for preset in presets::ALL {
            let document: Document = file::parse(preset.text).unwrap();
            let mut seen = Vec::new();
            // Parts of mixtures of colours cannot be looked at.
            for path in params(&document).keys().filter(|path| !path.contains(".mix[")) {
                let at = address(path).unwrap_or_else(|| panic!("{}: {path}", preset.name));
                assert!(!seen.contains(&at), "{}: {path} shares its numbers", preset.name);
                seen.push(at);
            }
        }
    }

    #[test]
    fn paths_lead_to_keys_slots_and_lanes() {
        let of = |key, slot, lane| Some(Address { key, slot, lane });
        for (path, expected) in [
            ("camera.position_m[2]", of(keys::CAMERA_POSITION, 0, 2)),
            ("lights.points[12].color.hsv[1]", of(keys::LAMP_COLOR, 12, 1)),
            ("lights.moving.intensity_cd", of(keys::LAMP_INTENSITY, MOVING, 0)),
            ("people.pose.gaze_deg[1]", of(keys::GAZE, 0, 1)),
            ("background.wall.color.linear[0]", of(keys::WALL_COLOR, 0, 0)),
            ("background.wall", None),
            ("lights.points[x].color[0]", None),
        ] {
            assert_eq!(address(path), expected, "{path}");
        }
    }
}
