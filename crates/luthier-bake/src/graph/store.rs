//! Results of jobs that outlive one bake.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use crate::graph::{Artefact, Job, JobKind, Key};

/// A job as stores know it.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    kind: JobKind,
    address: Key,
    result: Form<'a>,
}

/// How the bytes of a result are read.
#[derive(Debug, Clone, Copy)]
enum Form<'a> {
    Job(&'a dyn Job),
    Function(fn(&[u8]) -> Option<Artefact>),
}

impl<'a> Task<'a> {
    /// A task without a job: `decode` reads the bytes at its address.
    pub(crate) fn new(kind: JobKind, address: Key, decode: fn(&[u8]) -> Option<Artefact>) -> Self {
        Self { kind, address, result: Form::Function(decode) }
    }

    pub(crate) fn of(job: &'a dyn Job, address: Key) -> Self {
        Self { kind: job.kind(), address, result: Form::Job(job) }
    }

    /// Kind of the job.
    pub fn kind(&self) -> JobKind {
        self.kind
    }

    /// Hash of everything that decides the bytes of the result: kind, inputs and revision of the job and of its
    /// dependencies, and the version of this crate.
    pub fn address(&self) -> Key {
        self.address
    }

    /// Whether the result is worth storing beyond the process.
    pub fn is_kept(&self) -> bool {
        match self.result {
            Form::Job(job) => job.is_kept(),
            Form::Function(_) => true,
        }
    }

    /// Reads the bytes of [`Artefact::encode`]; `None` for other bytes.
    pub fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        match self.result {
            Form::Job(job) => job.decode(bytes),
            Form::Function(decode) => decode(bytes),
        }
    }
}

/// Results by their addresses. A job does not run if its result is here. A store may forget at any time.
pub trait Store: Sync {
    /// The result of a job.
    fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>>;

    /// Keeps a result.
    fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>);

    /// Marks a result as used that is not read now, because the result of a dependant is there.
    fn touch(&self, _task: &Task<'_>) {}

    /// The results of some jobs, in their order. Remote stores fetch them at once.
    fn get_all(&self, tasks: &[Task<'_>]) -> Vec<Option<Arc<Artefact>>> {
        tasks.par_iter().map(|task| self.get(task)).collect()
    }
}

/// A store in memory.
///
/// ```
/// use luthier_bake::{Function, MemoryStore};
///
/// let store = MemoryStore::default();
/// Function { kind: "square", revision: 1 }.keep(&serde_json::json!(3), &store, 9_u32);
/// store.sweep(); // The result was kept since the last call: it stays.
/// assert_eq!(store.len(), 1);
/// store.sweep();
/// assert!(store.is_empty());
/// ```
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

    /// Forgets every result that was neither read, touched nor kept since the last call.
    pub fn sweep(&self) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|_, kept| std::mem::take(&mut kept.is_used));
    }
}

impl Store for MemoryStore {
    fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.get_mut(&task.address())?;
        found.is_used = true;
        Some(Arc::clone(&found.artefact))
    }

    fn touch(&self, task: &Task<'_>) {
        if let Some(kept) = self.kept.lock().unwrap_or_else(PoisonError::into_inner).get_mut(&task.address()) {
            kept.is_used = true;
        }
    }

    fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
        let artefact = Arc::clone(artefact);
        self.kept
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(task.address(), Kept { artefact, is_used: true });
    }
}

impl fmt::Debug for MemoryStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MemoryStore").field("len", &self.len()).finish()
    }
}
