//! The program with `--engine` and `--adapter`: what is written, and what is refused.

use std::fs;
use std::path::Path;

use figurant::studio::Native;
use figurant::{Console, Exit, Stop};
use serde_json::Value;

use super::common::options;

/// Runs the program as the command line would: how it ended, and its messages.
fn figurant(args: &[&str]) -> (Exit, String) {
    let (exit, _, messages) = figurant_says(args);
    (exit, messages)
}

/// With what it wrote to standard output, before the messages.
fn figurant_says(args: &[&str]) -> (Exit, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = std::iter::once("figurant").chain(args.iter().copied());
    let console = &mut Console::new(&mut out, &mut err, false);
    let exit = figurant::run(&Native, words.map(Into::into), console, &Stop::new());
    let [out, err] = [out, err].map(|bytes| String::from_utf8(bytes).unwrap());
    (exit, out, err)
}

fn export(out: &Path, more: &[&str]) -> (Exit, String) {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/peoplesanspeople.json");
    let mut args = vec!["export", config, "--out", out.to_str().unwrap(), "--frames", "0..3"];
    args.extend(["--size", "200x150", "--progress", "none"]);
    args.extend(more);
    figurant(&args)
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn a_data_set_names_its_engine_and_is_the_same_twice() {
    let Some(adapter) = options().and_then(|o| o.adapter) else { return };
    let dir = tempfile::tempdir().unwrap();
    let [a, b, cpu] = ["a", "b", "cpu"].map(|name| dir.path().join(name));
    for (out, workers) in [(&a, "1"), (&b, "2")] {
        let wishes = ["--engine", "gpu", "--adapter", &adapter, "--workers", workers];
        let (exit, messages) = export(out, &wishes);
        assert_eq!(exit, Exit::Done, "{messages}");
    }
    let manifest = json(&a.join("manifest.json"));
    assert_eq!(manifest["engine"], "gpu");
    assert_eq!(manifest["adapter"], Value::String(adapter));
    for file in ["coco/annotations.json", "images/000001.jpg", "labels/instance/000002.png"] {
        assert!(fs::read(a.join(file)).unwrap() == fs::read(b.join(file)).unwrap(), "{file}");
    }
    // Labels come from the same samples, whichever engine took them.
    let (exit, messages) = export(&cpu, &["--engine", "cpu"]);
    assert_eq!(exit, Exit::Done, "{messages}");
    let manifest = json(&cpu.join("manifest.json"));
    assert_eq!(manifest["engine"], "cpu");
    assert_eq!(manifest.get("adapter"), None);
    let people = |out: &Path| json(&out.join("coco/annotations.json"))["annotations"].clone();
    let (gpu, cpu) = (people(&a), people(&cpu));
    let count = gpu.as_array().unwrap().len();
    assert!(count > 3 && cpu.as_array().unwrap().len() == count, "{count} people");
}

#[test]
fn an_engine_that_cannot_be_had_is_refused_before_anything_is_written() {
    let Some(adapter) = options().and_then(|o| o.adapter) else { return };
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let (exit, messages) = export(&out, &["--adapter", "Voodoo 2"]);
    assert_eq!(exit, Exit::NoEngine, "{messages}");
    assert!(messages.contains("Voodoo 2") && messages.contains(&adapter), "{messages}");
    assert!(!out.exists());
}

#[test]
fn the_program_compares_its_engines() {
    let Some(adapter) = options().and_then(|o| o.adapter) else { return };
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/everyday.json");
    let args = ["bench", "parity", config, "--frames", "2", "--size", "96x64"];
    let (exit, out, messages) = figurant_says(&[&args[..], &["--adapter", &adapter]].concat());
    assert_eq!(exit, Exit::Done, "{out}{messages}");
    assert!(out.contains(&format!("{adapter} shows the same")), "{out}");
    let row = out.lines().find(|line| line.contains("everyday.json")).unwrap();
    assert!(row.contains(" 12288 "), "{row}");
    let (exit, _, messages) = figurant_says(&["bench", "parity", "--adapter", "Voodoo 2"]);
    assert_eq!(exit, Exit::NoEngine, "{messages}");
}
