//! The program's own road: documents, the library and the engine of the core.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;

use figurant_core::document::cast::Member;
use figurant_core::document::file::{self, FileError};
use figurant_core::document::import::{self, ImportError};
use figurant_core::document::settle::{Settled, Source, SourceKind, read_all};
use figurant_core::document::{self, Document, ImageFormat, Param, presets};
use figurant_core::draw::Cast;
use figurant_core::engine::Engine;
use figurant_core::engine::cpu::{CpuEngine, CpuOptions, SimdChoice};
#[cfg(feature = "gpu")]
use figurant_core::engine::gpu::{self, GpuEngine, GpuOptions, ShaderFolder};
use figurant_core::export::{AssetLicence, DatasetInfo, PictureFormat};
use figurant_core::job::parity::Difference;
use figurant_core::job::{FrameError, Studio, catalogue};
use figurant_core::library::textures::TextureGroup;
use figurant_core::library::{Library, NO_LICENCE};
use figurant_core::plan::Outputs;
use figurant_core::sampling::Sampler;

use crate::road::{
    Adapter, EngineKind, EngineWish, Import, Job, LoadError, ParityWish, Road, Simd, Wishes,
};

/// The road that the program itself walks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Native;

/// A valid document with everything it draws from.
#[derive(Clone)]
pub struct Loaded {
    document: Arc<Document>,
    library: Arc<Library>,
    cast: Arc<Cast>,
    #[cfg(feature = "gpu")]
    shaders: Option<ShaderFolder>,
}

/// The folder that `FIGURANT_SHADERS` names, for those who work on shaders: builds for debugging
/// render by its files and take them anew whenever they change.
#[cfg(feature = "gpu")]
#[must_use]
pub fn shader_folder() -> Option<ShaderFolder> {
    let path = std::env::var_os("FIGURANT_SHADERS").filter(|_| cfg!(debug_assertions))?;
    Some(ShaderFolder::new(path.into(), |problem| eprintln!("{problem}")))
}

impl Loaded {
    /// The document, as it was loaded.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The document with another seed, picture size (pixels) and outputs.
    #[must_use]
    pub fn changed(&self, seed: u64, size: [u32; 2], outputs: &Outputs) -> Arc<Document> {
        let mut document = Document::clone(&self.document);
        let wishes = Wishes {
            seed: Some(seed),
            size: Some(size),
            outputs: Some(outputs.clone()),
            ..Wishes::default()
        };
        apply(&wishes, &mut document);
        Arc::new(document)
    }

    /// A studio for such a document, which must not name other assets.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub fn studio(
        &self,
        document: Arc<Document>,
        engine: Box<dyn Engine>,
        threads: NonZeroUsize,
    ) -> Result<Studio, FrameError> {
        let (library, cast) = (Arc::clone(&self.library), Arc::clone(&self.cast));
        Studio::new(document, library, cast, engine, threads)
    }

    /// Gives such a document to a studio that had another.
    ///
    /// # Errors
    /// When the document makes no sense; the studio keeps what it had.
    pub fn direct(&self, studio: &mut Studio, document: Arc<Document>) -> Result<(), FrameError> {
        studio.direct(document, Arc::clone(&self.library), Arc::clone(&self.cast))
    }

    /// Whether both were loaded at once.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.document, &other.document)
    }
}

impl Road for Native {
    type Document = Loaded;
    type Config = Document;
    type Maker = Studio;

    fn schema(&self) -> serde_json::Value {
        document::schema()
    }

    fn load(&self, config: &Path, wishes: &Wishes) -> Result<Job<Loaded>, LoadError> {
        let loaded = file::load(config).map_err(|error| match error {
            FileError::Invalid { problems, .. } => {
                LoadError::Invalid(problems.0.iter().map(ToString::to_string).collect())
            }
            other => LoadError::Unreadable(other.to_string()),
        })?;
        let folders = loaded.asset_folders();
        let Settled { document, sources } = read_all(loaded).map_err(|problems| {
            LoadError::Invalid(problems.0.iter().map(ToString::to_string).collect())
        })?;
        prepare(document, sources, &folders, wishes)
    }

    fn import(&self, scenario: &Path) -> Result<Import<Document>, LoadError> {
        let imported = import::load(scenario).map_err(|error| match error {
            ImportError::Invalid(problems) => {
                LoadError::Invalid(problems.0.iter().map(ToString::to_string).collect())
            }
            // These name the file themselves.
            ImportError::Io { .. } | ImportError::Folder(_) => {
                LoadError::Unreadable(error.to_string())
            }
            ImportError::TooLarge | ImportError::NotJson(_) | ImportError::NotAScenario(_) => {
                LoadError::Unreadable(format!("{}: {error}", scenario.display()))
            }
        })?;
        let notes = imported.notes.iter().map(ToString::to_string).collect();
        Ok(Import { document: imported.document, notes })
    }

    fn text(&self, config: &Document) -> String {
        file::text(config)
    }

    fn ready(&self, config: Document, wishes: &Wishes) -> Result<Job<Loaded>, LoadError> {
        prepare(config, Vec::new(), &[], wishes)
    }

    fn people(&self, job: &Job<Loaded>, frame: Option<u32>) -> Result<Vec<(u32, Member)>, String> {
        let Loaded { document, library, .. } = &job.document;
        let sampler =
            Sampler::new(Arc::clone(document), catalogue(library)).map_err(|e| e.to_string())?;
        let people: Vec<_> = match frame {
            Some(frame) => sampler.members_of_frame(frame),
            None => (0..).zip(sampler.members()).collect(),
        };
        match (people.is_empty(), frame) {
            (false, _) => Ok(people),
            (true, Some(frame)) => Err(format!("nobody stands in frame {frame}; choose another")),
            (true, None) => Err("people.identities: is null, so that nobody recurs; write a \
                 number, or give --frame for the people of one frame"
                .to_owned()),
        }
    }

    fn starter(&self, wishes: &Wishes) -> Result<Job<Loaded>, LoadError> {
        let document = file::parse(presets::ALL[0].text)
            .map_err(|problems| LoadError::Unreadable(problems.to_string()))?;
        prepare(document, Vec::new(), &[], wishes)
    }

    fn maker(&self, job: &Job<Loaded>, threads: NonZeroUsize) -> Result<Studio, FrameError> {
        let Loaded { document, library, cast, .. } = &job.document;
        let (document, library) = (Arc::clone(document), Arc::clone(library));
        Studio::new(document, library, Arc::clone(cast), engine(job)?, threads)
    }

    fn parity(
        &self,
        wish: &ParityWish<'_>,
        tell: &mut dyn FnMut(&str, &Difference),
    ) -> Result<String, LoadError> {
        #[cfg(feature = "gpu")]
        return crate::parity::parity(self, wish, tell);
        #[cfg(not(feature = "gpu"))]
        {
            let _ = (wish, tell);
            let text = "this program was built without the graphics engine: nothing to compare";
            Err(LoadError::NoEngine(text.to_owned()))
        }
    }

    fn window(&self, config: Option<&Path>) -> Result<(), String> {
        #[cfg(feature = "gui")]
        return crate::launch::open(config.map(Path::to_owned));
        #[cfg(not(feature = "gui"))]
        {
            let _ = config;
            Err("this program was built without one; build it with --features gui".to_owned())
        }
    }

    fn engine(&self, simd: Simd) -> String {
        let engine = CpuEngine::new(CpuOptions { simd: choice(simd), ..CpuOptions::default() });
        format!("cpu, {}", engine.simd_name())
    }

    fn adapters(&self) -> Option<Vec<Adapter>> {
        #[cfg(feature = "gpu")]
        return Some(
            gpu::adapters()
                .into_iter()
                .map(|a| Adapter { line: a.to_string(), hardware: a.hardware, name: a.name })
                .collect(),
        );
        #[cfg(not(feature = "gpu"))]
        None
    }

    fn built_in_assets(&self) -> Result<Vec<String>, String> {
        let library = Library::new(&[], 1024).map_err(|e| e.to_string())?;
        Ok(vec![
            format!("1 figure with {} face targets", library.figure.face_target_names().len()),
            format!(
                "{} motion clips and {} poses",
                library.clips.ids().count(),
                library.poses.ids().count()
            ),
            format!(
                "{} textures; {} patterns, {} reliefs and {} finishes of cloth",
                library.surface_textures().len(),
                library.textures.ids(TextureGroup::Cloth).len(),
                library.textures.ids(TextureGroup::Relief).len(),
                library.textures.ids(TextureGroup::Finish).len()
            ),
        ])
    }
}

const fn choice(simd: Simd) -> SimdChoice {
    match simd {
        Simd::Auto => SimdChoice::Auto,
        Simd::Baseline => SimdChoice::Baseline,
    }
}

/// The engine of a job.
fn engine(job: &Job<Loaded>) -> Result<Box<dyn Engine>, FrameError> {
    #[cfg(feature = "gpu")]
    if job.engine.kind == EngineKind::Gpu {
        let (adapter, shaders) = (job.engine.adapter.clone(), job.document.shaders.clone());
        let options = GpuOptions { adapter, shaders, ..GpuOptions::default() };
        return Ok(Box::new(GpuEngine::new(options)?));
    }
    Ok(Box::new(CpuEngine::new(CpuOptions { simd: choice(job.simd), ..CpuOptions::default() })))
}

/// Settles what renders here: one of the two engines, with the whole name of its adapter.
#[cfg(feature = "gpu")]
fn settle(wish: &EngineWish) -> Result<EngineWish, LoadError> {
    let cpu = EngineWish { kind: EngineKind::Cpu, adapter: None };
    let options = GpuOptions { adapter: wish.adapter.clone(), ..GpuOptions::default() };
    match wish.kind {
        EngineKind::Cpu => Ok(cpu),
        EngineKind::Auto => Ok(gpu::choice(&options).map_or(cpu, |adapter| EngineWish {
            kind: EngineKind::Gpu,
            adapter: Some(adapter.name),
        })),
        EngineKind::Gpu => match gpu::choice(&options) {
            Ok(adapter) => Ok(EngineWish { kind: EngineKind::Gpu, adapter: Some(adapter.name) }),
            Err(error) => Err(LoadError::NoEngine(error.to_string())),
        },
    }
}

/// Settles what renders here: the native engine, as there is no other.
#[cfg(not(feature = "gpu"))]
fn settle(wish: &EngineWish) -> Result<EngineWish, LoadError> {
    match wish.kind {
        EngineKind::Gpu => Err(LoadError::NoEngine(
            "this program was built without the graphics engine; use --engine cpu".to_owned(),
        )),
        _ => Ok(EngineWish { kind: EngineKind::Cpu, adapter: None }),
    }
}

/// Applies the wishes, loads the library and checks the one against the other.
fn prepare(
    mut document: Document,
    sources: Vec<Source>,
    folders: &[std::path::PathBuf],
    wishes: &Wishes,
) -> Result<Job<Loaded>, LoadError> {
    apply(wishes, &mut document);
    let invalid = |problems: Vec<document::Problem>| {
        let texts: Vec<String> = problems.iter().map(ToString::to_string).collect();
        if texts.is_empty() { Ok(()) } else { Err(LoadError::Invalid(texts)) }
    };
    invalid(document::validate(&document))?;
    let library = Library::new(folders, document.quality.max_texture_size)
        .map_err(|e| LoadError::Unreadable(e.to_string()))?;
    let studio = Loaded {
        document: Arc::new(document),
        library: Arc::new(library),
        cast: Arc::default(),
        #[cfg(feature = "gpu")]
        shaders: shader_folder(),
    };
    invalid(Studio::check_assets(&studio.document, &studio.library))?;
    let engine = settle(&wishes.engine)?;
    Ok(Job {
        frames: studio.document.frames,
        info: info(&studio, sources, &engine),
        engine,
        simd: wishes.simd,
        document: studio,
    })
}

fn apply(wishes: &Wishes, document: &mut Document) {
    if let Some(seed) = wishes.seed {
        document.seed = seed;
    }
    if let Some([width, height]) = wishes.size {
        document.image.width = width;
        document.image.height = height;
    }
    if let Some(outputs) = &wishes.outputs {
        document.output.outputs.clone_from(outputs);
    }
}

fn info(
    Loaded { document, library, .. }: &Loaded,
    sources: Vec<Source>,
    engine: &EngineWish,
) -> DatasetInfo {
    let of_library = library.licences().into_iter().map(|l| AssetLicence {
        id: l.id,
        content_hash: l.content_hash,
        licence: l.licence.to_owned(),
        source: l.source.to_owned(),
    });
    let of_config = sources.into_iter().map(|source| {
        let (kind, what) = match source.kind {
            SourceKind::People => ("people", "file of people of the config"),
            SourceKind::Numbers => ("numbers", "table of the config"),
        };
        AssetLicence {
            id: format!("{kind}/{}", source.name),
            content_hash: Some(source.content_hash),
            licence: NO_LICENCE.to_owned(),
            source: what.to_owned(),
        }
    });
    DatasetInfo {
        config_json: file::text(document),
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        engine: if engine.kind == EngineKind::Gpu { "gpu" } else { "cpu" }.to_owned(),
        adapter: engine.adapter.clone(),
        seed: document.seed,
        width: document.image.width,
        height: document.image.height,
        outputs: document.output.outputs.clone(),
        picture: match document.output.image_format {
            // One that is drawn comes with each frame.
            ImageFormat::Jpeg => match document.output.jpeg_quality {
                Param::Constant(quality) => PictureFormat::Jpeg(quality.round() as u8),
                Param::Random(_) => PictureFormat::DEFAULT,
            },
            ImageFormat::Png => PictureFormat::Png,
        },
        assets: of_library.chain(of_config).collect(),
    }
}
