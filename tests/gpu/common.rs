//! What the tests of the graphics engine share.

use figurant_core::draw::DrawList;
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions};
use figurant_core::engine::gpu::{GpuEngine, GpuOptions, adapters};
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
    PassPlan::new(&wanted, SceneFacts { sun_shadow: true })
}

pub fn by_gpu(engine: &mut GpuEngine, list: &DrawList, outputs: &[Output]) -> Frame {
    engine.render(list, &plan(outputs), &mut StageTimes::default()).unwrap()
}

pub fn by_cpu(list: &DrawList, outputs: &[Output]) -> Frame {
    CpuEngine::new(CpuOptions::default())
        .render(list, &plan(outputs), &mut StageTimes::default())
        .unwrap()
}

/// How two frames of one draw list differ.
#[derive(Debug, Default)]
pub struct Difference {
    pub pixels: usize,
    /// Pixels with another object, all of which the oracle leaves in doubt.
    pub ids: usize,
    /// Largest relative error of a distance, slope apart.
    pub depth: f64,
    /// Mean over all channels, steps of 255.
    pub color_mean: f64,
    /// Largest, away from edges, steps of 255.
    pub color_most: u8,
    /// Pixels away from edges.
    pub inner: usize,
}

impl Difference {
    pub fn add(&mut self, other: &Self) {
        let pixels = (self.pixels + other.pixels) as f64;
        self.color_mean = (self.color_mean * self.pixels as f64
            + other.color_mean * other.pixels as f64)
            / pixels.max(1.0);
        self.pixels += other.pixels;
        self.ids += other.ids;
        self.depth = self.depth.max(other.depth);
        self.color_most = self.color_most.max(other.color_most);
        self.inner += other.inner;
    }
}

/// Compares all buffers; panics where they differ by more than rounding may make them.
pub fn compare(name: &str, list: &DrawList, cpu: &Frame, gpu: &Frame) -> Difference {
    let mut found = Difference { pixels: (cpu.width * cpu.height) as usize, ..Default::default() };
    let oracle = Oracle::new(list);
    compare_labels(name, &oracle, list, cpu, gpu, &mut found);
    if let (Some(a), Some(b)) = (&cpu.picture, &gpu.picture) {
        compare_pictures(cpu, [a, b], &mut found);
    }
    found
}

/// Positions of the samples of a pixel, pixels.
fn positions(samples: u32) -> Vec<[f64; 2]> {
    let positions = figurant_tests::oracle::sample_positions(samples);
    positions.iter().map(|p| p.map(|v| f64::from(v) / 16.0)).collect()
}

fn compare_labels(
    name: &str,
    oracle: &Oracle,
    list: &DrawList,
    cpu: &Frame,
    gpu: &Frame,
    found: &mut Difference,
) {
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
            found.ids += 1;
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
        } else {
            found.depth = found.depth.max(error);
        }
    }
}

/// Steps of 255 by which neighbours differ where there is an edge of light or of a texture, which
/// a thousandth of a pixel may move over a texel's border.
const EDGE_STEPS: u8 = 40;

fn compare_pictures(frame: &Frame, [a, b]: [&Vec<u8>; 2], found: &mut Difference) {
    let ids = frame.object_ids.as_ref().unwrap();
    let (width, height) = (frame.width as usize, frame.height as usize);
    let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    found.color_mean = sum as f64 / a.len() as f64;
    for y in 0..height {
        for x in 0..width {
            let near = (y.saturating_sub(1)..(y + 2).min(height)).flat_map(|ny| {
                (x.saturating_sub(1)..(x + 2).min(width)).map(move |nx| ny * width + nx)
            });
            let own = y * width + x;
            let edge = near.clone().any(|i| ids[i] != ids[own])
                || (0..3).any(|c| {
                    let values = near.clone().map(|i| a[i * 3 + c]);
                    values.clone().max().unwrap() - values.min().unwrap() > EDGE_STEPS
                });
            if !edge {
                found.inner += 1;
                for c in 0..3 {
                    let apart = a[own * 3 + c].abs_diff(b[own * 3 + c]);
                    found.color_most = found.color_most.max(apart);
                }
            }
        }
    }
}
