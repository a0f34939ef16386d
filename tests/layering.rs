//! No layer imports upwards.
#[test]
fn t() {}
