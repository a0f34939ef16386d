//! What a frame of the graphics engine costs on the processor, and whether its device ever waits.
//!
//! `cargo bench -p figurant-tests --bench gpu_submit -- [PRESET] [FRAMES] [ADAPTER]`: milliseconds
//! a frame of the preset at its own size, with all outputs. Frames are sampled and drawn before
//! anything is measured, and each is rendered twice: the first time its people are `new` and their
//! meshes are uploaded, the second time they are `known`, as in data sets in which people recur.
//!
//! Everything that `render` does is either a stage of the processor's, timed by the wall, or
//! waiting for the device; "processor" is all but the latter. Medians over the frames, as drivers
//! of software take the processor for themselves. 2 ms allow 500 frames a second on one thread.
//! "own" is the mean time that the thread itself had of a processor, by the books of Linux: what a
//! busy machine adds to the others is not in it, what the driver does on this thread is.
//!
//! Then the frames are rendered by 1, 2 and 3 engines at once, one thread each. "Busy" is the part
//! of the time in which the device has at least one frame to work on, "in flight" how many frames
//! it has on average: between the end of a frame's submission and that of its wait.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use figurant_core::document::{file, presets};
use figurant_core::draw::{Cast, DrawList, DrawOptions, draw};
use figurant_core::engine::Engine;
use figurant_core::engine::gpu::{GpuEngine, GpuOptions, adapters};
use figurant_core::job::catalogue;
use figurant_core::library::Library;
use figurant_core::plan::{Output, PassPlan, SceneFacts, StageTimes};
use figurant_core::sampling::Sampler;

/// Stages of the processor's, in the order in which they run; all others are the device's.
const STAGES: [&str; 5] = ["check", "upload", "pack", "submit", "copy back"];

/// What is rendered.
struct Frames {
    lists: Vec<DrawList>,
    /// The same with meshes of their own: what they leave on a device are shaders and textures.
    others: Vec<DrawList>,
    plan: PassPlan,
}

/// Draw lists of the first frames of a preset.
fn frames(preset: &str, count: u32) -> Option<Frames> {
    let document = file::parse(presets::find(preset)?.text).expect("presets are valid");
    let library = Library::new(&[], document.quality.max_texture_size).expect("assets load");
    let options = DrawOptions {
        raster: true,
        shading: true,
        samples: document.labels.samples,
        shadow_map_size: document.quality.shadow_map_size,
        lod_error_px: document.quality.lod_error_px,
    };
    let casts = [Cast::default(), Cast::default()];
    let sampler = Sampler::new(Arc::new(document), catalogue(&library)).expect("presets sample");
    let list = |frame, cast: &Cast| {
        draw(&sampler.scene(frame), &library, cast, &options).expect("presets draw").list
    };
    let [lists, others] = casts.map(|cast| (0..count).map(|frame| list(frame, &cast)).collect());
    let plan = PassPlan::new(&Output::ALL.into(), SceneFacts::ANY);
    Some(Frames { lists, others, plan })
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Time that the calling thread has had of a processor, where the system says.
fn own_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(text.split_whitespace().next()?.parse().ok()?))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Time of the stages that are wanted.
fn time_of(times: &StageTimes, wanted: impl Fn(&str) -> bool) -> Duration {
    times.iter().filter(|(stage, _)| wanted(stage)).map(|(_, time)| time).sum()
}

/// What frames cost, each in milliseconds.
#[derive(Default)]
struct Costs {
    stages: [Vec<f64>; STAGES.len()],
    processor: Vec<f64>,
    device: Vec<f64>,
    own: Vec<f64>,
}

impl Costs {
    /// Renders a frame and adds what it cost.
    fn add(&mut self, list: &DrawList, plan: &PassPlan, engine: &mut GpuEngine) {
        let mut times = StageTimes::default();
        let (start, before) = (Instant::now(), own_time());
        let frame = engine.render(list, plan, &mut times).expect("presets render");
        engine.recycle(frame);
        let wall = start.elapsed();
        let own = own_time().zip(before).map(|(after, before)| after.saturating_sub(before));
        self.own.extend(own.map(milliseconds));
        let device = time_of(&times, |stage| !STAGES.contains(&stage));
        for (costs, stage) in self.stages.iter_mut().zip(STAGES) {
            costs.push(milliseconds(time_of(&times, |s| s == stage)));
        }
        self.device.push(milliseconds(device));
        self.processor.push(milliseconds(wall.saturating_sub(device)));
    }

    fn print(self, name: &str) {
        print!("{name:8} processor {:6.2} |", median(self.processor));
        for (stage, costs) in STAGES.iter().zip(self.stages) {
            print!(" {stage} {:.2}", median(costs));
        }
        let mean = self.own.iter().sum::<f64>() / self.own.len() as f64;
        println!(" | device {:.1} | own {mean:.2}", median(self.device));
    }
}

/// When the device had a frame, from the start of all: begin and end.
type Span = [f64; 2];

/// Renders the frames on a thread until there are none left.
fn serve(frames: &Frames, engine: &mut GpuEngine, next: &AtomicUsize, start: Instant) -> Vec<Span> {
    let mut spans = Vec::new();
    while let Some(list) = frames.lists.get(next.fetch_add(1, Ordering::Relaxed)) {
        let mut times = StageTimes::default();
        let frame = engine.render(list, &frames.plan, &mut times).expect("presets render");
        let end = start.elapsed();
        engine.recycle(frame);
        let copied = end.saturating_sub(time_of(&times, |stage| stage == "copy back"));
        let waited = time_of(&times, |stage| !STAGES.contains(&stage)).min(copied);
        spans.push([copied - waited, copied].map(|t| t.as_secs_f64()));
    }
    spans
}

/// Length of what spans cover together.
fn covered(mut spans: Vec<Span>) -> f64 {
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut end) = (0.0, 0.0f64);
    for [first, last] in spans {
        sum += (last - first.max(end)).max(0.0);
        end = end.max(last);
    }
    sum
}

/// Renders all frames by so many engines at once, and prints how busy they kept the device.
fn overlap(frames: &Frames, engines: &mut [GpuEngine]) {
    let (next, start) = (AtomicUsize::new(0), Instant::now());
    let spans: Vec<Span> = std::thread::scope(|scope| {
        let threads: Vec<_> = engines
            .iter_mut()
            .map(|engine| scope.spawn(|| serve(frames, engine, &next, start)))
            .collect();
        threads.into_iter().flat_map(|t| t.join().expect("no thread panics")).collect()
    });
    let wall = start.elapsed().as_secs_f64();
    let in_flight: f64 = spans.iter().map(|[first, last]| last - first).sum::<f64>() / wall;
    println!(
        "{} at once    {:5.1} frames/s, busy {:5.1} %, in flight {in_flight:.2}",
        engines.len(),
        frames.lists.len() as f64 / wall,
        covered(spans) / wall * 100.0
    );
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let preset = words.first().map_or("peoplesanspeople", String::as_str);
    let count = words.get(1).and_then(|n| n.parse().ok()).unwrap_or(8);
    let adapter = words.get(2).cloned().or_else(|| adapters().into_iter().next().map(|a| a.name));
    let Some(adapter) = adapter else {
        eprintln!("there is no graphics adapter");
        return;
    };
    let Some(frames) = frames(preset, count) else {
        eprintln!("no preset '{preset}'");
        return;
    };
    let options = GpuOptions { adapter: Some(adapter), ..GpuOptions::default() };
    let open = || GpuEngine::new(options.clone()).expect("an adapter that was found opens");
    let mut engines = vec![open()];
    let view = &frames.lists[0].view;
    println!(
        "{preset}, {count} frames of {}x{} on {}, milliseconds a frame",
        view.width,
        view.height,
        engines[0].adapter_name()
    );
    for list in &frames.others {
        engines[0].render(list, &frames.plan, &mut StageTimes::default()).expect("presets render");
    }
    let mut costs = [Costs::default(), Costs::default()];
    for list in &frames.lists {
        for costs in &mut costs {
            costs.add(list, &frames.plan, &mut engines[0]);
        }
    }
    for (name, costs) in ["new", "known"].into_iter().zip(costs) {
        costs.print(name);
    }
    for count in 1..=3 {
        while engines.len() < count {
            let mut engine = open();
            engine
                .render(&frames.lists[0], &frames.plan, &mut StageTimes::default())
                .expect("presets render");
            engines.push(engine);
        }
        overlap(&frames, &mut engines);
    }
}
