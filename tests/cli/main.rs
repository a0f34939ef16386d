//! The command line from its arguments to its exit status, over frames that are painted, not
//! rendered: everything but the way from a config to a frame.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod commands;
mod desk;
mod exports;
mod painter;
