//! One frame, and many.
//!
//! [`frame`] is the road from a document to one labelled frame; [`batch`] runs a range of frames over
//! workers into a data set, with whatever [`FrameMaker`] it is given. [`parity`] compares what two
//! engines make of the same scenes. `substitute` puts usable
//! pictures in the place of unusable ones before a scene is drawn, where the config asks for it.

pub mod batch;
pub mod frame;
mod maker;
pub mod parity;
pub mod progress;
pub mod ranges;
mod substitute;

pub use frame::{FrameError, Studio, View, Viewpoint, catalogue};
pub use maker::{FrameMaker, RenderedFrame};
