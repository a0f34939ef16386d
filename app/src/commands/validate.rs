//! `figurant validate`: every problem of a config.

use crate::args::ValidateArgs;
use crate::commands::not_loaded;
use crate::road::{Road, Wishes};
use crate::{Console, Exit, Failure};

/// Loads the config as an export would and reports what is wrong with it.
pub fn run<R: Road>(
    road: &R,
    args: &ValidateArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let job =
        road.load(&args.config, &Wishes::default()).map_err(|e| not_loaded(&args.config, e))?;
    let info = &job.info;
    console.note(&format!(
        "{}: no problems; {} frames of {} x {} pixels",
        args.config.display(),
        job.frames,
        info.width,
        info.height
    ));
    Ok(Exit::Done)
}
