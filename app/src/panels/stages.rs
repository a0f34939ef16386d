//! Where the time of the last frame went, and what was not computed.

use eframe::egui::{Align, Grid, Layout, RichText, Sense, TextStyle, Ui, vec2};
use figurant_core::plan::{Pass, Skipped};

use crate::session::Session;
use crate::theme;

/// Shows it.
pub fn ui(ui: &mut Ui, session: &Session) {
    let Some(shown) = &session.shown else {
        ui.label(RichText::new("No frame yet.").color(theme::WEAK));
        return;
    };
    let stages: Vec<(&str, f32)> =
        shown.times.iter().map(|(name, time)| (name, time.as_secs_f32() * 1e3)).collect();
    ui.style_mut().override_text_style = Some(TextStyle::Small);
    ui.spacing_mut().interact_size.y = 14.0;
    let longest = stages.iter().map(|(_, ms)| *ms).fold(0.0, f32::max);
    Grid::new("stages").num_columns(3).spacing([10.0, 0.0]).show(ui, |ui| {
        for (name, ms) in stages {
            ui.label(name);
            number(ui, format!("{ms:.2}"));
            bar(ui, ms / longest.max(1e-6));
            ui.end_row();
        }
        ui.label(RichText::new("all stages").strong())
            .on_hover_text("Summed over threads, so that it may exceed the time of the frame.");
        number(ui, format!("{:.1}", shown.times.total().as_secs_f32() * 1e3));
        ui.label(RichText::new("ms").color(theme::WEAK));
        ui.end_row();
        for (pass, why) in shown.plan.skipped() {
            ui.label(RichText::new(name(*pass)).color(theme::WEAK));
            ui.label(RichText::new("-").color(theme::WEAK));
            ui.label(RichText::new(reason(*why)).color(theme::WEAK).small());
            ui.end_row();
        }
    });
}

fn number(ui: &mut Ui, text: String) {
    ui.allocate_ui_with_layout(vec2(48.0, 14.0), Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(text).monospace());
    });
}

/// A share of the longest stage as a bar.
fn bar(ui: &mut Ui, share: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(90.0, 8.0), Sense::hover());
    let mut filled = rect;
    filled.set_width((rect.width() * share).max(1.0));
    ui.painter().rect_filled(filled, 2.0, theme::ACCENT.gamma_multiply(0.7));
}

/// A pass that did not run.
const fn name(pass: Pass) -> &'static str {
    match pass {
        Pass::Points => "keypoints",
        Pass::Skin => "skin",
        Pass::Visibility => "visibility",
        Pass::Shadow => "shadow",
        Pass::Shade => "shade",
        Pass::Defocus => "depth of field",
        Pass::MotionBlur => "motion blur",
        Pass::Bloom => "bloom",
        Pass::Display => "display",
        Pass::Resolve => "resolve",
        Pass::Reduce => "reduce",
    }
}

const fn reason(why: Skipped) -> &'static str {
    match why {
        Skipped::NotWanted => "skipped: nothing shown needs it",
        Skipped::NoSunShadow => "skipped: no sun casts a shadow",
        Skipped::InFocus => "skipped: all is in focus",
        Skipped::Still => "skipped: nothing moves",
        Skipped::NoBloom => "skipped: no light scatters",
    }
}
