//! Which frame of which config is shown, by which seed and how large.

use eframe::egui::{DragValue, Grid, RichText, Ui};

use super::{button, section};
use crate::command::Command;
use crate::session::{Scale, Session};

/// Shows and sets it.
pub fn ui(ui: &mut Ui, session: &mut Session) {
    config(ui, session);
    section(ui, "Frame");
    Grid::new("frame").num_columns(2).spacing([8.0, 5.0]).show(ui, |ui| {
        let label = ui.label("Frame");
        ui.horizontal(|ui| {
            let value = DragValue::new(&mut session.frame).speed(0.1);
            ui.add(value).labelled_by(label.id).on_hover_text(format!(
                "Which frame is shown; drag or type. The config exports frames 0 to {}, but every \
                 frame can be looked at.",
                session.frames().saturating_sub(1)
            ));
            button(ui, session, Command::PreviousFrame, session.frame > 0);
            button(ui, session, Command::NextFrame, true);
        });
        ui.end_row();
        let label = ui.label("Seed");
        ui.add(DragValue::new(&mut session.seed).speed(0.1)).labelled_by(label.id).on_hover_text(
            "Key of all randomness, as export's --seed; drag or type. The file keeps its own.",
        );
        ui.end_row();
        ui.label("Size");
        ui.horizontal(|ui| {
            for scale in Scale::ALL {
                let [w, h] = session.size_at(scale);
                ui.selectable_value(&mut session.scale, scale, scale.text())
                    .on_hover_text(format!("{w} x {h} pixels"));
            }
        });
        ui.end_row();
    });
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
