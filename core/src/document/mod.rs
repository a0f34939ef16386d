//! The config as a typed value.
