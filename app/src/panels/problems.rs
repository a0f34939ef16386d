//! What is wrong, with its place and what to do.

use eframe::egui::{RichText, Ui};

use crate::session::Session;
use crate::theme;

/// Shows it.
pub fn ui(ui: &mut Ui, session: &Session) {
    if session.problems().next().is_none() {
        ui.label(RichText::new("No problems.").color(theme::WEAK));
        return;
    }
    if !session.config_problems.is_empty() {
        let kept = if session.config.is_some() {
            "The config as it was before is still shown. Correct the file and reload it."
        } else {
            "Correct the file and reload it."
        };
        ui.label(RichText::new(kept).color(theme::WEAK));
    }
    for problem in session.problems() {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            ui.label(RichText::new(&problem.place).monospace().color(theme::WRONG));
            ui.label(&problem.text);
        });
    }
}
