//! The layers of the core import downwards only; this table is the design.
//!
//! The sources are read as text: every `crate::layer` in a file of a layer must be in that layer's
//! row, and `super::super` is refused because it hides where a name comes from.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

/// Who may import whom. A new entry is a change of the design, not a shortcut.
const MAY_IMPORT: &[(&str, &[&str])] = &[
    ("base", &[]),
    ("plan", &["base"]),
    ("scene", &["base"]),
    ("document", &["base", "scene", "plan"]),
    ("library", &["base", "document"]),
    ("sampling", &["base", "document", "library", "scene"]),
    ("geometry", &["base", "library", "scene"]),
    ("draw", &["base", "library", "scene", "geometry"]),
    ("engine", &["base", "library", "draw", "plan"]),
    ("label", &["base", "library", "scene", "geometry", "draw", "plan"]),
    ("export", &["base", "document", "scene", "plan", "label"]),
    (
        "job",
        &[
            "base", "document", "library", "scene", "sampling", "geometry", "plan", "draw",
            "engine", "label", "export",
        ],
    ),
];

/// Imports between the engines are refused as well: they share inputs, never code.
const SEPARATE: &[(&str, &str)] = &[("engine/cpu", "engine::gpu"), ("engine/gpu", "engine::cpu")];

fn core_src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src")
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// Code without comment lines, so that prose may name any layer.
fn code_of(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Layer names that follow `crate::`, also within `use crate::{a, b::c}`.
fn imported_layers(code: &str) -> Vec<String> {
    let mut layers = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let names: Vec<&str> = match rest.strip_prefix('{') {
            Some(group) => top_level_names(group),
            None => vec![rest],
        };
        for name in names {
            let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
            layers.push(name[..end].to_owned());
        }
    }
    layers
}

/// The first name of each entry of a braced import list.
fn top_level_names(group: &str) -> Vec<&str> {
    let (mut depth, mut start, mut names) = (0, 0, Vec::new());
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                names.push(group[start..i].trim());
                break;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                names.push(group[start..i].trim());
                start = i + 1;
            }
            _ => {}
        }
    }
    names.retain(|n| !n.is_empty());
    names
}

#[test]
fn no_layer_imports_upwards() {
    let mut faults = Vec::new();
    for (layer, allowed) in MAY_IMPORT {
        let mut files = Vec::new();
        rust_files(&core_src().join(layer), &mut files);
        assert!(!files.is_empty(), "layer {layer} has no files");
        for file in files {
            let code = code_of(&file);
            for import in imported_layers(&code) {
                if import != *layer && !allowed.contains(&import.as_str()) {
                    faults.push(format!("{}: {layer} must not see {import}", file.display()));
                }
            }
            if code.contains("super::super") {
                faults.push(format!("{}: super::super hides the source", file.display()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_layer_stands_in_the_table() {
    let layers: Vec<&str> = MAY_IMPORT.iter().map(|(l, _)| *l).collect();
    for entry in fs::read_dir(core_src()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert!(name == "lib" || layers.contains(&name.as_str()), "{name} is in no row");
    }
}

#[test]
fn engines_share_no_code() {
    for (folder, forbidden) in SEPARATE {
        let path = core_src().join(folder);
        if path.exists() {
            let mut files = Vec::new();
            rust_files(&path, &mut files);
            for file in files {
                assert!(!code_of(&file).contains(forbidden), "{} sees {forbidden}", file.display());
            }
        }
    }
}

/// What only some files may name, and the folders and files of the program that may.
const WINDOWS: &[&str] = &[
    "command.rs",
    "launch.rs",
    "layout.rs",
    "panels",
    "session.rs",
    "shell.rs",
    "theme.rs",
    "viewport",
];

#[test]
fn windows_and_graphics_stay_where_they_belong() {
    let mut core = Vec::new();
    rust_files(&core_src(), &mut core);
    for file in core {
        let code = code_of(&file);
        assert!(!code.contains("egui") && !code.contains("eframe"), "{} draws", file.display());
        let graphics = file.starts_with(core_src().join("engine/gpu"));
        assert!(graphics || !code.contains("wgpu::"), "{} sees wgpu", file.display());
    }
    let app = Path::new(env!("CARGO_MANIFEST_DIR")).join("../app/src");
    let mut files = Vec::new();
    rust_files(&app, &mut files);
    for file in files {
        let of_window = WINDOWS.iter().any(|name| file.starts_with(app.join(name)));
        let code = code_of(&file);
        let draws = ["egui", "eframe", "wgpu::"].iter().any(|name| code.contains(name));
        assert!(of_window || !draws, "{} needs the feature gui", file.display());
    }
}

#[test]
fn the_reader_of_imports_sees_groups_and_paths() {
    let code =
        "use crate::base::rng;\nuse crate::{draw::{abi, X}, plan};\nlet a = crate::label::b();";
    assert_eq!(imported_layers(code), ["base", "draw", "plan", "label"]);
}
