//! A window without a window system.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{Ui, vec2};
use egui_kittest::Harness;
use figurant::session::Session;
use figurant::shell::Shell;
use figurant::viewport::worker::{Pixels, Shown};

/// Longest that a picture may take, on a busy machine, in a build without optimisation.
const PATIENCE: Duration = Duration::from_secs(120);

/// Pixels of a side of the test's pictures.
pub const SIDE: u32 = 96;

/// A folder with a small config.
pub struct Folder {
    dir: tempfile::TempDir,
}

impl Folder {
    pub fn new() -> Self {
        let folder = Self { dir: tempfile::tempdir().unwrap() };
        folder.write(&config());
        folder
    }

    pub fn config(&self) -> PathBuf {
        self.dir.path().join("small.json")
    }

    pub fn write(&self, value: &serde_json::Value) {
        std::fs::write(self.config(), value.to_string()).unwrap();
    }
}

/// The starter preset with a small picture.
pub fn config() -> serde_json::Value {
    let preset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../presets/starter.json");
    let text = std::fs::read_to_string(preset).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["image"] = serde_json::json!({"width": SIDE, "height": SIDE});
    value
}

/// What is shown in the test's window.
pub struct Desk {
    path: PathBuf,
    shell: Option<Shell>,
}

/// A window that shows a config.
pub type Window = Harness<'static, Desk>;

pub fn open(path: PathBuf) -> Window {
    let show = |ui: &mut Ui, desk: &mut Desk| {
        let path = &desk.path;
        let shell = desk
            .shell
            .get_or_insert_with(|| Shell::new(ui.ctx(), None, Some(path.clone())).unwrap());
        shell.logic();
        shell.ui(ui);
    };
    let desk = Desk { path, shell: None };
    Harness::builder().with_size(vec2(1280.0, 800.0)).build_ui_state(show, desk)
}

pub fn session(window: &Window) -> &Session {
    &window.state().shell.as_ref().unwrap().session
}

/// Shows pass after pass until something holds; panics when that takes too long.
pub fn until(window: &mut Window, what: &str, holds: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    window.step();
    while !holds(session(window)) {
        assert!(start.elapsed() < PATIENCE, "waited too long for {what}");
        std::thread::sleep(Duration::from_millis(5));
        window.step();
    }
    // What changed is laid out now.
    window.step();
}

/// Waits for the picture that is wanted now.
pub fn settle(window: &mut Window) -> Arc<Shown> {
    let wanted = |s: &Session| {
        !s.busy
            && s.queue.is_empty()
            && s.shown.as_ref().map(|x| &x.request) == s.request().as_ref()
    };
    until(window, "the picture", |s| s.request().is_some() && wanted(s));
    session(window).shown.clone().unwrap()
}

/// A picture's bytes as an export holds them.
pub fn rgb(shown: &Shown) -> Vec<u8> {
    match &shown.pixels {
        Pixels::Host(image) => image.pixels.iter().flat_map(|p| [p.r(), p.g(), p.b()]).collect(),
        Pixels::Device(_) => panic!("the picture is on a device"),
    }
}
