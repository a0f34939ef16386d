//! From where the scene is seen.

use eframe::egui::{Grid, RichText, Ui};
use figurant_core::job::Viewpoint;
use glam::DVec3;

use super::choice;
use crate::command::Command;
use crate::session::Session;
use crate::theme;

/// Shows and sets it.
pub fn ui(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let free = session.flight.is_some();
        choice(ui, session, Command::DataCamera, !free);
        choice(ui, session, Command::FreeCamera, free);
    });
    let seen = session.shown.as_ref().map(|s| Viewpoint::from(&s.scene.camera));
    let Some(view) = session.flight.map(|f| f.viewpoint).or(seen) else { return };
    let ahead = view.rotation * DVec3::NEG_Z;
    let [x, y, z] = view.position_m.to_array();
    let yaw = (-ahead.x).atan2(-ahead.z).to_degrees();
    let pitch = ahead.y.clamp(-1.0, 1.0).asin().to_degrees();
    Grid::new("camera").num_columns(2).spacing([8.0, 2.0]).show(ui, |ui| {
        let mut row = |name: &str, text: String, hint: &str| {
            ui.label(RichText::new(name).color(theme::WEAK));
            ui.label(RichText::new(text).monospace()).on_hover_text(hint);
            ui.end_row();
        };
        row("Position", format!("{x:.2}  {y:.2}  {z:.2} m"), "Where it stands; +Y is up, metres.");
        row("Looks", format!("{yaw:.1}\u{b0}  {pitch:.1}\u{b0}"), "To the left of -Z, and up.");
        let fov = format!("{:.1}\u{b0}", view.fov_vertical_deg);
        row("Field", fov, "Angle between the rays through the top and the bottom edge.");
    });
}
