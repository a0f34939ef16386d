//! Persons, garments, skeletons and primitive shapes as meshes.
