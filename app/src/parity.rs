//! Both engines over the same frames, on the machine at hand.

use std::ops::Range;

use figurant_core::document::{Document, file, presets};
use figurant_core::engine::gpu;
use figurant_core::job::Studio;
use figurant_core::job::parity::{Difference, compare};

use crate::commands::processors;
use crate::road::{EngineKind, EngineWish, Job, LoadError, ParityWish, Road, Wishes};

/// The preset that is compared over many frames, and the frame that is taken of the others.
const MAIN: (&str, u32) = ("peoplesanspeople", 3);

/// The road to the core's own studio.
pub trait CoreRoad: Road<Document: Clone, Config = Document, Maker = Studio> {}

impl<R: Road<Document: Clone, Config = Document, Maker = Studio>> CoreRoad for R {}

/// Compares the engines; see [`Road::parity`].
pub fn parity<R: CoreRoad>(
    road: &R,
    wish: &ParityWish<'_>,
    tell: &mut dyn FnMut(&str, &Difference),
) -> Result<String, LoadError> {
    let adapter = adapter(wish.adapter.as_deref())?;
    let wishes = Wishes { size: Some(wish.size), ..Wishes::default() };
    if let Some(config) = wish.config {
        let job = road.load(config, &wishes)?;
        let found = differ(road, &job, &adapter, 0..wish.frames)
            .map_err(|e| LoadError::Unreadable(format!("{}: {e}", config.display())))?;
        tell(&config.display().to_string(), &found);
        return Ok(adapter);
    }
    for preset in presets::ALL {
        let (main, frame) = MAIN;
        let frames = if preset.name == main { 0..wish.frames } else { frame..frame + 1 };
        let failed = |e: String| LoadError::Unreadable(format!("{}: {e}", preset.name));
        let document = file::parse(preset.text).map_err(|e| failed(e.to_string()))?;
        let job = road.ready(document, &wishes)?;
        tell(preset.name, &differ(road, &job, &adapter, frames).map_err(failed)?);
    }
    Ok(adapter)
}

/// The adapter of a name, or the best there is: software will do.
fn adapter(name: Option<&str>) -> Result<String, LoadError> {
    let any = || gpu::adapters().first().map(|a| a.name.clone());
    let hardware = || gpu::choice(&gpu::GpuOptions::default()).ok().map(|a| a.name);
    let adapter = name.map(str::to_owned).or_else(hardware).or_else(any);
    let options = gpu::GpuOptions { adapter, ..gpu::GpuOptions::default() };
    gpu::choice(&options).map(|a| a.name).map_err(|e| LoadError::NoEngine(e.to_string()))
}

fn differ<R: CoreRoad>(
    road: &R,
    job: &Job<R::Document>,
    adapter: &str,
    frames: Range<u32>,
) -> Result<Difference, String> {
    let by = |kind: EngineKind| {
        let engine = EngineWish { kind, adapter: Some(adapter.to_owned()) };
        road.maker(&Job { engine, ..job.clone() }, processors()).map_err(|e| e.to_string())
    };
    let (mut native, mut graphics) = (by(EngineKind::Cpu)?, by(EngineKind::Gpu)?);
    compare(&mut native, &mut graphics, frames).map_err(|e| e.to_string())
}
