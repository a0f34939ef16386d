//! The line at the bottom: what is seen, in numbers.

use eframe::egui::{Align, Layout, RichText, Ui};

use crate::session::Session;
use crate::theme;
use crate::viewport::worker::{Renderer, Shown};

/// Shows it.
pub fn ui(ui: &mut Ui, session: &Session) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 14.0;
        if let Some(shown) = &session.shown {
            for (text, hint) in items(shown, session) {
                ui.label(RichText::new(text).small().color(theme::TEXT)).on_hover_text(hint);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let problems = session.problems().count();
            if problems > 0 {
                let noun = if problems == 1 { "problem" } else { "problems" };
                let text = RichText::new(format!("{problems} {noun}")).small();
                ui.label(text.color(theme::WRONG)).on_hover_text("See the panel Problems.");
            } else {
                let text = if session.busy { "rendering \u{2026}" } else { "ready" };
                ui.label(RichText::new(text).small().color(theme::WEAK));
            }
        });
    });
}

fn items(shown: &Shown, session: &Session) -> [(String, String); 6] {
    let people = shown.annotations.people.iter().filter(|p| p.is_visible()).count();
    let [width, height] = shown.request.size;
    let ms = shown.wall.as_secs_f64() * 1e3;
    let engine = match (shown.request.renderer, &session.graphics) {
        (Renderer::Graphics, Some(graphics)) => format!("graphics engine, {}", graphics.adapter),
        _ => "native engine".to_owned(),
    };
    let camera = if shown.request.viewpoint.is_some() { ", free camera" } else { "" };
    [
        (format!("frame {}{camera}", shown.request.frame), "The frame in view.".to_owned()),
        (format!("seed {}", shown.request.seed), "Key of all its randomness.".to_owned()),
        (engine, "What rendered it.".to_owned()),
        (format!("{width} x {height}"), "Its size in pixels.".to_owned()),
        (format!("{people} people"), "How many have a pixel of their own.".to_owned()),
        (format!("{ms:.0} ms"), "From its turn to the finished picture.".to_owned()),
    ]
}
