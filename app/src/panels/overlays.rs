//! Which labels are drawn over the picture.

use eframe::egui::Ui;

use super::hint;
use crate::command::Command;
use crate::overlay::Overlay;
use crate::session::Session;

/// Shows and sets them.
pub fn ui(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        for (overlay, command) in [
            (Overlay::Box2d, Command::Boxes),
            (Overlay::Keypoints, Command::Keypoints),
            (Overlay::Instance, Command::Masks),
        ] {
            let mut on = session.overlays.contains(&overlay);
            let hint = hint(ui, command);
            if ui.checkbox(&mut on, command.text()).on_hover_text(hint).changed() {
                session.queue.push(command);
            }
        }
    });
}
