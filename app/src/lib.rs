//! The program `figurant`, as a library that tests can reach.
//!
//! [`run`] is the whole program but for the process around it: arguments in, bytes on two streams
//! and an [`Exit`] out. It imports the core alone; what it needs of it stands in [`road`].

use std::ffi::OsString;

use clap::Parser;
use clap::error::ErrorKind;

mod args;
#[cfg(feature = "gui")]
pub mod command;
mod commands;
mod console;
mod exit;
#[cfg(feature = "gui")]
mod launch;
#[cfg(feature = "gui")]
mod layout;
pub mod overlay;
#[cfg(feature = "gui")]
mod panels;
#[cfg(feature = "gpu")]
mod parity;
mod player;
mod process;
mod report;
pub mod road;
#[cfg(feature = "gui")]
pub mod session;
#[cfg(feature = "gui")]
pub mod shell;
pub mod studio;
#[cfg(feature = "gui")]
mod theme;
#[cfg(feature = "gui")]
pub mod viewport;

use commands::import;
pub use console::Console;
pub use exit::{Exit, Failure};
pub use process::{Stop, main};
use road::Road;

/// Runs the program. `args` begin with the program's name; when `stop` is asked from outside,
/// the frames in hand are finished, the index is written and the program ends.
pub fn run<R: Road>(
    road: &R,
    args: impl IntoIterator<Item = OsString>,
    console: &mut Console<'_>,
    stop: &Stop,
) -> Exit {
    let (words, players) = player::split(args.into_iter().collect());
    let parsed = match args::Args::try_parse_from(words) {
        Ok(parsed) => parsed,
        Err(e) => return not_parsed(&e, console),
    };
    let ended = match parsed.command {
        None => commands::window::run(road, parsed.config.as_deref()),
        Some(args::Command::Export(args)) => {
            import::show_notes(&players, args.progress, console);
            commands::export::run(road, &args, console, stop)
        }
        Some(args::Command::Frame(args)) => commands::frame::run(road, &args, console),
        Some(args::Command::Import(args)) => import::run(road, &args, console),
        Some(args::Command::Gallery(args)) => commands::gallery::run(road, &args, console),
        Some(args::Command::People(args)) => commands::people::run(road, &args, console),
        Some(args::Command::Validate(args)) => commands::validate::run(road, &args, console),
        Some(args::Command::Schema) => commands::schema::run(road, console),
        Some(args::Command::Doctor(args)) => commands::doctor::run(road, &args, console),
        Some(args::Command::Bench(bench)) => commands::bench::run(road, &bench, console),
    };
    ended.unwrap_or_else(|failure| {
        console.note(&format!("error: {failure}"));
        failure.exit()
    })
}

/// Help that was asked for is data, everything else is an error.
fn not_parsed(error: &clap::Error, console: &mut Console<'_>) -> Exit {
    let text = error.render().to_string();
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => match console.data(text.as_bytes()) {
            Ok(()) => Exit::Done,
            Err(failure) => failure.exit(),
        },
        _ => {
            console.note(text.trim_end());
            Exit::BadInput
        }
    }
}
