//! The native engine against the brute-force oracle, closed forms, and itself in other forms.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod common;
mod labels;
mod lens;
mod limits;
mod motion;
mod optics;
mod picture;
