//! What was made once and may be wanted again, up to a limit of memory.
//!
//! Values by key, shared between threads. What is kept never depends on who asks, only how long
//! the answer takes does, so nothing made from cached values depends on the cache.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Values by key; when they grow beyond a limit, the one used longest ago is dropped first.
#[derive(Debug)]
pub struct Cache<K, V> {
    limit_bytes: usize,
    state: Mutex<State<K, V>>,
}

/// A value, once it is made. Its lock is held while it is being made.
type Slot<V> = Arc<Mutex<Option<Arc<V>>>>;

#[derive(Debug)]
struct State<K, V> {
    entries: BTreeMap<K, Entry<V>>,
    /// Keys by when they were last used.
    by_use: BTreeMap<u64, K>,
    size_bytes: usize,
    clock: u64,
}

#[derive(Debug)]
struct Entry<V> {
    slot: Slot<V>,
    last_used: u64,
    size_bytes: usize,
}

/// A thread that panicked leaves at worst a value uncounted or unmade: all stays usable.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<K: Ord + Clone, V> Cache<K, V> {
    /// An empty cache that keeps up to so many bytes. The value used last always stays.
    #[must_use]
    pub const fn new(limit_bytes: usize) -> Self {
        let state =
            State { entries: BTreeMap::new(), by_use: BTreeMap::new(), size_bytes: 0, clock: 0 };
        Self { limit_bytes, state: Mutex::new(state) }
    }

    /// Bytes that the kept values occupy.
    #[must_use]
    pub fn size_bytes(&self) -> usize {
        lock(&self.state).size_bytes
    }

    /// The value of a key, made if it is not there. Whoever asks for the same key meanwhile waits
    /// for it; `make` must therefore not wait for other threads.
    ///
    /// # Errors
    /// Those of `make`; the next to ask tries again.
    pub fn get_or_make<E>(
        &self,
        key: &K,
        size_bytes: impl FnOnce(&V) -> usize,
        make: impl FnOnce() -> Result<V, E>,
    ) -> Result<Arc<V>, E> {
        let slot = lock(&self.state).slot(key);
        let mut value = lock(&slot);
        if let Some(known) = &*value {
            return Ok(Arc::clone(known));
        }
        let made = Arc::new(make()?);
        *value = Some(Arc::clone(&made));
        drop(value);
        let size_bytes = size_bytes(&made);
        lock(&self.state).grow(key, &slot, size_bytes, self.limit_bytes);
        Ok(made)
    }
}

impl<K: Ord + Clone, V> State<K, V> {
    /// The place of a key's value, marked as used now.
    fn slot(&mut self, key: &K) -> Slot<V> {
        self.clock += 1;
        let now = self.clock;
        let new = || Entry { slot: Slot::default(), last_used: now, size_bytes: 0 };
        let entry = self.entries.entry(key.clone()).or_insert_with(new);
        self.by_use.remove(&entry.last_used);
        entry.last_used = now;
        self.by_use.insert(now, key.clone());
        Arc::clone(&entry.slot)
    }

    /// Counts a value that was made, unless it was dropped meanwhile, and drops old ones.
    fn grow(&mut self, key: &K, slot: &Slot<V>, size_bytes: usize, limit_bytes: usize) {
        match self.entries.get_mut(key) {
            Some(entry) if Arc::ptr_eq(&entry.slot, slot) => entry.size_bytes = size_bytes,
            _ => return,
        }
        self.size_bytes += size_bytes;
        while self.size_bytes > limit_bytes && self.entries.len() > 1 {
            let Some((_, oldest)) = self.by_use.pop_first() else { return };
            if let Some(entry) = self.entries.remove(&oldest) {
                self.size_bytes -= entry.size_bytes;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Asks for a number, which counts as so many bytes; the second is whether it was made.
    fn get(cache: &Cache<u32, u32>, key: u32, size_bytes: usize) -> (u32, bool) {
        let mut made = false;
        let make = || {
            made = true;
            Ok::<_, Infallible>(key * 10)
        };
        let Ok(value) = cache.get_or_make(&key, |_| size_bytes, make);
        (*value, made)
    }

    #[test]
    fn what_was_used_longest_ago_is_dropped_first() {
        let cache = Cache::new(30);
        for key in 1..=3 {
            assert_eq!(get(&cache, key, 10), (key * 10, true));
        }
        assert_eq!(get(&cache, 1, 10), (10, false));
        assert_eq!(get(&cache, 4, 10), (40, true), "2 is dropped, 1 was used since");
        assert_eq!(cache.size_bytes(), 30);
        assert_eq!(get(&cache, 1, 10), (10, false));
        assert_eq!(get(&cache, 2, 10), (20, true));
        assert_eq!(get(&cache, 9, 1000), (90, true), "the last one stays whatever its size");
        assert_eq!(get(&cache, 9, 1000), (90, false));
        assert_eq!(cache.size_bytes(), 1000);
    }

    #[test]
    fn a_failure_is_tried_again() {
        let cache = Cache::<u32, u32>::new(10);
        assert_eq!(cache.get_or_make(&7, |_| 1, || Err("no")), Err("no"));
        assert_eq!(get(&cache, 7, 1), (70, true));
    }

    #[test]
    fn threads_that_want_the_same_make_it_once() {
        let (cache, made) = (Cache::<u32, u32>::new(1000), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for key in 0..50 {
                        let make = || {
                            made.fetch_add(1, Ordering::Relaxed);
                            Ok::<_, Infallible>(key)
                        };
                        let Ok(value) = cache.get_or_make(&key, |_| 1, make);
                        assert_eq!(*value, key);
                    }
                });
            }
        });
        assert_eq!(made.into_inner(), 50);
    }
}
