//! What renders.

use eframe::egui::{Label, RichText, Ui};

use crate::session::{Session, threads};
use crate::theme;
use crate::viewport::worker::Renderer;

const NATIVE: &str = "Renders on the processor: the same bytes on every machine, as exported.";

/// Shows and sets it.
pub fn ui(ui: &mut Ui, session: &mut Session) {
    let graphics = session.graphics.clone();
    ui.horizontal(|ui| {
        ui.selectable_value(&mut session.renderer, Renderer::Native, "Native")
            .on_hover_text(format!("{NATIVE} (G switches)"));
        let hint = match &graphics {
            Some(g) if g.hardware => format!("Renders on {} (G switches).", g.adapter),
            Some(g) => {
                format!("Renders on {}, which is software and slower (G switches).", g.adapter)
            }
            None => "The window has no device with compute shaders.".to_owned(),
        };
        ui.add_enabled_ui(graphics.is_some(), |ui| {
            ui.selectable_value(&mut session.renderer, Renderer::Graphics, "Graphics")
                .on_hover_text(&hint)
                .on_disabled_hover_text(&hint);
        });
        let adapter = match (session.renderer, &graphics) {
            (Renderer::Graphics, Some(graphics)) => graphics.adapter.clone(),
            _ => match threads(graphics.as_ref()).get() {
                1 => "1 thread".to_owned(),
                count => format!("{count} threads"),
            },
        };
        let text = RichText::new(&adapter).color(theme::WEAK).small();
        ui.add(Label::new(text).truncate()).on_hover_text(adapter);
    });
}
