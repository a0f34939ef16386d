//! `figurant schema`: the JSON Schema of the config.

use crate::road::Road;
use crate::{Console, Exit, Failure};

/// Prints it.
pub fn run<R: Road>(road: &R, console: &mut Console<'_>) -> Result<Exit, Failure> {
    // The alternate form of a JSON value is the indented one.
    console.data(format!("{:#}\n", road.schema()).as_bytes())?;
    Ok(Exit::Done)
}
