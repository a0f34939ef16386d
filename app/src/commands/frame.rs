//! `figurant frame`: one frame as a picture, with labels drawn on it if asked.

use std::collections::BTreeSet;

use figurant_core::export::{atomic, picture};
use figurant_core::job::FrameMaker;
use figurant_core::plan::Output;

use crate::args::FrameArgs;
use crate::commands::{not_loaded, processors};
use crate::overlay;
use crate::road::{Road, Wishes};
use crate::{Console, Exit, Failure};

/// Renders the frame and writes the file.
pub fn run<R: Road>(
    road: &R,
    args: &FrameArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let out = &args.out;
    if !out.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Err(Failure::input(format!(
            "--out {}: expected a file name that ends in .png",
            out.display()
        )));
    }
    let overlays: BTreeSet<_> = args.overlay.iter().copied().collect();
    let wanted = overlays.iter().map(|o| o.needs()).chain([Output::Rgb]);
    let job = road
        .load(&args.config, &Wishes::from(&args.changes).only(wanted))
        .map_err(|e| not_loaded(&args.config, e))?;
    let mut maker = road.maker(&job, processors()).map_err(|e| Failure::new(Exit::NoEngine, e))?;
    let failed = |reason: &dyn std::fmt::Display| {
        Failure::new(Exit::SomeFailed, format!("frame {}: {reason}", args.frame))
    };
    let made = maker.make(args.frame).map_err(|e| failed(&e))?;
    let labels = &made.annotations;
    let mut pixels = made.picture.ok_or_else(|| failed(&"no picture was made"))?;
    overlay::draw(&mut pixels, labels, &overlays).map_err(|e| failed(&e))?;
    let bytes = picture::png_rgb(&pixels, labels.width, labels.height).map_err(|e| failed(&e))?;
    atomic::write(out, &bytes).map_err(Failure::input)?;
    console.note(&format!(
        "frame {} in {:.0} ms -> {}",
        args.frame,
        made.times.total().as_secs_f64() * 1e3,
        out.display()
    ));
    Ok(Exit::Done)
}
