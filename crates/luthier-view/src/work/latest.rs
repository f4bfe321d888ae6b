//! A slot between threads that holds the latest value only.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// A value that waits for its taker; a newer one replaces it.
#[derive(Debug)]
pub(crate) struct Latest<T> {
    slot: Mutex<Slot<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct Slot<T> {
    value: Option<T>,
    closed: bool,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self { slot: Mutex::new(Slot { value: None, closed: false }), changed: Condvar::new() }
    }
}

impl<T> Latest<T> {
    pub(crate) fn put(&self, value: T) {
        self.lock().value = Some(value);
        self.changed.notify_all();
    }

    /// The value, if there is one.
    pub(crate) fn take(&self) -> Option<T> {
        self.lock().value.take()
    }

    /// Waits for a value; `None` when the slot is closed.
    pub(crate) fn wait(&self) -> Option<T> {
        let filled = self.changed.wait_while(self.lock(), |slot| slot.value.is_none() && !slot.closed);
        let mut slot = filled.unwrap_or_else(PoisonError::into_inner);
        if slot.closed { None } else { slot.value.take() }
    }

    /// True where work on an older value should stop.
    pub(crate) fn is_outdated(&self) -> bool {
        let slot = self.lock();
        slot.closed || slot.value.is_some()
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.lock().closed
    }

    pub(crate) fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Slot<T>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newer_values_replace_older_ones() {
        let slot = Latest::default();
        assert!(!slot.is_outdated());
        slot.put(1);
        slot.put(2);
        assert!(slot.is_outdated());
        assert_eq!(slot.wait(), Some(2));
        assert_eq!(slot.take(), None);
    }

    #[test]
    fn closing_wakes_who_waits() {
        let slot = Latest::<u32>::default();
        std::thread::scope(|scope| {
            let waiter = scope.spawn(|| slot.wait());
            slot.close();
            assert_eq!(waiter.join().unwrap(), None);
        });
        slot.put(1);
        assert_eq!(slot.wait(), None, "closed for good");
    }
}
