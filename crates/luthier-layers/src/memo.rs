//! Memo of a pure function: a bounded number of its values by argument.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Values kept at most; then all are forgotten.
const KEPT: usize = 4096;

/// Values of a pure function by argument. Results do not depend on which values are kept.
#[derive(Debug)]
pub(crate) struct Memo<K, V>(Mutex<BTreeMap<K, V>>);

impl<K: Ord, V: Copy> Memo<K, V> {
    pub(crate) const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The value of a key: `compute`'s, now or before.
    pub(crate) fn get(&self, key: K, compute: impl FnOnce() -> V) -> V {
        if let Some(value) = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return *value;
        }
        // Not under the lock: other threads may compute the same meanwhile, and come to the same value.
        let value = compute();
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= KEPT {
            kept.clear();
        }
        kept.insert(key, value);
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_computed_once_and_forgotten_in_the_end() {
        let memo = Memo::new();
        let mut calls = 0;
        for _ in 0..3 {
            assert_eq!(
                memo.get(7, || {
                    calls += 1;
                    42
                }),
                42
            );
        }
        assert_eq!(calls, 1);
        (0..2 * KEPT).for_each(|key| assert_eq!(memo.get(key + 8, || 1), 1));
        assert!(memo.0.lock().unwrap().len() <= KEPT);
    }
}
