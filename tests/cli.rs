//! The command line from its arguments to its exit status, over frames that are painted, not
//! rendered: everything but the way from a config to a frame.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use figurant::road::{Adapter, Import, Job, LoadError, ParityWish, Road, Simd, Wishes};
use figurant::{Console, Exit, Stop};
use figurant_core::document::cast::Member;
use figurant_core::export::{DatasetInfo, PictureFormat};
use figurant_core::job::parity::Difference;
use figurant_core::job::{FrameMaker, RenderedFrame};
use figurant_core::label::annotation::{
    Annotations, CameraLabel, Keypoint, PersonLabel, PersonMeta, Visibility,
};
use figurant_core::plan::{Output, Outputs, PassPlan, SceneFacts, StageTimes};
use figurant_core::scene::{Camera, Environment, Lights, Post, Scene, Sex};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// Paints frames of one person each, whose mask is a rectangle.
struct Painter {
    width: u32,
    height: u32,
    seed: u64,
    fails: Vec<u32>,
}

#[derive(Debug, thiserror::Error)]
enum PaintError {
    #[error("frame {0} is out of paint")]
    Paint(u32),
    #[error("there is no brush on this machine")]
    Brush,
}

impl FrameMaker for Painter {
    type Error = PaintError;

    fn make(&mut self, frame: u32) -> Result<RenderedFrame, PaintError> {
        if self.fails.contains(&frame) {
            return Err(PaintError::Paint(frame));
        }
        let (width, height) = (self.width, self.height);
        let camera = Camera {
            width,
            height,
            fov_vertical_deg: 40.0,
            position_m: DVec3::new(0.0, 0.0, 5.0),
            rotation: DQuat::IDENTITY,
            near_m: 0.1,
            depth_of_field: None,
            distortion: None,
        };
        let inside =
            |i: u32| (i % width) >= width / 4 && (i % width) < width / 2 && i / width >= height / 4;
        let ids: Vec<u16> = (0..width * height).map(|i| if inside(i) { 2 } else { 0 }).collect();
        let color = |i: u32| {
            let v = (u64::from(i % width * 3 + frame * 5) + self.seed) as u8;
            if inside(i) { [220, v, 40] } else { [v, v, 90] }
        };
        let at = [f64::from(width) / 3.0, f64::from(height) / 2.0];
        let reason = Visibility::Visible;
        let (f, c) = (camera.focal_px(), camera.center_px());
        let camera_m = [(at[0] - c.x) / f * 5.0, (at[1] - c.y) / f * 5.0, 5.0];
        let point = Keypoint { image_px: at, camera_m, reason, visible_fraction: None };
        let h = f64::from(height);
        let (x0, x1, y0) = (f64::from(width / 4), f64::from(width / 2), f64::from(height / 4));
        let person = PersonLabel {
            instance: 2,
            bbox: Some([x0, y0, x1 - x0, h - y0]),
            mask_area: Some(ids.iter().filter(|id| **id != 0).count() as u64),
            keypoints: Some([point; 17]),
            meta: PersonMeta {
                age_years: 30.0,
                sex: Sex::Male,
                stature_m: 1.8,
                bmi_kg_m2: 24.0,
                mass_kg: None,
                garments: vec![],
                identity: None,
                name: None,
                activity: "standing".to_owned(),
                clip: "stand".to_owned(),
                pose: String::new(),
                phase: 0.5,
                mirrored: false,
            },
        };
        Ok(RenderedFrame {
            scene: Scene {
                frame,
                seed: self.seed,
                camera,
                lights: Lights {
                    sun: None,
                    points: vec![],
                    environment: Environment {
                        sky_lux: [1.0; 3],
                        ground_lux: [1.0; 3],
                        background_nits: [0.0; 3],
                        ambient_occlusion: false,
                        image: None,
                    },
                },
                exposure_ev100: 3.0,
                post: Post::default(),
                objects: vec![],
                people: vec![],
                jpeg_quality: None,
            },
            picture: Some((0..width * height).flat_map(color).collect()),
            skipped: vec![],
            annotations: Annotations {
                frame,
                width,
                height,
                camera: CameraLabel::from(&camera),
                people: vec![person],
                semantic: Some(ids.iter().map(|id| u8::from(*id != 0)).collect()),
                instance_ids: Some(ids),
            },
            plan: PassPlan::new(&Outputs::new(), SceneFacts::default()),
            times: StageTimes::default(),
        })
    }
}

/// A config is a JSON object: `frames`, `fails` (frames that fail), `brush` (whether there is one).
struct Atelier;

impl Atelier {
    fn job(config: &Value, wishes: &Wishes) -> Job<Value> {
        let [width, height] = wishes.size.unwrap_or([32, 24]);
        let info = DatasetInfo {
            config_json: format!("{config:#}\n"),
            program_version: "0.0.0".to_owned(),
            engine: "brush".to_owned(),
            adapter: None,
            seed: wishes.seed.unwrap_or(1),
            width,
            height,
            outputs: wishes.outputs.clone().unwrap_or_else(|| Output::ALL.into()),
            picture: PictureFormat::Jpeg(92),
            assets: BTreeSet::new(),
        };
        let frames = config["frames"].as_u64().unwrap_or(3) as u32;
        Job {
            document: config.clone(),
            frames,
            info,
            engine: wishes.engine.clone(),
            simd: wishes.simd,
        }
    }
}

impl Road for Atelier {
    type Document = Value;
    type Config = Value;
    type Maker = Painter;

    fn schema(&self) -> Value {
        json!({"type": "object"})
    }

    fn load(&self, config: &Path, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        let unreadable =
            |e| LoadError::Unreadable(format!("cannot read {}: {e}", config.display()));
        let text = fs::read_to_string(config).map_err(unreadable)?;
        let value: Value = serde_json::from_str(&text)
            .map_err(|e| LoadError::Invalid(vec![format!("config: {e}")]))?;
        let known = |key: &&String| !["frames", "fails", "brush"].contains(&key.as_str());
        let unknown: Vec<_> = value.as_object().unwrap().keys().filter(known).collect();
        if unknown.is_empty() {
            return Ok(Self::job(&value, wishes));
        }
        Err(LoadError::Invalid(unknown.iter().map(|key| format!("{key}: no such field")).collect()))
    }

    /// A scenario is a JSON object as well: it becomes a config but for what begins with `unity`.
    fn import(&self, scenario: &Path) -> Result<Import<Value>, LoadError> {
        let unreadable =
            |e| LoadError::Unreadable(format!("cannot read {}: {e}", scenario.display()));
        let text = fs::read_to_string(scenario).map_err(unreadable)?;
        let mut value: Value = serde_json::from_str(&text)
            .map_err(|e| LoadError::Invalid(vec![format!("scenario: {e}")]))?;
        let map = value.as_object_mut().unwrap();
        let foreign = |key: &&String| key.starts_with("unity");
        let foreign: Vec<String> = map.keys().filter(foreign).cloned().collect();
        foreign.iter().for_each(|key| drop(map.remove(key)));
        let notes = foreign.iter().map(|key| format!("{key}: is left out")).collect();
        Ok(Import { document: value, notes })
    }

    fn text(&self, config: &Value) -> String {
        format!("{config:#}\n")
    }

    fn ready(&self, config: Value, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        Ok(Self::job(&config, wishes))
    }

    fn people(&self, job: &Job<Value>, frame: Option<u32>) -> Result<Vec<(u32, Member)>, String> {
        let name = |name: &str| Member { name: Some(name.to_owned()), ..Member::default() };
        match frame {
            Some(frame) => Ok(vec![(2, name(&format!("in_{frame}_of_{}", job.info.seed)))]),
            None if job.document["brush"] == false => Err("nobody recurs".to_owned()),
            None => Ok(vec![(0, name("maria")), (1, Member::default()), (2, name("otto"))]),
        }
    }

    fn starter(&self, wishes: &Wishes) -> Result<Job<Value>, LoadError> {
        Ok(Self::job(&json!({}), wishes))
    }

    fn maker(&self, job: &Job<Value>, _: NonZeroUsize) -> Result<Painter, PaintError> {
        if job.document["brush"] == false {
            return Err(PaintError::Brush);
        }
        let fails = job.document["fails"].as_array().into_iter().flatten();
        let fails = fails.map(|f| f.as_u64().unwrap() as u32).collect();
        let info = &job.info;
        Ok(Painter { width: info.width, height: info.height, seed: info.seed, fails })
    }

    fn parity(
        &self,
        wish: &ParityWish<'_>,
        tell: &mut dyn FnMut(&str, &Difference),
    ) -> Result<String, LoadError> {
        if wish.adapter.as_deref() == Some("anvil") {
            return Err(LoadError::NoEngine("there is no anvil".to_owned()));
        }
        let [width, height] = wish.size.map(|side| side as usize);
        let pixels = width * height * wish.frames as usize;
        // An odd number of frames is one in which a colour is far off.
        let color_most = if wish.frames % 2 == 1 { 99 } else { 1 };
        tell("brush", &Difference { pixels, color_most, ..Difference::default() });
        Ok("easel".to_owned())
    }

    fn window(&self, config: Option<&Path>) -> Result<(), String> {
        match config {
            Some(_) => Ok(()),
            None => Err("the wall is bricked up".to_owned()),
        }
    }

    fn engine(&self, simd: Simd) -> String {
        format!("brush ({simd:?})")
    }

    fn adapters(&self) -> Option<Vec<Adapter>> {
        let (name, line) = ("easel".to_owned(), "easel (wood)".to_owned());
        Some(vec![Adapter { name, line, hardware: true }])
    }

    fn built_in_assets(&self) -> Result<Vec<String>, String> {
        Ok(vec!["3 colours".to_owned()])
    }
}

/// A folder with a config, and the program.
struct Desk {
    dir: tempfile::TempDir,
}

struct Ran {
    exit: Exit,
    out: String,
    err: String,
}

impl Desk {
    fn new(config: &Value) -> Self {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("c.json"), config.to_string()).unwrap();
        Self { dir }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// Runs a command line; words that start with `@` are paths in the folder.
    fn run_with(&self, line: &str, stop: &Stop) -> Ran {
        let word = |w: &str| match w.strip_prefix('@') {
            Some(name) => self.path(name).into_os_string(),
            None => w.into(),
        };
        let args = ["figurant"].into_iter().chain(line.split_whitespace()).map(word);
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let exit =
            figurant::run(&Atelier, args, &mut Console::new(&mut out, &mut err, false), stop);
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Ran { exit, out: text(out), err: text(err) }
    }

    fn run(&self, line: &str) -> Ran {
        self.run_with(line, &Stop::new())
    }
}

fn desk() -> Desk {
    Desk::new(&json!({}))
}

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
