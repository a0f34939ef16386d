//! The panels: each a function over the session that it shows and changes.

use eframe::egui::{Response, RichText, Separator, Ui};

use crate::command::Command;
use crate::session::Session;
use crate::theme;

pub mod camera;
pub mod engine;
pub mod frame;
pub mod overlays;
pub mod problems;
pub mod stages;
pub mod status;

/// All that is set by hand, one section below the other.
pub fn side(ui: &mut Ui, session: &mut Session) {
    frame::ui(ui, session);
    section(ui, "Camera");
    camera::ui(ui, session);
    section(ui, "Overlays");
    overlays::ui(ui, session);
    section(ui, "Engine");
    engine::ui(ui, session);
}

/// A heading with room above it.
fn section(ui: &mut Ui, text: &str) {
    ui.add_space(1.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new(text).color(theme::ACCENT).small());
        ui.add(Separator::default().horizontal());
    });
}

/// What a command's button tells when the pointer rests on it.
fn hint(ui: &Ui, command: Command) -> String {
    format!("{} ({})", command.tooltip(), ui.ctx().format_shortcut(&command.shortcut()))
}

/// A button that carries out a command.
fn button(ui: &mut Ui, session: &mut Session, command: Command, enabled: bool) -> Response {
    let hint = hint(ui, command);
    let response = ui.add_enabled(enabled, eframe::egui::Button::new(command.text()));
    let response = response.on_hover_text(&hint).on_disabled_hover_text(hint);
    if response.clicked() {
        session.queue.push(command);
    }
    response
}

/// One of several choices, which a command takes.
fn choice(ui: &mut Ui, session: &mut Session, command: Command, chosen: bool) {
    let response = ui.selectable_label(chosen, command.text()).on_hover_text(hint(ui, command));
    if response.clicked() {
        session.queue.push(command);
    }
}
