//! One frame, and many.
//!
//! [`batch`] runs a range of frames over workers into a data set, with whatever [`FrameMaker`] it is
//! given; what a frame is made of is the maker's business.

pub mod batch;
mod maker;
pub mod progress;
pub mod ranges;

pub use maker::{FrameMaker, RenderedFrame};
