//! Results of jobs that outlive one bake.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::graph::{Key, Output};

/// Result of a job: a function of the inputs whose hash is its [`Key`].
#[derive(Debug)]
pub struct Artefact(pub(crate) Output);

/// Results by their keys. A job whose result is here is not run; a store may forget at any time.
pub trait Store: Sync {
    /// The result of a key.
    fn get(&self, key: Key) -> Option<Arc<Artefact>>;
    /// Keeps a result.
    fn put(&self, key: Key, artefact: &Arc<Artefact>);
}

/// A store in memory.
#[derive(Default)]
pub struct MemoryStore {
    kept: Mutex<BTreeMap<Key, Kept>>,
}

struct Kept {
    artefact: Arc<Artefact>,
    is_used: bool,
}

impl MemoryStore {
    /// Number of results.
    pub fn len(&self) -> usize {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Whether there is no result.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Forgets what was neither read nor kept since the last call.
    pub fn sweep(&self) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|_, kept| std::mem::take(&mut kept.is_used));
    }
}

impl Store for MemoryStore {
    fn get(&self, key: Key) -> Option<Arc<Artefact>> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.get_mut(&key)?;
        found.is_used = true;
        Some(Arc::clone(&found.artefact))
    }

    fn put(&self, key: Key, artefact: &Arc<Artefact>) {
        let artefact = Arc::clone(artefact);
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Kept { artefact, is_used: true });
    }
}

impl fmt::Debug for MemoryStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MemoryStore").field("len", &self.len()).finish()
    }
}
