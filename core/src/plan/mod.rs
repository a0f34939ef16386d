//! Wanted outputs -> passes: what nobody asked for is not computed.
//!
//! [`output`] names what a user may ask for and the buffers each output is made from, [`pass`] is
//! the table of passes with what they read and write, `walk` goes through it backwards, and [`frame`]
//! is what an engine hands back. How a pass is run is the engines' business.

pub mod frame;
pub mod output;
pub mod pass;
mod walk;

pub use frame::{Frame, ObjectSamples, StageTimes};
pub use output::{Output, Outputs};
pub use pass::{Buffer, Pass};
pub use walk::{Delivery, PassPlan, SceneFacts, Skipped};
