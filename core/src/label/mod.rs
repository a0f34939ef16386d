//! Frame + scene + draw list -> annotations.
