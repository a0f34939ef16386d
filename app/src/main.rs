//! The program `figurant`.

use std::process::ExitCode;

fn main() -> ExitCode {
    figurant::main(&figurant::studio::Native)
}
