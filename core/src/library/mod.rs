//! Assets by id: human figures, motion clips, textures and meshes.
//!
//! The only door to asset files. Values of this layer are immutable and shared by `Arc`; ids and
//! content hashes are what scenes and manifests hold. What a frame shows is not decided here.

pub mod figure;
pub mod mesh;
pub mod texture;
