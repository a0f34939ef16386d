//! Document to scene: what seeds, frames and switches mean across all sections.

use figurant_core::base::lens::Lens;
use figurant_core::document::{
    Auto, Brown, Choice, Distortion, Document, Fisheye, OutfitRow, Param, Problem, Season, file,
    presets,
};
use figurant_core::library::environment::Environments;
use figurant_core::library::pose::Poses;
use figurant_core::library::textures::{TextureGroup, TextureLibrary};
use figurant_core::sampling::{
    Activity, Catalogue, Counts, SampleError, Sampler, check_assets, counts,
};
use figurant_core::scene::{BottomKind, OuterKind, Person, Role, Scene, Sex, ShoeKind, TopKind};
use serde_json::Value;

fn activity(id: &str, activity: &str) -> Activity {
    Activity { id: id.to_owned(), activity: activity.to_owned(), ..Activity::default() }
}

fn catalogue() -> Catalogue {
    let names = |kind: &str, n: usize| (0..n).map(|i| format!("{kind}_{i}")).collect();
    let clips = [
        "walk",
        "run",
        "jump",
        "kick",
        "punch",
        "spinkick",
        "spin",
        "backflip",
        "cartwheel",
        "roll",
    ]
    .into_iter()
    .chain(["dance_a", "dance_b", "crawl", "getup_facedown", "getup_faceup"]);
    Catalogue {
        face_targets: names("nose-scale", 60),
        face_units: names("unit", 3),
        clips: clips.map(|id| activity(id, "moving")).collect(),
        poses: Poses::built_in().all().iter().map(|p| activity(&p.id, &p.activity)).collect(),
        textures: TextureLibrary::new(&[])
            .expect("no folders")
            .ids(TextureGroup::Procedural)
            .to_vec(),
        cloth_patterns: names("pattern", 5),
        cloth_reliefs: names("relief", 7),
        cloth_finishes: names("finish", 5),
        environments: Environments::new(&[]).expect("no folders").ids().to_vec(),
    }
}

fn preset(name: &str) -> Document {
    let text = presets::find(name).expect("the preset ships with the program").text;
    file::parse(text).expect("a test of the presets themselves says why")
}

fn sample(document: &Document, catalogue: &Catalogue, frame: u32) -> Result<Scene, SampleError> {
    Ok(Sampler::new(document.clone().into(), catalogue.clone())?.scene(frame))
}

fn scene(document: &Document, frame: u32) -> Scene {
    sample(document, &catalogue(), frame).expect("a valid document")
}

fn mean_and_spread(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

#[test]
fn the_seeds_preset_places_as_many_as_the_seed() {
    let document = preset("peoplesanspeople");
    let all: Vec<Counts> = (0..1000).map(|frame| counts(&document, frame)).collect();
    let people: Vec<f64> = all.iter().map(|c| f64::from(c.people)).collect();
    let (mean, spread) = mean_and_spread(&people);
    assert!((mean - 16.8).abs() < 0.3, "people: mean {mean}");
    assert!((spread - 1.5).abs() < 0.3, "people: spread {spread}");
    let occluders: Vec<f64> = all.iter().map(|c| f64::from(c.occluders)).collect();
    let (mean, spread) = mean_and_spread(&occluders);
    assert!((mean - 24.1).abs() < 0.3, "occluders: mean {mean}");
    assert!((spread - 1.7).abs() < 0.3, "occluders: spread {spread}");
    for frame in [0, 17, 999] {
        let scene = scene(&document, frame);
        let occluders = scene.objects.iter().filter(|o| o.role == Role::Occluder).count();
        let counts = &all[frame as usize];
        assert_eq!(
            (scene.people.len(), occluders),
            (counts.people as usize, counts.occluders as usize)
        );
    }
}

#[test]
fn the_seeds_ranges_are_kept_and_filled() {
    let document = preset("peoplesanspeople");
    let mut seen: Vec<(&str, f64, f64, Vec<f64>)> = vec![
        ("fov", 5.0, 50.0, vec![]),
        ("camera x", -5.0, 5.0, vec![]),
        ("camera z", 10.0, 20.0, vec![]),
        ("exposure", 6.5, 11.5, vec![]),
        ("lamp", 5_000.0, 50_000.0, vec![]),
        ("person scale", 0.5, 3.0, vec![]),
        ("person z", -9.0, 6.0, vec![]),
        ("person x", -7.5, 7.5, vec![]),
        ("occluder size", 0.127, 1.8288, vec![]),
        ("occluder hue", -180.0, 180.0, vec![]),
        ("phase", 0.0, 1.0, vec![]),
    ];
    let mut lamps = 0;
    for frame in 0..300 {
        let s = scene(&document, frame);
        let mut add = |i: usize, v: f64| seen[i].3.push(v);
        add(0, s.camera.fov_vertical_deg);
        add(1, s.camera.position_m.x);
        add(2, s.camera.position_m.z);
        add(3, s.exposure_ev100);
        lamps += s.lights.points.len();
        s.lights.points.iter().for_each(|p| add(4, p.intensity_cd));
        for p in &s.people {
            add(5, p.placement.scale.x);
            add(6, p.placement.position_m.z);
            add(7, p.placement.position_m.x);
            add(10, p.pose.phase);
        }
        for o in s.objects.iter().filter(|o| o.role == Role::Occluder) {
            add(8, o.placement.scale.x);
            add(9, o.material.hue_offset_deg);
        }
        assert_eq!(s.lights.sun.unwrap().illuminance_lux, 10_000.0);
    }
    for (name, min, max, values) in seen {
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        let edge = 0.03 * (max - min);
        assert!(low >= min && low < min + edge, "{name}: lowest {low}, expected {min}");
        assert!(high <= max && high > max - edge, "{name}: highest {high}, expected {max}");
    }
    // Seven lamps, each on with probability 0.8: 5.6 a frame, standard error 0.06.
    let mean = lamps as f64 / 300.0;
    assert!((mean - 5.6).abs() < 0.25, "{mean} lamps a frame");
}

#[test]
fn frames_need_no_order() {
    for preset_ in presets::ALL {
        let document = preset(preset_.name);
        let forward: Vec<Scene> = (0..20).map(|f| scene(&document, f)).collect();
        for f in [19, 3, 11, 0, 7] {
            assert_eq!(scene(&document, f), forward[f as usize], "{} frame {f}", preset_.name);
        }
        // One preset has the same people in every light.
        let drawn = |scene: &Scene| (scene.people.clone(), scene.lights.clone());
        assert_ne!(drawn(&forward[0]), drawn(&forward[1]));
        let other = Document { seed: document.seed + 1, ..document };
        assert_ne!(drawn(&scene(&other, 0)), drawn(&forward[0]));
    }
}

/// Removes what a path with `*` for every item leads to; `objects[wall]` stands for its role.
fn blot(value: &mut Value, path: &[&str]) {
    let (Some(name), rest) = (path.first(), &path[1..]) else { return };
    match value {
        Value::Object(map) if rest.is_empty() => {
            map.remove(*name);
        }
        Value::Object(map) => {
            if let Some(inner) = map.get_mut(*name) {
                blot(inner, rest);
            }
        }
        Value::Array(items) if *name == "*" => items.iter_mut().for_each(|item| blot(item, rest)),
        Value::Array(items) => items.retain(|item| item["role"] != *name),
        _ => {}
    }
}

#[test]
fn a_switch_changes_nothing_else() {
    type Switch = (fn(&mut Document), &'static [&'static str]);
    let switches: [Switch; 14] = [
        (|d| d.camera.enabled = false, &["camera"]),
        (|d| d.lights.sun.enabled = false, &["lights/sun"]),
        (|d| d.lights.moving.enabled = false, &["lights/points"]),
        (|d| d.lights.environment.enabled = false, &["lights/environment"]),
        (|d| d.background.wall.enabled = false, &["objects/wall"]),
        (|d| d.background.floor.enabled = true, &["objects/floor"]),
        (|d| d.occluders.enabled = false, &["objects/occluder"]),
        (|d| d.people.enabled = false, &["people"]),
        // Automatic looks and clothes follow the body; the shape of the face does not.
        (
            |d| d.people.body.enabled = false,
            &[
                "people/*/body",
                "people/*/look/skin_color",
                "people/*/look/hair_color",
                "people/*/look/iris_color",
                "people/*/look/freckles",
                "people/*/look/flush",
                "people/*/look/hair",
                "people/*/look/beard",
                "people/*/look/headwear",
                "people/*/look/glasses",
                "people/*/outfit",
            ],
        ),
        (|d| d.people.look.enabled = false, &["people/*/look"]),
        (|d| d.people.wardrobe.enabled = false, &["people/*/outfit"]),
        (|d| d.people.pose.enabled = false, &["people/*/pose"]),
        (|d| d.post.enabled = false, &["exposure_ev100", "post"]),
        (|d| d.materials.roughness = Param::uniform(0.1, 0.9), &["objects/*/material/roughness"]),
    ];
    let base = preset("peoplesanspeople");
    for (switch, paths) in switches {
        let mut switched = base.clone();
        switch(&mut switched);
        let mut differ = false;
        for frame in 0..5 {
            let [mut a, mut b] =
                [&base, &switched].map(|d| serde_json::to_value(scene(d, frame)).unwrap());
            differ |= a != b;
            for path in paths {
                let path: Vec<&str> = path.split('/').collect();
                blot(&mut a, &path);
                blot(&mut b, &path);
            }
            assert!(a == b, "{paths:?}, frame {frame}: something else has changed");
        }
        assert!(differ, "{paths:?}: the switch does nothing");
    }
}

#[test]
fn a_scene_survives_its_file() {
    for preset_ in presets::ALL {
        let scene = scene(&preset(preset_.name), 3);
        let text = serde_json::to_string(&scene).unwrap();
        assert_eq!(serde_json::from_str::<Scene>(&text).unwrap(), scene);
    }
}

#[test]
fn scenes_hold_only_what_makes_sense() {
    for preset_ in presets::ALL {
        let document = preset(preset_.name);
        for frame in 0..200 {
            let s = scene(&document, frame);
            assert!((0.1..179.0).contains(&s.camera.fov_vertical_deg));
            assert!(
                s.lights.sun.is_none_or(|sun| (sun.direction_to_sun.length() - 1.0).abs() < 1e-9)
            );
            for (slot, p) in s.people.iter().enumerate() {
                assert_eq!(p.slot, slot as u32);
                let (body, look, outfit) = (&p.body, &p.look, &p.outfit);
                assert!((0.6..2.1).contains(&body.stature_m), "{body:?}");
                assert!((body.ancestry.iter().sum::<f64>() - 1.0).abs() < 1e-9);
                let colors = [look.skin_color, look.hair_color, look.iris_color];
                let cloth = [
                    outfit.top.color,
                    outfit.bottom.color,
                    outfit.outer.color,
                    outfit.shoes.color,
                    outfit.shoes.sock_color,
                ];
                for channel in colors.into_iter().chain(cloth).flatten() {
                    assert!((0.0..=1.0).contains(&channel));
                }
                assert!((p.placement.rotation.length() - 1.0).abs() < 1e-9);
                let known = catalogue();
                let named =
                    known.clips.iter().chain(&known.poses).find(|a| a.id == p.pose.clip).unwrap();
                assert_eq!(named.activity, p.pose.activity);
            }
        }
    }
}

#[test]
fn the_starter_shows_six_people_of_readable_size() {
    let document = preset("starter");
    for frame in 0..200 {
        let s = scene(&document, frame);
        assert_eq!(s.people.len(), 6, "frame {frame}");
        for p in &s.people {
            let height_px = |y: f64| {
                let point = p.placement.position_m + glam::DVec3::new(0.0, y, 0.0);
                s.camera.project(s.camera.view_from_world(point)).unwrap()
            };
            let (feet, crown) = (height_px(0.0), height_px(1.7));
            let share = (feet.y - crown.y) / f64::from(s.camera.height);
            assert!((0.36..0.8).contains(&share), "frame {frame}: {share} of the height");
            assert!(crown.y > 0.0 && feet.y < 640.0, "frame {frame}: {feet} {crown}");
            assert!((-20.0..660.0).contains(&feet.x), "frame {frame}: {feet}");
        }
    }
}

#[test]
fn a_lens_moves_nothing_else_and_one_of_zeros_is_none() {
    let without = preset("peoplesanspeople");
    let with = |distortion| {
        let mut document = without.clone();
        document.camera.distortion = Some(distortion);
        document
    };
    let zeros = with(Distortion::Brown(Brown::default()));
    let barrels = with(Distortion::Brown(Brown {
        k1: Param::uniform(-0.3, -0.1),
        k3: Param::uniform(0.0, 0.01),
        ..Brown::default()
    }));
    let fisheye = with(Distortion::Fisheye(Fisheye::default()));
    let mut seen = Vec::new();
    for frame in 0..20 {
        let plain = scene(&without, frame);
        assert_eq!(scene(&zeros, frame), plain);
        let mut bent = scene(&barrels, frame);
        let Some(Lens::Brown { k1, k2, k3, .. }) = bent.camera.distortion.take() else {
            panic!("frame {frame} has no barrel");
        };
        assert_eq!(bent, plain);
        assert!((-0.3..-0.1).contains(&k1) && k2 == 0.0 && (0.0..0.01).contains(&k3));
        seen.push((k1, k3));
        // A fisheye of zeros is not a pinhole.
        let none = Lens::Fisheye { k1: 0.0, k2: 0.0, k3: 0.0, k4: 0.0 };
        assert_eq!(scene(&fisheye, frame).camera.distortion, Some(none));
    }
    assert!(seen.windows(2).all(|w| w[0].0 != w[1].0 && w[0].1 != w[1].1), "{seen:?}");
    let text = serde_json::to_string(&scene(&without, 0)).unwrap();
    assert!(!text.contains("distortion"), "scenes without a lens are written as ever");
    let text = serde_json::to_string(&scene(&barrels, 0)).unwrap();
    assert_eq!(serde_json::from_str::<Scene>(&text).unwrap(), scene(&barrels, 0));
}

#[test]
fn the_lineup_fits_into_its_picture() {
    let document = preset("lineup");
    let s = scene(&document, 0);
    assert_eq!(s.people.len(), 14);
    for p in &s.people {
        let at = |x: f64, y: f64| {
            let point = p.placement.position_m + glam::DVec3::new(x, y, 0.0);
            s.camera.project(s.camera.view_from_world(point)).unwrap()
        };
        let (low, high) = (at(-0.45, -0.05), at(0.45, 2.1));
        assert!(low.x > 0.0 && high.x < 1920.0 && high.y > 0.0 && low.y < 640.0, "{low} {high}");
    }
    let women = s.people.iter().filter(|p| p.body.sex == Sex::Female).count();
    assert!((3..=11).contains(&women), "{women} women");
}

#[test]
fn assets_that_are_not_there_are_named() {
    let mut document = preset("peoplesanspeople");
    document.people.pose.clip = Choice::Always("wlak".to_owned());
    document.background.wall.texture =
        Choice::of([("bricks".to_owned(), 1.0), ("lost".to_owned(), 0.0)]);
    let found: Vec<String> =
        check_assets(&document, &catalogue()).iter().map(Problem::to_string).collect();
    assert_eq!(
        found,
        [
            "background.wall.texture: there is no texture \"bricks\"",
            "people.pose.clip: there is no clip or pose \"wlak\"; did you mean `walk`?",
        ]
    );
    let none = Catalogue { textures: Vec::new(), ..catalogue() };
    let document = preset("peoplesanspeople");
    let error = sample(&document, &none, 0).unwrap_err();
    assert!(matches!(&error, SampleError::Assets(p) if p.0.len() == 2), "{error}");
    assert!(sample(&preset("lineup"), &none, 0).is_ok(), "plain surfaces need no texture");
}

#[test]
fn a_document_that_makes_no_sense_is_not_sampled() {
    let mut document = preset("starter");
    document.people.scale = Param::Constant(f64::NAN);
    let error = sample(&document, &catalogue(), 0).unwrap_err();
    assert!(error.to_string().starts_with("people.scale: "), "{error}");
}

/// Every leaf of a config, by JSON pointer.
fn leaves(value: &Value, path: &str, into: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(name, inner)| leaves(inner, &format!("{path}/{name}"), into));
        }
        Value::Array(items) => {
            let all = items.iter().enumerate();
            all.for_each(|(i, inner)| leaves(inner, &format!("{path}/{i}"), into));
        }
        _ => {}
    }
    if !path.is_empty() {
        into.push(path.to_owned());
    }
}

/// Whatever value is put wherever: the config is refused with a path, or its frames are sound.
#[test]
fn no_config_panics_hangs_or_gives_nonsense() {
    let hostile = [
        "-1",
        "0",
        "1",
        "2.5",
        "1e-300",
        "1e300",
        "1e9",
        "4294967296",
        "\"x\"",
        "\"any\"",
        "\"none\"",
        "null",
        "true",
        "[]",
        "{}",
        "[0, 0, 0]",
        "[1, 2]",
        "{\"uniform\": [0, 1]}",
        "{\"uniform\": [1, 0]}",
        "{\"poisson\": 1000}",
        "{\"mix\": [[1, 0.5], [0, -1]]}",
        "{\"normal\": {\"mean\": 0.5, \"std\": 0.01}}",
        "{\"choice\": [[0.5, 1]]}",
        "{\"rotation\": \"uniform\"}",
        "{\"bernoulli\": 0.5}",
        "{\"mode\": \"row\", \"count\": 500, \"spacing_m\": 0.001}",
        "{\"mode\": \"ground\", \"x_m\": [0, 20], \"z_m\": [0, 20], \"count\": 490, \"separation_m\": 0.999}",
        "{\"mode\": \"ground\", \"x_m\": [0, 1], \"z_m\": [0, 1], \"count\": 500, \"separation_m\": 0}",
        "{\"mode\": \"poisson_disk\", \"depth_m\": 0, \"separation_m\": 1e6}",
    ];
    let (mut accepted, mut refused) = (0, 0);
    for preset_ in presets::ALL {
        let base: Value = serde_json::from_str(preset_.text).unwrap();
        let mut paths = Vec::new();
        leaves(&base, "", &mut paths);
        for (i, path) in paths.into_iter().enumerate() {
            // A different handful for each path, each value for many paths.
            for text in hostile.iter().cycle().skip(2 * i).take(2) {
                let mut value = base.clone();
                *value.pointer_mut(&path).unwrap() = serde_json::from_str(text).unwrap();
                let Ok(document) = file::parse(&value.to_string()) else {
                    refused += 1;
                    continue;
                };
                match sample(&document, &catalogue(), 0) {
                    // A number that is not finite is written as null.
                    Ok(scene) => {
                        let written = serde_json::to_string(&scene).unwrap();
                        let read: Scene = serde_json::from_str(&written)
                            .unwrap_or_else(|e| panic!("{path} = {text}: {e}"));
                        assert!(read == scene, "{path} = {text}");
                        assert!(scene.people.len() <= 500 && scene.objects.len() <= 10_002);
                    }
                    Err(SampleError::Assets(_)) => {}
                    Err(error) => panic!("{path} = {text}: {error}"),
                }
                accepted += 1;
            }
        }
    }
    assert!(accepted > 100 && refused > 300, "{accepted} accepted, {refused} refused");
}

/// Everybody of some frames of the line-up, after a change to what they wear.
fn dressed(change: impl FnOnce(&mut Document)) -> Vec<Person> {
    let mut document = preset("lineup");
    change(&mut document);
    (0..60).flat_map(|frame| scene(&document, frame).people).collect()
}

#[test]
fn people_dress_for_season_and_sex() {
    let summer = dressed(|d| d.people.wardrobe.season = Choice::Always(Season::Summer));
    assert!(summer.iter().all(|p| p.outfit.outer.kind == OuterKind::None));
    let bare = |p: &&Person| p.outfit.bottom.kind == BottomKind::Shorts;
    assert!(summer.iter().filter(bare).count() > summer.len() / 5);
    let winter = dressed(|d| d.people.wardrobe.season = Choice::Always(Season::Winter));
    assert!(winter.iter().filter(bare).count() == 0);
    let coats = winter.iter().filter(|p| p.outfit.outer.kind != OuterKind::None).count();
    assert!(coats > winter.len() / 2);
    for p in summer.iter().chain(&winter) {
        let skirt = p.outfit.bottom.kind.is_skirt();
        assert!(!skirt || p.body.sex == Sex::Female, "{:?}", p.outfit);
        assert!(p.outfit.top.kind != TopKind::TankTop || p.outfit.top.sleeve == 0.0);
    }
}

#[test]
fn a_document_brings_its_own_outfits() {
    let row = |text: &str| serde_json::from_str::<OutfitRow>(text).unwrap();
    let table = vec![
        row(r#"{"sex": "male", "top": "shirt", "bottom": "jeans", "shoes": "boots"}"#),
        row(r#"{"sex": "female", "age_years": [0, 30], "top": "tank_top", "bottom": "leggings"}"#),
        row(r#"{"weight": 0, "sex": "female", "top": "hoodie", "bottom": "shorts"}"#),
    ];
    let people = dressed(|d| {
        d.people.wardrobe.outfit = Auto::Given(table);
        d.people.wardrobe.shoes.kind = Auto::Given(Choice::Always(ShoeKind::Sandals));
    });
    for p in people {
        let outfit = (p.outfit.top.kind, p.outfit.bottom.kind);
        let [man, woman] =
            [(TopKind::Shirt, BottomKind::Jeans), (TopKind::TankTop, BottomKind::Leggings)];
        match p.body.sex {
            Sex::Male => assert_eq!(outfit, man),
            Sex::Female if p.body.age_years <= 30.0 => assert_eq!(outfit, woman),
            // No row is for her: she wears any that somebody wears.
            Sex::Female => assert!(outfit == man || outfit == woman),
        }
        assert_eq!(p.outfit.shoes.kind, ShoeKind::Sandals, "what is given alone comes first");
        assert_eq!(p.outfit.outer.kind, OuterKind::None);
    }
}

#[test]
fn outfits_that_make_no_sense_are_refused() {
    let problem = |rows: &str| {
        let mut document = preset("lineup");
        document.people.wardrobe.outfit = Auto::Given(serde_json::from_str(rows).unwrap());
        sample(&document, &catalogue(), 0).expect_err("it must be refused").to_string()
    };
    let none = problem("[]");
    assert!(none.contains("people.wardrobe.outfit"), "{none}");
    let weights = problem(r#"[{"weight": -1, "top": "shirt", "bottom": "jeans"}]"#);
    assert!(weights.contains("people.wardrobe.outfit[0]"), "{weights}");
    let ages = problem(r#"[{"age_years": [9, 3], "top": "shirt", "bottom": "jeans"}]"#);
    assert!(ages.contains("people.wardrobe.outfit[0].age_years"), "{ages}");
}

#[test]
fn people_face_what_they_should() {
    let mut document = preset("everyday");
    for (law, point) in [
        (r#"{"facing": {"towards": "camera", "yaw_deg": 0}}"#, None),
        (r#"{"facing": {"towards": [1, 2, -30]}}"#, Some(glam::DVec3::new(1.0, 2.0, -30.0))),
    ] {
        document.people.rotation_deg = serde_json::from_str(law).expect("a rotation");
        for frame in 0..20 {
            let scene = scene(&document, frame);
            for p in &scene.people {
                let front = p.placement.rotation * glam::DVec3::Z;
                let way = point.unwrap_or(scene.camera.position_m) - p.placement.position_m;
                let level = glam::DVec3::new(way.x, 0.0, way.z).normalize();
                assert!(front.distance(level) < 1e-9, "{law}, frame {frame}: {front} {level}");
            }
        }
    }
    let refused =
        r#"{"version": 1, "camera": {"rotation_deg": {"facing": {"towards": "camera"}}}}"#;
    let problems = file::parse(refused).expect_err("no camera faces itself").to_string();
    assert!(problems.starts_with("camera.rotation_deg.facing: only people"), "{problems}");
}

/// Discs within the boxes of people and upright cubes lie apart on the ground, and nobody moves.
#[test]
fn occluders_keep_out_of_people() {
    let mut document = preset("everyday");
    document.occluders.shape = Choice::Always(figurant_core::scene::Shape::Cube);
    let clashes = |document: &Document| {
        let clash = |s: &Scene| {
            let cubes = s.objects.iter().filter(|o| o.role == Role::Occluder);
            let near = |o: &figurant_core::scene::Object| {
                let reach = 0.3 + 0.5 * o.placement.scale.x;
                let away = |p: &Person| (p.placement.position_m - o.placement.position_m) * LEVEL;
                s.people.iter().any(|p| away(p).length() < reach)
            };
            cubes.filter(|o| near(o)).count()
        };
        (0..60).map(|frame| clash(&scene(document, frame))).sum::<usize>()
    };
    const LEVEL: glam::DVec3 = glam::DVec3::new(1.0, 0.0, 1.0);
    let mut apart = document.clone();
    let figurant_core::document::Placement::Ground(ground) = &mut apart.occluders.placement else {
        panic!("everyday has its occluders on the ground");
    };
    ground.no_overlap = true;
    assert!(clashes(&document) > 5);
    assert_eq!(clashes(&apart), 0);
    assert_eq!(scene(&document, 7).people, scene(&apart, 7).people);
}

#[test]
fn lenses_temperatures_and_qualities_are_drawn_and_move_nothing_else() {
    let base = preset("peoplesanspeople");
    let mut document = base.clone();
    document.camera.focal_length_mm = Some(Param::uniform(20.0, 60.0));
    document.lights.sun.temperature_k = Some(Param::uniform(2000.0, 10_000.0));
    document.lights.points[1].temperature_k = Some(2700.0.into());
    document.output.jpeg_quality = Param::uniform(60.0, 95.0);
    let mut seen = (Vec::new(), Vec::new());
    for frame in 0..100 {
        let (mut a, b) = (scene(&document, frame), scene(&base, frame));
        assert_eq!(b.jpeg_quality, None);
        seen.0.push(a.camera.fov_vertical_deg);
        seen.1.push(f64::from(a.jpeg_quality.take().expect("it is drawn")));
        let luminance = |c: [f64; 3]| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let (warm, plain) = (
            a.lights.sun.as_ref().expect("a sun").color,
            b.lights.sun.as_ref().expect("a sun").color,
        );
        assert_ne!(warm, plain);
        // The product with a tint keeps the luminance of white alone.
        assert!((luminance(warm) / luminance(plain) - 1.0).abs() < 0.15, "{warm:?} {plain:?}");
        a.camera.fov_vertical_deg = b.camera.fov_vertical_deg;
        a.lights = b.lights.clone();
        assert_eq!(a, b, "frame {frame}");
    }
    let within = |all: &[f64], low: f64, high: f64| all.iter().all(|v| (low..=high).contains(v));
    // 2 atan(12 / 60) and 2 atan(12 / 20).
    assert!(within(&seen.0, 22.6, 61.93) && within(&seen.1, 60.0, 95.0), "{seen:?}");
    assert!(!within(&seen.0, 25.0, 58.0) && !within(&seen.1, 63.0, 92.0), "{seen:?}");
}
