//! Publishes files into a folder, all or none.
//!
//! Files are staged in `.luthier-new/`. Its renaming to `.luthier-ready/` is the moment of publication: before it the folder holds the old
//! generation, after it [`crate::Folder`] reads the new one. Then every file is moved to its place, the manifest last. A program that is killed in
//! between leaves `.luthier-ready/`, whose files the next publication moves before its own. A `.luthier-new/` that was left is removed. One program
//! publishes into a folder at a time: others wait for its lock on the folder.
//!
//! A file whose bytes are in place already is not staged. It keeps its time of modification, so build systems see that it did not change.
//!
//! Where the names in a manifest contain the hashes of their files ([`crate::Encoded::with_hashed_names`]), only the manifest is replaced. For
//! readers that know nothing of these folders, its renaming is the publication. Files of the previous generation stay for readers that have its
//! manifest, which is kept as `.luthier-before.json`. The next publication removes the files that neither its own manifest nor the one in place
//! names.
//!
//! Nothing is flushed to the disk (`fsync`) before it is published. That cost 150 ms to 200 ms for the 30 files of a bake of `materials` on ext4,
//! against 3 ms to 8 ms without. After a loss of power, files may be empty. Readers detect these by their hashes, and the next bake writes them
//! again, because it compares bytes, not times.

mod names;
mod settle;
mod stage;

pub(crate) use names::hashed;

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use crate::{MANIFEST, PackageError, input};

/// Folder of the files that are being written.
const NEW: &str = ".luthier-new";
/// Folder of complete files that are being moved to their places.
pub(crate) const READY: &str = ".luthier-ready";
/// Manifest of the previous generation, if names contain hashes. Its files stay until the next publication.
const BEFORE: &str = ".luthier-before.json";
/// File that a program locks while it publishes, on systems where it cannot lock the folder.
const LOCK: &str = ".luthier.lock";

/// Name of the file that lists the textures of an environment.
pub const ENVIRONMENT: &str = "environment.json";

/// Files that name others with their hashes.
const LISTS: [&str; 2] = [MANIFEST, ENVIRONMENT];

/// Folder of the report beside the manifest.
pub const REPORT_FOLDER: &str = "report";

/// The report: for programs, for pull requests, and for people.
pub const REPORT_FILES: [&str; 3] = ["report/report.json", "report/report.md", "report/index.html"];

/// Writes all files into a folder, or none; the folder is made if it does not exist. A new manifest or list of an environment also removes the files
/// that its predecessor named and that are not written again, and a manifest the report on the previous bake. Files that the folder already has stay
/// as they are.
///
/// # Errors
/// [`PackageError::Write`]; the folder then holds the files that it held.
pub fn publish(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    publish_where(folder, files, || Ok(()))
}

/// Writes files beside a bake, such as a report on it, as [`publish`] does. The SHA-256 of its manifest identifies the bake.
///
/// # Errors
/// [`PackageError::Rebaked`] where another bake has taken its place; [`PackageError::Write`].
pub fn publish_beside(folder: &Path, manifest_sha256: &str, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    publish_where(folder, files, || {
        let manifest = input::image(&folder.join(MANIFEST)).unwrap_or_default();
        let is_same = crate::sha256(&manifest) == manifest_sha256;
        is_same.then_some(()).ok_or_else(|| PackageError::Rebaked { folder: folder.to_owned() })
    })
}

/// Waits while another program publishes into a folder. [`publish`] waits, too; a program that must not wait there calls this first.
pub fn wait(folder: &Path) {
    if let Ok(handle) = handle(folder) {
        let _ = handle.lock();
    }
}

/// A lock that keeps others from publishing into a folder until it is dropped; `None` where the folder cannot be locked. Its holder must not publish
/// into that folder, which would wait for ever.
pub fn shared(folder: &Path) -> Option<File> {
    let handle = handle(folder).ok()?;
    handle.lock_shared().ok()?;
    Some(handle)
}

/// Publishes under the lock, if `allowed` permits it. If nothing is published, the folders that were made are removed.
fn publish_where(
    folder: &Path,
    files: &[(&str, &[u8])],
    allowed: impl FnOnce() -> Result<(), PackageError>,
) -> Result<(), PackageError> {
    let mut made = Vec::new();
    let (_lock, published) = match lock(folder, &mut made) {
        Ok(lock) => {
            let settled = settle::settle(folder).and_then(|()| allowed());
            (Some(lock), settled.and_then(|()| replace(folder, files)))
        }
        Err(error) => (None, Err(error)),
    };
    if published.is_err() {
        // The innermost was made last. A folder that is not empty stays.
        made.iter().rev().for_each(|folder| drop(std::fs::remove_dir(folder)));
    }
    published
}

/// Locks a folder, which is made if it does not exist.
fn lock(folder: &Path, made: &mut Vec<PathBuf>) -> Result<File, PackageError> {
    loop {
        stage::make(folder, made)?;
        let handle = at("write to", folder, handle(folder))?;
        at("lock", folder, handle.lock())?;
        // While this waited, the folder may have been removed, and made again.
        if stage::is_at(&handle, folder) {
            return Ok(handle);
        }
    }
}

/// Stages the files that are not in place yet, and publishes them.
fn replace(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    let mut files: Vec<_> =
        files.iter().filter(|(path, bytes)| !stage::holds(&folder.join(path), bytes)).copied().collect();
    if files.is_empty() {
        return Ok(());
    }
    let next = files.iter().find(|(path, _)| *path == MANIFEST).map(|(_, next)| String::from_utf8_lossy(next));
    let before = next.filter(|next| names::are_hashed(next)).and_then(|_| std::fs::read(folder.join(MANIFEST)).ok());
    if let Some(before) =
        before.as_deref().filter(|before| !names::named_by(&String::from_utf8_lossy(before)).is_empty())
    {
        files.push((BEFORE, before));
    }
    let (new, ready) = (folder.join(NEW), folder.join(READY));
    let staged = stage::stage(folder, &files);
    if let Err(error) = staged.and_then(|()| at("write to", folder, std::fs::rename(&new, &ready))) {
        let _ = settle::sweep(folder);
        return Err(error);
    }
    settle::settle(folder)
}

/// The bytes of a file of a folder's generation, which an interrupted publication may have left among the files that are ready.
pub(crate) fn current(folder: &Path, path: &str) -> Option<Vec<u8>> {
    [folder.join(READY), folder.to_owned()].iter().find_map(|folder| input::image(&folder.join(path)).ok())
}

/// The existing files that the manifest of a folder names, with forward slashes.
pub(crate) fn named(folder: &Path) -> Vec<String> {
    let Some(manifest) = current(folder, MANIFEST) else { return Vec::new() };
    let named = names::named_by(&String::from_utf8_lossy(&manifest));
    let there = named.into_iter().filter(|path| folder.join(path).is_file());
    there.map(|path| path.to_string_lossy().replace('\\', "/")).collect()
}

/// The file by which a folder is locked: the folder itself, or a file inside it on systems that cannot open folders.
fn handle(folder: &Path) -> io::Result<File> {
    if cfg!(unix) {
        File::open(folder)
    } else {
        OpenOptions::new().create(true).truncate(false).write(true).open(folder.join(LOCK))
    }
}

fn at<T>(action: &'static str, path: &Path, result: io::Result<T>) -> Result<T, PackageError> {
    result.map_err(|source| PackageError::Write { action, path: path.to_owned(), source })
}

/// All files below a folder.
fn list(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { list(&path, files)? } else { files.push(path) }
    }
    files.sort();
    Ok(())
}

#[cfg(test)]
mod tests;
