//! The store in a folder.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use luthier_bake::{Artefact, Key, Store, Task};
use tempfile::NamedTempFile;
use thiserror::Error;

use crate::entry::{pack, unpack};

/// Folder of the entries.
pub(crate) const OBJECTS: &str = "objects";

/// Folder of entries that are being written.
pub(crate) const TEMPORARY: &str = "tmp";

/// Age of a mark of use after which a read renews it: a write for every read would be slow.
const MARK_AGE: Duration = Duration::from_secs(3600);

/// Age after which files of killed writers are removed.
const LEFT_AGE: Duration = Duration::from_secs(3600);

/// Why a store cannot be used.
#[derive(Debug, Error)]
#[error("cannot {action} {path}: {source}")]
pub struct StoreError {
    /// The action in words.
    action: &'static str,
    /// The file or folder.
    path: PathBuf,
    /// Error of the system.
    source: io::Error,
}

/// An error of the system about a path of the store.
pub(crate) fn at<T>(action: &'static str, path: &Path, result: io::Result<T>) -> Result<T, StoreError> {
    result.map_err(|source| StoreError { action, path: path.to_owned(), source })
}

/// Results of jobs in a folder.
///
/// A store never makes a bake fail: an unreadable entry is computed again, and an entry that cannot be written is not
/// kept. [`Self::problem`] returns the first reason.
#[derive(Debug)]
pub struct DiskStore {
    pub(crate) root: PathBuf,
    /// Most bytes of all entries.
    pub(crate) limit: u64,
    /// Bytes that this process has written.
    pub(crate) written: AtomicU64,
    problem: Mutex<Option<StoreError>>,
}

impl DiskStore {
    /// Opens the store in a folder, and makes the folder if it does not exist. If entries take more than `limit` bytes
    /// together, [`Self::close`] removes the least recently used ones.
    ///
    /// # Errors
    /// [`StoreError`] where the folder can be neither made nor listed.
    pub fn open(root: &Path, limit: u64) -> Result<Self, StoreError> {
        let temporary = root.join(TEMPORARY);
        at("make the folder", &temporary, fs::create_dir_all(&temporary))?;
        let store = Self { root: root.to_owned(), limit, written: AtomicU64::new(0), problem: Mutex::new(None) };
        store.sweep(&temporary)?;
        Ok(store)
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The first problem; returned once.
    pub fn problem(&self) -> Option<StoreError> {
        self.problem.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Bytes at an address that are not the result of a job.
    pub fn bytes(&self, kind: &str, address: Key) -> Option<Vec<u8>> {
        self.read(kind, address)
    }

    /// Keeps bytes that are not the result of a job.
    pub fn put_bytes(&self, kind: &str, address: Key, bytes: &[u8]) {
        self.write(kind, address, bytes);
    }

    /// Removes files that killed writers left.
    fn sweep(&self, temporary: &Path) -> Result<(), StoreError> {
        for file in at("list", temporary, fs::read_dir(temporary))?.flatten() {
            let age = file.metadata().and_then(|m| m.modified()).ok().and_then(|time| time.elapsed().ok());
            if age.is_some_and(|age| age > LEFT_AGE) {
                // Another process may have removed it.
                let _ = fs::remove_file(file.path());
            }
        }
        Ok(())
    }

    fn path(&self, kind: &str, address: Key) -> PathBuf {
        let hex = address.to_string();
        self.root.join(OBJECTS).join(&hex[..2]).join(format!("{}-{kind}", &hex[2..]))
    }

    /// The result at an address. A damaged entry is removed.
    fn read(&self, kind: &str, address: Key) -> Option<Vec<u8>> {
        let path = self.path(kind, address);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
            Err(error) => return self.note(at("read", &path, Err(error))),
        };
        let Some(result) = unpack(address, &bytes) else {
            return self.note(
                at("read", &path, Err(io::Error::other("the entry is damaged, and is made anew")))
                    .or_else(|damaged| at("remove", &path, fs::remove_file(&path)).and(Err(damaged))),
            );
        };
        let result = result.to_vec();
        mark(&path);
        Some(result)
    }

    fn write(&self, kind: &str, address: Key, result: &[u8]) {
        let bytes = pack(address, result);
        if self.note(self.place(&self.path(kind, address), &bytes)).is_some() {
            self.written.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        }
    }

    /// Writes a file beside its place, and renames it.
    fn place(&self, path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
        let temporary = self.root.join(TEMPORARY);
        let mut file = at("write into", &temporary, temporary_file(&temporary))?;
        at("write into", &temporary, file.write_all(bytes))?;
        if let Some(folder) = path.parent().filter(|folder| !folder.is_dir()) {
            at("make the folder", folder, fs::create_dir_all(folder))?;
        }
        at("write", path, file.persist(path).map(drop).map_err(|error| error.error))
    }

    /// Keeps the first error.
    fn note<T>(&self, result: Result<T, StoreError>) -> Option<T> {
        let noted = result.map_err(|error| {
            self.problem.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        });
        noted.ok()
    }
}

/// A new file with a unique name, which is removed unless it is renamed. Others may read it as they may any new file.
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Marks an entry as used now, if the last mark is old.
fn mark(path: &Path) {
    let marked = fs::metadata(path).and_then(|m| m.modified());
    let is_due = marked.is_ok_and(|time| time.elapsed().is_ok_and(|age| age > MARK_AGE));
    if is_due && let Ok(file) = File::options().append(true).open(path) {
        let _ = file.set_modified(SystemTime::now());
    }
}

impl Store for DiskStore {
    fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
        if !task.is_kept() {
            return None;
        }
        let bytes = self.read(task.kind().name(), task.address())?;
        task.decode(&bytes).map(Arc::new)
    }

    fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
        if task.is_kept()
            && let Some(bytes) = artefact.encode()
        {
            self.write(task.kind().name(), task.address(), &bytes);
        }
    }
}

#[cfg(test)]
mod tests;
