//! The core of Figurant: from a document to labelled frames, without a window.
//!
//! One road, walked by preview, export, tests and benches alike:
//!
//! ```text
//! Document + frame index -> Scene -> DrawList -> [PassPlan] -> Frame -> Annotations -> files
//!          sampling          draw      engine       label        export
//! ```
//!
//! Each arrow is a function on values. The modules below stand in import order: each sees only
//! those above it, and `tests/layering.rs` refuses an upward import.
//!
//! | layer | what it holds | must not be in it |
//! |---|---|---|
//! | [`base`] | spaces, keyed random numbers, hashes, maths | anything of ours |
//! | [`document`] | the config as a typed value, its checks and its file | sampled numbers |
//! | [`library`] | assets by id: figures, clips, textures, meshes | what a frame shows |
//! | [`scene`] | types only: one frame with every number settled | functions that decide |
//! | [`sampling`] | (document, catalogue, frame) -> scene | geometry, pixels |
//! | [`geometry`] | persons, garments, skeletons and primitive shapes as meshes | cameras, pixels |
//! | [`plan`] | wanted outputs -> passes, and what a frame holds | how a pass is run |
//! | [`draw`] | scene -> draw list: view space, levels of detail, culling | engine code |
//! | [`engine`] | (draw list, pass plan) -> frame | labels, files, documents |
//! | [`label`] | frame + scene + draw list -> annotations | pixels of the picture |
//! | [`export`] | annotations and images -> files | how they came about |
//! | [`job`] | one frame, and many: ranges, workers, progress | formulas |

pub mod base;
pub mod document;
pub mod draw;
pub mod engine;
pub mod export;
pub mod geometry;
pub mod job;
pub mod label;
pub mod library;
pub mod plan;
pub mod sampling;
pub mod scene;
