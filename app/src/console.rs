//! The two streams: data goes to one, all else to the other.

use std::io::{ErrorKind, Write};

use crate::{Exit, Failure};

/// Where the program writes to.
pub struct Console<'a> {
    out: &'a mut dyn Write,
    err: &'a mut dyn Write,
    terminal: bool,
}

impl<'a> Console<'a> {
    /// Data goes to `out`, messages go to `err`; `terminal` says whether somebody watches the latter
    /// on a terminal, who is shown a bar instead of lines.
    pub fn new(out: &'a mut dyn Write, err: &'a mut dyn Write, terminal: bool) -> Self {
        Self { out, err, terminal }
    }

    /// Whether messages go to a terminal.
    #[must_use]
    pub const fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// Writes data.
    ///
    /// # Errors
    /// When it cannot be written, unless the reader has seen enough and closed the pipe.
    pub fn data(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        match self.out.write_all(bytes).and_then(|()| self.out.flush()) {
            Err(e) if e.kind() != ErrorKind::BrokenPipe => {
                Err(Failure::new(Exit::SomeFailed, format!("cannot write to standard output: {e}")))
            }
            _ => Ok(()),
        }
    }

    /// Writes a message and a line feed. If even that fails there is nobody left to tell.
    pub fn note(&mut self, message: &str) {
        drop(writeln!(self.err, "{message}"));
    }
}
