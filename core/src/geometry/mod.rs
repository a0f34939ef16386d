//! Persons, garments, skeletons and primitive shapes as meshes.

pub mod body;
mod cut;
mod garment;
mod hair;
pub mod person;
pub mod phenotype;
