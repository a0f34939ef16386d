//! What a frame costs, stage by stage and setting by setting: `cargo bench -p figurant-tests`.
//!
//! All settings make the same frames in turn within one run, so that their ratios hold on a machine
//! whose speed drifts. One thread; files are not written. Arguments: a preset and how many frames.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::{Duration, Instant};

use figurant_core::document::{Document, file, presets};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::job::{FrameMaker, Studio};
use figurant_core::library::Library;
use figurant_core::plan::{Output, StageTimes};

type Change = fn(&mut Document);

/// What is compared; the first is what the others are measured against.
const SETTINGS: &[(&str, SimdChoice, Change)] = &[
    ("all outputs, 4 samples, sun shadow", SimdChoice::Auto, |_| {}),
    ("the same, baseline instructions", SimdChoice::Baseline, |_| {}),
    ("1 sample", SimdChoice::Auto, |d| d.labels.samples = 1),
    ("16 samples", SimdChoice::Auto, |d| d.labels.samples = 16),
    ("no sun", SimdChoice::Auto, |d| d.lights.sun.enabled = false),
    ("shadow map 1024", SimdChoice::Auto, |d| d.quality.shadow_map_size = 1024),
    ("detail to 1 px", SimdChoice::Auto, |d| d.quality.lod_error_px = 1.0),
    ("detail to 0.05 px", SimdChoice::Auto, |d| d.quality.lod_error_px = 0.05),
    ("no bloom", SimdChoice::Auto, |d| d.post.bloom = 0.0.into()),
    ("out of focus, f/2", SimdChoice::Auto, |d| {
        let blur = &mut d.camera.depth_of_field;
        (blur.f_number, blur.focus_distance_m) = (2.0.into(), 8.0.into());
        blur.focal_length_mm = None;
    }),
    ("1 sample, no sun, no effects of the lens", SimdChoice::Auto, |d| {
        d.labels.samples = 1;
        d.lights.sun.enabled = false;
        (d.post.enabled, d.camera.depth_of_field.enabled) = (false, false);
    }),
    ("labels without a picture", SimdChoice::Auto, |d| {
        d.output.outputs.remove(&Output::Rgb);
    }),
    ("keypoints alone", SimdChoice::Auto, |d| d.output.outputs = [Output::Keypoints].into()),
];

struct Run {
    studio: Studio,
    frames: Vec<Duration>,
    times: StageTimes,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let name = words.first().map_or("peoplesanspeople", String::as_str);
    let count: u32 = words.get(1).and_then(|n| n.parse().ok()).unwrap_or(40);
    let Some(preset) = presets::find(name) else {
        eprintln!("no preset '{name}'");
        return;
    };
    let document = file::parse(preset.text).expect("presets are valid");
    let library = Arc::new(Library::new(&[], 1024).expect("built-in assets load"));
    let mut runs: Vec<Run> = SETTINGS
        .iter()
        .map(|(_, simd, change)| {
            let mut document = document.clone();
            change(&mut document);
            Run {
                studio: studio(document, *simd, &library),
                frames: Vec::new(),
                times: StageTimes::default(),
            }
        })
        .collect();
    for frame in 0..count {
        for run in &mut runs {
            let start = Instant::now();
            let made = run.studio.make(frame).expect("presets render");
            run.frames.push(start.elapsed());
            run.times.merge(&made.times);
        }
    }
    report(name, count, &mut runs);
}

fn studio(document: Document, simd: SimdChoice, library: &Arc<Library>) -> Studio {
    let engine = CpuEngine::new(CpuOptions { simd, ..CpuOptions::default() });
    let (library, cast) = (Arc::clone(library), Arc::default());
    Studio::new(Arc::new(document), library, cast, Box::new(engine), NonZeroUsize::MIN)
        .expect("one thread can be had")
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn median(frames: &mut [Duration]) -> f64 {
    frames.sort_unstable();
    milliseconds(frames[frames.len() / 2])
}

fn report(name: &str, count: u32, runs: &mut [Run]) {
    println!("preset {name}, {count} frames, one thread, milliseconds a frame");
    let base = median(&mut runs[0].frames);
    for ((setting, _, _), run) in SETTINGS.iter().zip(runs.iter_mut()) {
        let median = median(&mut run.frames);
        println!("{setting:<40} median {median:7.2}   ratio {:5.2}", median / base);
    }
    println!("\nby stage, mean of {}:", SETTINGS[0].0);
    let order: BTreeMap<usize, (&str, Duration)> = runs[0].times.iter().enumerate().collect();
    for (stage, time) in order.values() {
        println!("{stage:<40} {:14.2}", milliseconds(*time) / f64::from(count));
    }
}
