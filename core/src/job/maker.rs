//! What makes frames, as a batch sees it.

use crate::export::SkippedAsset;
use crate::label::Annotations;
use crate::plan::{PassPlan, StageTimes};
use crate::scene::Scene;

/// Everything that was made for one frame.
#[derive(Clone, Debug)]
pub struct RenderedFrame {
    /// What it shows.
    pub scene: Scene,
    /// 8-bit sRGB, row by row, `width * height * 3` long; absent where it was not asked for.
    pub picture: Option<Vec<u8>>,
    /// Its labels.
    pub annotations: Annotations,
    /// Pictures in whose place it shows others.
    pub skipped: Vec<SkippedAsset>,
    /// The passes that made it.
    pub plan: PassPlan,
    /// Time spent by stage.
    pub times: StageTimes,
}

/// Makes frames by their number. One maker is used by one thread at a time and keeps its buffers;
/// what it makes depends on nothing but the frame's number.
pub trait FrameMaker {
    /// Why a frame could not be made.
    type Error: std::error::Error;

    /// Makes a frame.
    ///
    /// # Errors
    /// When the frame cannot be made; others may still be.
    fn make(&mut self, frame: u32) -> Result<RenderedFrame, Self::Error>;
}
