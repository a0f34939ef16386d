//! What the commands need of the core, in one place.
//!
//! [`Road`] is the border that tests put small frames behind; the program itself walks the core's
//! one road. No command calls documents, libraries or engines by any other way.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::Path;

use figurant_core::document::cast::Member;
use figurant_core::export::DatasetInfo;
use figurant_core::job::FrameMaker;
use figurant_core::job::parity::Difference;
use figurant_core::plan::Outputs;

/// Which of an engine's code paths runs. They give the same bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Simd {
    /// The fastest that the processor has.
    #[default]
    Auto,
    /// The one that every processor has.
    Baseline,
}

/// What renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EngineKind {
    /// Graphics hardware if there is any, else the native engine.
    Auto,
    /// A graphics adapter.
    Gpu,
    /// The native engine.
    #[default]
    Cpu,
}

/// What is to render; the native engine if nothing is said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EngineWish {
    /// Which engine.
    pub kind: EngineKind,
    /// Part of the name of its adapter; the fastest hardware if absent.
    pub adapter: Option<String>,
}

/// A graphics adapter, for people to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// How to name it.
    pub name: String,
    /// A line on it.
    pub line: String,
    /// Whether it is a graphics processor and not a program that pretends to be one.
    pub hardware: bool,
}

/// What the command line changes about a config.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wishes {
    /// Instead of the config's seed.
    pub seed: Option<u64>,
    /// Width and height instead of the config's, pixels.
    pub size: Option<[u32; 2]>,
    /// Instead of the config's outputs.
    pub outputs: Option<Outputs>,
    /// What renders.
    pub engine: EngineWish,
    /// Which code path of the engine runs.
    pub simd: Simd,
}

/// What the engines are to be compared over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParityWish<'a> {
    /// The config; the seed's preset, and a frame of every other, if absent.
    pub config: Option<&'a Path>,
    /// How many of its frames.
    pub frames: u32,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Part of the name of the graphics adapter; the fastest hardware, or else any, if absent.
    pub adapter: Option<String>,
}

/// A config that is ready to be rendered.
#[derive(Clone, Debug)]
pub struct Job<D> {
    /// What makers are set up from.
    pub document: D,
    /// How many frames the config has.
    pub frames: u32,
    /// What is the same for all frames of a data set of it.
    pub info: DatasetInfo,
    /// What renders: settled, with the whole name of its adapter.
    pub engine: EngineWish,
    /// Which code path of the engine runs.
    pub simd: Simd,
}

/// A config that was made of a scenario of Unity Perception.
#[derive(Clone, Debug)]
pub struct Import<D> {
    /// The config.
    pub document: D,
    /// A line on each thing in the scenario that was left out or changed.
    pub notes: Vec<String>,
}

/// Why a config cannot be rendered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LoadError {
    /// The file, or one that it names, cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// Its content is wrong. Each text names the field, what is wrong, and what to do.
    #[error("{}", .0.join("\n"))]
    Invalid(Vec<String>),
    /// The engine that was asked for cannot be had here.
    #[error("{0}")]
    NoEngine(String),
}

/// The way from configs to frames.
pub trait Road: Sync {
    /// A loaded config with what it draws from.
    type Document: Sync;
    /// A config by itself.
    type Config;
    /// What makes its frames.
    type Maker: FrameMaker<Error: Send + 'static>;

    /// The JSON Schema of the config.
    fn schema(&self) -> serde_json::Value;

    /// Loads and checks a config file with the wishes applied.
    ///
    /// # Errors
    /// When the file or an asset cannot be read, or something in it is wrong.
    fn load(&self, config: &Path, wishes: &Wishes) -> Result<Job<Self::Document>, LoadError>;

    /// Reads a scenario file of Unity Perception as a config.
    ///
    /// # Errors
    /// When the file cannot be read, or something in it is wrong.
    fn import(&self, scenario: &Path) -> Result<Import<Self::Config>, LoadError>;

    /// The text of a config's file.
    fn text(&self, config: &Self::Config) -> String;

    /// Makes such a config ready, with the wishes applied.
    ///
    /// # Errors
    /// When something in it is wrong, or what renders cannot be had.
    fn ready(
        &self,
        config: Self::Config,
        wishes: &Wishes,
    ) -> Result<Job<Self::Document>, LoadError>;

    /// The people who recur over the frames of a config with their identities, or those who stand
    /// in one frame with their instance ids, as configs can list them.
    ///
    /// # Errors
    /// When there is nobody.
    fn people(
        &self,
        job: &Job<Self::Document>,
        frame: Option<u32>,
    ) -> Result<Vec<(u32, Member)>, String>;

    /// A config that ships with the program, to try a machine with.
    ///
    /// # Errors
    /// When what ships with the program is damaged.
    fn starter(&self, wishes: &Wishes) -> Result<Job<Self::Document>, LoadError>;

    /// Sets up a maker with its engine and buffers, that may use some threads of its own.
    ///
    /// # Errors
    /// When no engine can be used here.
    fn maker(
        &self,
        job: &Job<Self::Document>,
        threads: NonZeroUsize,
    ) -> Result<Self::Maker, <Self::Maker as FrameMaker>::Error>;

    /// Renders frames by the native engine and by a graphics adapter, and tells of each config how
    /// far they are apart; the adapter's name.
    ///
    /// # Errors
    /// When there is no such adapter, or a config or a frame of it fails.
    fn parity(
        &self,
        wish: &ParityWish<'_>,
        tell: &mut dyn FnMut(&str, &Difference),
    ) -> Result<String, LoadError>;

    /// Shows a config, or one that ships with the program, in a window until that is closed. What is
    /// wrong with the config is said there.
    ///
    /// # Errors
    /// Why no window can be opened here, and what to do.
    fn window(&self, config: Option<&Path>) -> Result<(), String>;

    /// The engine and the code path that a maker would use here, for people to read.
    fn engine(&self, simd: Simd) -> String;

    /// The graphics adapters of this machine. Nothing if the program was built without the graphics
    /// engine.
    fn adapters(&self) -> Option<Vec<Adapter>>;

    /// Loads every asset that ships with the program; a line on each kind.
    ///
    /// # Errors
    /// What cannot be loaded, and why.
    fn built_in_assets(&self) -> Result<Vec<String>, String>;
}

impl Wishes {
    /// The outputs of a list, or those of the config if it is empty.
    #[must_use]
    pub fn only(mut self, outputs: impl IntoIterator<Item = figurant_core::plan::Output>) -> Self {
        let outputs: BTreeSet<_> = outputs.into_iter().collect();
        self.outputs = Some(outputs).filter(|o| !o.is_empty());
        self
    }
}
