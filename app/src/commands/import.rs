//! `figurant import`: a scenario of Unity Perception as a config.

use figurant_core::export::atomic;
use serde_json::json;

use crate::args::ImportArgs;
use crate::commands::not_loaded;
use crate::report::Style;
use crate::road::Road;
use crate::{Console, Exit, Failure};

/// Writes the config, and says what of the scenario is not in it.
pub fn run<R: Road>(
    road: &R,
    args: &ImportArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let import = road.import(&args.scenario).map_err(|e| not_loaded(&args.scenario, e))?;
    let text = road.text(&import.document);
    show_notes(&import.notes, Style::Auto, console);
    let Some(out) = &args.out else {
        console.data(text.as_bytes())?;
        return Ok(Exit::Done);
    };
    if out.exists() && !args.overwrite {
        return Err(Failure::input(format!(
            "--out {}: is there already; give --overwrite to replace it",
            out.display()
        )));
    }
    atomic::write(out, text.as_bytes()).map_err(Failure::input)?;
    console.note(&format!("{} -> {}", args.scenario.display(), out.display()));
    Ok(Exit::Done)
}

/// Shows what was left out or changed, one thing a line.
pub fn show_notes(notes: &[String], style: Style, console: &mut Console<'_>) {
    for note in notes {
        match style {
            Style::Auto | Style::Bar => console.note(&format!("note: {note}")),
            Style::Json => console.note(&json!({"event": "note", "text": note}).to_string()),
            Style::None => {}
        }
    }
}
