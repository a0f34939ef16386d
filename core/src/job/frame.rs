//! The one road from a document and a frame number to a labelled picture.
//!
//! Preview, export, tests and benches all call [`Studio`]; they differ only in the
//! document, the wanted outputs and the engine they bring.

use std::sync::Arc;

use crate::document::Document;
use super::{FrameMaker, RenderedFrame};
use crate::draw::{self, DrawError, DrawOptions, Drawn};
use crate::engine::{Engine, EngineError};
use crate::label;
use crate::library::Library;
use crate::plan::{Frame, Outputs, Pass, PassPlan, SceneFacts, StageTimes};
use crate::sampling::{self, SampleError};
use crate::scene::Scene;

/// A frame that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The document has no such frame.
    #[error("sampling: {0}")]
    Sample(#[from] SampleError),
    /// The scene names something that the library does not hold.
    #[error("drawing: {0}")]
    Draw(#[from] DrawError),
    /// The engine refused.
    #[error("rendering: {0}")]
    Engine(#[from] EngineError),
}

/// A document, what it draws from and what renders it.
pub struct Studio {
    document: Arc<Document>,
    library: Arc<Library>,
    outputs: Outputs,
    engine: Box<dyn Engine>,
}

impl Studio {
    /// A studio for a valid document.
    #[must_use]
    pub fn new(document: Arc<Document>, library: Arc<Library>, engine: Box<dyn Engine>) -> Self {
        let outputs = document.output.outputs.clone();
        Self { document, library, outputs, engine }
    }

    /// The road from a scene on, for scenes that come from elsewhere.
    ///
    /// # Errors
    /// When the scene cannot be drawn, or the engine refuses it.
    pub fn render_scene(
        &mut self,
        scene: &Scene,
        times: &mut StageTimes,
    ) -> Result<(Drawn, Frame), FrameError> {
        let sun_shadow = scene.lights.sun.as_ref().is_some_and(|s| s.shadow);
        let plan = PassPlan::new(&self.outputs, SceneFacts { sun_shadow });
        let options = DrawOptions {
            raster: plan.needs_engine(),
            shading: plan.runs(Pass::Shade),
            samples: self.document.labels.samples,
            shadow_map_size: self.document.quality.shadow_map_size,
            lod_error_px: self.document.quality.lod_error_px,
        };
        let drawn = times.measure("draw", || draw::draw(scene, &self.library, &options))?;
        let frame = if plan.needs_engine() {
            self.engine.render(&drawn.list, &plan, times)?
        } else {
            Frame { width: scene.camera.width, height: scene.camera.height, ..Frame::default() }
        };
        Ok((drawn, frame))
    }
}

impl FrameMaker for Studio {
    type Error = FrameError;

    /// Samples a frame, renders it and labels it.
    fn make(&mut self, frame: u32) -> Result<RenderedFrame, FrameError> {
        let mut times = StageTimes::default();
        let scene = times.measure("sample", || {
            sampling::sample(&self.document, self.library.catalogue(), frame)
        })?;
        let (drawn, rendered) = self.render_scene(&scene, &mut times)?;
        let annotations =
            times.measure("label", || label::annotate(&scene, &drawn, &rendered, &self.outputs));
        Ok(RenderedFrame { scene, picture: rendered.picture, annotations, times })
    }
}
