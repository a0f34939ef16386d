//! Time of each stage of both engines on a fixed scene.
//!
//! `cargo bench -p figurant-tests --bench engine_stages -- [FRAMES] [PICTURE.png]`: medians over
//! the frames, in milliseconds, for one thread and for all; the picture shows what was measured.
//! The graphics engine runs on the first adapter there is, if only one of software.

use std::time::Instant;

use figurant_core::draw::DrawList;
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
use figurant_core::engine::gpu::{GpuEngine, GpuOptions, adapters};
use figurant_core::plan::{Output, Outputs, PassPlan, SceneFacts, StageTimes};
use figurant_tests::crowd::crowd;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Renders frames and prints the medians of their stages.
fn measure(name: &str, list: &DrawList, outputs: &[Output], options: CpuOptions, frames: usize) {
    measure_engine(name, list, outputs, &mut CpuEngine::new(options), frames);
}

/// As [`measure`], with any engine.
fn measure_engine(
    name: &str,
    list: &DrawList,
    outputs: &[Output],
    engine: &mut dyn Engine,
    frames: usize,
) {
    let wanted: Outputs = outputs.iter().copied().collect();
    let plan = PassPlan::new(&wanted, SceneFacts::ANY);
    let mut walls = Vec::new();
    let mut stages: Vec<(&'static str, Vec<f64>)> = Vec::new();
    for frame in 0..frames + 2 {
        let mut times = StageTimes::default();
        let start = Instant::now();
        engine.render(list, &plan, &mut times).expect("the scene is valid");
        let wall = start.elapsed().as_secs_f64() * 1e3;
        if frame < 2 {
            continue;
        }
        walls.push(wall);
        for (stage, time) in times.iter() {
            let ms = time.as_secs_f64() * 1e3;
            match stages.iter_mut().find(|(name, _)| *name == stage) {
                Some((_, values)) => values.push(ms),
                None => stages.push((stage, vec![ms])),
            }
        }
    }
    let least = walls.iter().copied().fold(f64::INFINITY, f64::min);
    print!("{name:34} {:7.2} (least {least:6.2}) |", median(walls));
    for (stage, values) in stages {
        print!(" {stage} {:.2}", median(values));
    }
    println!();
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let frames = arguments.first().and_then(|a| a.parse().ok()).unwrap_or(15);
    let one = |simd| CpuOptions { simd, threads: 1 };
    let auto = one(SimdChoice::Auto);
    let everything = &Output::ALL;
    let labels = &[Output::Box2d, Output::Instance, Output::Keypoints];

    let mut list = crowd(640, 640, 4, 15_000);
    println!("instruction set: {}", CpuEngine::new(auto).simd_name());
    measure("4 samples, all, 1 thread", &list, everything, auto, frames);
    measure(
        "4 samples, all, 2 threads",
        &list,
        everything,
        CpuOptions { threads: 2, ..auto },
        frames,
    );
    measure(
        "4 samples, all, baseline, 1 thread",
        &list,
        everything,
        one(SimdChoice::Baseline),
        frames,
    );
    measure("4 samples, labels", &list, labels, auto, frames);
    list.samples = 1;
    measure("1 sample, all", &list, everything, auto, frames);
    measure("1 sample, labels", &list, labels, auto, frames);
    list.samples = 16;
    measure("16 samples, all", &list, everything, auto, frames);
    list.samples = 4;
    list.lights.sun.as_mut().expect("there is a sun").shadow = false;
    measure("4 samples, all, no shadow", &list, everything, auto, frames);

    if let Some(adapter) = adapters().into_iter().next() {
        println!("adapter: {adapter}");
        let options = GpuOptions { adapter: Some(adapter.name), ..GpuOptions::default() };
        let mut gpu = GpuEngine::new(options).expect("an adapter that was found opens");
        let mut list = crowd(640, 640, 4, 15_000);
        measure_engine("gpu, 4 samples, all", &list, everything, &mut gpu, frames);
        measure_engine("gpu, 4 samples, labels", &list, labels, &mut gpu, frames);
        list.samples = 1;
        measure_engine("gpu, 1 sample, all", &list, everything, &mut gpu, frames);
        measure_engine("gpu, 1 sample, labels", &list, labels, &mut gpu, frames);
    }

    if let Some(path) = arguments.get(1) {
        let list = crowd(640, 640, 4, 15_000);
        let plan = PassPlan::new(&everything.iter().copied().collect(), SceneFacts::ANY);
        let frame = CpuEngine::new(auto)
            .render(&list, &plan, &mut StageTimes::default())
            .expect("the scene is valid");
        let picture = frame.picture.expect("it was asked for");
        image::RgbImage::from_raw(frame.width, frame.height, picture)
            .expect("three bytes a pixel")
            .save(path)
            .expect("the picture can be written");
    }
}
