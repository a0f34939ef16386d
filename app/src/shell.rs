//! The window: `logic` takes what the preview has to say, `ui` shows the panels.

use std::path::PathBuf;

use eframe::egui::{self, Context, Ui};
use eframe::egui_wgpu::RenderState;
use figurant_core::engine::gpu::GpuContext;

use crate::command::Command;
use crate::layout::Layout;
use crate::panels;
use crate::session::{Graphics, Session, threads};
use crate::studio::shader_folder;
use crate::theme;
use crate::viewport::paint::Screen;
use crate::viewport::preview::Preview;

/// All that a window holds.
pub struct Shell {
    /// What is open and how it is looked at.
    pub session: Session,
    preview: Preview,
    screen: Screen,
    layout: Layout,
}

impl Shell {
    /// Opens a config, or the one that the program starts with, in a window that draws by a
    /// device; without one only the native engine renders.
    ///
    /// # Errors
    /// When the system gives no thread for the preview.
    pub fn new(
        ctx: &Context,
        render: Option<RenderState>,
        path: Option<PathBuf>,
    ) -> std::io::Result<Self> {
        theme::apply(ctx);
        let context = render
            .as_ref()
            .and_then(|r| GpuContext::new(&r.adapter, r.device.clone(), r.queue.clone()).ok())
            .map(|context| GpuContext { shaders: shader_folder(), ..context });
        let graphics =
            context.as_ref().map(|c| Graphics { adapter: c.name.clone(), hardware: c.hardware });
        let threads = threads(graphics.as_ref());
        let waker = ctx.clone();
        let mut preview =
            Preview::start(context, threads, Box::new(move || waker.request_repaint()))?;
        preview.open(path.clone());
        Ok(Self {
            session: Session::new(path, graphics),
            preview,
            screen: Screen::new(render),
            layout: Layout::default(),
        })
    }

    /// Takes what the preview made.
    pub fn logic(&mut self) {
        self.session.step(&mut self.preview);
    }

    /// Shows everything, and carries out what was asked for.
    pub fn ui(&mut self, ui: &mut Ui) {
        self.keys(ui.ctx());
        let bar = egui::Frame::new().fill(theme::BAR).inner_margin(egui::Margin::symmetric(10, 0));
        egui::Panel::bottom("status")
            .exact_size(22.0)
            .resizable(false)
            .frame(bar)
            .show(ui, |ui| panels::status::ui(ui, &self.session));
        egui::CentralPanel::no_frame().show(ui, |ui| {
            self.layout.ui(ui, &mut self.session, &mut self.screen);
        });
        if self.session.queue.contains(&Command::Quit) {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if !self.session.queue.is_empty() {
            ui.ctx().request_repaint();
        }
        self.session.step(&mut self.preview);
    }

    /// Turns keys into commands, unless somebody types.
    fn keys(&mut self, ctx: &Context) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        for command in Command::ALL {
            if ctx.input_mut(|i| i.consume_shortcut(&command.shortcut())) {
                self.session.queue.push(command);
            }
        }
    }
}

impl eframe::App for Shell {
    fn logic(&mut self, _: &Context, _: &mut eframe::Frame) {
        Self::logic(self);
    }

    /// Panels show this without being filled, at which devices of software are slow.
    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        theme::PANEL.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        Self::ui(self, ui);
    }
}
