//! Persons, garments, skeletons and primitive shapes as meshes.
//!
//! Functions from a scene's values and the library's assets to points and triangles in model
//! space. Cameras and pixels are not known here.
//!
//! | file | what it does |
//! |---|---|
//! | [`phenotype`] | sliders -> weights of shape targets -> vertex positions |
//! | [`body`] | joints, keypoints, contact points and measures of a body at rest |
//! | [`person`] | a dressed person at rest: skin, eyes, hair and clothes as one mesh |
//! | [`surface`] | what the parts of a person look like |
//! | `garment`, `hair`, `cut` | clothes and hair, cut from shells along scalar fields |
//! | `clothes`, `layers`, `drape`, `skirt` | how garments hang, one over the other |
//! | [`skeleton`], [`pose`] | joints, and clips retargeted to a body |
//! | [`points`] | poses single vertices in double precision |
//! | [`shape`] | primitive shapes |

pub mod body;
mod clothes;
mod cut;
mod drape;
mod garment;
mod hair;
mod layers;
pub mod person;
pub mod phenotype;
pub mod points;
pub mod pose;
pub mod shape;
pub mod skeleton;
mod skirt;
pub mod surface;
