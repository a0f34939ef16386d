//! What the seed's pictures look like as a whole: brightness, its spread, clipping, saturation.
//!
//! The published figures are those of the seed's 36 sample pictures: mean luma 0.505 with a
//! standard deviation of 0.177 between pictures, 1.1 % of the pixels clipped and 1.8 % nearly
//! black, mean saturation (HSV) 0.37.

use std::num::NonZeroUsize;
use std::sync::Arc;

use figurant_core::document::{file, presets};
use figurant_core::engine::cpu::{CpuEngine, CpuOptions};
use figurant_core::job::{FrameMaker, Studio};
use figurant_core::library::Library;
use figurant_core::plan::Output;

const FRAMES: u32 = 400;
/// Standard deviation between the published pictures.
const SPREAD: f64 = 0.177;

/// Of one picture, 0..1.
struct Look {
    luma: f64,
    saturation: f64,
    clipped: f64,
    black: f64,
}

fn look(rgb: &[u8]) -> Look {
    let pixels = rgb.as_chunks::<3>().0;
    let mean = |of: &dyn Fn([f64; 3]) -> f64| {
        let sum: f64 = pixels.iter().map(|p| of(p.map(|v| f64::from(v) / 255.0))).sum();
        sum / pixels.len() as f64
    };
    let largest = |[r, g, b]: [f64; 3]| r.max(g).max(b);
    let smallest = |[r, g, b]: [f64; 3]| r.min(g).min(b);
    Look {
        luma: mean(&|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b),
        saturation: mean(&|p| (largest(p) - smallest(p)) / largest(p).max(1e-6)),
        clipped: mean(&|p| f64::from(u8::from(smallest(p) > 0.995))),
        black: mean(&|p| f64::from(u8::from(largest(p) < 0.02))),
    }
}

#[test]
fn the_seeds_preset_looks_like_the_seeds_pictures() {
    let preset = presets::find("peoplesanspeople").unwrap();
    let mut document = file::parse(preset.text).unwrap();
    (document.image.width, document.image.height) = (128, 128);
    document.labels.samples = 1;
    document.output.outputs = [Output::Rgb].into();
    let library = Arc::new(Library::new(&[], document.quality.max_texture_size).unwrap());
    let engine = Box::new(CpuEngine::new(CpuOptions::default()));
    let threads = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let mut studio =
        Studio::new(Arc::new(document), library, Arc::default(), engine, threads).unwrap();
    let looks: Vec<Look> =
        (0..FRAMES).map(|frame| look(&studio.make(frame).unwrap().picture.unwrap())).collect();
    let mean = |of: fn(&Look) -> f64| looks.iter().map(of).sum::<f64>() / f64::from(FRAMES);
    let luma = mean(|l| l.luma);
    let square = mean(|l| l.luma * l.luma);
    let spread = (square - luma * luma).sqrt();
    let [saturation, clipped, black] =
        [mean(|l| l.saturation), mean(|l| l.clipped), mean(|l| l.black)];
    let found = format!(
        "luma {luma:.3}, spread {spread:.3}, saturation {saturation:.3}, clipped {clipped:.4}, black {black:.4}"
    );
    // The mean of 36 pictures is known to a sixth of their spread; three of these.
    assert!((luma - 0.505).abs() < 0.5 * SPREAD, "{found}");
    assert!((saturation - 0.37).abs() < 0.5 * SPREAD, "{found}");
    // Every sampled range is drawn in full here, while 36 published pictures were picked.
    assert!((0.75 * SPREAD..1.6 * SPREAD).contains(&spread), "{found}");
    assert!(clipped < 0.022 && black < 0.036, "{found}");
}
