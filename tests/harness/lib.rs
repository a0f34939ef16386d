//! What the tests share.

pub mod drawlists;
pub mod meshes;
pub mod oracle;
