//! Frame + scene + draw list -> annotations.

pub mod annotation;

pub use annotation::Annotations;
