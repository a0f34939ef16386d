//! Persons, garments, skeletons and primitive shapes as meshes.
//!
//! Functions from a scene's values and the library's assets to points and triangles in model
//! space. Cameras and pixels are not known here.

pub mod points;
pub mod pose;
pub mod shape;
pub mod skeleton;
