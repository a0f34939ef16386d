//! What is open and how it is looked at. Knows no window: panels read and change it, the preview
//! is asked for what it wants to see.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use figurant_core::plan::{Output, Outputs};

use crate::command::Command;
use crate::commands::processors;
use crate::overlay::Overlay;
use crate::road::LoadError;
use crate::studio::Loaded;
use crate::viewport::fly::Flight;
use crate::viewport::preview::{Answer, Preview};
use crate::viewport::worker::{Renderer, Request, Shown};
use crate::viewport::zoom::Zoom;

/// Longest that a picture may take while the free camera moves, before smaller ones are made.
const SMOOTH: Duration = Duration::from_millis(33);

/// Something that is wrong, for people to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Path of a field in the config, or what else is concerned.
    pub place: String,
    /// What is wrong and what to do.
    pub text: String,
}

/// The graphics engine, as far as it can be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Graphics {
    /// Name of the adapter.
    pub adapter: String,
    /// Whether it is a graphics processor.
    pub hardware: bool,
}

/// How many threads the native engine makes pictures on. Where the window is drawn by software it
/// needs a processor itself, so that it goes on moving.
#[must_use]
pub fn threads(graphics: Option<&Graphics>) -> NonZeroUsize {
    let all = processors();
    match graphics {
        Some(graphics) if !graphics.hardware => NonZeroUsize::new(all.get() - 1).unwrap_or(all),
        _ => all,
    }
}

/// Size of the picture as a part of the config's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// As it is exported.
    #[default]
    Full,
    /// Half as wide and high.
    Half,
    /// A quarter as wide and high.
    Quarter,
}

impl Scale {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Full, Self::Half, Self::Quarter];

    /// As part of one.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Full => "1/1",
            Self::Half => "1/2",
            Self::Quarter => "1/4",
        }
    }

    const fn divisor(self) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }
}

/// An open config and how it is looked at.
pub struct Session {
    /// The config's file; none for the one that the program starts with.
    pub path: Option<PathBuf>,
    /// The config, once it was loaded. The last good one stays.
    pub config: Option<Loaded>,
    /// What is wrong with the config's file.
    pub config_problems: Vec<Problem>,
    /// Why the picture cannot be made.
    pub frame_problem: Option<Problem>,
    /// Which frame.
    pub frame: u32,
    /// Key of all randomness.
    pub seed: u64,
    /// Size of the picture.
    pub scale: Scale,
    /// The free camera, while it is in use.
    pub flight: Option<Flight>,
    /// Whether the free camera is on the move, so that speed counts more than pixels.
    pub moving: bool,
    /// Whether pictures of full size come too slowly for a camera on the move.
    slow: bool,
    /// What renders.
    pub renderer: Renderer,
    /// The graphics engine, if there is one.
    pub graphics: Option<Graphics>,
    /// Labels that are drawn over the picture.
    pub overlays: BTreeSet<Overlay>,
    /// Where the picture lies.
    pub zoom: Zoom,
    /// Screen pixels to one of the picture, as it was drawn last.
    pub zoom_factor: f32,
    /// Whether one pixel to a pixel was asked for; only the viewport knows its own size.
    pub wants_actual_size: bool,
    /// The last picture.
    pub shown: Option<Arc<Shown>>,
    /// Whether a picture or a config is on its way.
    pub busy: bool,
    /// Commands that wait to be carried out.
    pub queue: Vec<Command>,
}

impl Session {
    /// Nothing is open yet. Graphics hardware renders if there is any.
    #[must_use]
    pub fn new(path: Option<PathBuf>, graphics: Option<Graphics>) -> Self {
        let renderer = match &graphics {
            Some(graphics) if graphics.hardware => Renderer::Graphics,
            _ => Renderer::Native,
        };
        Self {
            path,
            config: None,
            config_problems: Vec::new(),
            frame_problem: None,
            frame: 0,
            seed: 0,
            scale: Scale::Full,
            flight: None,
            moving: false,
            slow: false,
            renderer,
            graphics,
            overlays: BTreeSet::from([Overlay::Box2d, Overlay::Keypoints]),
            zoom: Zoom::Fit,
            zoom_factor: 1.0,
            wants_actual_size: false,
            shown: None,
            busy: false,
            queue: Vec::new(),
        }
    }

    /// Name of what is open.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.path.as_deref().and_then(|p| p.file_name());
        name.map_or_else(|| "starter preset".to_owned(), |n| n.to_string_lossy().into_owned())
    }

    /// Frames of the config.
    #[must_use]
    pub fn frames(&self) -> u32 {
        self.config.as_ref().map_or(0, |c| c.document().frames)
    }

    /// Width and height of the picture that is wanted, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        let size = self.size_at(self.scale);
        if self.moving && self.slow { size.map(|side| side.div_ceil(2)) } else { size }
    }

    /// Width and height of a picture of another scale, pixels.
    #[must_use]
    pub fn size_at(&self, scale: Scale) -> [u32; 2] {
        let full = self.config.as_ref().map_or([1, 1], |c| {
            let image = &c.document().image;
            [image.width, image.height]
        });
        full.map(|side| (side / scale.divisor()).max(1))
    }

    /// All problems, those of the config first.
    pub fn problems(&self) -> impl Iterator<Item = &Problem> {
        self.config_problems.iter().chain(&self.frame_problem)
    }

    /// The picture that is wanted, once a config is open.
    #[must_use]
    pub fn request(&self) -> Option<Request> {
        let config = self.config.clone()?;
        // Boxes are always wanted: the people in view are counted by them.
        let overlays = self.overlays.iter().map(|o| o.needs());
        let outputs: Outputs = overlays.chain([Output::Rgb, Output::Box2d]).collect();
        Some(Request {
            config,
            frame: self.frame,
            seed: self.seed,
            size: self.size(),
            viewpoint: self.flight.map(|f| f.viewpoint),
            outputs,
            renderer: self.renderer,
        })
    }

    /// Takes what the preview has to say, carries out commands, and asks for what is wanted now.
    pub fn step(&mut self, preview: &mut Preview) {
        while let Some(answer) = preview.poll() {
            self.take(answer);
        }
        for command in std::mem::take(&mut self.queue) {
            self.run(command, preview);
        }
        if let Some(request) = self.request() {
            preview.ask(request);
        }
        self.busy = preview.is_busy();
    }

    fn take(&mut self, answer: Answer) {
        match answer {
            Answer::Opened(Ok(config)) => {
                self.seed = config.document().seed;
                self.config = Some(config);
                self.config_problems.clear();
            }
            Answer::Opened(Err(error)) => self.config_problems = self.described(error),
            Answer::Shown(shown) => {
                self.frame_problem = None;
                if shown.request.size == self.size_at(self.scale) {
                    self.slow = shown.wall > SMOOTH;
                }
                self.shown = Some(Arc::from(shown));
            }
            Answer::Failed(text) => {
                let place = format!("frame {}", self.frame);
                self.frame_problem = Some(Problem { place, text });
            }
        }
    }

    fn described(&self, error: LoadError) -> Vec<Problem> {
        let lines = match error {
            LoadError::Invalid(lines) => lines,
            LoadError::Unreadable(text) | LoadError::NoEngine(text) => {
                return vec![Problem { place: self.name(), text }];
            }
        };
        let split = |line: String| match line.split_once(": ") {
            Some((place, text)) => Problem { place: place.to_owned(), text: text.to_owned() },
            None => Problem { place: self.name(), text: line },
        };
        lines.into_iter().map(split).collect()
    }

    fn run(&mut self, command: Command, preview: &mut Preview) {
        match command {
            Command::NextFrame => self.frame = self.frame.saturating_add(1),
            Command::PreviousFrame => self.frame = self.frame.saturating_sub(1),
            Command::Reload => {
                preview.forget();
                preview.open(self.path.clone());
            }
            Command::DataCamera => (self.flight, self.moving) = (None, false),
            Command::FreeCamera => {
                if let (None, Some(shown)) = (self.flight, &self.shown) {
                    self.flight = Some(Flight::new(&shown.scene));
                }
            }
            Command::SwitchEngine => self.switch_engine(),
            Command::Boxes => self.toggle(Overlay::Box2d),
            Command::Keypoints => self.toggle(Overlay::Keypoints),
            Command::Masks => self.toggle(Overlay::Instance),
            Command::Fit => self.zoom = Zoom::Fit,
            Command::ActualSize => self.wants_actual_size = true,
            // The shell has seen it.
            Command::Quit => {}
        }
    }

    fn switch_engine(&mut self) {
        self.renderer = match self.renderer {
            Renderer::Native if self.graphics.is_some() => Renderer::Graphics,
            _ => Renderer::Native,
        };
    }

    fn toggle(&mut self, overlay: Overlay) {
        if !self.overlays.remove(&overlay) {
            self.overlays.insert(overlay);
        }
    }
}
