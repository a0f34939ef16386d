//! What the tests share.

pub mod crowd;
pub mod drawlists;
pub mod light;
pub mod limbs;
pub mod meshes;
pub mod oracle;
pub mod solid;
pub mod worn;
