//! The one road from a document and a frame number to a labelled picture.
//!
//! Preview, export, tests and benches all call [`Studio`]; they differ only in the
//! document, the wanted outputs and the engine they bring.

use std::num::NonZeroUsize;
use std::sync::Arc;

use super::{FrameMaker, RenderedFrame};
use crate::document::{Document, Problem};
use crate::draw::{self, Cast, DrawError, DrawOptions, Drawn};
use crate::engine::{Engine, EngineError};
use crate::label;
use crate::library::Library;
use crate::library::textures::TextureGroup;
use crate::plan::{Frame, Outputs, Pass, PassPlan, SceneFacts, StageTimes};
use crate::sampling::{self, Activity, Catalogue, SampleError, Sampler};
use crate::scene::Scene;

/// A frame that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// The document cannot be sampled.
    #[error("sampling: {0}")]
    Sample(#[from] SampleError),
    /// The scene names something that the library does not hold.
    #[error("drawing: {0}")]
    Draw(#[from] DrawError),
    /// No threads could be had.
    #[error(transparent)]
    Threads(#[from] ThreadError),
    /// The graphics engine cannot be had.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Adapter(#[from] crate::engine::gpu::GpuError),
    /// The engine refused.
    #[error("rendering: {0}")]
    Engine(#[from] EngineError),
}

/// No threads could be had.
#[derive(Debug, thiserror::Error)]
#[error("{threads} threads cannot be started ({source}); ask for fewer with --workers")]
pub struct ThreadError {
    threads: NonZeroUsize,
    source: rayon::ThreadPoolBuildError,
}

/// A document, what it draws from and what renders it.
pub struct Studio {
    sampler: Sampler,
    library: Arc<Library>,
    cast: Arc<Cast>,
    outputs: Outputs,
    engine: Box<dyn Engine>,
    threads: rayon::ThreadPool,
}

impl Studio {
    /// A studio for a document, with some threads of its own. What it makes depends neither on how many nor on what `cast`, which
    /// studios may share, holds already.
    ///
    /// # Errors
    /// When the document makes no sense or names assets that are not there
    /// ([`Self::check_assets`]), or the system gives no threads.
    pub fn new(
        document: Arc<Document>,
        library: Arc<Library>,
        cast: Arc<Cast>,
        engine: Box<dyn Engine>,
        threads: NonZeroUsize,
    ) -> Result<Self, FrameError> {
        let threads = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build()
            .map_err(|source| ThreadError { threads, source })?;
        let outputs = document.output.outputs.clone();
        let sampler = Sampler::new(document, catalogue(&library))?;
        Ok(Self { sampler, library, cast, outputs, engine, threads })
    }

    /// What a document names that the library does not hold.
    #[must_use]
    pub fn check_assets(document: &Document, library: &Library) -> Vec<Problem> {
        sampling::check_assets(document, &catalogue(library))
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
        let document = self.sampler.document();
        let options = DrawOptions {
            raster: plan.needs_engine(),
            shading: plan.runs(Pass::Shade),
            samples: document.labels.samples,
            shadow_map_size: document.quality.shadow_map_size,
            lod_error_px: document.quality.lod_error_px,
        };
        let (library, cast, engine) = (&self.library, &self.cast, &mut self.engine);
        self.threads.install(|| {
            let drawn = times.measure("draw", || draw::draw(scene, library, cast, &options))?;
            let frame = if plan.needs_engine() {
                engine.render(&drawn.list, &plan, times)?
            } else {
                Frame { width: scene.camera.width, height: scene.camera.height, ..Frame::default() }
            };
            Ok((drawn, frame))
        })
    }
}

/// The names of what a library holds.
#[must_use]
pub fn catalogue(library: &Library) -> Catalogue {
    let activity =
        |id: &str, activity: &str| Activity { id: id.to_owned(), activity: activity.to_owned() };
    Catalogue {
        face_targets: library.figure.face_shape_names().map(str::to_owned).collect(),
        face_units: library.figure.face_unit_names().map(str::to_owned).collect(),
        clips: library.clips.all().iter().map(|c| activity(&c.id, c.activity())).collect(),
        poses: library.poses.all().iter().map(|p| activity(&p.id, &p.activity)).collect(),
        textures: library.surface_textures(),
        cloth_patterns: library.textures.ids(TextureGroup::Cloth).to_vec(),
    }
}

impl FrameMaker for Studio {
    type Error = FrameError;

    /// Samples a frame, renders it and labels it.
    fn make(&mut self, frame: u32) -> Result<RenderedFrame, FrameError> {
        let mut times = StageTimes::default();
        let scene = times.measure("sample", || self.sampler.scene(frame));
        let (drawn, mut rendered) = self.render_scene(&scene, &mut times)?;
        let annotations =
            times.measure("label", || label::annotate(&scene, &drawn, &rendered, &self.outputs));
        let picture = rendered.picture.take();
        self.engine.recycle(rendered);
        Ok(RenderedFrame { scene, picture, annotations, times })
    }
}
