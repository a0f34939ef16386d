//! Values by number, for meshes that are cut: many look-ups, small numbers, no order.
//!
//! Open addressing in a table that is at most half full (Knuth, "The Art of Computer Programming"
//! 3, 6.4, algorithm L). What is in it is never listed, so nothing depends on how it is laid out.

/// Values by key; [`u32::MAX`] is no key.
pub(super) struct Lookup<V> {
    slots: Vec<(u32, V)>,
    count: usize,
}

const FREE: u32 = u32::MAX;

/// The key of an edge, whichever way it is gone.
pub(super) const fn edge(a: u16, b: u16) -> u32 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (low as u32) << 16 | high as u32
}

impl<V: Copy + Default> Lookup<V> {
    pub fn new() -> Self {
        Self { slots: vec![(FREE, V::default()); 256], count: 0 }
    }

    /// Where a key is, or where it would be put.
    fn slot(&self, key: u32) -> usize {
        let mask = self.slots.len() - 1;
        // Multiplication by the golden ratio spreads neighbouring keys (Knuth, 6.4).
        let mut i = (key.wrapping_mul(0x9e37_79b9) >> 8) as usize & mask;
        while self.slots[i].0 != key && self.slots[i].0 != FREE {
            i = (i + 1) & mask;
        }
        i
    }

    pub fn get(&self, key: u32) -> Option<V> {
        let (found, value) = self.slots[self.slot(key)];
        (found == key).then_some(value)
    }

    /// Sets a key's value.
    pub fn set(&mut self, key: u32, value: V) {
        let mut i = self.slot(key);
        if self.slots[i].0 == FREE {
            self.count += 1;
            if self.count * 2 > self.slots.len() {
                self.grow();
                i = self.slot(key);
            }
        }
        self.slots[i] = (key, value);
    }

    fn grow(&mut self) {
        let larger = vec![(FREE, V::default()); self.slots.len() * 4];
        for (key, value) in std::mem::replace(&mut self.slots, larger) {
            if key != FREE {
                let i = self.slot(key);
                self.slots[i] = (key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_set_last_is_found_and_nothing_else() {
        let mut table = Lookup::new();
        let keys: Vec<u32> = (0..5000u16).map(|i| edge(i % 71, i)).collect();
        let mut last = std::collections::BTreeMap::new();
        for (i, &key) in keys.iter().enumerate() {
            assert_eq!(table.get(key), last.get(&key).copied(), "{key}");
            table.set(key, i);
            last.insert(key, i);
        }
        for key in keys {
            assert_eq!(table.get(key), last.get(&key).copied());
        }
        assert_eq!(table.get(edge(4000, 4001)), None);
        assert_eq!(edge(7, 3), edge(3, 7));
    }
}
