//! The whole program: the same bytes however a data set is made, and labels that keep their word.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;

use figurant::studio::Native;
use figurant::{Console, Exit, Stop};
use figurant_core::document::{Document, file, presets};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::job::{FrameMaker, RenderedFrame, Studio};
use figurant_core::label::Visibility;
use figurant_core::library::Library;
use serde_json::Value;

fn preset(name: &str) -> Document {
    file::parse(presets::find(name).unwrap().text).unwrap()
}

fn studio(document: Document, simd: SimdChoice, threads: usize) -> Studio {
    let library = Library::new(&[], document.quality.max_texture_size).unwrap();
    let engine = CpuEngine::new(CpuOptions { simd, ..CpuOptions::default() });
    let threads = NonZeroUsize::new(threads).unwrap();
    Studio::new(Arc::new(document), Arc::new(library), Arc::default(), Box::new(engine), threads)
        .unwrap()
}

/// Runs the program as the command line would.
fn figurant(args: &[&str]) -> (Exit, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = std::iter::once("figurant").chain(args.iter().copied());
    let exit = figurant::run(
        &Native,
        words.map(Into::into),
        &mut Console::new(&mut out, &mut err, false),
        &Stop::new(),
    );
    (exit, String::from_utf8(err).unwrap())
}

fn export(out: &Path, frames: &str, more: &[&str]) {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/peoplesanspeople.json");
    let mut args = vec!["export", config, "--out", out.to_str().unwrap(), "--frames", frames];
    args.extend(["--size", "200x150", "--progress", "none"]);
    args.extend(more);
    let (exit, messages) = figurant(&args);
    assert_eq!(exit, Exit::Done, "{messages}");
}

/// Every file of a folder with its bytes, by its path within.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

fn assert_same(a: &BTreeMap<String, Vec<u8>>, b: &BTreeMap<String, Vec<u8>>, how: &str) {
    let names = |m: &BTreeMap<String, Vec<u8>>| m.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(a), names(b), "{how}");
    for (name, bytes) in a {
        assert!(bytes == &b[name], "{how}: {name} differs");
    }
}

#[test]
fn a_data_set_is_the_same_by_any_workers_and_instruction_set() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        export(&out, "0..8", more);
        files(&out)
    };
    let one = made("one", &["--workers", "1"]);
    assert!(one.keys().any(|k| k.ends_with("000007.jpg")));
    assert_same(&one, &made("two", &["--workers", "2"]), "2 workers");
    assert_same(&one, &made("many", &["--workers", "5"]), "5 workers");
    assert_same(&one, &made("plain", &["--workers", "2", "--simd", "baseline"]), "baseline SIMD");
}

#[test]
fn frames_made_alone_and_in_reverse_are_those_made_together() {
    let folder = tempfile::tempdir().unwrap();
    let together = folder.path().join("together");
    export(&together, "0..8", &[]);
    let together = files(&together);
    for frame in (0..8).rev() {
        let out = folder.path().join(format!("alone-{frame}"));
        export(&out, &format!("{frame}..{}", frame + 1), &["--workers", "1"]);
        let stem = format!("{frame:06}");
        let alone = files(&out);
        let of_frame: Vec<_> = alone.iter().filter(|(k, _)| k.contains(&stem)).collect();
        assert!(of_frame.len() >= 4, "picture, scene and two label pictures");
        for (name, bytes) in of_frame {
            assert!(*bytes == together[name], "{name} differs");
        }
    }
}

#[test]
fn switching_outputs_off_changes_no_other() {
    let mut document = preset("starter");
    (document.image.width, document.image.height) = (160, 160);
    let all = studio(document.clone(), SimdChoice::Auto, 2).make(3).unwrap();
    for output in document.output.outputs.clone() {
        document.output.outputs = [output].into();
        let only = studio(document.clone(), SimdChoice::Auto, 1).make(3).unwrap();
        assert_eq!(only.scene, all.scene);
        assert!(only.picture.is_none() || only.picture == all.picture, "{output:?}");
        let (a, b) = (&only.annotations, &all.annotations);
        assert!(a.instance_ids.is_none() || a.instance_ids == b.instance_ids, "{output:?}");
        assert!(a.semantic.is_none() || a.semantic == b.semantic, "{output:?}");
        for (a, b) in a.people.iter().zip(&b.people) {
            assert!(a.bbox.is_none() || a.bbox == b.bbox, "{output:?}");
            assert!(a.keypoints.is_none() || a.keypoints == b.keypoints, "{output:?}");
        }
    }
}

#[test]
fn every_preset_shows_people_small() {
    for preset in presets::ALL {
        let mut document = file::parse(preset.text).unwrap();
        (document.image.width, document.image.height) = (128, 96);
        let made = studio(document, SimdChoice::Auto, 2).make(0).unwrap();
        let picture = made.picture.unwrap();
        let (low, high) = (picture.iter().min().unwrap(), picture.iter().max().unwrap());
        assert!(high - low > 60, "{}: a picture between {low} and {high}", preset.name);
        assert!(!made.annotations.people.is_empty(), "{}: nobody", preset.name);
    }
}

/// The invariants of the labels, over frames of the seed's preset.
#[test]
fn labels_keep_their_word() {
    let mut document = preset("peoplesanspeople");
    (document.image.width, document.image.height) = (320, 240);
    let mut studio = studio(document, SimdChoice::Auto, 2);
    let (mut people, mut loose, mut visible, mut off) = (0, 0, 0, 0);
    for frame in 0..30 {
        let made = studio.make(frame).unwrap();
        let found = check_frame(&made);
        people += made.annotations.people.len();
        loose += found.loose_boxes;
        visible += found.visible_keypoints;
        off += found.off_mask;
    }
    assert!(people > 100, "{people} people in 30 frames");
    assert!(loose * 50 <= people, "{loose} of {people} boxes are loose");
    assert!(off * 100 <= visible, "{off} of {visible} visible keypoints are off their mask");
}

#[derive(Default)]
struct Found {
    loose_boxes: usize,
    visible_keypoints: usize,
    off_mask: usize,
}

fn check_frame(made: &RenderedFrame) -> Found {
    let labels = &made.annotations;
    let ids = labels.instance_ids.as_ref().unwrap();
    let w = labels.width as usize;
    let mut found = Found::default();
    for person in &labels.people {
        let at: Vec<_> = (0..ids.len()).filter(|i| ids[*i] == person.instance).collect();
        assert!(!at.is_empty(), "an annotated person owns a pixel");
        assert_eq!(person.mask_area, Some(at.len() as u64));
        let x = |i: &usize| (i % w) as f64;
        let y = |i: &usize| (i / w) as f64;
        let range = |f: &dyn Fn(&usize) -> f64| {
            (at.iter().map(f).fold(f64::MAX, f64::min), at.iter().map(f).fold(0.0, f64::max) + 1.0)
        };
        let ((x0, x1), (y0, y1)) = (range(&x), range(&y));
        let [bx, by, bw, bh] = person.bbox.unwrap();
        let slack = [x0 - bx, y0 - by, bx + bw - x1, by + bh - y1];
        assert!(slack.iter().all(|s| *s >= 0.0), "a box cuts its mask: {slack:?}");
        found.loose_boxes += usize::from(slack.iter().any(|s| *s > 1.0));
        for k in person.keypoints.as_ref().unwrap() {
            let [u, v] = k.image_px;
            let [px, py, pz] = k.camera_m;
            if k.coco_visibility() > 0 {
                let [row_x, row_y, _] = labels.camera.k;
                let q = [row_x[0] * px / pz + row_x[2], row_y[1] * py / pz + row_y[2]];
                assert!((q[0] - u).abs() < 1e-6 && (q[1] - v).abs() < 1e-6);
                assert!(u >= 0.0 && v >= 0.0 && u < w as f64 && v < f64::from(labels.height));
            }
            if k.reason == Visibility::Visible {
                found.visible_keypoints += 1;
                let near =
                    at.iter().any(|i| (x(i) + 0.5 - u).abs() < 2.6 && (y(i) + 0.5 - v).abs() < 2.6);
                found.off_mask += usize::from(!near);
            }
        }
    }
    found
}

/// People are written to files, one is edited and named, and they stand in another data set.
#[test]
fn people_of_one_config_are_named_in_the_data_set_of_another() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let seed = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/peoplesanspeople.json");
    let (exit, messages) = figurant(&["people", seed, "--out", &path("all"), "--person", "3,8"]);
    assert_eq!(exit, Exit::Done, "{messages}");
    let edited = read(&path("all/0003.json"), |person| {
        person["name"] = "maria".into();
        person["body"]["age_years"] = 71.5.into();
    });
    let poses = r#"{"poses": {"mine": {"activity": "testing", "both": {"elbow_flexion": 40}}}}"#;
    fs::create_dir(path("assets")).unwrap();
    fs::write(path("assets/mine.poses.json"), poses).unwrap();
    let config = serde_json::json!({
        "version": 1,
        "assets": ["assets", "all"],
        "background": {"wall": {"texture": "none"}},
        "occluders": {"enabled": false},
        "people": {
            "identities": null,
            "cast": [{"file": "all/0003.json"}, {"file": "0008.json"}],
            "pose": {"clip": "pose/mine"},
        },
    });
    fs::write(path("config.json"), config.to_string()).unwrap();
    let args = ["export", &path("config.json"), "--out", &path("out"), "--frames", "2"];
    let (exit, messages) = figurant(&[&args[..], &["--size", "200x150"]].concat());
    assert_eq!(exit, Exit::Done, "{messages}");

    let manifest = read(&path("out/manifest.json"), |_| {});
    let who = &manifest["identities"];
    assert_eq!(who.as_array().unwrap().len(), 2);
    assert_eq!((&who[0]["id"], &who[0]["name"]), (&0.into(), &"maria".into()));
    assert_eq!((&who[1]["id"], &who[1].get("name")), (&1.into(), &None));
    for field in ["sex", "age_years", "stature_m", "bmi_kg_m2"] {
        assert_eq!(who[0][field], edited["body"][field], "{field}");
    }
    let index = read(&path("out/coco/annotations.json"), |_| {});
    let shown = index["annotations"].as_array().unwrap();
    let marias = shown.iter().filter(|a| a["figurant"]["person"]["name"] == "maria").count();
    assert!(marias > 0 && marias < shown.len());
    assert_eq!(who[0]["annotations"], marias);
    let asset = |id: &str| {
        let all = manifest["assets"].as_array().unwrap();
        all.iter().find(|a| a["id"] == id).unwrap_or_else(|| panic!("{id}: {all:?}")).clone()
    };
    for id in ["poses/mine.poses.json", "people/all/0003.json", "people/0008.json"] {
        let asset = asset(id);
        assert_eq!(asset["licence"], "NOASSERTION", "{id}");
        assert_eq!(asset["content_hash"].as_str().unwrap().len(), 64, "{id}");
    }
    // The data set's own config holds the people themselves and gives the same frames.
    fs::copy(path("out/config.json"), path("again.json")).unwrap();
    let args = ["export", &path("again.json"), "--out", &path("again"), "--frames", "2"];
    let (exit, messages) = figurant(&args);
    assert_eq!(exit, Exit::Done, "{messages}");
    for name in ["scenes/000001.json", "coco/annotations.json"] {
        assert!(
            fs::read(path(&format!("out/{name}"))).unwrap()
                == fs::read(path(&format!("again/{name}"))).unwrap(),
            "{name}"
        );
    }
}

/// A JSON file after a change, which is written back.
fn read(path: &str, change: impl FnOnce(&mut Value)) -> Value {
    let mut value: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let before = value.clone();
    change(&mut value);
    if value != before {
        fs::write(path, value.to_string()).unwrap();
    }
    value
}

#[test]
fn hostile_configs_are_refused_with_their_field() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let seed = presets::find("peoplesanspeople").unwrap().text;
    let crowded = seed.replace("\"separation_m\": 3", "\"separation_m\": 0");
    let cases = [
        (r#"{"version": 1, "image": {"width": 0, "height": 64}}"#, "image.width"),
        (r#"{"version": 1, "image": {"width": 100000, "height": 100000}}"#, "image"),
        (crowded.as_str(), "people.placement.separation_m"),
        (r#"{"version": 1, "people": {"scale": {"uniform": [3, 1]}}}"#, "people.scale"),
        (r#"{"version": 1, "people": {"body": {"age_years": 0}}}"#, "people.body.age_years"),
        (r#"{"version": 1, "people": {"cast": [{"file": "gone.json"}]}}"#, "people.cast[0].file"),
        (
            r#"{"version": 1, "people": {"cast": [{"look": {"face": {"head-ovall": 1}}}]}}"#,
            "people.cast[0].look.face.head-ovall",
        ),
        (r#"{"version": 1, "people": {"identities": 1, "cast": [{}, {}]}}"#, "people.identities"),
        (r#"{"version": 1, "frames": 1e999}"#, "number"),
        (r#"{"version": 99}"#, "version"),
        (r#"{"version": 1, "camra": {}}"#, "camera"),
        (r#"{"version": 1, "assets": ["no-such-folder"]}"#, "no-such-folder"),
        ("{\"version\": 1, \"name\": \"trunc", "config"),
        ("not json", "config"),
    ];
    for (text, named) in cases {
        let config = folder.path().join("config.json");
        fs::write(&config, text).unwrap();
        let args = ["export", config.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let (exit, messages) = figurant(&args);
        assert_eq!(exit, Exit::BadInput, "{text}: {messages}");
        assert!(messages.contains(named), "{text}: {messages}");
        assert!(!out.exists(), "{text}: something was written");
    }
}
