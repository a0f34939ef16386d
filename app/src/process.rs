//! The process around the program: streams, Ctrl-C and the exit status.

use std::io::IsTerminal;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::road::Road;
use crate::{Console, Exit};

/// A wish from outside to stop.
#[derive(Debug, Default)]
pub struct Stop {
    asked: AtomicBool,
    heeded: AtomicBool,
}

impl Stop {
    /// Nobody has asked yet, and nobody would listen.
    #[must_use]
    pub const fn new() -> Self {
        Self { asked: AtomicBool::new(false), heeded: AtomicBool::new(false) }
    }

    /// From now on the program looks at the flag and ends in good order when it is set.
    pub fn heed(&self) -> &AtomicBool {
        self.heeded.store(true, Ordering::Relaxed);
        &self.asked
    }

    /// Asks the program to stop; whether it will do so by itself.
    pub fn ask(&self) -> bool {
        let again = self.asked.swap(true, Ordering::Relaxed);
        self.heeded.load(Ordering::Relaxed) && !again
    }
}

static STOP: Stop = Stop::new();

/// The whole program with the arguments and streams of this process. Ctrl-C, and being asked to
/// terminate, end an export after the frames in hand; a second time, or during any other command,
/// they end the process at once.
pub fn main<R: Road>(road: &R) -> ExitCode {
    let handler = || {
        if STOP.ask() {
            eprintln!("stopping after the frames in hand; once more stops at once");
        } else {
            std::process::exit(i32::from(Exit::Interrupted.code()));
        }
    };
    let (mut out, mut err) = (std::io::stdout(), std::io::stderr());
    let terminal = err.is_terminal();
    let mut console = Console::new(&mut out, &mut err, terminal);
    if let Err(e) = ctrlc::set_handler(handler) {
        console.note(&format!("warning: Ctrl-C will end the program at once: {e}"));
    }
    crate::run(road, std::env::args_os(), &mut console, &STOP).into()
}
