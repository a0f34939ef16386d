//! All other commands.

use figurant::Exit;
use serde_json::{Value, json};
use std::fs;

use super::desk::{Desk, desk};

#[test]
fn a_scenario_is_imported() {
    let desk = Desk::new(&json!({"frames": 2, "unityLayer": 1, "unityTag": 2}));
    let ran = desk.run("import @c.json");
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    assert_eq!(serde_json::from_str::<Value>(&ran.out).unwrap(), json!({"frames": 2}));
    assert_eq!(ran.err, "note: unityLayer: is left out\nnote: unityTag: is left out\n");
    let ran = desk.run("import @c.json --out @own.json");
    assert_eq!((ran.exit, ran.out.as_str()), (Exit::Done, ""));
    assert_eq!(desk.json("own.json"), json!({"frames": 2}));
    assert!(ran.err.contains("note: unityTag") && ran.err.contains("own.json"), "{}", ran.err);
    fs::write(desk.path("own.json"), "mine").unwrap();
    let ran = desk.run("import @c.json --out @own.json");
    assert_eq!(ran.exit.code(), 2);
    assert!(ran.err.contains("--overwrite"), "{}", ran.err);
    assert_eq!(desk.text("own.json"), "mine");
    let ran = desk.run("import @c.json --out @own.json --overwrite");
    assert_eq!((ran.exit, desk.json("own.json")), (Exit::Done, json!({"frames": 2})));
    let ran = desk.run("import @none.json");
    assert_eq!((ran.exit.code(), ran.out.as_str()), (2, ""));
    assert!(ran.err.contains("none.json"), "{}", ran.err);
}

#[test]
fn a_frame_is_written_with_and_without_overlay() {
    let desk = desk();
    let decoded = |name: &str| image::open(desk.path(name)).unwrap().into_rgb8();
    assert_eq!(desk.run("frame @c.json --frame 7 --out @a.png --size 64x48").exit, Exit::Done);
    let plain = decoded("a.png");
    assert_eq!(plain.dimensions(), (64, 48));
    assert_eq!(plain.get_pixel(0, 0).0, [36, 36, 90]);
    for overlay in ["box2d", "keypoints", "instance", "box2d,keypoints,instance"] {
        let ran = desk
            .run(&format!("frame @c.json --frame 7 --out @b.png --size 64x48 --overlay {overlay}"));
        assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
        assert!(decoded("b.png") != plain, "{overlay}");
    }
    let ran = desk.run("frame @c.json --frame 7 --out @no/such/a.png");
    assert_eq!(ran.exit, Exit::BadInput);
    assert!(
        ran.err.contains("a.png") && ran.err.contains("the folder does not exist"),
        "{}",
        ran.err
    );
    let desk = Desk::new(&json!({"fails": [7]}));
    assert_eq!(desk.run("frame @c.json --frame 7 --out @a.png").exit, Exit::SomeFailed);
}

#[test]
fn people_are_written_to_a_file_or_a_folder() {
    let desk = desk();
    let ran = desk.run("people @c.json --out @all.json");
    assert_eq!((ran.exit, ran.out.as_str()), (Exit::Done, ""), "{}", ran.err);
    assert!(ran.err.contains("3 people") && ran.err.contains("\"cast\""), "{}", ran.err);
    assert_eq!(desk.json("all.json"), json!([{"name": "maria"}, {}, {"name": "otto"}]));
    assert_eq!(desk.run("people @c.json --out @one.json --person 2").exit, Exit::Done);
    assert_eq!(desk.json("one.json"), json!({"name": "otto"}));
    let ran = desk.run("people @c.json --out @f.json --frame 5 --seed 9");
    assert_eq!(ran.exit, Exit::Done, "{}", ran.err);
    assert_eq!(desk.json("f.json"), json!({"name": "in_5_of_9"}));
    assert_eq!(desk.run("people @c.json --out @some/folder").exit, Exit::Done);
    for (file, expected) in [
        ("0000-maria.json", json!({"name": "maria"})),
        ("0001.json", json!({})),
        ("0002-otto.json", json!({"name": "otto"})),
    ] {
        assert_eq!(desk.json(&format!("some/folder/{file}")), expected);
    }
}

#[test]
fn people_that_cannot_be_written_say_why() {
    let desk = desk();
    fs::write(desk.path("mine.json"), "edited").unwrap();
    fs::create_dir(desk.path("some")).unwrap();
    fs::write(desk.path("some/0001.json"), "edited").unwrap();
    for (line, expected) in [
        ("people @c.json --out @mine.json", "give --overwrite"),
        ("people @c.json --out @some", "0001.json: is there already"),
        ("people @c.json --out @new.json --person 1,7", "--person 7: there is nobody of that id"),
        ("people @c.json --out @mine.json/below", "--out"),
        ("people @c.json", "--out"),
    ] {
        let ran = desk.run(line);
        assert_eq!(ran.exit, Exit::BadInput, "{line}: {}", ran.err);
        assert!(ran.err.contains(expected), "{line}: {}", ran.err);
    }
    assert_eq!(desk.text("mine.json"), "edited");
    assert!(!desk.path("some/0000-maria.json").exists(), "nothing is half written");
    assert_eq!(desk.run("people @c.json --out @mine.json --overwrite").exit, Exit::Done);
    let desk = Desk::new(&json!({"brush": false}));
    let ran = desk.run("people @c.json --out @a.json");
    assert_eq!(ran.exit, Exit::BadInput);
    assert!(ran.err.contains("c.json: nobody recurs"), "{}", ran.err);
}

#[test]
fn data_goes_to_stdout_alone() {
    let desk = desk();
    let ran = desk.run("schema");
    assert_eq!((ran.exit, ran.err.as_str()), (Exit::Done, ""));
    assert_eq!(serde_json::from_str::<Value>(&ran.out).unwrap(), json!({"type": "object"}));
    let ran = desk.run("--help");
    assert_eq!((ran.exit, ran.err.as_str()), (Exit::Done, ""));
    for word in ["export", "frame", "validate", "schema", "doctor", "130"] {
        assert!(ran.out.contains(word), "{word}");
    }
    assert!(desk.run("--version").out.starts_with("figurant "));
    let ran = desk.run("validate @c.json");
    assert_eq!((ran.exit, ran.out.as_str()), (Exit::Done, ""));
    assert!(ran.err.contains("no problems"), "{}", ran.err);
}

#[test]
fn without_a_command_a_window_opens_or_it_says_why_not() {
    let desk = desk();
    let ran = desk.run("@c.json");
    assert_eq!((ran.exit, ran.out.as_str(), ran.err.as_str()), (Exit::Done, "", ""));
    let ran = desk.run("");
    assert_eq!((ran.exit, ran.exit.code(), ran.out.as_str()), (Exit::NoWindow, 3, ""));
    for part in ["no window can be opened: the wall is bricked up", "export", "frame"] {
        assert!(ran.err.contains(part), "{}", ran.err);
    }
    // Most likely a command that is misspelt.
    let ran = desk.run("exprot");
    assert_eq!((ran.exit, ran.out.as_str()), (Exit::BadInput, ""));
    assert!(ran.err.contains("exprot: there is no such file"), "{}", ran.err);
}

#[test]
fn the_doctor_reports_on_everything() {
    let ran = desk().run("doctor --simd baseline");
    assert_eq!(ran.exit, Exit::Done, "{}", ran.out);
    for part in [
        "figurant 0",
        "threads",
        "brush (Baseline)",
        "3 colours",
        "32 x 24 pixels with 1 people",
        "easel (wood)",
        "window      ",
    ] {
        assert!(ran.out.contains(part), "{part} in\n{}", ran.out);
    }
}

#[test]
fn engines_that_differ_end_in_failure_and_in_figures() {
    let same = desk().run("bench parity --frames 2 --size 8x4");
    assert_eq!(same.exit, Exit::Done, "{}", same.err);
    assert!(same.out.contains("easel shows the same") && same.out.contains(" 64 "), "{}", same.out);
    let other = desk().run("bench parity --frames 3");
    assert_eq!(other.exit, Exit::SomeFailed, "{}", other.err);
    assert!(other.out.contains("NOT the same") && other.out.contains(" 99 "), "{}", other.out);
    let none = desk().run("bench parity --adapter anvil");
    assert_eq!(none.exit, Exit::NoEngine);
    assert!(none.err.contains("anvil"), "{}", none.err);
    assert_eq!(desk().run("bench parity --frames 0").exit, Exit::BadInput);
}
