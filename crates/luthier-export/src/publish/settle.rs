//! Moves files that are ready to their places, and removes the files that they replace. Names with hashes replace nothing; then the files of the
//! generation before the last are removed.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use super::names::{are_hashed, named_by};
use super::{BEFORE, LISTS, NEW, READY, REPORT_FILES, at, list};
use crate::{MANIFEST, PackageError};

/// Moves the files that are ready to their places, the manifest last, and removes what an interrupted program left.
pub(super) fn settle(folder: &Path) -> Result<(), PackageError> {
    sweep(folder)?;
    let ready = folder.join(READY);
    if !ready.exists() {
        return Ok(());
    }
    let mut files = Vec::new();
    at("list", &ready, list(&ready, &mut files))?;
    let paths = files.iter().map(|file| file.strip_prefix(&ready).map(Path::to_owned).unwrap_or_default());
    let (lists, others): (Vec<_>, Vec<_>) = paths.partition(|path| LISTS.iter().any(|list| path == Path::new(list)));
    let (before, others): (Vec<_>, Vec<_>) = others.into_iter().partition(|path| path == Path::new(BEFORE));
    others.iter().try_for_each(|path| place(folder, path))?;
    for list in lists {
        remove_stale(folder, &list, &text(&ready.join(&list)))?;
        if list == Path::new(MANIFEST) {
            // The files of the kept manifest are gone. It becomes the manifest that is about to be replaced.
            before.iter().try_for_each(|path| place(folder, path))?;
        }
        place(folder, &list)?;
    }
    at("remove", &ready, std::fs::remove_dir_all(&ready))
}

/// Moves a file that is ready to its place.
fn place(folder: &Path, path: &Path) -> Result<(), PackageError> {
    let place = folder.join(path);
    // The folder may be gone if a user tidied up after an interrupted publication.
    place.parent().map_or(Ok(()), |parent| at("make the folder", parent, std::fs::create_dir_all(parent)))?;
    at("write", &place, std::fs::rename(folder.join(READY).join(path), &place))
}

/// The text of a list. One that cannot be read is empty, because it names nothing.
fn text(list: &Path) -> String {
    std::fs::read_to_string(list).unwrap_or_default()
}

/// Removes files that were not published, and the folders that were made for them at their places.
pub(super) fn sweep(folder: &Path) -> Result<(), PackageError> {
    let new = folder.join(NEW);
    if !new.exists() {
        return Ok(());
    }
    let mut folders = Vec::new();
    at("list", &new, list_folders(&new, &mut folders))?;
    // The innermost come last. A folder that is not empty stays.
    for inner in folders.iter().rev().filter_map(|inner| inner.strip_prefix(&new).ok()) {
        let _ = std::fs::remove_dir(folder.join(inner));
    }
    at("remove", &new, std::fs::remove_dir_all(&new))
}

/// All folders below a folder.
fn list_folders(folder: &Path, folders: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            folders.push(entry.path());
            list_folders(&entry.path(), folders)?;
        }
    }
    Ok(())
}

/// Removes the files that are [`stale`], and the folders that this empties.
fn remove_stale(folder: &Path, list: &Path, next: &str) -> Result<(), PackageError> {
    for path in stale(folder, list, next) {
        if path.is_file() {
            at("remove", &path, std::fs::remove_file(&path))?;
        }
        // A folder stays if something else is in it.
        path.ancestors().skip(1).take_while(|f| *f != folder).take_while(|f| std::fs::remove_dir(f).is_ok()).count();
    }
    Ok(())
}

/// The files to remove: those that the list in place names and the next one does not. If names contain hashes, they are the files of the list before
/// the one in place that neither of the two names. Some may not exist.
pub(super) fn stale(folder: &Path, list: &Path, next: &str) -> Vec<PathBuf> {
    let old = text(&folder.join(list));
    let replaced = if old == next { Vec::new() } else { named_by(&old) };
    if replaced.is_empty() {
        return Vec::new();
    }
    let mut current: BTreeSet<PathBuf> = named_by(next).into_iter().chain([list.to_owned()]).collect();
    let mut stale = Vec::new();
    if list == Path::new(MANIFEST) {
        stale.extend(named_by(&text(&folder.join(BEFORE))));
        if are_hashed(next) {
            current.extend(replaced);
        } else {
            stale.extend(replaced.into_iter().chain([PathBuf::from(BEFORE)]));
        }
        stale.extend(REPORT_FILES.map(PathBuf::from));
    } else {
        stale.extend(replaced);
    }
    stale.retain(|path| !current.contains(path));
    stale.iter().map(|path| folder.join(path)).collect()
}
