//! How the window is divided: tiles that the user can drag and resize.

use eframe::egui::{self, Id, ScrollArea, Ui, WidgetText};
use egui_tiles::{
    Behavior, Container, SimplificationOptions, TabState, TileId, Tiles, Tree, UiResponse,
};

use crate::panels;
use crate::session::Session;
use crate::theme;
use crate::viewport::{self, paint::Screen};

/// Width of the column beside the picture when the window opens, points.
const COLUMN: f32 = 292.0;

/// A part of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The picture.
    Viewport,
    /// All that is set by hand.
    Side,
    /// Where the time went.
    Stages,
    /// What is wrong.
    Problems,
}

/// The tiles of a window.
pub struct Layout {
    tree: Tree<Pane>,
    root: TileId,
    picture: TileId,
    column: TileId,
    problems: TileId,
    /// Width of the whole when the tiles were last laid out, points.
    width: f32,
    had_problems: bool,
}

impl Default for Layout {
    fn default() -> Self {
        let mut tiles = Tiles::default();
        let picture = tiles.insert_pane(Pane::Viewport);
        let side = tiles.insert_pane(Pane::Side);
        let stages = tiles.insert_pane(Pane::Stages);
        let problems = tiles.insert_pane(Pane::Problems);
        let settings = tiles.insert_tab_tile(vec![side]);
        let report = tiles.insert_tab_tile(vec![stages, problems]);
        let column = tiles.insert_vertical_tile(vec![settings, report]);
        let root = tiles.insert_horizontal_tile(vec![picture, column]);
        if let Some(egui_tiles::Tile::Container(Container::Linear(linear))) = tiles.get_mut(column)
        {
            linear.shares.set_share(settings, 0.58);
            linear.shares.set_share(report, 0.42);
        }
        let tree = Tree::new(Id::unique("tiles"), root, tiles);
        Self { tree, root, picture, column, problems, width: 0.0, had_problems: false }
    }
}

impl Layout {
    /// Shows all tiles.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session, screen: &mut Screen) {
        self.keep_column(ui.available_width());
        let has_problems = session.problems().next().is_some();
        if has_problems && !self.had_problems {
            let problems = self.problems;
            self.tree.make_active(|id, _| id == problems);
        }
        self.had_problems = has_problems;
        self.tree.ui(&mut Shown { session, screen }, ui);
    }

    /// A window of another width gives the difference to the picture.
    fn keep_column(&mut self, width: f32) {
        if width == self.width || width < 1.0 {
            return;
        }
        let known = self.tree.tiles.rect(self.column).map(|r| r.width());
        let column = known.filter(|_| self.width > 0.0).unwrap_or(COLUMN).min(width * 0.5);
        self.width = width;
        let tile = self.tree.tiles.get_mut(self.root);
        if let Some(egui_tiles::Tile::Container(Container::Linear(linear))) = tile {
            linear.shares.set_share(self.picture, width - column);
            linear.shares.set_share(self.column, column);
        }
    }
}

/// What the tiles show.
struct Shown<'a> {
    session: &'a mut Session,
    screen: &'a mut Screen,
}

impl Behavior<Pane> for Shown<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        match pane {
            Pane::Viewport => viewport::ui(ui, self.session, self.screen),
            Pane::Side => padded(ui, |ui| panels::side(ui, self.session)),
            Pane::Stages => padded(ui, |ui| panels::stages::ui(ui, self.session)),
            Pane::Problems => padded(ui, |ui| panels::problems::ui(ui, self.session)),
        }
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        match pane {
            Pane::Viewport => "Picture".into(),
            Pane::Side => "View".into(),
            Pane::Stages => "Stage times".into(),
            Pane::Problems => match self.session.problems().count() {
                0 => "Problems".into(),
                n => format!("Problems ({n})").into(),
            },
        }
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: false, ..SimplificationOptions::OFF }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        2.0
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        24.0
    }

    fn tab_bar_color(&self, _: &egui::Visuals) -> egui::Color32 {
        theme::BAR
    }

    fn tab_bg_color(
        &self,
        _: &egui::Visuals,
        _: &Tiles<Pane>,
        _: TileId,
        state: &TabState,
    ) -> egui::Color32 {
        if state.active { theme::PANEL } else { theme::BAR }
    }

    fn tab_text_color(
        &self,
        _: &egui::Visuals,
        _: &Tiles<Pane>,
        _: TileId,
        state: &TabState,
    ) -> egui::Color32 {
        if state.active { theme::TEXT } else { theme::WEAK }
    }
}

fn padded(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let frame = egui::Frame::new().inner_margin(egui::Margin::symmetric(10, 8));
    frame.show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        ScrollArea::vertical().auto_shrink(false).show(ui, add);
    });
}
