//! Size of a store, and removal of entries beyond its limit.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::SystemTime;

use luthier_bake::Key;

use crate::disk::{DiskStore, OBJECTS, StoreError, TEMPORARY, at};
use crate::entry::unpack;

/// File with the number of bytes of all entries, as the last writing process left it.
const USAGE: &str = "usage";

/// File that is locked while [`USAGE`] is updated and entries are removed.
const LOCK: &str = "lock";

/// Share of the limit that stays when entries are removed, in percent. The margin keeps the next bake from removing
/// again.
const KEPT: u64 = 90;

/// Entries of a store, and their bytes.
///
/// ```
/// use luthier_bake::Key;
/// use luthier_store::{DEFAULT_LIMIT, DiskStore};
///
/// # let folder = std::env::temp_dir().join(format!("luthier-store-usage-{}", std::process::id()));
/// let store = DiskStore::open(&folder, DEFAULT_LIMIT)?;
/// store.put_bytes("note", Key::of(b"inputs"), b"result");
/// assert_eq!(store.usage()?.kinds["note"].entries, 1);
/// assert_eq!(store.clear()?.all().entries, 1);
/// assert_eq!(store.usage()?.all().entries, 0);
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), luthier_store::StoreError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Usage {
    /// By kind of job.
    pub kinds: BTreeMap<String, KindUsage>,
}

/// Entries of one kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct KindUsage {
    /// Number of entries.
    pub entries: u64,
    /// Their bytes.
    pub bytes: u64,
}

impl Usage {
    /// All entries together.
    pub fn all(&self) -> KindUsage {
        let kinds = self.kinds.values();
        KindUsage { entries: kinds.clone().map(|kind| kind.entries).sum(), bytes: kinds.map(|kind| kind.bytes).sum() }
    }
}

/// Result of a check of all entries.
///
/// ```
/// use luthier_bake::Key;
/// use luthier_store::{DEFAULT_LIMIT, DiskStore};
///
/// # let folder = std::env::temp_dir().join(format!("luthier-store-verified-{}", std::process::id()));
/// let store = DiskStore::open(&folder, DEFAULT_LIMIT)?;
/// store.put_bytes("note", Key::of(b"inputs"), b"result");
/// let verified = store.verify()?;
/// assert_eq!((verified.whole, verified.damaged.len()), (1, 0));
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), luthier_store::StoreError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Verified {
    /// Entries that are whole.
    pub whole: u64,
    /// Damaged entries, which have been removed.
    pub damaged: Vec<PathBuf>,
}

/// An entry on disk.
struct Found {
    path: PathBuf,
    kind: String,
    address: Option<Key>,
    bytes: u64,
    used: SystemTime,
}

impl DiskStore {
    /// Counts all entries.
    ///
    /// # Errors
    /// [`StoreError`] where the folder cannot be listed.
    pub fn usage(&self) -> Result<Usage, StoreError> {
        let mut usage = Usage::default();
        for Found { kind, bytes, .. } in self.found()? {
            let KindUsage { entries, bytes: sum } = usage.kinds.entry(kind).or_default();
            *entries += 1;
            *sum += bytes;
        }
        Ok(usage)
    }

    /// Reads all entries, and removes those that are damaged.
    ///
    /// # Errors
    /// [`StoreError`] if the folder cannot be listed, or an entry cannot be read or removed.
    pub fn verify(&self) -> Result<Verified, StoreError> {
        let mut verified = Verified::default();
        for Found { path, address, .. } in self.found()? {
            // Another process may have removed it.
            let bytes = match fs::read(&path) {
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                read => at("read", &path, read)?,
            };
            if address.is_some_and(|address| unpack(address, &bytes).is_some()) {
                verified.whole += 1;
            } else {
                remove(&path)?;
                verified.damaged.push(path);
            }
        }
        Ok(verified)
    }

    /// Removes all entries, and returns what there was.
    ///
    /// # Errors
    /// [`StoreError`] where the folder cannot be listed, or an entry not be removed.
    pub fn clear(&self) -> Result<Usage, StoreError> {
        let _lock = self.lock()?;
        let usage = self.usage()?;
        for folder in [OBJECTS, TEMPORARY].map(|name| self.root.join(name)).iter().filter(|folder| folder.exists()) {
            at("remove", folder, fs::remove_dir_all(folder))?;
        }
        self.save(0)?;
        Ok(usage)
    }

    /// Counts the bytes that this process has written, and removes entries beyond the limit, the least recently used
    /// first. To be called at the end of a bake.
    ///
    /// # Errors
    /// [`StoreError`] where files of the store cannot be read, written or removed.
    pub fn close(&self) -> Result<(), StoreError> {
        let written = self.written.swap(0, Ordering::Relaxed);
        if written == 0 {
            return Ok(());
        }
        let _lock = self.lock()?;
        let before = fs::read_to_string(self.root.join(USAGE)).ok().and_then(|text| text.trim().parse::<u64>().ok());
        let all = match before {
            Some(before) => before.saturating_add(written),
            None => self.usage()?.all().bytes,
        };
        if all <= self.limit {
            return self.save(all);
        }
        let mut found = self.found()?;
        found.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
        let mut left: u64 = found.iter().map(|found| found.bytes).sum();
        let wanted = if left > self.limit { self.limit / 100 * KEPT } else { left };
        for Found { path, bytes, .. } in found {
            if left <= wanted {
                break;
            }
            remove(&path)?;
            left -= bytes;
        }
        self.save(left)
    }

    fn save(&self, bytes: u64) -> Result<(), StoreError> {
        let path = self.root.join(USAGE);
        at("write", &path, fs::write(&path, format!("{bytes}\n")))
    }

    fn lock(&self) -> Result<File, StoreError> {
        let path = self.root.join(LOCK);
        let file = at("write", &path, File::options().create(true).append(true).open(&path))?;
        at("lock", &path, file.lock())?;
        Ok(file)
    }

    fn found(&self) -> Result<Vec<Found>, StoreError> {
        let objects = self.root.join(OBJECTS);
        let mut found = Vec::new();
        if !objects.exists() {
            return Ok(found);
        }
        for folder in at("list", &objects, fs::read_dir(&objects))?.flatten().map(|folder| folder.path()) {
            for file in at("list", &folder, fs::read_dir(&folder))?.flatten() {
                // Another process may have removed it.
                let Ok(metadata) = file.metadata() else { continue };
                let (path, name) = (file.path(), file.file_name().to_string_lossy().into_owned());
                let (hex, kind) = name.split_once('-').unwrap_or((&name, ""));
                found.push(Found {
                    address: address(&folder, hex),
                    kind: kind.to_owned(),
                    bytes: metadata.len(),
                    used: metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH),
                    path,
                });
            }
        }
        Ok(found)
    }
}

/// Removes an entry, if it is still there.
fn remove(path: &Path) -> Result<(), StoreError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        removed => at("remove", path, removed),
    }
}

/// The address of a file in a folder.
fn address(folder: &Path, hex: &str) -> Option<Key> {
    Key::parse(&format!("{}{hex}", folder.file_name()?.to_str()?))
}
