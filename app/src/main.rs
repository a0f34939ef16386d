//! The program `figurant`.
fn main() {}
