mod refused;

use glam::{DMat3, DVec3};
use serde_json::{Value, json};

use super::*;
use crate::base::math::rotation_from_euler_deg;
use crate::document::Problem;
use crate::document::{
    Choice, Color, ColorLaw, Distribution, Flag, Normal, Param, Placement, PoissonDisk, Rotation,
    SunAngles, SunDirection, Vector, presets,
};

const SEEDS: &str =
    include_str!("../../../../tests/data/peoplesanspeople/scenarioConfiguration.json");

/// A scenario of some randomizers.
fn of(groups: &[Value]) -> String {
    json!({"constants": {}, "randomizers": {"randomizerGroups": groups}}).to_string()
}

fn group(id: &str, items: Value) -> Value {
    json!({"randomizerId": id, "items": items})
}

fn off(id: &str) -> Value {
    json!({"randomizerId": id, "state": {"enabled": false, "canBeSwitchedByUser": true}})
}

fn num(value: f64) -> Value {
    json!({"scalar": {"value": {"num": value}}})
}

fn flag(value: bool) -> Value {
    json!({"scalar": {"value": {"bool": value}}})
}

/// A parameter of one component.
fn param(sampler: Value) -> Value {
    params(json!({"value": sampler}))
}

fn params(samplers: Value) -> Value {
    let mut items = samplers;
    for item in items.as_object_mut().unwrap().values_mut() {
        *item = json!({"samplerOptions": item});
    }
    json!({"param": {"items": items}})
}

fn uniform(min: f64, max: f64) -> Value {
    json!({"uniform": {"min": min, "max": max}})
}

fn import(groups: &[Value]) -> Imported {
    scenario(&of(groups)).unwrap()
}

fn document(groups: &[Value]) -> Document {
    import(groups).document
}

fn problems(text: &str) -> Vec<Problem> {
    match scenario(text).unwrap_err() {
        ImportError::Invalid(problems) => problems.0,
        other => panic!("{other}"),
    }
}

fn disk(placement: Placement) -> PoissonDisk {
    match placement {
        Placement::PoissonDisk(disk) => disk,
        other => panic!("{other:?}"),
    }
}

/// The default document with everything else that a scenario can say.
fn other_document() -> Document {
    let mut d = Document { seed: 1, frames: 7, ..Document::default() };
    let none = || Choice::Always("none".to_owned());
    for placement in [&mut d.people.placement, &mut d.occluders.placement] {
        *placement = Placement::PoissonDisk(PoissonDisk {
            x_m: [1.0, 2.0],
            y_m: [1.0, 2.0],
            depth_m: Param::Constant(1.0),
            separation_m: 0.5,
            count: None,
            no_overlap: false,
            in_view: 0.0,
        });
    }
    (d.people.enabled, d.occluders.enabled) = (false, false);
    (d.people.scale, d.occluders.scale) = (Param::Constant(2.0), Param::Constant(2.0));
    let turned = || Rotation::Euler([1.0, 2.0, 3.0].map(Param::Constant));
    (d.people.rotation_deg, d.occluders.rotation_deg) = (turned(), turned());
    (d.background.wall.texture, d.occluders.texture) = (none(), none());
    d.background.wall.hue_offset_deg = Param::Constant(1.0);
    d.occluders.hue_offset_deg = Param::Constant(1.0);
    let (azimuth_deg, elevation_deg) = (1.0.into(), 2.0.into());
    d.lights.sun.direction = SunDirection::Angles(SunAngles { azimuth_deg, elevation_deg });
    d.people.pose.enabled = false;
    d.people.wardrobe.top.hue_offset_deg = Param::Constant(1.0);
    d.people.wardrobe.bottom.hue_offset_deg = Param::Constant(1.0);
    d.camera.enabled = false;
    d.camera.fov_vertical_deg = Param::Constant(30.0);
    d.camera.position_offset_m = Vector::constant(1.0, 2.0, 3.0);
    d.camera.rotation_offset_deg = [1.0, 2.0, 3.0].map(Param::Constant);
    for lamp in &mut d.lights.points {
        (lamp.on, lamp.intensity_cd, lamp.color) = (Flag::Always(false), 1.0.into(), Color::WHITE);
    }
    let moving = &mut d.lights.moving;
    (moving.on, moving.intensity_cd) = (Flag::Always(false), 1.0.into());
    moving.color = Color::WHITE;
    moving.position_m = Vector::constant(1.0, 1.0, 1.0);
    moving.position_offset_m = Vector::constant(1.0, 1.0, 1.0);
    d.post.enabled = false;
    d.post.exposure_ev = Param::Constant(3.0);
    d.post.vignette = Param::Constant(0.1);
    d.post.white_balance_temperature = Param::Constant(1.0);
    d.post.contrast = Param::Constant(2.0);
    d.post.saturation = Param::Constant(3.0);
    d
}

#[test]
fn the_seeds_own_file_is_the_seeds_preset() {
    let mut preset = file::parse(presets::find("peoplesanspeople").unwrap().text).unwrap();
    preset.name.clear();
    assert_eq!(scenario(SEEDS).unwrap().document, preset);
    // From whatever it starts: all of these fields come from the file.
    assert_eq!(onto(other_document(), SEEDS).unwrap().document, preset);
}

#[test]
fn what_the_seeds_file_says_in_vain_is_noted() {
    let notes = scenario(SEEDS).unwrap().notes;
    let at =
        |group: usize, item: &str| format!("randomizers.randomizerGroups[{group}].items.{item}");
    let expected = [
        at(10, "hueTop"),
        at(10, "hueBottom"),
        at(11, "usePhysicalCamera"),
        at(13, "useRotatingLight"),
        at(13, "changeLightRotation"),
        at(14, "filmGrainIntensityParameter"),
        at(14, "lensDistortionIntensityParameter"),
    ];
    let paths: Vec<&str> = notes.iter().map(|n| n.path.as_str()).collect();
    assert_eq!(paths, expected, "{notes:#?}");
}

#[test]
fn positions_and_angles_are_mirrored() {
    let d = document(&[
        group(
            "CustomForegroundObjectPlacementRandomizer",
            json!({"minX": num(-1.0), "maxX": num(4.0), "minY": num(0.0), "maxY": num(3.0),
                "depth": param(uniform(-2.0, 6.0)), "separationDistance": num(1.5)}),
        ),
        group("CustomBackgroundObjectPlacementRandomizer", json!({"maxX": num(2.0)})),
        group(
            "CustomForegroundRotationRandomizer",
            json!({"rotation": params(json!({"x": uniform(5.0, 10.0), "y": uniform(0.0, 90.0),
                "z": {"constant": {"value": 3.0}}}))}),
        ),
    ]);
    let people = disk(d.people.placement);
    assert_eq!((people.x_m, people.y_m), ([-4.0, 1.0], [0.0, 3.0]));
    assert_eq!((people.depth_m, people.separation_m), (Param::uniform(-2.0, 6.0), 1.5));
    // Where a group says nothing, the seed's values stay.
    let occluders = disk(d.occluders.placement);
    assert_eq!((occluders.x_m, occluders.y_m), ([-2.0, 7.5], [-7.5, 7.5]));
    let turned = [Param::uniform(5.0, 10.0), Param::uniform(-90.0, 0.0), Param::Constant(-3.0)];
    assert_eq!(d.people.rotation_deg, Rotation::Euler(turned));
}

#[test]
fn cameras_and_lamps_move_by_their_formulas() {
    let d = document(&[
        group(
            "CustomCameraRandomizer",
            json!({"changeCameraPosition": num(0.5), "multiplyFactor": num(4.0),
                "useRotatingCamera": flag(false), "randomFloat": param(uniform(0.25, 1.25)),
                "cameraFieldOfViewParameter": param(uniform(20.0, 30.0))}),
        ),
        group("CustomLightPositionRotationRandomizer", json!({"useMovingLight": flag(false)})),
        group(
            "CustomLightRandomizer",
            json!({"lightIntensityParameter": param(uniform(0.0, 0.5)),
                "auxParameter": param(json!({"constant": {"value": 0.9}})),
                "lightColorParameter": params(json!({"green": uniform(0.4, 1.0)}))}),
        ),
    ]);
    let side = |a: f64, b: f64| Param::uniform(a, b);
    let (plus, minus) = (side(0.5, 2.5), side(-2.5, -0.5));
    // Three draws in four are above a half and go to +x there, which is -x here.
    let along = Param::mix([(0.75, plus.clone()), (0.25, minus.clone())]);
    let mirrored = Param::mix([(0.75, minus), (0.25, plus)]);
    assert_eq!(d.camera.position_offset_m, Vector::Axes([mirrored, along.clone(), along]));
    assert_eq!(d.camera.rotation_offset_deg, [0.0; 3].map(Param::Constant));
    assert_eq!(d.camera.fov_vertical_deg, Param::uniform(20.0, 30.0));
    assert_eq!(d.lights.moving.position_offset_m, Vector::constant(0.0, 0.0, 0.0));
    for (on, intensity, color) in d
        .lights
        .points
        .iter()
        .map(|p| (p.on, &p.intensity_cd, &p.color))
        .chain([(d.lights.moving.on, &d.lights.moving.intensity_cd, &d.lights.moving.color)])
    {
        assert_eq!(on, Flag::Always(false));
        assert_eq!(*intensity, Param::uniform(5_000.0, 27_500.0));
        let unit = || Param::uniform(0.0, 1.0);
        assert_eq!(*color, Color::Srgb([unit(), Param::uniform(0.4, 1.0), unit()]));
    }
}

/// The scenario's matrices, mirrored in x as a whole, against ours from the imported angles.
#[test]
fn turned_objects_and_cameras_are_mirror_images() {
    let constant = |value: f64| json!({"constant": {"value": value}});
    let d = document(&[
        group(
            "RotationRandomizer",
            json!({"rotation": params(json!({"x": constant(20.0), "y": constant(50.0),
                "z": constant(-70.0)}))}),
        ),
        group(
            "CustomCameraRandomizer",
            json!({"changeCameraRotation": num(3.0), "randomFloat": param(constant(1.0))}),
        ),
    ]);
    let matrix = |[x, y, z]: [f64; 3]| DMat3::from_quat(rotation_from_euler_deg(x, y, z));
    let angles = |params: &[Param; 3]| {
        let angle = |p: &Param| match p {
            Param::Constant(angle) => *angle,
            Param::Random(_) => panic!("{p:?}"),
        };
        [0, 1, 2].map(|i| angle(&params[i]))
    };
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let Rotation::Euler(params) = &d.occluders.rotation_deg else { panic!("{d:?}") };
    let expected = mirror * matrix([20.0, 50.0, -70.0]) * mirror;
    assert!(matrix(angles(params)).abs_diff_eq(expected, 1e-12), "{params:?}");
    // Their camera looks down its +Z, ours down its -Z; both have x to the right of the picture.
    let theirs = matrix([15.0, 180.0 + 15.0, 15.0]);
    let expected = mirror * theirs * DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let ours = angles(&d.camera.rotation_offset_deg);
    assert!(matrix(ours).abs_diff_eq(expected, 1e-12), "{ours:?}");
    assert_eq!(d.camera.position_offset_m, Vector::constant(-5.0, 5.0, 5.0));
}

#[test]
fn what_is_switched_off_is_as_in_the_seeds_scene() {
    let all: Vec<Value> = RANDOMIZERS.iter().filter(|r| r.of_seed).map(|r| off(r.id)).collect();
    let Imported { document: d, notes } = import(&all);
    assert_eq!(notes.len(), all.len(), "{notes:#?}");
    assert!(!d.people.enabled && !d.occluders.enabled);
    assert!(!d.people.pose.enabled && !d.camera.enabled);
    assert_eq!((d.people.scale, d.occluders.scale), (1.0.into(), 10.0.into()));
    assert_eq!((d.people.rotation_deg, d.occluders.rotation_deg), (Rotation::NONE, Rotation::NONE));
    assert_eq!(d.background.wall.texture, Choice::Always("none".to_owned()));
    assert_eq!(d.background.wall.hue_offset_deg, Param::Constant(0.0));
    assert_eq!(d.people.wardrobe.top.hue_offset_deg, Param::Constant(0.0));
    assert_eq!(d.camera.fov_vertical_deg, Param::Constant(60.0));
    assert_eq!(d.camera.position_offset_m, Vector::constant(0.0, 0.0, 0.0));
    assert_eq!(d.lights.points[5].on, Flag::Always(true));
    assert_eq!(d.lights.moving.position_m, Vector::constant(0.0, 7.0, 5.5));
    assert_eq!(d.post.exposure_ev, Param::Constant(10.0));
    assert_eq!((d.post.vignette, d.post.contrast), (0.0.into(), 0.0.into()));
    assert!(matches!(d.lights.sun.direction, SunDirection::Angles(_)));
}

/// The seed's people carry the tags of both rotations, and the later one wins.
#[test]
fn people_without_a_rotation_of_their_own_are_turned_as_occluders() {
    let turn = json!({"rotation": params(json!({"x": uniform(0.0, 10.0), "y": uniform(0.0, 20.0),
        "z": uniform(0.0, 30.0)}))});
    let d =
        document(&[off("CustomForegroundRotationRandomizer"), group("RotationRandomizer", turn)]);
    let angles = [(0.0, 10.0), (-20.0, 0.0), (-30.0, 0.0)].map(|(a, b)| Param::uniform(a, b));
    assert_eq!(d.occluders.rotation_deg, Rotation::Euler(angles));
    assert_eq!(d.people.rotation_deg, d.occluders.rotation_deg);
}

#[test]
fn every_sampler_is_read_in_every_spelling() {
    let scale = |sampler: Value| {
        let d =
            document(&[group("CustomForegroundScaleRandomizer", json!({"scale": param(sampler)}))]);
        d.people.scale
    };
    let normal = |min, max| {
        let (mean, std) = (1.0, 0.2);
        Param::Random(Distribution::Normal(Normal { mean, std, min: Some(min), max: Some(max) }))
    };
    let short = json!({"min": 0.5, "max": 2.0, "mean": 1.0, "stddev": 0.2});
    assert_eq!(scale(json!({"normal": short})), normal(0.5, 2.0));
    let long = json!({"range": {"minimum": 0.5, "maximum": 2.0}, "mean": 1.0,
        "standardDeviation": 0.2});
    assert_eq!(scale(json!({"normal": long})), normal(0.5, 2.0));
    let range = json!({"range": {"minimum": 1, "maximum": 2}});
    assert_eq!(scale(json!({"uniform": range})), Param::uniform(1.0, 2.0));
    assert_eq!(scale(uniform(2.0, 2.0)), Param::Constant(2.0));
    assert_eq!(scale(json!({"constant": {"value": 0.730_000_019_073_486_3}})), 0.73.into());
    let tent = json!({"curve": {"keys": [{"time": 0.5, "value": 0}, [1, 2], [2, 0]]}});
    let points = vec![(0.5, 0.0), (1.0, 2.0), (2.0, 0.0)];
    assert_eq!(scale(tent), Param::Random(Distribution::Curve(points)));
    // A scalar where a parameter is usual.
    let d = document(&[group("CustomForegroundScaleRandomizer", json!({"scale": num(2.0)}))]);
    assert_eq!(d.people.scale, Param::Constant(2.0));
}

#[test]
fn groups_by_id_are_read_as_well() {
    let text = json!({"randomizers": {"groups": {"CustomForegroundScaleRandomizer": {
        "metadata": {}, "items": {"scale": param(uniform(1.0, 2.0))}}}}})
    .to_string();
    let imported = scenario(&text).unwrap();
    assert_eq!(imported.document.people.scale, Param::uniform(1.0, 2.0));
    let [note] = imported.notes.as_slice() else { panic!("{:#?}", imported.notes) };
    assert!(note.message.contains("keep its values: CustomBackgroundObject"), "{note}");
    assert_eq!(note.message.matches("Randomizer").count(), 14, "{note}");
}

#[test]
fn limits_clamp_and_say_so() {
    let places = [
        json!({"uniform": {"min": 0.5, "max": 9.0, "limits": {"min": 1.0, "max": 2.0}}}),
        json!({"uniform": {"min": 0.5, "max": 9.0}, "limits": {"min": 1.0, "max": 2.0}}),
        json!({"uniform": {"min": 0.5, "max": 9.0, "minAllowed": 1.0, "maxAllowed": 2.0,
            "shouldCheckValidRange": true}}),
    ];
    for sampler in places {
        let groups =
            [group("CustomForegroundScaleRandomizer", json!({"scale": param(sampler.clone())}))];
        let imported = import(&groups);
        assert_eq!(imported.document.people.scale, Param::uniform(1.0, 2.0), "{sampler}");
        let note = &imported.notes[0];
        assert!(note.path.ends_with("samplerOptions.uniform"), "{note}");
        assert!(note.message.contains("0.5 to 9 leaves the limits 1 to 2"), "{note}");
    }
    let harmless = json!({"uniform": {"min": 1, "max": 2, "minAllowed": 0, "maxAllowed": 0,
        "shouldCheckValidRange": false}});
    let groups = [group("CustomForegroundScaleRandomizer", json!({"scale": param(harmless)}))];
    let imported = import(&groups);
    assert_eq!(imported.document.people.scale, Param::uniform(1.0, 2.0));
    assert_eq!(imported.notes.len(), 1, "{:#?}", imported.notes);
}

#[test]
fn constants_of_both_versions_are_read() {
    let with = |constants: Value| {
        let mut found = scenario(&json!({"constants": constants}).to_string()).unwrap();
        found.notes.retain(|note| note.path.starts_with("constants."));
        found
    };
    let old = with(json!({"randomSeed": 9, "totalIterations": 12.0, "framesPerIteration": 1,
        "instanceCount": 1, "instanceIndex": 0}));
    assert_eq!((old.document.seed, old.document.frames), (9, 12));
    assert_eq!(old.notes, []);
    let new = with(json!({"randomSeed": 9, "startIteration": 5, "iterationCount": 20}));
    assert_eq!(new.document.frames, 25);
    assert_eq!(new.notes[0].path, "constants.startIteration");
    assert!(new.notes[0].message.contains("--frames 5..25"), "{}", new.notes[0]);
    let odd = with(json!({"framesPerIteration": 3, "instanceCount": 4, "instanceIndex": 2,
        "randmoSeed": 0.5}));
    let paths: Vec<_> = odd.notes.iter().map(|n| n.path.as_str()).collect();
    let expected = ["randmoSeed", "framesPerIteration", "instanceCount", "instanceIndex"];
    assert_eq!(paths, expected.map(|name| format!("constants.{name}")));
    assert!(odd.notes[0].message.contains("did you mean `randomSeed`?"), "{}", odd.notes[0]);
}

#[test]
fn randomizers_of_perception_are_mapped_or_noted() {
    let imported = import(&[
        group(
            "BackgroundObjectPlacementRandomizer",
            json!({"depth": num(3.0), "layerCount": num(4.0), "separationDistance": num(2.0)}),
        ),
        group("ForegroundObjectPlacementRandomizer", json!({"depth": num(-1.0)})),
        group(
            "ColorRandomizer",
            json!({"colorParameter": params(json!({"hue": uniform(0.0, 0.5),
                "saturation": uniform(0.2, 1.0), "value": uniform(0.5, 1.0),
                "alpha": uniform(0.0, 1.0)}))}),
        ),
        group("VolumeRandomizer", json!({})),
        group("SkyboxRandomizer", json!({"rotation": param(uniform(0.0, 360.0))})),
    ]);
    let d = imported.document;
    let occluders = disk(d.occluders.placement);
    // Four layers 2 m apart each: four times as many as one, half as far from each other.
    let layers = [3.0, 5.0, 7.0, 9.0].map(|z| (z, 1.0)).to_vec();
    assert_eq!(occluders.depth_m, Param::Random(Distribution::Choice(layers)));
    assert_eq!(occluders.separation_m, 1.0);
    let people = disk(d.people.placement);
    assert_eq!((people.depth_m, people.separation_m), (Param::Constant(-1.0), 2.0));
    let hsv = [(0.0, 180.0), (0.2, 1.0), (0.5, 1.0)].map(|(a, b)| Param::uniform(a, b));
    assert_eq!(d.occluders.color, Color::Other(ColorLaw::Hsv(hsv)));
    assert_eq!(d.background.wall.color, d.occluders.color);
    for (path, part) in [
        ("[0]", "4 layers become one pattern 1 m apart"),
        ("[1]", "places people"),
        ("[2]", "which objects"),
        ("[2].items.colorParameter", "alpha"),
        ("[3]", "objects of the Unity scene"),
        ("[4].items.rotation", "no counterpart"),
    ] {
        let path = format!("randomizers.randomizerGroups{path}");
        let found = imported.notes.iter().any(|n| n.path == path && n.message.contains(part));
        assert!(found, "{path}: {part} in {:#?}", imported.notes);
    }
}

#[test]
fn what_is_unknown_is_noted_with_what_was_meant() {
    let mut twisted = group(
        "CustomForegroundScaleRandomizer",
        json!({"scael": param(uniform(1.0, 2.0)), "scale": params(json!({"value":
            {"uniform": {"min": 1, "max": 2, "mode": 3}}}))}),
    );
    twisted["stats"] = json!({});
    let imported = import(&[
        twisted,
        group("CustomCamraRandomizer", json!({})),
        group("MyOwnThing", json!({"strange": 3})),
        group("SunAngleRandomizer", json!({"hour": param(uniform(1.0, 2.0))})),
    ]);
    let at = |path: &str| {
        let path = format!("randomizers.randomizerGroups{path}");
        let note = imported.notes.iter().find(|n| n.path == path);
        note.map(|n| n.message.clone()).unwrap_or_else(|| panic!("{path}: {:#?}", imported.notes))
    };
    assert!(at("[0].stats").ends_with("did you mean `state`?"));
    assert!(at("[0].items.scael").ends_with("did you mean `scale`?"));
    let inner = "[0].items.scale.param.items.value.samplerOptions.uniform.mode";
    assert!(at(inner).contains("unknown field `mode`"));
    assert!(at("[1]").ends_with("did you mean `CustomCameraRandomizer`?"));
    assert_eq!(at("[2]"), "unknown randomizer `MyOwnThing` is left out");
    assert_eq!(imported.document.people.scale, Param::uniform(1.0, 2.0));
}
