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
//! | `garment`, `cut` | clothes, cut from a shell along scalar fields |
//! | `hair`, `beard`, `headwear`, `glasses` | what grows and sits on the head |
//! | [`skeleton`], [`pose`] | joints, and clips retargeted to a body |
//! | [`points`] | poses single vertices in double precision |
//! | [`shape`] | primitive shapes |

mod beard;
pub mod body;
mod cut;
mod garment;
mod glasses;
mod hair;
mod headwear;
pub mod person;
pub mod phenotype;
pub mod points;
pub mod pose;
pub mod shape;
pub mod skeleton;
pub mod surface;
