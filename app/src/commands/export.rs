//! `figurant export`: a data set.

use std::num::NonZeroUsize;

use figurant_core::export::{Dataset, Existing};
use figurant_core::job::batch::{self, BatchError, Order};

use crate::args::ExportArgs;
use crate::commands::{not_loaded, processors};
use crate::report::Reporter;
use crate::road::{Road, Wishes};
use crate::{Console, Exit, Failure, Stop};

/// Writes it.
pub fn run<R: Road>(
    road: &R,
    args: &ExportArgs,
    console: &mut Console<'_>,
    stop: &Stop,
) -> Result<Exit, Failure> {
    let wishes = Wishes::from(&args.changes).only(args.only.iter().copied());
    let job = road.load(&args.config, &wishes).map_err(|e| not_loaded(&args.config, e))?;
    let frames = args.frames.clone().unwrap_or(0..job.frames);
    let existing = if args.overwrite { Existing::Overwrite } else { Existing::Refuse };
    let dataset = Dataset::create(&args.out, job.info.clone(), existing).map_err(Failure::input)?;
    let workers = args.workers.unwrap_or_else(processors);
    // Frames are the coarsest work to share; threads within a frame are for spare processors.
    let threads = NonZeroUsize::new(processors().get() / workers).unwrap_or(NonZeroUsize::MIN);
    let order = Order { dataset: &dataset, frames, workers, stop: stop.heed() };
    let mut reporter = Reporter::new(args.progress, order.frames.len() as u64, console);
    let summary = batch::run(&order, || road.maker(&job, threads), &mut |p| reporter.update(p));
    let summary = match summary {
        Ok(summary) => summary,
        Err(error) => {
            reporter.clear();
            let exit = match &error {
                BatchError::Maker(_) => Exit::NoEngine,
                BatchError::Storage { .. } => Exit::BadInput,
            };
            return Err(Failure::new(exit, error));
        }
    };
    reporter.close(&summary, &args.out);
    Ok(if summary.report.interrupted {
        Exit::Interrupted
    } else if summary.report.failed.is_empty() {
        Exit::Done
    } else {
        Exit::SomeFailed
    })
}
