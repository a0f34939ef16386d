//! A scenario of PeopleSansPeople through the whole program: import, validate and export.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use figurant::studio::Native;
use figurant::{Console, Exit, Stop};
use figurant_core::document::{file, presets};
use serde_json::{Value, json};

const SEEDS: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/data/peoplesanspeople/scenarioConfiguration.json");

struct Ran {
    exit: Exit,
    out: String,
    err: String,
}

fn figurant(args: &[&str]) -> Ran {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = std::iter::once("figurant").chain(args.iter().copied()).map(Into::into);
    let exit =
        figurant::run(&Native, words, &mut Console::new(&mut out, &mut err, false), &Stop::new());
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran { exit, out: text(out), err: text(err) }
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap()
}

#[test]
fn a_scenario_goes_through_the_whole_program() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let config = at("config.json");
    let ran = figurant(&["import", SEEDS, "--out", &config]);
    assert_eq!((ran.exit, ran.out.as_str()), (Exit::Done, ""), "{}", ran.err);
    assert!(ran.err.contains("note: randomizers.randomizerGroups[10].items.hueTop: "));
    let ran = figurant(&["validate", &config]);
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    assert!(ran.err.contains("no problems; 100 frames of 640 x 640"), "{}", ran.err);
    let mut preset = file::parse(presets::find("peoplesanspeople").unwrap().text).unwrap();
    preset.name = "scenarioConfiguration".to_owned();
    assert_eq!(file::load(Path::new(&config)).unwrap().document, preset);

    // In two steps and in one: the same bytes.
    let frames = ["--frames", "2", "--size", "160x120", "--engine", "cpu", "--progress", "json"];
    let (two, one) = (at("two"), at("one"));
    let ran = figurant(&[&["export", &config, "--out", &two], frames.as_slice()].concat());
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    let scenario = format!("--scenario-config-file={SEEDS}");
    let ran = figurant(&[&["export", &scenario, "--out", &one], frames.as_slice()].concat());
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    let events = ran.err.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let notes = events.filter(|e| e["event"] == "note").count();
    assert!(notes > 5, "{}", ran.err);
    for name in [
        "config.json",
        "manifest.json",
        "images/000001.jpg",
        "scenes/000001.json",
        "coco/annotations.json",
    ] {
        let (a, b) = (read(Path::new(&two), name), read(Path::new(&one), name));
        assert!(a == b, "{name} differs");
    }
    let index: Value =
        serde_json::from_slice(&read(Path::new(&one), "coco/annotations.json")).unwrap();
    assert_eq!(index["images"].as_array().unwrap().len(), 2);
}

#[test]
fn a_scenario_with_faults_is_refused_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.json");
    let mut scenario: Value = serde_json::from_slice(&fs::read(SEEDS).unwrap()).unwrap();
    let groups = &mut scenario["randomizers"]["randomizerGroups"];
    groups[1]["items"]["scale"]["param"]["items"]["value"]["samplerOptions"]["uniform"] =
        json!({"min": 3, "max": 1});
    groups[3]["items"] = json!({"scale": {"param": {"items": {}}}});
    fs::write(&path, scenario.to_string()).unwrap();
    let out = folder.path().join("out");
    let (path, out_arg) = (path.to_str().unwrap(), out.to_str().unwrap());
    for args in [
        vec!["import", path],
        vec!["import", path, "--out", out_arg],
        vec!["export", "--scenario-config-file", path, "--out", out_arg],
    ] {
        let ran = figurant(&args);
        assert_eq!((ran.exit.code(), ran.out.as_str()), (2, ""), "{args:?}");
        for part in [
            "bad.json: 2 problems",
            "randomizerGroups[1].items.scale.param.items.value.samplerOptions.uniform: min must",
            "randomizerGroups[3].items.scale.param.items: holds no sampler",
        ] {
            assert!(ran.err.contains(part), "{part} in {}", ran.err);
        }
        assert!(!out.exists());
    }
}
