//! Keyed random numbers.
