//! Exports: what they write, and what stops them.

use figurant::{Exit, Stop};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;

use super::desk::{Desk, desk};

#[test]
fn an_export_writes_the_whole_layout() {
    let desk = Desk::new(&json!({"frames": 4}));
    let ran = desk.run("export @c.json --out @out --workers 2");
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    assert_eq!(ran.out, "");
    assert!(ran.err.contains("4 frames in "), "{}", ran.err);
    for file in [
        "config.json",
        "report.json",
        "images/000003.jpg",
        "scenes/000003.json",
        "labels/instance/000003.png",
        "labels/semantic/000003.png",
    ] {
        assert!(desk.path("out").join(file).is_file(), "{file}");
    }
    let manifest = desk.json("out/manifest.json");
    assert_eq!(manifest["frames_done"], json!([[0, 4]]));
    assert_eq!(manifest["semantic_classes"][1]["name"], "person");
    let index = desk.json("out/coco/annotations.json");
    assert_eq!(index["images"].as_array().unwrap().len(), 4);
    assert_eq!(index["annotations"][3]["image_id"], 3);
    assert!(!desk.path("out/.figurant").exists());
}

#[test]
fn arguments_reach_the_frames() {
    let desk = desk();
    let ran = desk.run(
        "export @c.json --out @out --frames 5..7 --seed 9 --size 40x20 --only box2d,instance --progress none",
    );
    assert_eq!((ran.exit, ran.err.as_str()), (Exit::Done, ""));
    let manifest = desk.json("out/manifest.json");
    assert_eq!(manifest["seed"], 9);
    assert_eq!(manifest["outputs"], json!(["box2d", "instance"]));
    assert_eq!(manifest["frames_done"], json!([[5, 7]]));
    let image = &desk.json("out/coco/annotations.json")["images"][0];
    assert_eq!(
        (&image["width"], &image["height"], &image["id"]),
        (&json!(40), &json!(20), &json!(5))
    );
    assert!(!desk.path("out/images").exists());
}

#[test]
fn a_scenario_is_exported_in_one_step() {
    let desk = Desk::new(&json!({"frames": 2, "unityTag": 2}));
    let equals =
        format!("export --scenario-config-file={} --out @b", desk.path("c.json").display());
    for (out, line) in
        [("a", "export -logfile - --scenario-config-file @c.json --out @a"), ("b", &equals)]
    {
        let ran = desk.run(line);
        assert_eq!(ran.exit, Exit::Done, "{line}: {}", ran.err);
        assert!(ran.err.contains("note: unityTag: is left out\n"), "{line}: {}", ran.err);
        assert_eq!(ran.err.starts_with("note: -logfile -: is a Unity player's"), out == "a");
        assert_eq!(desk.json(&format!("{out}/config.json")), json!({"frames": 2}));
        let manifest = desk.json(&format!("{out}/manifest.json"));
        assert_eq!(manifest["frames_done"], json!([[0, 2]]), "{line}");
    }
    let more = |style: &str| {
        let export =
            "export --scenario-config-file @c.json --out @c --overwrite --seed 8 --frames 1";
        desk.run(&format!("{export} --progress {style}"))
    };
    assert_eq!(more("none").err, "");
    let ran = more("json");
    let first: Value = serde_json::from_str(ran.err.lines().next().unwrap()).unwrap();
    assert_eq!(first, json!({"event": "note", "text": "unityTag: is left out"}));
    assert_eq!(desk.json("c/manifest.json")["seed"], 8);
    for (line, expected) in [
        ("export @c.json --scenario-config-file @c.json --out @d", "cannot be used with"),
        ("export --out @d", "CONFIG"),
        ("export --scenario-config-file @none.json --out @d", "none.json"),
    ] {
        let ran = desk.run(line);
        assert_eq!(ran.exit.code(), 2, "{line}");
        assert!(ran.err.contains(expected), "{line}: {}", ran.err);
        assert!(!desk.path("d").exists(), "{line}");
    }
}

#[test]
fn the_number_of_workers_changes_no_byte() {
    let desk = Desk::new(&json!({"frames": 9, "fails": [4]}));
    for (out, workers) in [("a", 1), ("b", 4)] {
        let ran = desk.run(&format!("export @c.json --out @{out} --workers {workers}"));
        assert_eq!(ran.exit, Exit::SomeFailed);
    }
    for file in ["manifest.json", "report.json", "coco/annotations.json", "images/000008.jpg"] {
        let read = |out: &str| fs::read(desk.path(out).join(file)).unwrap();
        assert!(read("a") == read("b"), "{file}");
    }
}

#[test]
fn a_failed_frame_is_reported_and_the_rest_is_written() {
    let desk = Desk::new(&json!({"frames": 6, "fails": [2, 4]}));
    let ran = desk.run("export @c.json --out @out");
    assert_eq!((ran.exit, ran.exit.code()), (Exit::SomeFailed, 1));
    assert!(ran.err.contains("frame 2 failed: frame 2 is out of paint"), "{}", ran.err);
    let report = desk.json("out/report.json");
    assert_eq!(report["failed"][1]["frame"], 4);
    assert_eq!(report["frames_done"], 4);
    assert_eq!(desk.json("out/coco/annotations.json")["images"].as_array().unwrap().len(), 4);
}

#[test]
fn an_interrupted_export_is_indexed() {
    let desk = Desk::new(&json!({"frames": 50}));
    let stop = Stop::new();
    assert!(!stop.ask(), "nobody listens before the export begins");
    let ran = desk.run_with("export @c.json --out @out", &stop);
    assert_eq!((ran.exit, ran.exit.code()), (Exit::Interrupted, 130));
    assert!(ran.err.contains("interrupted: 50 frames were not begun"), "{}", ran.err);
    assert_eq!(desk.json("out/coco/annotations.json")["images"], json!([]));
    assert_eq!(desk.json("out/report.json")["interrupted"], true);
    assert!(!stop.ask(), "the second time ends the process");
}

#[test]
fn a_folder_is_only_overwritten_when_asked() {
    let desk = desk();
    assert_eq!(desk.run("export @c.json --out @out --frames 3").exit, Exit::Done);
    fs::write(desk.path("out/notes.txt"), "mine").unwrap();
    let ran = desk.run("export @c.json --out @out --frames 1");
    assert_eq!((ran.exit, ran.exit.code()), (Exit::BadInput, 2));
    assert!(ran.err.contains("not empty") && ran.err.contains("--overwrite"), "{}", ran.err);
    assert!(desk.path("out/images/000002.jpg").exists());
    assert_eq!(desk.run("export @c.json --out @out --frames 1 --overwrite").exit, Exit::Done);
    assert!(!desk.path("out/images/000002.jpg").exists());
    assert_eq!(desk.text("out/notes.txt"), "mine");
}

#[test]
fn wrong_arguments_and_configs_exit_with_2_and_say_why() {
    let desk = Desk::new(&json!({"framse": 3, "lihgt": 1}));
    let cases = [
        ("export @missing.json --out @out", "missing.json"),
        (
            "export @c.json --out @out",
            "2 problems in the config:\n  framse: no such field\n  lihgt",
        ),
        ("validate @c.json", "framse: no such field"),
        ("export @c.json", "--out"),
        ("export @c.json --out @out --frames 5..5", "there is no frame in 5..5"),
        ("export @c.json --out @out --frames x", "expected A..B"),
        ("export @c.json --out @out --size 640", "640x480"),
        ("export @c.json --out @out --only rgb,boxes", "box2d"),
        ("export @c.json --out @out --workers 0", "0"),
        ("frame @c.json --frame 0 --out @a.jpg", ".png"),
        ("exprot @c.json", "unexpected argument"),
        ("export @c.json --out @c.json", "problems in the config"),
    ];
    for (line, expected) in cases {
        let ran = desk.run(line);
        assert_eq!(ran.exit.code(), 2, "{line}: {}", ran.err);
        assert!(ran.err.contains(expected), "{line}: {}", ran.err);
        assert_eq!(ran.out, "", "{line}");
        assert!(!desk.path("out").exists(), "{line} left a folder");
    }
}

#[test]
fn an_output_path_that_is_a_file_is_refused() {
    let desk = desk();
    let ran = desk.run("export @c.json --out @c.json --overwrite");
    assert_eq!(ran.exit, Exit::BadInput);
    assert!(ran.err.contains("is a file"), "{}", ran.err);
    assert_eq!(desk.text("c.json"), "{}");
}

#[test]
fn no_engine_exits_with_3() {
    let desk = Desk::new(&json!({"brush": false}));
    for line in ["export @c.json --out @out", "frame @c.json --frame 0 --out @a.png"] {
        let ran = desk.run(line);
        assert_eq!(ran.exit.code(), 3, "{line}");
        assert!(ran.err.contains("no brush on this machine"), "{line}: {}", ran.err);
    }
}

#[test]
fn json_progress_is_a_line_for_each_frame_and_a_summary() {
    let desk = Desk::new(&json!({"frames": 5, "fails": [3]}));
    let ran = desk.run("export @c.json --out @out --progress json --workers 2");
    let lines: Vec<Value> = ran.err.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!(lines.len(), 6);
    let frames: BTreeSet<u64> = lines[..5].iter().map(|l| l["frame"].as_u64().unwrap()).collect();
    assert!(frames.into_iter().eq(0..5));
    assert_eq!((&lines[4]["done"], &lines[4]["failed"]), (&json!(4), &json!(1)));
    assert_eq!(lines[5]["event"], "summary");
    let stages = lines[5]["worker_ms_per_frame"].as_object().unwrap();
    assert!(stages["encode"].as_f64().unwrap() > 0.0);
    let sum_ms: f64 = stages.values().map(|v| v.as_f64().unwrap()).sum::<f64>() * 5.0;
    let wall_ms = lines[5]["wall_s"].as_f64().unwrap() * 1e3 * 2.0;
    assert!((sum_ms / wall_ms - 1.0).abs() < 0.1, "{sum_ms} of {wall_ms}");
}
