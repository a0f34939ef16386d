//! Every randomizer that a scenario may hold, and what becomes of it.

use super::fields::Fields;
use super::{camera, light, place};
use crate::document::Document;

/// A randomizer.
pub(super) struct Randomizer {
    pub(super) id: &'static str,
    /// Whether PeopleSansPeople runs it.
    pub(super) of_seed: bool,
    /// Maps its fields.
    pub(super) on: fn(&mut Fields<'_>, &mut Document),
    /// What its fields are where it is switched off.
    pub(super) off: fn(&mut Document),
    /// The same in words; empty where there is nothing to say.
    pub(super) when_off: &'static str,
}

/// One of PeopleSansPeople.
const fn seeds(
    id: &'static str,
    on: fn(&mut Fields<'_>, &mut Document),
    off: fn(&mut Document),
    when_off: &'static str,
) -> Randomizer {
    Randomizer { id, of_seed: true, on, off, when_off }
}

/// One of Unity Perception that the seed does not use.
const fn perceptions(
    id: &'static str,
    on: fn(&mut Fields<'_>, &mut Document),
    off: fn(&mut Document),
    when_off: &'static str,
) -> Randomizer {
    Randomizer { id, of_seed: false, on, off, when_off }
}

/// All of them: first those of PeopleSansPeople in the order in which it runs them.
pub(super) const RANDOMIZERS: [Randomizer; 27] = [
    seeds(
        "CustomBackgroundObjectPlacementRandomizer",
        place::seeds_occluders,
        place::no_occluders,
        "there are no occluders",
    ),
    seeds(
        "CustomBackgroundOccluderScaleRandomizer",
        place::occluder_scale,
        place::occluder_scale_off,
        "occluders.scale is 10, as that of the prefabs of PeopleSansPeople",
    ),
    seeds(
        "CustomForegroundObjectPlacementRandomizer",
        place::seeds_people,
        place::nobody,
        "there are no people",
    ),
    seeds(
        "CustomForegroundScaleRandomizer",
        place::people_scale,
        place::people_scale_off,
        "people.scale is 1",
    ),
    seeds(
        "TextureRandomizer",
        place::texture,
        place::texture_off,
        "wall and occluders have no textures, as theirs in the scene are not in the file",
    ),
    seeds("HueOffsetRandomizer", place::hue, place::hue_off, "hue offsets are 0"),
    seeds(
        "RotationRandomizer",
        place::occluder_rotation,
        place::occluder_rotation_off,
        "occluders are not turned",
    ),
    seeds(
        "CustomForegroundRotationRandomizer",
        place::people_rotation,
        place::people_rotation_off,
        "people are turned as occluders are, since those of PeopleSansPeople carry both tags",
    ),
    seeds(
        "SunAngleRandomizer",
        light::sun,
        light::sun_off,
        "the sun stands where it stands in the scene of PeopleSansPeople",
    ),
    seeds(
        "AnimationRandomizer",
        place::pose,
        place::pose_off,
        "people.pose is off: all its parameters take their medians",
    ),
    seeds(
        "ShaderGraphTextureRandomizer",
        place::clothes,
        place::clothes_off,
        "hue offsets of clothes are 0; their colours and patterns are still drawn",
    ),
    seeds(
        "CustomCameraRandomizer",
        camera::camera,
        camera::camera_off,
        "the camera is that of the scene: 60 degrees, neither moved nor turned",
    ),
    seeds(
        "CustomLightRandomizer",
        light::lamps,
        light::lamps_off,
        "lamps are as in the scene: white, 1591.55 cd, always on",
    ),
    seeds(
        "CustomLightPositionRotationRandomizer",
        light::moving_lamp,
        light::moving_lamp_off,
        "the moving lamp stands at (0, 7, 5.5), as in the scene",
    ),
    seeds(
        "CustomPostProcessVolumeRandomizer",
        camera::post_process,
        camera::post_process_off,
        "post is as in the scene: an exposure value of 10 and no other effect",
    ),
    perceptions(
        "CustomNormalForegroundObjectPlacementRandomizer",
        place::normal_placement,
        place::nothing,
        "",
    ),
    perceptions(
        "BackgroundObjectPlacementRandomizer",
        place::background,
        place::no_occluders,
        "there are no occluders",
    ),
    perceptions(
        "ForegroundObjectPlacementRandomizer",
        place::foreground,
        place::nobody,
        "there are no people",
    ),
    perceptions("ColorRandomizer", place::color, place::nothing, ""),
    perceptions("LightRandomizer", by_tags, place::nothing, ""),
    perceptions("MaterialPropertyRandomizer", by_tags, place::nothing, ""),
    perceptions("MaterialSwapperRandomizer", by_tags, place::nothing, ""),
    perceptions("TransformRandomizer", by_tags, place::nothing, ""),
    perceptions("VolumeRandomizer", by_tags, place::nothing, ""),
    perceptions("SceneRandomizer", scenes, place::nothing, ""),
    perceptions("SkyboxRandomizer", skybox, place::nothing, ""),
    perceptions("SubstanceRandomizer", substance, place::nothing, ""),
];

/// One whose settings are not in the file.
fn by_tags(fields: &mut Fields<'_>, _: &mut Document) {
    fields.note(
        "is left out: its settings lie on objects of the Unity scene, not in this file; set the \
         fields of the config by hand",
    );
}

fn scenes(fields: &mut Fields<'_>, _: &mut Document) {
    fields.note("is left out: Unity scenes have no counterpart; write a config for each");
    fields.left_out("iterationsPerScene", "has no counterpart");
}

fn skybox(fields: &mut Fields<'_>, _: &mut Document) {
    fields.note(
        "is left out: its pictures are not in this file, and lights.environment has no pictures",
    );
    fields.left_out("rotation", "has no counterpart");
}

fn substance(fields: &mut Fields<'_>, _: &mut Document) {
    fields.note("is left out: Substance materials have no counterpart");
    fields.left_out("updateFrequency", "has no counterpart");
    fields.left_out("maxRandomizationsPerIteration", "has no counterpart");
}
