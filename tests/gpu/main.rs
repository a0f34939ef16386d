//! The graphics engine against the native one and the oracle, on whatever adapter there is.
//!
//! With `REQUIRE_GPU=1` a machine without an adapter fails these tests; without it they say that
//! they were skipped. `GPU_ADAPTER` names another adapter than the first.

#![allow(clippy::unwrap_used, reason = "helpers of tests, too, fail by panicking")]

mod common;
mod export;
mod limits;
mod parity;
mod reload;
mod scenes;
mod vertices;
