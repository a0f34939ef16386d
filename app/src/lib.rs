//! The program `figurant`, as a library that tests can reach.
