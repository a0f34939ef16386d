//! The names of all random quantities. A name is written once and stays: renaming a field of the
//! document changes no value, and a new quantity gets a new name.

use crate::base::rng::Key;

macro_rules! keys {
    ($($name:ident = $text:literal,)*) => {
        $(pub(super) const $name: Key = Key::new($text);)*
        #[cfg(test)]
        const ALL: &[(&str, Key)] = &[$(($text, $name),)*];
    };
}

keys! {
    CAMERA_FOV = "camera.fov_vertical",
    CAMERA_POSITION = "camera.position",
    CAMERA_POSITION_OFFSET = "camera.position_offset",
    CAMERA_ROTATION = "camera.rotation",
    CAMERA_ROTATION_OFFSET = "camera.rotation_offset",
    SUN_HOUR = "lights.sun.hour",
    SUN_DAY = "lights.sun.day_of_year",
    SUN_LATITUDE = "lights.sun.latitude",
    SUN_AZIMUTH = "lights.sun.azimuth",
    SUN_ELEVATION = "lights.sun.elevation",
    SUN_ILLUMINANCE = "lights.sun.illuminance",
    SUN_COLOR = "lights.sun.color",
    LAMP_ON = "lights.lamp.on",
    LAMP_POSITION = "lights.lamp.position",
    LAMP_POSITION_OFFSET = "lights.lamp.position_offset",
    LAMP_INTENSITY = "lights.lamp.intensity",
    LAMP_COLOR = "lights.lamp.color",
    SKY = "lights.environment.sky",
    SKY_COLOR = "lights.environment.sky_color",
    GROUND = "lights.environment.ground",
    GROUND_COLOR = "lights.environment.ground_color",
    BACKGROUND = "lights.environment.background",
    BACKGROUND_COLOR = "lights.environment.background_color",
    WALL_POSITION = "background.wall.position",
    WALL_TEXTURE = "background.wall.texture",
    WALL_COLOR = "background.wall.color",
    WALL_HUE = "background.wall.hue_offset",
    FLOOR_POSITION = "background.floor.position",
    FLOOR_TEXTURE = "background.floor.texture",
    FLOOR_COLOR = "background.floor.color",
    FLOOR_HUE = "background.floor.hue_offset",
    MATERIAL_ROUGHNESS = "materials.roughness",
    MATERIAL_METALLIC = "materials.metallic",
    MATERIAL_NORMAL = "materials.normal_strength",
    OCCLUDER_PLACE = "occluders.placement",
    OCCLUDER_DEPTH = "occluders.placement.depth",
    OCCLUDER_COUNT = "occluders.placement.count",
    OCCLUDER_SCALE = "occluders.scale",
    OCCLUDER_ROTATION = "occluders.rotation",
    OCCLUDER_SHAPE = "occluders.shape",
    OCCLUDER_TEXTURE = "occluders.texture",
    OCCLUDER_COLOR = "occluders.color",
    OCCLUDER_HUE = "occluders.hue_offset",
    PERSON_PLACE = "people.placement",
    PERSON_DEPTH = "people.placement.depth",
    PERSON_COUNT = "people.placement.count",
    PERSON_SCALE = "people.scale",
    PERSON_ROTATION = "people.rotation",
    IDENTITY = "people.identities",
    AGE = "people.body.age",
    SEX = "people.body.sex",
    STATURE = "people.body.stature",
    MUSCLE = "people.body.muscle",
    BMI = "people.body.bmi",
    PROPORTIONS = "people.body.proportions",
    ANCESTRY = "people.body.ancestry",
    CUP = "people.body.cup",
    FIRMNESS = "people.body.firmness",
    SKIN = "people.look.skin",
    HAIR = "people.look.hair",
    HAIR_COLOR = "people.look.hair_color",
    GREYING = "people.look.greying",
    DYED = "people.look.dyed",
    DYE = "people.look.dye",
    BEARD = "people.look.beard",
    HEADWEAR = "people.look.headwear",
    HEADWEAR_COLOR = "people.look.headwear_color",
    GLASSES = "people.look.glasses",
    IRIS = "people.look.iris",
    FRECKLES = "people.look.freckles",
    FLUSH = "people.look.flush",
    FACE_COUNT = "people.look.face_targets",
    FACE_ORDER = "people.look.face_order",
    FACE_AMOUNT = "people.look.face_amount",
    EXPRESSION = "people.look.expression",
    EXPRESSION_STRENGTH = "people.look.expression.strength",
    GAZE_YAW = "people.look.gaze_yaw",
    GAZE_PITCH = "people.look.gaze_pitch",
    SEASON = "people.wardrobe.season",
    OUTFIT = "people.wardrobe.outfit",
    TOP_KIND = "people.wardrobe.top.kind",
    TOP_SLEEVE = "people.wardrobe.top.sleeve",
    TOP_NECKLINE = "people.wardrobe.top.neckline",
    TOP_LOOSENESS = "people.wardrobe.top.looseness",
    TOP_COLOR = "people.wardrobe.top.color",
    TOP_PATTERN = "people.wardrobe.top.pattern",
    TOP_HUE = "people.wardrobe.top.hue_offset",
    BOTTOM_KIND = "people.wardrobe.bottom.kind",
    BOTTOM_TROUSERS = "people.wardrobe.bottom.trousers_length",
    BOTTOM_SHORTS = "people.wardrobe.bottom.shorts_length",
    BOTTOM_SKIRT = "people.wardrobe.bottom.skirt_length",
    BOTTOM_FLARE = "people.wardrobe.bottom.flare",
    BOTTOM_LOOSENESS = "people.wardrobe.bottom.looseness",
    BOTTOM_COLOR = "people.wardrobe.bottom.color",
    BOTTOM_PATTERN = "people.wardrobe.bottom.pattern",
    BOTTOM_HUE = "people.wardrobe.bottom.hue_offset",
    OUTER_KIND = "people.wardrobe.outer.kind",
    OUTER_OPEN = "people.wardrobe.outer.open",
    OUTER_LOOSENESS = "people.wardrobe.outer.looseness",
    OUTER_COLOR = "people.wardrobe.outer.color",
    OUTER_PATTERN = "people.wardrobe.outer.pattern",
    OUTER_HUE = "people.wardrobe.outer.hue_offset",
    SHOE_KIND = "people.wardrobe.shoes.kind",
    SOCKS = "people.wardrobe.shoes.socks",
    SOCK_COLOR = "people.wardrobe.shoes.sock_color",
    SHOE_COLOR = "people.wardrobe.shoes.color",
    CLIP = "people.pose.clip",
    PHASE = "people.pose.phase",
    MIRRORED = "people.pose.mirrored",
    POSE_VARIATION = "people.pose.variation",
    POSE_ANGLE = "people.pose.variation.angle",
    BLEND_CLIP = "people.pose.blend.clip",
    BLEND_PHASE = "people.pose.blend.phase",
    BLEND_SHARE = "people.pose.blend.share",
    HANDS = "people.pose.hands",
    GAZE = "people.pose.gaze",
    EXPOSURE = "post.exposure",
    COMPENSATION = "post.compensation",
    VIGNETTE = "post.vignette",
    TEMPERATURE = "post.white_balance_temperature",
    TINT = "post.white_balance_tint",
    CONTRAST = "post.contrast",
    SATURATION = "post.saturation",
    GRAIN = "post.grain",
    GRAIN_NOISE = "post.grain.noise",
    PERSON_CHOSEN = "people.placement.chosen",
    PERSON_IN_VIEW = "people.placement.in_view",
    OCCLUDER_CHOSEN = "occluders.placement.chosen",
    OCCLUDER_IN_VIEW = "occluders.placement.in_view",
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn no_two_names_share_a_hash() {
        let mut seen = BTreeMap::new();
        for (name, key) in ALL {
            if let Some(other) = seen.insert(*key, *name) {
                panic!("{name} and {other} have the same key");
            }
        }
    }
}
