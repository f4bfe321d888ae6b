//! Publication of files into a folder, all or none.
//!
//! Files are staged in `.luthier-new/`. Its renaming to `.luthier-ready/` is the moment of publication: before it the folder
//! holds the old generation, after it [`crate::Folder`] reads the new one. Then every file is moved to its place, the manifest last. A
//! program that was killed between leaves `.luthier-ready/`, whose files the next publication moves before its own; a `.luthier-new/` is
//! removed. One program publishes into a folder at a time: others wait for its lock on the folder.

use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use serde_json::Value;

use crate::{MANIFEST, PackageError};

/// Folder of the files that are being written.
const NEW: &str = ".luthier-new";
/// Folder of complete files that are being moved to their places.
pub(crate) const READY: &str = ".luthier-ready";
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

/// Writes files into a folder, which is made if it does not exist: all of them, or none. Where one is a manifest or the list of an environment, what
/// the one before it named is removed unless it is written again, the report on that bake too.
///
/// # Errors
/// [`PackageError::Write`]; the folder then holds the files that it held.
pub fn publish(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    at("make the folder", folder, std::fs::create_dir_all(folder))?;
    let handle = at("write to", folder, handle(folder))?;
    at("lock", folder, handle.lock())?;
    settle(folder)?;
    let new = folder.join(NEW);
    let staged = stage(folder, &new, files);
    if staged.is_err() {
        let _ = std::fs::remove_dir_all(&new);
    }
    staged?;
    at("write to", folder, std::fs::rename(&new, folder.join(READY)))?;
    settle(folder)
}

/// A lock that keeps others from publishing into a folder; `None` where the folder cannot be locked.
pub(crate) fn shared(folder: &Path) -> Option<File> {
    let handle = handle(folder).ok()?;
    handle.lock_shared().ok()?;
    Some(handle)
}

/// The file by which a folder is locked: the folder itself, or, where folders are no files, one inside it.
fn handle(folder: &Path) -> io::Result<File> {
    if cfg!(unix) {
        File::open(folder)
    } else {
        OpenOptions::new().create(true).truncate(false).write(true).open(folder.join(LOCK))
    }
}

/// Writes all files into a folder of their own, and makes sure that nothing is in the way of any.
fn stage(folder: &Path, new: &Path, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    at("write to", folder, std::fs::create_dir(new))?;
    for (path, bytes) in files {
        let (file, place) = (new.join(path), folder.join(path));
        for parent in [file.parent(), place.parent()].into_iter().flatten() {
            at("make the folder", parent, std::fs::create_dir_all(parent))?;
        }
        if place.is_dir() {
            return at("write", &place, Err(ErrorKind::IsADirectory.into()));
        }
        at("write", &place, std::fs::write(&file, bytes))?;
    }
    Ok(())
}

/// Moves what is ready to its places, the manifest last, and removes what an interrupted program left.
fn settle(folder: &Path) -> Result<(), PackageError> {
    let (new, ready) = (folder.join(NEW), folder.join(READY));
    if new.exists() {
        at("remove", &new, std::fs::remove_dir_all(&new))?;
    }
    if !ready.exists() {
        return Ok(());
    }
    let mut files = Vec::new();
    at("list", &ready, list(&ready, &mut files))?;
    let relative = |file: &PathBuf| file.strip_prefix(&ready).map(Path::to_owned).unwrap_or_default();
    let (lists, others): (Vec<_>, Vec<_>) =
        files.iter().map(relative).partition(|path| LISTS.iter().any(|list| path == Path::new(list)));
    for path in &others {
        at("write", &folder.join(path), std::fs::rename(ready.join(path), folder.join(path)))?;
    }
    for path in lists {
        remove_stale(folder, &path, &ready.join(&path))?;
        at("write", &folder.join(&path), std::fs::rename(ready.join(&path), folder.join(&path)))?;
    }
    at("remove", &ready, std::fs::remove_dir_all(&ready))
}

/// Removes what the list in place names and the next one does not.
fn remove_stale(folder: &Path, list: &Path, next: &Path) -> Result<(), PackageError> {
    // Unreadable is as good as none: it names nothing.
    let [old, next] = [&folder.join(list), next].map(|path| std::fs::read_to_string(path).unwrap_or_default());
    if old == next {
        return Ok(());
    }
    let current: BTreeSet<PathBuf> = named_by(&next).into_iter().chain([list.to_owned()]).collect();
    let mut stale = named_by(&old);
    if stale.is_empty() {
        return Ok(());
    }
    stale.retain(|path| !current.contains(path));
    if list == Path::new(MANIFEST) {
        stale.extend(REPORT_FILES.map(PathBuf::from));
    }
    for path in stale.iter().map(|path| folder.join(path)).filter(|path| path.is_file()) {
        at("remove", &path, std::fs::remove_file(&path))?;
    }
    // Stays if something else is in it.
    let _ = std::fs::remove_dir(folder.join(REPORT_FOLDER));
    Ok(())
}

/// The bytes of a file of the generation that a folder holds, wherever an interrupted publication left it.
pub(crate) fn current(folder: &Path, path: &str) -> Option<Vec<u8>> {
    [folder.join(READY), folder.to_owned()].iter().find_map(|folder| std::fs::read(folder.join(path)).ok())
}

/// The files that the manifest of a folder names and that are there, with forward slashes.
pub(crate) fn named(folder: &Path) -> Vec<String> {
    let Some(manifest) = current(folder, MANIFEST) else { return Vec::new() };
    let named = named_by(&String::from_utf8_lossy(&manifest));
    let there = named.into_iter().filter(|path| folder.join(path).is_file());
    there.map(|path| path.to_string_lossy().replace('\\', "/")).collect()
}

/// The files that a manifest of luthier, of any schema, names with a hash, as far as they lie inside its folder.
fn named_by(manifest: &str) -> Vec<PathBuf> {
    let Ok(manifest) = serde_json::from_str::<Value>(manifest) else { return Vec::new() };
    if !manifest["generator"].as_str().is_some_and(|g| g.starts_with("luthier ")) {
        return Vec::new();
    }
    let mut paths = Vec::new();
    let mut open = vec![&manifest];
    while let Some(value) = open.pop() {
        match value {
            Value::Array(items) => open.extend(items),
            Value::Object(entries) => {
                if let (Some(Value::String(path)), Some(Value::String(_))) =
                    (entries.get("path"), entries.get("sha256"))
                {
                    paths.push(PathBuf::from(path));
                }
                open.extend(entries.values());
            }
            _ => {}
        }
    }
    paths.retain(|path| path.components().all(|part| matches!(part, Component::Normal(_))));
    paths
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

fn at<T>(action: &'static str, path: &Path, result: io::Result<T>) -> Result<T, PackageError> {
    result.map_err(|source| PackageError::Write { action, path: path.to_owned(), source })
}

#[cfg(test)]
mod tests;
