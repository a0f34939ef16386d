//! (draw list, pass plan) -> frame. Engines of equal rank behind one trait.
//!
//! An engine knows nothing of documents, labels or files. [`cpu`] is native Rust: tiles over
//! threads, eight-wide portable SIMD, the same bytes on every machine. `gpu` (feature `gpu`) runs
//! the same stages as compute shaders by way of wgpu. What they share is `input`, which says what
//! a draw list must fulfil, `pattern`, where samples lie, `lens` and `squares`, where they lie behind
//! a lens, `noise`, the grain of a pixel, and `optics`, at which size light is spread.

use crate::draw::DrawList;
use crate::plan::{Frame, PassPlan, StageTimes};

pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
mod input;
mod lens;
mod noise;
mod optics;
mod pattern;
mod squares;

/// What can go wrong while a frame is rendered.
#[derive(Debug, thiserror::Error)]
pub enum EngineError {
    /// A number in the draw list is NaN or infinite.
    #[error("object {object}: {what} is not finite; the scene that led to it is at fault")]
    NotFinite {
        /// Index in the draw list's objects, or `u32::MAX` for the view and the lights.
        object: u32,
        /// Which number.
        what: &'static str,
    },
    /// The draw list asks for more than the engine can do.
    #[error("{what} is {got}, at most {limit} can be drawn")]
    TooLarge {
        /// Which number.
        what: &'static str,
        /// What was asked for.
        got: u64,
        /// What is possible.
        limit: u64,
    },
    /// The draw list contradicts itself.
    #[error("{what} {index} is {got}, expected {expected}; the draw list is at fault")]
    Invalid {
        /// Which number.
        what: &'static str,
        /// Of which object, draw, material or texture; 0 where there is only one.
        index: u64,
        /// What it is, 0 where it is not a whole number.
        got: u64,
        /// What it should be.
        expected: &'static str,
    },
    /// The graphics device ran out of memory.
    #[error(
        "{adapter} has no memory left for {what}; use fewer --workers, smaller pictures or \
         --engine cpu"
    )]
    OutOfMemory {
        /// Name of the adapter.
        adapter: String,
        /// What did not fit.
        what: String,
    },
    /// The graphics device went away while it rendered, and again once it was back.
    #[error("{adapter} was lost while it rendered ({reason}); try again, or use --engine cpu")]
    DeviceLost {
        /// Name of the adapter.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The graphics driver refused something.
    #[error("{adapter} refused to render ({reason}); update its driver, or use --engine cpu")]
    Driver {
        /// Name of the adapter.
        adapter: String,
        /// What was refused and why.
        reason: String,
    },
}

/// Renders draw lists. One engine is used by one thread at a time and keeps its buffers.
pub trait Engine: Send {
    /// Runs the plan's passes and hands back the buffers they write.
    ///
    /// # Errors
    /// When the draw list holds a number that is not finite, or more than the engine can draw.
    fn render(
        &mut self,
        list: &DrawList,
        plan: &PassPlan,
        times: &mut StageTimes,
    ) -> Result<Frame, EngineError>;

    /// Takes a frame back that nobody reads any more, so that its memory serves later ones.
    fn recycle(&mut self, frame: Frame) {
        drop(frame);
    }
}

/// A buffer of a length, in the memory of an earlier one where there was one. What it holds is left
/// as it is: engines write every pixel.
fn resized<T: Clone + Default>(earlier: Option<Vec<T>>, len: usize) -> Vec<T> {
    let mut buffer = earlier.unwrap_or_default();
    buffer.resize(len, T::default());
    buffer
}
