//! The window's looks: dark, dense and calm.

use eframe::egui::style::{Selection, WidgetVisuals};
use eframe::egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Theme, Visuals,
    vec2,
};

/// Behind the picture.
pub const VOID: Color32 = Color32::from_rgb(17, 18, 21);
/// Behind panels.
pub const PANEL: Color32 = Color32::from_rgb(29, 31, 36);
/// Behind the status line and tabs.
pub const BAR: Color32 = Color32::from_rgb(23, 24, 28);
/// Lines between parts.
pub const LINE: Color32 = Color32::from_rgb(46, 49, 56);
/// Text.
pub const TEXT: Color32 = Color32::from_rgb(212, 215, 220);
/// Text that may be overlooked.
pub const WEAK: Color32 = Color32::from_rgb(139, 144, 153);
/// What is chosen.
pub const ACCENT: Color32 = Color32::from_rgb(232, 165, 76);
/// What is wrong.
pub const WRONG: Color32 = Color32::from_rgb(240, 113, 103);

/// Dresses a window.
pub fn apply(ctx: &Context) {
    ctx.set_theme(Theme::Dark);
    ctx.set_visuals_of(Theme::Dark, visuals());
    ctx.all_styles_mut(|style| {
        let font = |size| FontId::new(size, FontFamily::Proportional);
        style.text_styles = [
            (TextStyle::Small, font(11.0)),
            (TextStyle::Body, font(13.0)),
            (TextStyle::Button, font(13.0)),
            (TextStyle::Heading, font(14.0)),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        style.spacing.item_spacing = vec2(6.0, 5.0);
        style.spacing.button_padding = vec2(7.0, 2.0);
        style.spacing.interact_size.y = 20.0;
        style.spacing.menu_margin = Margin::same(5);
        style.spacing.slider_width = 150.0;
        style.animation_time = 0.05;
    });
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    let widget = |fill, line: Color32, text| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius: CornerRadius::same(3),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    visuals.override_text_color = None;
    visuals.panel_fill = PANEL;
    visuals.window_fill = PANEL;
    visuals.extreme_bg_color = VOID;
    visuals.faint_bg_color = Color32::from_rgb(33, 35, 41);
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.hyperlink_color = ACCENT;
    visuals.warn_fg_color = ACCENT;
    visuals.error_fg_color = WRONG;
    visuals.selection = Selection {
        bg_fill: Color32::from_rgb(92, 68, 36),
        stroke: Stroke::new(1.0, Color32::from_rgb(255, 224, 184)),
    };
    let widgets = &mut visuals.widgets;
    widgets.noninteractive = widget(PANEL, LINE, TEXT);
    widgets.inactive = widget(Color32::from_rgb(43, 46, 53), Color32::from_rgb(54, 58, 66), TEXT);
    widgets.hovered = widget(Color32::from_rgb(53, 57, 65), WEAK, Color32::WHITE);
    widgets.active = widget(Color32::from_rgb(66, 71, 81), ACCENT, Color32::WHITE);
    widgets.open = widget(Color32::from_rgb(43, 46, 53), LINE, TEXT);
    visuals
}
