//! The window: its controls by their names, and the preview behind it, over real configs with small
//! pictures. No window system is needed; `.ci/check_window.py` opens a real window.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod common;
mod controls;
mod preview;
