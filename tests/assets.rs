//! Users' folders of pictures, good and bad: what a data set says of them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use figurant::studio::Native;
use figurant::{Console, Exit, Stop};
use serde_json::{Value, json};

fn figurant(args: &[&str]) -> (Exit, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = std::iter::once("figurant").chain(args.iter().copied());
    let mut console = Console::new(&mut out, &mut err, false);
    let exit = figurant::run(&Native, words.map(Into::into), &mut console, &Stop::new());
    (exit, String::from_utf8(err).unwrap())
}

/// Two good pictures among bad ones: cut, empty, none at all, and one that claims to be huge.
fn pictures(folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    let good = |name: &str, value: u8| {
        image::RgbImage::from_pixel(40, 30, image::Rgb([value, 90, 200])).save(folder.join(name))
    };
    good("b.png", 20).unwrap();
    good("f.jpg", 220).unwrap();
    let whole = fs::read(folder.join("b.png")).unwrap();
    fs::write(folder.join("a.png"), &whole[..whole.len() / 2]).unwrap();
    fs::write(folder.join("c.jpg"), b"").unwrap();
    fs::write(folder.join("d.png"), b"no picture").unwrap();
    // Width and height of a PNG stand at bytes 16 to 23.
    let mut huge = whole;
    huge[16..24].copy_from_slice(&[0, 0, 0x4e, 0x20, 0, 0, 0x4e, 0x20]);
    fs::write(folder.join("e.png"), huge).unwrap();
    fs::write(folder.join("g.hdr"), b"#?RADIANCE\n").unwrap();
}

/// Occluders and a wall of the folder's pictures, in so many frames.
fn config(folder: &Path, assets: &Value) -> String {
    let files = ["a.png", "b.png", "c.jpg", "d.png", "e.png", "f.jpg"];
    let any: Vec<Value> = files.iter().map(|f| json!([format!("folder/photos/{f}"), 1])).collect();
    let text = json!({
        "version": 1, "frames": 8, "seed": 3, "assets": assets,
        "background": {"wall": {"texture": {"choice": any}}},
        "occluders": {"texture": {"choice": any}},
        "output": {"outputs": ["rgb", "instance"], "image_format": "png"},
    });
    let path = folder.join("config.json");
    fs::write(&path, text.to_string()).unwrap();
    path.to_str().unwrap().to_owned()
}

fn export(config: &str, out: &Path, workers: &str) -> (Exit, Value, String) {
    let out_text = out.to_str().unwrap();
    let args = ["export", config, "--out", out_text, "--size", "96x96", "--workers", workers];
    let (exit, messages) = figurant(&args);
    let report = fs::read(out.join("report.json")).unwrap();
    (exit, serde_json::from_slice(&report).unwrap(), messages)
}

#[test]
fn unusable_pictures_stop_the_frames_that_need_them_by_name() {
    let folder = tempfile::tempdir().unwrap();
    pictures(&folder.path().join("photos"));
    let config = config(folder.path(), &json!(["photos"]));
    let (exit, report, _) = export(&config, &folder.path().join("out"), "2");
    assert_eq!(exit, Exit::SomeFailed);
    let failed = report["failed"].as_array().unwrap();
    assert!(!failed.is_empty());
    for frame in failed {
        let reason = frame["reason"].as_str().unwrap();
        let named = ["a.png", "c.jpg", "d.png", "e.png"].iter().any(|f| reason.contains(f));
        assert!(named, "{reason}");
    }
    assert!(report.get("skipped_assets").is_none());
}

#[test]
fn skipped_pictures_are_replaced_alike_by_any_workers_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    pictures(&folder.path().join("photos"));
    let assets = json!({"folders": ["photos"], "on_error": "skip"});
    let config = config(folder.path(), &assets);
    let [one, two] = ["1", "3"].map(|workers| {
        let out = folder.path().join(workers);
        let (exit, report, messages) = export(&config, &out, workers);
        assert_eq!(exit, Exit::Done, "{messages}");
        assert!(messages.contains("a.png"), "{messages}");
        assert_eq!(report["failed"], json!([]));
        let skipped = report["skipped_assets"].as_array().unwrap();
        let ids: Vec<&str> = skipped.iter().map(|s| s["id"].as_str().unwrap()).collect();
        let bad = ["a.png", "c.jpg", "d.png", "e.png"].map(|f| format!("folder/photos/{f}"));
        assert_eq!(ids, bad);
        assert!(skipped.iter().all(|s| s["reason"].as_str().unwrap().len() > 10));
        // Each image says which of them it lacks, and all of them together are the report's.
        let index = fs::read(out.join("coco/annotations.json")).unwrap();
        let index: Value = serde_json::from_slice(&index).unwrap();
        let images = index["images"].as_array().unwrap().iter();
        let lacks = images.filter_map(|i| i["figurant"]["skipped_assets"].as_array()).flatten();
        let mut lacks: Vec<_> = lacks.cloned().collect();
        lacks.sort_by_key(Value::to_string);
        lacks.dedup();
        assert_eq!(&lacks, skipped);
        out
    });
    for frame in 0..8 {
        let same = |path: String| {
            let [a, b] = [&one, &two].map(|out| fs::read(out.join(&path)).unwrap());
            assert_eq!(a, b, "{path}");
            a
        };
        same(format!("images/{frame:06}.png"));
        // A scene says what its picture shows.
        let scene = String::from_utf8(same(format!("scenes/{frame:06}.json"))).unwrap();
        assert!(scene.contains("photos/b.png") || scene.contains("photos/f.jpg"));
        assert!(!["a.png", "c.jpg", "d.png", "e.png"].iter().any(|f| scene.contains(f)));
    }
}

#[test]
fn a_folder_that_vanished_is_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for assets in [json!(["gone"]), json!({"folders": ["gone"], "on_error": "skip"})] {
        let config = config(folder.path(), &assets);
        let out = folder.path().join("out");
        let args = ["export", &config, "--out", out.to_str().unwrap(), "--progress", "none"];
        let (exit, messages) = figurant(&args);
        assert_eq!(exit, Exit::BadInput, "{messages}");
        assert!(messages.contains("gone") && messages.contains("does not exist"), "{messages}");
        assert!(!out.exists());
    }
}
