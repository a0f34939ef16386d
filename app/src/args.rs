//! The command line.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use figurant_core::job::ranges;
use figurant_core::plan::Output;

use crate::overlay::Overlay;
use crate::report::Style;
use crate::road::{EngineKind, EngineWish, Simd};

const AFTER_HELP: &str = "Exit status: 0 done, 1 some frames failed (listed in report.json), \
    2 wrong arguments, config or disk, 3 no usable engine or window, 130 interrupted. \
    Standard output carries data only.";

/// Labelled pictures of people who do not exist.
#[derive(Debug, Parser)]
#[command(name = "figurant", version, after_help = AFTER_HELP)]
pub struct Args {
    /// A config to look at in a window; without one the starter preset.
    pub config: Option<PathBuf>,
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a data set.
    Export(ExportArgs),
    /// Render one frame to a PNG file.
    Frame(FrameArgs),
    /// Make a config of a scenario file of PeopleSansPeople or Unity Perception 0.9 to 1.0.
    Import(ImportArgs),
    /// Make a page of pictures from a list of configs.
    Gallery(GalleryArgs),
    /// Write the people of a config as files, to be edited and listed in configs.
    People(PeopleArgs),
    /// Check a config: every problem, with its field and a suggestion.
    Validate(ValidateArgs),
    /// Print the JSON Schema of the config.
    Schema,
    /// Say what this machine can do, with a test frame, and what is missing.
    Doctor(DoctorArgs),
    /// Measure this machine's engines.
    #[command(subcommand)]
    Bench(Bench),
}

/// What can be changed about a config from the command line.
#[derive(Clone, Debug, ClapArgs)]
pub struct Changes {
    /// Key of all randomness, instead of the config's.
    #[arg(long)]
    pub seed: Option<u64>,
    /// Picture size in pixels, instead of the config's.
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// What renders.
    #[arg(long, value_enum, default_value_t = EngineKind::Auto)]
    pub engine: EngineKind,
    /// Part of the name of the graphics adapter that renders; `doctor` lists them.
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Which code path of the native engine runs; pictures are the same.
    #[arg(long, value_enum, default_value_t = Simd::Auto)]
    pub simd: Simd,
}

impl Changes {
    /// The engine that is asked for: an adapter's name asks for the graphics engine.
    #[must_use]
    pub fn engine(&self) -> EngineWish {
        let kind = match (self.engine, &self.adapter) {
            (EngineKind::Auto, Some(_)) => EngineKind::Gpu,
            (kind, _) => kind,
        };
        EngineWish { kind, adapter: self.adapter.clone() }
    }
}

#[derive(Debug, ClapArgs)]
pub struct ExportArgs {
    /// The config.
    #[arg(required_unless_present = "scenario_config_file")]
    pub config: Option<PathBuf>,
    /// A scenario file of PeopleSansPeople or Unity Perception, instead of a config.
    #[arg(long, value_name = "PATH", conflicts_with = "config")]
    pub scenario_config_file: Option<PathBuf>,
    /// Folder of the data set; made if it does not exist.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Frames from A up to but without B, or the first N; all frames of the config by default.
    #[arg(long, value_name = "A..B|N", value_parser = ranges::parse)]
    pub frames: Option<Range<u32>>,
    /// Write these outputs only.
    #[arg(long, value_name = "OUTPUTS", value_delimiter = ',', value_parser = output_parser())]
    pub only: Vec<Output>,
    /// Threads that render; one for each processor by default.
    #[arg(long, value_name = "N")]
    pub workers: Option<NonZeroUsize>,
    /// Replace the data set that is in the folder. Files that are not part of it are kept.
    #[arg(long)]
    pub overwrite: bool,
    /// How progress is shown, on standard error.
    #[arg(long, value_enum, default_value_t = Style::Auto)]
    pub progress: Style,
    #[command(flatten)]
    pub changes: Changes,
}

#[derive(Debug, ClapArgs)]
pub struct ImportArgs {
    /// The scenario, a JSON file.
    pub scenario: PathBuf,
    /// File of the config; standard output by default.
    #[arg(long, value_name = "FILE.json")]
    pub out: Option<PathBuf>,
    /// Replace the file if it is there.
    #[arg(long)]
    pub overwrite: bool,
}

#[derive(Debug, ClapArgs)]
pub struct FrameArgs {
    /// The config.
    pub config: PathBuf,
    /// Which frame.
    #[arg(long, value_name = "I")]
    pub frame: u32,
    /// The picture's file, ending in .png.
    #[arg(long, value_name = "FILE.png")]
    pub out: PathBuf,
    /// Labels to draw on the picture.
    #[arg(long, value_enum, value_delimiter = ',')]
    pub overlay: Vec<Overlay>,
    #[command(flatten)]
    pub changes: Changes,
}

#[derive(Debug, ClapArgs)]
pub struct GalleryArgs {
    /// The list: which frames of which configs, with headings and captions.
    pub list: PathBuf,
    /// Folder of the page and its pictures; made if it does not exist.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
}

#[derive(Debug, ClapArgs)]
pub struct PeopleArgs {
    /// The config.
    pub config: PathBuf,
    /// A file that ends in .json for all of them, or a folder for a file each.
    #[arg(long, value_name = "DIR|FILE.json")]
    pub out: PathBuf,
    /// Those who stand in this frame instead of those who recur over the frames.
    #[arg(long, value_name = "I")]
    pub frame: Option<u32>,
    /// Some of them only: by identity, or with --frame by instance id.
    #[arg(long, value_name = "IDS", value_delimiter = ',')]
    pub person: Vec<u32>,
    /// Replace files that are there.
    #[arg(long)]
    pub overwrite: bool,
    /// Key of all randomness, instead of the config's.
    #[arg(long)]
    pub seed: Option<u64>,
}

#[derive(Debug, ClapArgs)]
pub struct ValidateArgs {
    /// The config.
    pub config: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub struct DoctorArgs {
    /// Which of the engine's code paths renders the test frame.
    #[arg(long, value_enum, default_value_t = Simd::Auto)]
    pub simd: Simd,
}

#[derive(Debug, Subcommand)]
pub enum Bench {
    /// Compare what the native engine and a graphics adapter make of the same frames.
    Parity(ParityArgs),
}

#[derive(Debug, ClapArgs)]
pub struct ParityArgs {
    /// The config; without one frames of peoplesanspeople, and one of every other preset.
    pub config: Option<PathBuf>,
    /// How many frames.
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,
    /// Picture size in pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "128x128")]
    pub size: [u32; 2],
    /// Part of the name of the graphics adapter.
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Outputs by their names, so that a wrong one is answered with a list and a suggestion.
fn output_parser() -> impl TypedValueParser<Value = Output> {
    PossibleValuesParser::new(Output::ALL.map(Output::name)).map(|name| {
        let output = Output::ALL.into_iter().find(|o| o.name() == name);
        output.expect("the parser accepts names of outputs only")
    })
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |digits: &str| digits.parse::<u32>().ok().filter(|n| *n > 0);
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    sides
        .ok_or_else(|| format!("expected width x height in pixels such as 640x480, got \"{text}\""))
}

impl ValueEnum for EngineKind {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Auto, Self::Gpu, Self::Cpu]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        use clap::builder::PossibleValue;
        Some(match self {
            Self::Auto => {
                PossibleValue::new("auto").help("a graphics processor if there is one, else cpu")
            }
            Self::Gpu => PossibleValue::new("gpu").help("a graphics adapter"),
            Self::Cpu => PossibleValue::new("cpu").help("the native engine"),
        })
    }
}

impl ValueEnum for Simd {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Auto, Self::Baseline]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(match self {
            Self::Auto => {
                clap::builder::PossibleValue::new("auto").help("the fastest that the processor has")
            }
            Self::Baseline => clap::builder::PossibleValue::new("baseline")
                .help("the one that every processor has"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn sizes_are_two_positive_numbers() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for text in ["", "640", "640x", "0x5", "-1x5", "1x2x3", "640 x 480", "axb"] {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
