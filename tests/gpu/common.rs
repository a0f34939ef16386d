//! What the tests of the graphics engine share.

use figurant_core::draw::DrawList;
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions};
use figurant_core::engine::gpu::{GpuEngine, GpuOptions, adapters};
use figurant_core::job::parity::Difference;
use figurant_core::plan::{Frame, Output, Outputs, PassPlan, SceneFacts, StageTimes};
use figurant_tests::oracle::Oracle;

/// The options that name an adapter of this machine; nothing, with a word about it, if there is
/// none and none is required.
pub fn options() -> Option<GpuOptions> {
    let found = adapters();
    let wanted = std::env::var("GPU_ADAPTER").ok();
    let adapter = wanted.or_else(|| found.first().map(|a| a.name.clone()));
    if adapter.is_none() {
        let required = std::env::var("REQUIRE_GPU").is_ok_and(|v| v == "1");
        assert!(!required, "REQUIRE_GPU is set, but there is no graphics adapter");
        println!("SKIPPED: there is no graphics adapter; install one of software to run this");
        return None;
    }
    Some(GpuOptions { adapter, ..GpuOptions::default() })
}

pub fn engine() -> Option<GpuEngine> {
    let engine = GpuEngine::new(options()?).unwrap();
    println!("adapter: {}", engine.adapter_name());
    Some(engine)
}

pub fn plan(outputs: &[Output]) -> PassPlan {
    let wanted: Outputs = outputs.iter().copied().collect();
    PassPlan::new(&wanted, SceneFacts::ANY)
}

pub fn by_gpu(engine: &mut GpuEngine, list: &DrawList, outputs: &[Output]) -> Frame {
    engine.render(list, &plan(outputs), &mut StageTimes::default()).unwrap()
}

pub fn by_cpu(list: &DrawList, outputs: &[Output]) -> Frame {
    CpuEngine::new(CpuOptions::default())
        .render(list, &plan(outputs), &mut StageTimes::default())
        .unwrap()
}

/// Compares all buffers; panics where they differ by more than rounding may make them.
pub fn compare(name: &str, list: &DrawList, cpu: &Frame, gpu: &Frame) -> Difference {
    compare_labels(name, &Oracle::new(list), list, cpu, gpu);
    Difference::of(cpu, gpu)
}

/// Positions of the samples of a pixel, pixels.
fn positions(samples: u32) -> Vec<[f64; 2]> {
    let positions = figurant_tests::oracle::sample_positions(samples);
    positions.iter().map(|p| p.map(|v| f64::from(v) / 16.0)).collect()
}

fn compare_labels(name: &str, oracle: &Oracle, list: &DrawList, cpu: &Frame, gpu: &Frame) {
    let (a, b) = (cpu.object_ids.as_ref().unwrap(), gpu.object_ids.as_ref().unwrap());
    let (da, db) = (cpu.depth_m.as_ref().unwrap(), gpu.depth_m.as_ref().unwrap());
    let positions = positions(list.samples);
    for i in 0..a.len() {
        let at = [i % cpu.width as usize, i / cpu.width as usize];
        let samples = || {
            positions
                .iter()
                .map(|p| oracle.sample(at[0] as f64 + p[0], at[1] as f64 + p[1]))
                .collect::<Vec<_>>()
        };
        if a[i] != b[i] {
            let samples = samples();
            assert!(
                samples.iter().any(|s| s.doubt),
                "{name}: object {} instead of {} at {at:?}: {samples:?}",
                b[i],
                a[i]
            );
            continue;
        }
        let error = f64::from((da[i] - db[i]).abs()) / f64::from(da[i]).max(1e-9);
        if error > 1e-5 {
            let samples = samples();
            let slope = samples
                .iter()
                .filter_map(|s| s.hit)
                .map(|h| h.slope_per_px / h.depth)
                .fold(0.0, f64::max);
            assert!(
                samples.iter().any(|s| s.doubt) || error < 1e-5 + slope * 2e-4,
                "{name}: distance {} instead of {} at {at:?}: {error:e}, slope {slope:e}: {samples:?}",
                db[i],
                da[i]
            );
        }
    }
}
