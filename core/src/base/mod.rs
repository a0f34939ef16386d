//! What every layer stands on: conventions of space, keyed random numbers, hashes, caches, colour,
//! lenses and maths.
//!
//! Values in, values out. Nothing here knows of documents, scenes or files.

pub mod cache;
pub mod color;
pub mod hash;
pub mod lens;
pub mod math;
pub mod rng;
pub mod space;
