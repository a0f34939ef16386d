//! How the program ends.

use std::process::ExitCode;

/// The program's exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Everything was done.
    Done,
    /// Some frames failed; everything else is written and valid.
    SomeFailed,
    /// The arguments or the config are wrong, or the disk they name cannot hold what is written.
    BadInput,
    /// Nothing here can render.
    NoEngine,
    /// No window can be opened here.
    NoWindow,
    /// Stopped from outside.
    Interrupted,
}

impl Exit {
    /// The number that the shell sees.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::SomeFailed => 1,
            Self::BadInput => 2,
            Self::NoEngine | Self::NoWindow => 3,
            Self::Interrupted => 130,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}

/// Why a command ended without doing what it was told, for the user to read.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    exit: Exit,
    message: String,
}

impl Failure {
    /// A failure that ends the program with a status.
    pub fn new(exit: Exit, message: impl ToString) -> Self {
        Self { exit, message: message.to_string() }
    }

    /// Wrong arguments, config or output folder.
    pub fn input(message: impl ToString) -> Self {
        Self::new(Exit::BadInput, message)
    }

    /// The status to end with.
    #[must_use]
    pub const fn exit(&self) -> Exit {
        self.exit
    }
}
