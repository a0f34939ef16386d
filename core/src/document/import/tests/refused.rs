//! What is wrong in a scenario is refused with its place, whatever it is.

use super::*;

#[test]
fn wrong_values_are_refused_with_their_path() {
    let scale =
        |sampler: Value| group("CustomForegroundScaleRandomizer", json!({"scale": param(sampler)}));
    let at = "items.scale.param.items.value.samplerOptions";
    let curve = |keys: Value| scale(json!({"curve": {"keys": keys}}));
    let cases = [
        (scale(uniform(3.0, 1.0)), format!("{at}.uniform"), "min 3 and max 1"),
        (scale(json!({})), at.to_owned(), "exactly one sampler of \"uniform\", \"normal\""),
        (scale(json!({"uniform": {}, "constant": {}})), at.to_owned(), "exactly one sampler"),
        (scale(json!({"uniform": {"min": 1}})), format!("{at}.uniform.max"), "missing"),
        (
            scale(json!({"uniform": {"min": "NaN", "max": 1}})),
            format!("{at}.uniform.min"),
            "expected a finite number, got \"NaN\"",
        ),
        (
            scale(json!({"normal": {"min": 0, "max": 1, "mean": 0, "stddev": -1}})),
            format!("{at}.normal.stddev"),
            "must be >= 0",
        ),
        (curve(json!([])), format!("{at}.curve.keys"), "two points at least, got 0"),
        (curve(json!([[0, 1], [0, 1]])), format!("{at}.curve.keys[1]"), "x must grow"),
        (curve(json!([[0, 1], [1, -1]])), format!("{at}.curve.keys[1]"), "density must be >= 0"),
        (curve(json!([[0, 0], [1, 0]])), format!("{at}.curve.keys"), "0 everywhere"),
        (curve(json!([[0, 1], 3])), format!("{at}.curve.keys[1]"), "expected an object"),
        (
            group("CustomForegroundScaleRandomizer", json!({"scale": {"param": {}}})),
            "items.scale.param.items".to_owned(),
            "holds no sampler",
        ),
        (
            group("CustomForegroundScaleRandomizer", json!({"scale": flag(true)})),
            "items.scale".to_owned(),
            "expected a number, got true or false",
        ),
        (
            group("CustomForegroundScaleRandomizer", json!({"scale": {}})),
            "items.scale".to_owned(),
            "exactly one of \"param\" and \"scalar\"",
        ),
        (
            group("CustomCameraRandomizer", json!({"useMovingCamera": num(1.0)})),
            "items.useMovingCamera".to_owned(),
            "{\"bool\": true}",
        ),
        (
            group("CustomCameraRandomizer", json!({"multiplyFactor": param(uniform(0.0, 1.0))})),
            "items.multiplyFactor".to_owned(),
            "expected one number",
        ),
        (
            group("RotationRandomizer", json!({"rotation": num(3.0)})),
            "items.rotation".to_owned(),
            "a parameter with x, y, z",
        ),
        (
            json!({"randomizerId": "RotationRandomizer", "state": {"enabled": "yes"}}),
            "state.enabled".to_owned(),
            "expected true or false",
        ),
        (json!({"items": {}}), "randomizerId".to_owned(), "missing"),
        // Right in form, but not what a config may hold.
        (scale(uniform(-1.0, 1.0)), "items.scale".to_owned(), "people.scale must be > 0"),
        (
            group("CustomLightRandomizer", json!({"lightIntensityParameter": num(-1.0)})),
            "items.lightIntensityParameter".to_owned(),
            "must be >= 0",
        ),
        (
            group("HueOffsetRandomizer", json!({"hueOffset": num(1e9)})),
            "items.hueOffset".to_owned(),
            "<= 3600",
        ),
        (
            group("CustomCameraRandomizer", json!({"changeCameraRotation": num(1e9)})),
            "items.changeCameraRotation".to_owned(),
            "camera.rotation_offset_deg",
        ),
        (
            group("CustomForegroundObjectPlacementRandomizer", json!({"minX": num(9.0)})),
            "items.minX".to_owned(),
            "people.placement.x_m",
        ),
        (
            group("BackgroundObjectPlacementRandomizer", json!({"layerCount": num(1.5)})),
            "items.layerCount".to_owned(),
            "whole number",
        ),
    ];
    for (group, path, part) in cases {
        let found = problems(&of(&[group]));
        let path = format!("randomizers.randomizerGroups[0].{path}");
        let hit = found.iter().any(|p| p.path == path && p.to_string().contains(part));
        assert!(hit, "{path}: {part} in {found:#?}");
    }
}

#[test]
fn wrong_frames_are_refused_with_their_path() {
    for (text, path) in [
        (json!({"constants": {"totalIterations": 0}}), "constants.totalIterations"),
        (json!({"constants": {"totalIterations": -4}}), "constants.totalIterations"),
        (json!({"constants": {"totalIterations": 1e12}}), "constants.totalIterations"),
        (json!({"constants": {"randomSeed": "7"}}), "constants.randomSeed"),
        (
            json!({"constants": {"iterationCount": u64::MAX, "startIteration": u64::MAX}}),
            "constants.iterationCount",
        ),
        (json!({"constants": []}), "constants"),
        (json!({"randomizers": {}}), "randomizers"),
        (json!({"randomizers": {"randomizerGroups": {}}}), "randomizers.randomizerGroups"),
        (json!({"randomizers": {"randomizerGroups": [3]}}), "randomizers.randomizerGroups[0]"),
        (json!({"randomizers": {"groups": []}}), "randomizers.groups"),
    ] {
        let found = problems(&text.to_string());
        assert_eq!(found[0].path, path, "{found:#?}");
    }
    let many: Vec<Value> = (0..1001).map(|i| off(&format!("R{i}"))).collect();
    let found = problems(&of(&many));
    assert!(found[0].to_string().contains("at most 1000 randomizers, got 1001"), "{found:#?}");
    let twins = [off("TextureRandomizer"), off("HueOffsetRandomizer"), off("TextureRandomizer")];
    assert_eq!(problems(&of(&twins))[0].path, "randomizers.randomizerGroups[2]");
}

#[test]
fn what_is_no_scenario_says_why() {
    let message = |text: &str| scenario(text).unwrap_err().to_string();
    assert!(message(" ").contains("empty"));
    assert!(message("{\"constants\": {").contains("ends too early"));
    assert!(message("{\"constants\": NaN}").contains("not valid JSON"));
    assert!(message("{\"constants\": {\"randomSeed\": 1e999}}").contains("out of range"));
    assert!(message(&"[".repeat(100_000)).contains("recursion"));
    let twice = message("{\"constants\": {\"randomSeed\": 1, \"randomSeed\": 2}}");
    assert!(twice.contains("`randomSeed` stands twice here at line 1"), "{twice}");
    assert!(message("[]").contains("\"constants\" and \"randomizers\""));
    assert!(message("{\"version\": 1}").contains("config already"));
    let large = " ".repeat(MAX_BYTES as usize + 1);
    assert!(matches!(scenario(&large), Err(ImportError::TooLarge)));
}

#[test]
fn a_file_gives_its_name_and_says_why_it_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my scenario.json");
    std::fs::write(&path, SEEDS).unwrap();
    assert_eq!(load(&path).unwrap().document.name, "my scenario");
    assert!(matches!(load(folder.path()), Err(ImportError::Folder(_))));
    let missing = load(&folder.path().join("none.json")).unwrap_err().to_string();
    assert!(missing.contains("none.json"), "{missing}");
    std::fs::File::create(&path).unwrap().set_len(100 << 20).unwrap();
    assert!(matches!(load(&path), Err(ImportError::TooLarge)));
    std::fs::write(&path, [0x7b, 0xff]).unwrap();
    assert!(load(&path).unwrap_err().to_string().contains("not UTF-8"));
}

/// The places of all values in a value, itself included.
fn pointers(value: &Value, here: &str, into: &mut Vec<String>) {
    into.push(here.to_owned());
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(k, v)| pointers(v, &format!("{here}/{k}"), into));
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| pointers(v, &format!("{here}/{i}"), into));
        }
        _ => {}
    }
}

/// Metadata say nothing and make the file three times as long.
fn drop_metadata(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.remove("metadata");
            map.values_mut().for_each(drop_metadata);
        }
        Value::Array(items) => items.iter_mut().for_each(drop_metadata),
        _ => {}
    }
}

/// Whatever stands in the place of any value: a document that makes sense, or problems by name.
#[test]
fn no_value_in_any_place_goes_wrong() {
    let mut seeds: Value = serde_json::from_str(SEEDS).unwrap();
    drop_metadata(&mut seeds);
    let mut places = Vec::new();
    pointers(&seeds, "", &mut places);
    assert!(places.len() > 400, "{}", places.len());
    let hostile = [
        json!(null),
        json!("x"),
        json!(-1),
        json!(1e300),
        json!(-1e38),
        json!(1e-45),
        json!([]),
        json!({}),
        json!(true),
        json!({"constant": {"value": 1e308}}),
    ];
    let (mut good, mut refused) = (0, 0);
    for place in places.iter().filter(|p| !p.is_empty()) {
        for value in &hostile {
            let mut twisted = seeds.clone();
            *twisted.pointer_mut(place).unwrap() = value.clone();
            match scenario(&twisted.to_string()) {
                Ok(imported) => {
                    assert_eq!(validate(&imported.document), [], "{place}: {value}");
                    good += 1;
                }
                Err(ImportError::Invalid(Problems(problems))) => {
                    assert!(!problems.is_empty(), "{place}: {value}");
                    let theirs = |p: &Problem| {
                        p.path.starts_with("constants") || p.path.starts_with("randomizers")
                    };
                    assert!(problems.iter().all(theirs), "{place}: {value}: {problems:#?}");
                    refused += 1;
                }
                Err(other) => panic!("{place}: {value}: {other}"),
            }
        }
    }
    assert!(good > 100 && refused > 1000, "{good} were read, {refused} refused");
}
