//! The one road from a document and a frame number to a labelled picture.
//!
//! Preview, export, tests and benches all call [`Studio`]; they differ only in the
//! document, the wanted outputs and the engine they bring.

use std::num::NonZeroUsize;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::substitute::substitute;
use super::{FrameMaker, RenderedFrame};
use crate::document::{Document, OnError, Problem};
use crate::draw::{self, Cast, DrawError, DrawOptions, Drawn};
use crate::engine::{Engine, EngineError};
use crate::label;
use crate::library::Library;
use crate::library::clip::Clip;
use crate::library::pose::Pose;
use crate::library::textures::TextureGroup;
use crate::plan::{Delivery, Frame, Outputs, Pass, PassPlan, SceneFacts, Skipped, StageTimes};
use crate::sampling::{self, Activity, Catalogue, SampleError, Sampler};
use crate::scene::{Camera, Scene};

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

/// What is asked of a frame beside its document: which one, seen from where, delivered how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Number of the frame.
    pub frame: u32,
    /// Seen from elsewhere than where the document's camera stands; the rest of the scene stays.
    pub viewpoint: Option<Viewpoint>,
    /// Where the picture is wanted.
    pub delivery: Delivery,
}

/// Another place for a scene's camera; the picture's size and the near plane stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Metres, world.
    pub position_m: DVec3,
    /// World from view, a unit quaternion; at identity it looks down -Z with +Y up.
    pub rotation: DQuat,
    /// Angle between the rays through the middle of the top and bottom edge, degrees.
    pub fov_vertical_deg: f64,
}

impl From<&Camera> for Viewpoint {
    fn from(camera: &Camera) -> Self {
        let Camera { position_m, rotation, fov_vertical_deg, .. } = *camera;
        Self { position_m, rotation, fov_vertical_deg }
    }
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

    /// Another document for the same engine and its threads.
    ///
    /// # Errors
    /// When it makes no sense or names assets that are not there; the studio keeps what it had.
    pub fn direct(
        &mut self,
        document: Arc<Document>,
        library: Arc<Library>,
        cast: Arc<Cast>,
    ) -> Result<(), FrameError> {
        let outputs = document.output.outputs.clone();
        self.sampler = Sampler::new(document, catalogue(&library))?;
        (self.library, self.cast, self.outputs) = (library, cast, outputs);
        Ok(())
    }

    /// What a frame shows.
    #[must_use]
    pub fn scene(&self, frame: u32) -> Scene {
        self.sampler.scene(frame)
    }

    /// The passes that a scene takes, as far as that is known before it is drawn.
    #[must_use]
    pub fn plan(&self, scene: &Scene) -> PassPlan {
        let facts = SceneFacts {
            sun_shadow: scene.lights.sun.as_ref().is_some_and(|s| s.shadow),
            defocus: scene.camera.depth_of_field.is_some(),
            motion: scene.camera.motion_blur.is_some(),
            bloom: scene.post.bloom > 0.0,
        };
        PassPlan::new(&self.outputs, facts)
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
        let (drawn, frame, _) = self.render(scene, self.plan(scene), times)?;
        Ok((drawn, frame))
    }

    fn render(
        &mut self,
        scene: &Scene,
        plan: PassPlan,
        times: &mut StageTimes,
    ) -> Result<(Drawn, Frame, PassPlan), FrameError> {
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
            let plan = match drawn.list.defocus {
                Some(_) => plan,
                None => plan.without(Pass::Defocus, Skipped::InFocus),
            };
            let plan = match drawn.list.shutter {
                Some(_) => plan,
                None => plan.without(Pass::MotionBlur, Skipped::Still),
            };
            let frame = if plan.needs_engine() {
                engine.render(&drawn.list, &plan, times)?
            } else {
                Frame { width: scene.camera.width, height: scene.camera.height, ..Frame::default() }
            };
            Ok((drawn, frame, plan))
        })
    }

    /// Samples a frame, renders it as the view asks and labels it. The picture is absent if it was
    /// not asked for, or was left on the engine's device.
    ///
    /// # Errors
    /// When the scene cannot be drawn, or the engine refuses it.
    pub fn make_view(&mut self, view: &View) -> Result<RenderedFrame, FrameError> {
        let mut times = StageTimes::default();
        let mut scene = times.measure("sample", || self.sampler.scene(view.frame));
        if let Some(Viewpoint { position_m, rotation, fov_vertical_deg }) = view.viewpoint {
            scene.camera = Camera { position_m, rotation, fov_vertical_deg, ..scene.camera };
        }
        let skips = self.sampler.document().assets.on_error == OnError::Skip;
        let skipped = if skips { substitute(&mut scene, &self.library) } else { Vec::new() };
        let plan = self.plan(&scene).delivered(view.delivery);
        let (drawn, mut rendered, plan) = self.render(&scene, plan, &mut times)?;
        let annotations =
            times.measure("label", || label::annotate(&scene, &drawn, &rendered, &self.outputs));
        let picture = rendered.picture.take();
        self.engine.recycle(rendered);
        Ok(RenderedFrame { scene, picture, annotations, skipped, plan, times })
    }
}

/// The names of what a library holds.
#[must_use]
pub fn catalogue(library: &Library) -> Catalogue {
    let of_clip = |clip: &Clip| Activity {
        id: clip.id.clone(),
        activity: clip.activity().to_owned(),
        unsuited: clip.unsuited(),
        ..Activity::default()
    };
    let of_pose = |pose: &Pose| Activity {
        id: pose.id.clone(),
        activity: pose.activity.clone(),
        seated: pose.seated,
        unsuited: pose.unsuited.clone(),
    };
    Catalogue {
        face_targets: library.figure.face_shape_names().map(str::to_owned).collect(),
        face_units: library.figure.face_unit_names().map(str::to_owned).collect(),
        clips: library.clips.all().iter().map(of_clip).collect(),
        poses: library.poses.all().iter().map(of_pose).collect(),
        textures: library.surface_textures(),
        cloth_patterns: library.textures.ids(TextureGroup::Cloth).to_vec(),
        cloth_reliefs: library.textures.ids(TextureGroup::Relief).to_vec(),
        cloth_finishes: library.textures.ids(TextureGroup::Finish).to_vec(),
        environments: library.environments.ids().to_vec(),
    }
}

impl FrameMaker for Studio {
    type Error = FrameError;

    /// Samples a frame, renders it and labels it.
    fn make(&mut self, frame: u32) -> Result<RenderedFrame, FrameError> {
        self.make_view(&View { frame, ..View::default() })
    }
}
