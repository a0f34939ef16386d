//! Which frame of which config is shown, by which seed and how large.

use eframe::egui::{DragValue, Grid, RichText, Slider, Ui, WidgetInfo};

use super::{button, choice, section};
use crate::command::Command;
use crate::session::{Scale, Session};
use crate::theme;
use crate::viewport::zoom::Zoom;

/// Shows and sets it.
pub fn ui(ui: &mut Ui, session: &mut Session) {
    config(ui, session);
    section(ui, "Frame");
    scrubber(ui, session);
    Grid::new("frame").num_columns(2).spacing([8.0, 4.0]).show(ui, |ui| {
        which(ui, session);
        how_large(ui, session);
    });
}

/// All frames that the config exports, to slide through.
fn scrubber(ui: &mut Ui, session: &mut Session) {
    let last = session.frames().saturating_sub(1);
    if last == 0 {
        return;
    }
    ui.spacing_mut().slider_width = ui.available_width() - 4.0;
    let mut frame = session.frame.min(last);
    let slider = ui.add(Slider::new(&mut frame, 0..=last).show_value(false));
    slider.widget_info(|| WidgetInfo::slider(true, f64::from(frame), "Frames of the config"));
    let hint = format!("Frames 0 to {last}, which the config exports.");
    if slider.on_hover_text(hint).changed() {
        session.frame = frame;
    }
}

fn which(ui: &mut Ui, session: &mut Session) {
    let label = ui.label("Frame");
    ui.horizontal(|ui| {
        let value = DragValue::new(&mut session.frame).speed(0.1);
        ui.add(value).labelled_by(label.id).on_hover_text(
            "Which frame is shown; drag or type. Frames that the config does not export can be \
             looked at, too.",
        );
        button(ui, session, Command::PreviousFrame, session.frame > 0);
        button(ui, session, Command::NextFrame, true);
    });
    ui.end_row();
    let label = ui.label("Seed");
    ui.add(DragValue::new(&mut session.seed).speed(0.1)).labelled_by(label.id).on_hover_text(
        "Key of all randomness, as export's --seed; drag or type. The file keeps its own.",
    );
    ui.end_row();
}

fn how_large(ui: &mut Ui, session: &mut Session) {
    ui.label("Size");
    ui.horizontal(|ui| {
        for scale in Scale::ALL {
            let [w, h] = session.size_at(scale);
            let hint = format!("Renders {w} x {h} pixels.");
            ui.selectable_value(&mut session.scale, scale, scale.text()).on_hover_text(hint);
        }
    });
    ui.end_row();
    ui.label("Zoom");
    ui.horizontal(|ui| {
        choice(ui, session, Command::Fit, session.zoom == Zoom::Fit);
        let actual = session.zoom != Zoom::Fit && session.zoom_factor == 1.0;
        choice(ui, session, Command::ActualSize, actual);
        let factor = format!("{:.0} %", session.zoom_factor * 100.0);
        ui.label(RichText::new(factor).color(theme::WEAK)).on_hover_text(
            "Pixels of the screen to one of the picture. The wheel zooms, with Ctrl under the free \
             camera; a double click fits.",
        );
    });
    ui.end_row();
}

fn config(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let name = RichText::new(session.name()).strong();
        let path = session.path.as_ref().map_or_else(
            || {
                "The preset that the program starts with; figurant FILE.json opens a config."
                    .to_owned()
            },
            |path| path.display().to_string(),
        );
        ui.label(name).on_hover_text(path);
        button(ui, session, Command::Reload, true);
    });
}
