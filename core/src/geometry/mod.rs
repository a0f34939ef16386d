//! Persons, garments, skeletons and primitive shapes as meshes.
//!
//! Functions from a scene's values and the library's assets to points and triangles in model
//! space. Cameras and pixels are not known here.
//!
//! | file | what it does |
//! |---|---|
//! | [`phenotype`] | sliders -> weights of shape targets -> vertex positions |
//! | [`body`] | joints, keypoints, contact points and measures of a body at rest |
//! | `solve` | sliders of the body model from stature and body mass index |
//! | [`person`] | a dressed person at rest: skin, eyes, hair and clothes as one mesh |
//! | `shown` | the skin that is not hidden |
//! | [`surface`] | what the parts of a person look like |
//! | `shell` | the surface out of which clothes are made |
//! | `garment`, `refine`, `cut`, `lookup` | clothes, cut from it along scalar fields |
//! | `clothes`, `layers`, `drape`, `over_seat`, `skirt` | how garments hang, one over the other |
//! | `hair`, `beard`, `lashes`, `headwear`, `glasses` | what grows and sits on the head |
//! | [`skeleton`], [`pose`] | joints, and clips and poses retargeted to a body |
//! | [`hang`], [`sway`] | joints of cloth that hangs round both legs |
//! | [`tress`] | joints of hair that hangs |
//! | [`stance`], `hand` | what joints and fingers are to do |
//! | [`trunk`], `settle` | keep arms out of trunks, lay bodies on the ground |
//! | [`seat`] | what sitting people sit on |
//! | [`points`] | poses single vertices in double precision |
//! | [`shape`] | primitive shapes |
//! | `wide` | functions for processors with wider vectors |

mod beard;
pub mod body;
mod clothes;
mod cut;
mod drape;
mod garment;
mod glasses;
mod hair;
mod hand;
pub mod hang;
mod headwear;
mod lashes;
mod layers;
mod lookup;
mod over_seat;
pub mod person;
pub mod phenotype;
pub mod points;
pub mod pose;
mod refine;
pub mod seat;
mod settle;
pub mod shape;
mod shell;
mod shown;
pub mod skeleton;
mod skirt;
mod solve;
pub mod stance;
pub mod surface;
pub mod sway;
pub mod tress;
pub mod trunk;
mod wide;
