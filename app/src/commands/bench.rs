//! `figurant bench`: what this machine's engines do, measured.

use figurant_core::job::parity::{COLOR_MEAN, COLOR_MOST, DEPTH, Difference, IDS};

use crate::args::{Bench, ParityArgs};
use crate::commands::not_loaded;
use crate::road::{LoadError, ParityWish, Road};
use crate::{Console, Exit, Failure};

/// Runs one of the benches.
pub fn run<R: Road>(road: &R, bench: &Bench, console: &mut Console<'_>) -> Result<Exit, Failure> {
    match bench {
        Bench::Parity(args) => parity(road, args, console),
    }
}

/// A line for each config, then one for all; fails where the engines are further apart than promised.
fn parity<R: Road>(
    road: &R,
    args: &ParityArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let config = args.config.as_deref();
    let adapter = args.adapter.clone();
    let wish = ParityWish { config, frames: args.frames, size: args.size, adapter };
    let mut all = Difference::default();
    let mut written = console.data(HEAD.as_bytes());
    let adapter = road
        .parity(&wish, &mut |name, found| {
            all.add(found);
            if written.is_ok() {
                written = console.data(line(name, found).as_bytes());
            }
        })
        .map_err(|e| match (e, config) {
            (LoadError::Invalid(problems), Some(path)) => {
                not_loaded(path, LoadError::Invalid(problems))
            }
            (LoadError::NoEngine(text), _) => Failure::new(Exit::NoEngine, text),
            (e, _) => Failure::input(e.to_string()),
        })?;
    written?;
    let [width, height] = args.size;
    let verdict = if all.is_parity() { "the same" } else { "NOT the same" };
    let text = format!(
        "{}{adapter} shows {verdict} as the native engine at {width}x{height}: at most {IDS:e} of the \
         pixels may show another object; away from edges colours may differ by {COLOR_MOST} steps of \
         255, by {COLOR_MEAN} on average, and distances by {DEPTH:e}\n",
        line("all", &all)
    );
    console.data(text.as_bytes())?;
    Ok(if all.is_parity() { Exit::Done } else { Exit::SomeFailed })
}

const HEAD: &str =
    "config                  pixels  ids  colour mean  most  distance  people  labels\n";

fn line(name: &str, found: &Difference) -> String {
    let Difference { pixels, ids, color_mean, color_most, depth, people, labels, .. } = found;
    format!(
        "{name:<20} {pixels:>9} {ids:>4} {color_mean:>12.4} {color_most:>5} {depth:>9.1e} {people:>7} \
         {labels:>7}\n"
    )
}
