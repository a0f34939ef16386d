//! `figurant export`: a data set, of a config or of a scenario of Unity Perception.

use std::num::NonZeroUsize;

use figurant_core::export::{Dataset, Existing};
use figurant_core::job::batch::{self, BatchError, Order};

use crate::args::ExportArgs;
use crate::commands::import::show_notes;
use crate::commands::{not_loaded, processors};
use crate::report::Reporter;
use crate::road::{Job, Road, Wishes};
use crate::{Console, Exit, Failure, Stop};

/// Writes it.
pub fn run<R: Road>(
    road: &R,
    args: &ExportArgs,
    console: &mut Console<'_>,
    stop: &Stop,
) -> Result<Exit, Failure> {
    let wishes = Wishes::from(&args.changes).only(args.only.iter().copied());
    let job = job(road, args, &wishes, console)?;
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

/// What is to be exported, from whichever file was named.
fn job<R: Road>(
    road: &R,
    args: &ExportArgs,
    wishes: &Wishes,
    console: &mut Console<'_>,
) -> Result<Job<R::Document>, Failure> {
    match (&args.config, &args.scenario_config_file) {
        (Some(config), _) => road.load(config, wishes).map_err(|e| not_loaded(config, e)),
        (None, Some(scenario)) => {
            let import = road.import(scenario).map_err(|e| not_loaded(scenario, e))?;
            show_notes(&import.notes, args.progress, console);
            road.ready(import.document, wishes).map_err(|e| not_loaded(scenario, e))
        }
        (None, None) => Err(Failure::input("name a config, or give --scenario-config-file PATH")),
    }
}
