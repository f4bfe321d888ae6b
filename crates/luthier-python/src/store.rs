//! The store of results that all materials of a process share.

use std::path::Path;
use std::sync::{LazyLock, PoisonError, RwLock};

use luthier::{MemoryStore, Store};
use luthier_store::{DEFAULT_LIMIT, DiskStore};
use pyo3::prelude::*;

use crate::fault::file;

static MEMORY: LazyLock<MemoryStore> = LazyLock::new(MemoryStore::default);

/// The folder in use. Functions that are alive keep the store that they began with.
static DISK: RwLock<Option<&'static DiskStore>> = RwLock::new(None);

/// The store in use: a folder, or memory.
pub(crate) fn store() -> &'static dyn Store {
    match *DISK.read().unwrap_or_else(PoisonError::into_inner) {
        Some(disk) => disk,
        None => &*MEMORY,
    }
}

/// Keeps results in a folder; with `None` in memory.
#[pyfunction]
#[pyo3(signature = (folder))]
pub(crate) fn cache(py: Python<'_>, folder: Option<&str>) -> PyResult<()> {
    py.detach(|| {
        let opened = folder.map(|folder| DiskStore::open(Path::new(folder), DEFAULT_LIMIT)).transpose()?;
        let opened = opened.map(|store| &*Box::leak(Box::new(store)));
        let before = std::mem::replace(&mut *DISK.write().unwrap_or_else(PoisonError::into_inner), opened);
        before.map_or(Ok(()), |before| before.close().map(|_| ()))
    })
    .map_err(|error: luthier_store::StoreError| file(error))
}
