//! The road behind the preview: requests in, pictures out, one after the other.
//!
//! It is the exporter's road: a studio of the core with the document, size and outputs of the
//! request. What differs are wishes of the request's own, the viewpoint and where the picture goes.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::ColorImage;
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions};
use figurant_core::engine::gpu::{GpuContext, GpuEngine, GpuError, GpuPicture, GpuPictures};
use figurant_core::job::{FrameError, Studio, View, Viewpoint};
use figurant_core::label::Annotations;
use figurant_core::plan::{Delivery, Outputs, PassPlan, StageTimes};
use figurant_core::scene::Scene;

use crate::road::{LoadError, Road, Wishes};
use crate::studio::{Loaded, Native};

/// Which engine renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Renderer {
    /// On the processor.
    Native,
    /// On the window's own graphics device.
    Graphics,
}

/// A picture that is wanted.
#[derive(Clone)]
pub struct Request {
    /// What to show.
    pub config: Loaded,
    /// Number of the frame.
    pub frame: u32,
    /// Key of all randomness.
    pub seed: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Seen from elsewhere than from where the config's camera stands.
    pub viewpoint: Option<Viewpoint>,
    /// The picture and the labels that are wanted with it.
    pub outputs: Outputs,
    /// What renders.
    pub renderer: Renderer,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        self.same_studio(other)
            && self.renderer == other.renderer
            && (self.frame, self.viewpoint) == (other.frame, other.viewpoint)
    }
}

impl Request {
    /// Whether both want the same document of their studio.
    fn same_studio(&self, other: &Self) -> bool {
        self.config.is(&other.config)
            && (self.seed, self.size) == (other.seed, other.size)
            && self.outputs == other.outputs
    }
}

/// Pixels, where they are.
#[derive(Clone)]
pub enum Pixels {
    /// In memory, opaque sRGB.
    Host(Arc<ColorImage>),
    /// On the window's graphics device.
    Device(Arc<GpuPicture>),
}

/// A picture with everything that is known about it.
pub struct Shown {
    /// What was wanted.
    pub request: Request,
    /// The picture.
    pub pixels: Pixels,
    /// Its labels.
    pub annotations: Annotations,
    /// What it shows, with the camera that it was seen by.
    pub scene: Scene,
    /// Time by stage.
    pub times: StageTimes,
    /// Passes that ran and that were skipped.
    pub plan: PassPlan,
    /// From the request's turn to the finished picture.
    pub wall: Duration,
}

/// A studio with what its document was made from.
struct Desk {
    studio: Studio,
    request: Request,
    /// Where its engine leaves pictures, if it leaves them on the device.
    pictures: Option<GpuPictures>,
}

/// Renders requests. Keeps an engine of each kind, so that switching back costs nothing.
pub struct Worker {
    context: Option<GpuContext>,
    threads: NonZeroUsize,
    native: Option<Desk>,
    graphics: Option<Desk>,
}

impl Worker {
    /// Renders on a device if there is one, and on so many threads.
    #[must_use]
    pub fn new(context: Option<GpuContext>, threads: NonZeroUsize) -> Self {
        Self { context, threads, native: None, graphics: None }
    }

    /// Loads a config, or the one that the program starts with.
    ///
    /// # Errors
    /// When it cannot be read or something in it is wrong.
    pub fn open(path: Option<&Path>) -> Result<Loaded, LoadError> {
        let wishes = Wishes::default();
        let job = match path {
            Some(path) => Native.load(path, &wishes)?,
            None => Native.starter(&wishes)?,
        };
        Ok(job.document)
    }

    /// Renders a request.
    ///
    /// # Errors
    /// When no engine can be had, or the frame cannot be made. The next request may do better.
    pub fn show(&mut self, request: Request) -> Result<Shown, FrameError> {
        let start = Instant::now();
        let desk = self.desk(&request)?;
        let delivery = match desk.pictures {
            Some(_) => Delivery::Texture,
            None => Delivery::Readback,
        };
        let Request { frame, viewpoint, .. } = request;
        let made = desk.studio.make_view(&View { frame, viewpoint, delivery })?;
        let pixels = match desk.pictures.as_ref().and_then(GpuPictures::take) {
            Some(picture) => Pixels::Device(picture),
            None => {
                let size = request.size.map(|side| side as usize);
                let rgb = made.picture.unwrap_or_else(|| vec![0; size[0] * size[1] * 3]);
                Pixels::Host(Arc::new(ColorImage::from_rgb(size, &rgb)))
            }
        };
        Ok(Shown {
            plan: made.plan,
            pixels,
            annotations: made.annotations,
            scene: made.scene,
            times: made.times,
            wall: start.elapsed(),
            request,
        })
    }

    /// Forgets an engine and its buffers, which may hold anything after a panic.
    pub fn forget(&mut self, renderer: Renderer) {
        match renderer {
            Renderer::Native => self.native = None,
            Renderer::Graphics => self.graphics = None,
        }
    }

    /// The studio of a request's engine, with its document.
    fn desk(&mut self, request: &Request) -> Result<&mut Desk, FrameError> {
        let threads = self.threads;
        let place = match request.renderer {
            Renderer::Native => &mut self.native,
            Renderer::Graphics => &mut self.graphics,
        };
        let document = || request.config.changed(request.seed, request.size, &request.outputs);
        let desk = match place.take() {
            Some(mut desk) => {
                if !desk.request.same_studio(request) {
                    // On an error the studio has its old document still.
                    let directed = request.config.direct(&mut desk.studio, document());
                    if let Err(e) = directed {
                        *place = Some(desk);
                        return Err(e);
                    }
                    desk.request = request.clone();
                }
                desk
            }
            None => {
                let (engine, pictures) = engine(request.renderer, self.context.as_ref())?;
                let studio = request.config.studio(document(), engine, threads)?;
                Desk { studio, request: request.clone(), pictures }
            }
        };
        Ok(place.insert(desk))
    }
}

/// An engine, and where it leaves pictures if that is not in its frames.
fn engine(
    renderer: Renderer,
    context: Option<&GpuContext>,
) -> Result<(Box<dyn Engine>, Option<GpuPictures>), FrameError> {
    Ok(match (renderer, context) {
        (Renderer::Graphics, Some(context)) => {
            let (engine, pictures) = GpuEngine::on(context.clone());
            (Box::new(engine), Some(pictures))
        }
        (Renderer::Graphics, None) => return Err(GpuError::NoAdapter.into()),
        (Renderer::Native, _) => (Box::new(CpuEngine::new(CpuOptions::default())), None),
    })
}
