//! The picture: what is shown, where, and what the pointer does with it.

pub mod fly;
pub mod overlay;
pub mod paint;
pub mod preview;
mod quad;
pub mod worker;
pub mod zoom;

use std::sync::Arc;

use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Key, PointerButton, Rect, Response, Role, Sense, Ui,
    WidgetInfo, vec2,
};
use glam::DVec3;

use self::fly::Flight;
use self::overlay::Map;
use self::paint::{Screen, WHOLE};
use self::worker::Shown;
use self::zoom::{Pane, Zoom};
use crate::overlay::Overlay;
use crate::session::Session;
use crate::theme;

/// From this zoom on, pixels of the picture are shown as squares.
const SHARP: f32 = 2.0;
/// Radians a point of the pointer's way turns the free camera by.
const TURN: f64 = 0.008;
/// How long the free camera must not move to be at rest, seconds.
const REST_S: f64 = 0.15;
/// Metres a second that the free camera flies at.
const SPEED_M_S: f64 = 2.5;
/// How much faster with Shift.
const FASTER: f64 = 4.0;

/// Shows the picture and lets the pointer move it, or the free camera.
pub fn ui(ui: &mut Ui, session: &mut Session, screen: &mut Screen) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Picture"));
    let Some(shown) = session.shown.clone() else {
        let text = match session.problems().next() {
            Some(_) => "Nothing can be shown; see Problems.",
            None => "Making the first picture \u{2026}",
        };
        let font = FontId::proportional(14.0);
        ui.painter().rect_filled(rect, 0.0, theme::VOID);
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, theme::WEAK);
        return;
    };
    // A smaller picture of a camera on the move takes the same place.
    let [width, height] = session.size_at(session.scale).map(|side| side as f32);
    let pane = Pane { rect, size: vec2(width, height), pixels_per_point: ui.pixels_per_point() };
    let before = session.flight;
    steer(ui, &response, session, &pane);
    note_motion(ui, session, before);
    session.zoom_factor = session.zoom.factor(&pane);
    let map = Map { rect: session.zoom.rect(&pane), size: shown.request.size };
    draw(ui, session, screen, &shown, &map, rect);
    if let Some(at) = response.hover_pos().filter(|_| !response.dragged()) {
        let points = session.overlays.contains(&Overlay::Keypoints);
        if let Some(text) = overlay::under(&map, &shown.annotations, at, points) {
            response.on_hover_text_at_pointer(text);
        }
    }
}

fn draw(
    ui: &Ui,
    session: &Session,
    screen: &mut Screen,
    shown: &Arc<Shown>,
    map: &Map,
    clip: Rect,
) {
    let painter = ui.painter().with_clip_rect(clip);
    let sharp = map.rect.width() * ui.pixels_per_point() >= SHARP * map.size[0] as f32;
    screen.picture(&painter, shown, map.rect, sharp && !session.moving);
    if session.overlays.contains(&Overlay::Instance)
        && let Some(texture) = screen.masks(ui.ctx(), shown)
    {
        painter.image(texture, map.rect, WHOLE, Color32::WHITE);
    }
    if session.overlays.contains(&Overlay::Box2d) {
        overlay::boxes(&painter, map, &shown.annotations);
    }
    if session.overlays.contains(&Overlay::Keypoints) {
        overlay::keypoints(&painter, map, &shown.annotations);
    }
}

/// What pointer and keys do over the picture.
fn steer(ui: &Ui, response: &Response, session: &mut Session, pane: &Pane) {
    if std::mem::take(&mut session.wants_actual_size) {
        session.zoom.set(pane, 1.0);
    }
    let (by, scroll) = ui.input(|i| (i.zoom_delta(), i.smooth_scroll_delta().y));
    let wheel = f64::from(scroll) * 0.005;
    if let Some(at) = response.hover_pos() {
        if by != 1.0 {
            session.zoom.zoom_at(pane, at, by);
        } else if wheel != 0.0 {
            match &mut session.flight {
                Some(flight) => flight.dolly((-wheel).exp()),
                None => session.zoom.zoom_at(pane, at, wheel.exp() as f32),
            }
        }
    }
    if response.double_clicked() {
        session.zoom = Zoom::Fit;
    }
    let by = response.drag_delta();
    let [x, y] = [by.x, by.y].map(f64::from);
    let (command, shift) = ui.input(|i| (i.modifiers.command, i.modifiers.shift));
    let dragged = |button| response.dragged_by(button);
    match &mut session.flight {
        _ if command && response.dragged() => session.zoom.pan(pane, by),
        None if response.dragged() => {
            session.zoom.pan(pane, by);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        Some(flight) if dragged(PointerButton::Middle) || (shift && response.dragged()) => {
            let height = f64::from(session.zoom.rect(pane).height());
            flight.pan(x / height, y / height);
        }
        Some(flight) if dragged(PointerButton::Secondary) => flight.look(-x * TURN, -y * TURN),
        Some(flight) if dragged(PointerButton::Primary) => flight.orbit(-x * TURN, y * TURN),
        _ => {}
    }
    fly(ui, session, shift);
}

/// Notes whether the free camera moves; a moment after it came to rest a picture of full size is
/// due.
fn note_motion(ui: &Ui, session: &mut Session, before: Option<Flight>) {
    let memory = ui.scope_id().with("moved");
    let now = ui.input(|i| i.time);
    if before.is_some() && session.flight != before {
        ui.data_mut(|d| d.insert_temp(memory, now));
        session.moving = true;
    } else if session.moving {
        let rested = now - ui.data(|d| d.get_temp::<f64>(memory)).unwrap_or(now);
        session.moving = rested < REST_S;
    }
    if session.moving {
        ui.ctx().request_repaint_after_secs(REST_S as f32 * 1.1);
    }
}

/// Flies for as long as keys are held.
fn fly(ui: &Ui, session: &mut Session, fast: bool) {
    let Some(flight) = &mut session.flight else { return };
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let step = ui.input(|i| {
        let axis = |plus, minus| f64::from(i.key_down(plus)) - f64::from(i.key_down(minus));
        DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::S, Key::W))
            * f64::from(i.stable_dt.min(0.1))
    });
    if step != DVec3::ZERO {
        flight.fly(step * SPEED_M_S * if fast { FASTER } else { 1.0 });
        ui.ctx().request_repaint();
    }
}
