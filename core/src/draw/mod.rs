//! Scene -> [`DrawList`]: everything in view space and single precision, ready for an engine.

pub mod abi;

pub use abi::DrawList;
