//! Values by number, for meshes that are cut: many look-ups, small numbers, no order.
//!
//! What is in a table is never listed, so nothing depends on how it is laid out.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Values by vertex or [`edge`].
pub(super) type Lookup<V> = HashMap<u32, V, BuildHasherDefault<Spread>>;

/// The key of an edge, whichever way it is gone.
pub(super) const fn edge(a: u16, b: u16) -> u32 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (low as u32) << 16 | high as u32
}

/// Hashes one number by a product with the golden ratio (Knuth, "The Art of Computer Programming"
/// 3, 6.4): keys are our own, so that nobody can choose those that collide.
#[derive(Default)]
pub(super) struct Spread(u64);

impl Hasher for Spread {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u32((*byte).into()));
    }

    fn write_u32(&mut self, number: u32) {
        let product = (self.0 ^ u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        // Tables look at the lowest bits and the highest.
        self.0 = product ^ product >> 32;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_the_same_both_ways_and_no_other() {
        assert_eq!(edge(7, 3), edge(3, 7));
        assert_ne!(edge(7, 3), edge(7, 4));
    }
}
