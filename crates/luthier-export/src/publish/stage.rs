//! Stages files: writes them into a folder of their own, and checks that nothing can stop their publication later.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::settle::stale;
use super::{LISTS, NEW, at};
use crate::PackageError;

/// Makes a folder and its parents, and notes those that it made, the outermost first.
pub(super) fn make(folder: &Path, made: &mut Vec<PathBuf>) -> Result<(), PackageError> {
    let missing: Vec<&Path> = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.is_dir()).collect();
    for missing in missing.into_iter().rev() {
        match std::fs::create_dir(missing) {
            Ok(()) => made.push(missing.to_owned()),
            // Another program has just made it.
            Err(error) if error.kind() == ErrorKind::AlreadyExists && missing.is_dir() => {}
            Err(error) => return at("make the folder", missing, Err(in_the_way(missing, error))),
        }
    }
    Ok(())
}

/// The error of a folder that cannot be made. If something is in its way, its words do not depend on the system.
fn in_the_way(folder: &Path, error: io::Error) -> io::Error {
    match std::fs::symlink_metadata(folder) {
        Ok(found) if found.is_symlink() => io::Error::other("a broken link is in its place"),
        Ok(_) => io::Error::other("a file is in its place"),
        Err(_) => error,
    }
}

/// True where a place holds a regular file with these bytes.
pub(super) fn holds(place: &Path, bytes: &[u8]) -> bool {
    std::fs::symlink_metadata(place).is_ok_and(|found| found.is_file() && found.len() == bytes.len() as u64)
        && std::fs::read(place).is_ok_and(|found| found == bytes)
}

/// Writes all files into a folder of their own, and checks that nothing is in the way at their places.
pub(super) fn stage(folder: &Path, files: &[(&str, &[u8])]) -> Result<(), PackageError> {
    let new = folder.join(NEW);
    at("write to", folder, std::fs::create_dir(&new))?;
    let mut parents = BTreeSet::new();
    for (path, bytes) in files {
        let (file, place) = (new.join(path), folder.join(path));
        if place.is_dir() {
            return at("write", &place, Err(ErrorKind::IsADirectory.into()));
        }
        // The folder in `.luthier-new` comes first: if the program ends here, a sweep knows from it which folders were made at their places.
        [file.parent(), place.parent()].into_iter().flatten().try_for_each(|parent| make(parent, &mut Vec::new()))?;
        parents.extend(place.parent().map(Path::to_owned));
        at("write", &place, std::fs::write(&file, bytes))?;
    }
    for (list, next) in files.iter().filter(|(path, _)| LISTS.contains(path)) {
        let stale = stale(folder, Path::new(list), &String::from_utf8_lossy(next));
        parents.extend(stale.iter().filter(|path| path.is_file()).filter_map(|path| path.parent().map(Path::to_owned)));
    }
    parents.iter().try_for_each(|parent| at("write to", parent, takes_files(parent, &new)))
}

/// True where files can be moved from one folder into another and out of it: permissions allow it, and the file system is the same.
#[cfg(unix)]
fn takes_files(parent: &Path, from: &Path) -> io::Result<()> {
    use std::os::unix::fs::MetadataExt;

    use rustix::fs::{Access, AtFlags, CWD, accessat};

    accessat(CWD, parent, Access::WRITE_OK | Access::EXEC_OK, AtFlags::EACCESS)?;
    if parent.metadata()?.dev() == from.metadata()?.dev() {
        Ok(())
    } else {
        Err(io::Error::new(ErrorKind::CrossesDevices, "it lies on another file system than the folder of the bake"))
    }
}

/// True where an open folder, or the file of its lock, is the one at this path.
#[cfg(unix)]
pub(super) fn is_at(handle: &File, folder: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let (Ok(open), Ok(there)) = (handle.metadata(), folder.metadata()) else { return false };
    (open.dev(), open.ino()) == (there.dev(), there.ino())
}

/// True where the folder of an open lock is at this path: on these systems it cannot be removed while the lock is open.
#[cfg(not(unix))]
pub(super) fn is_at(_: &File, folder: &Path) -> bool {
    folder.is_dir()
}

#[cfg(not(unix))]
fn takes_files(_: &Path, _: &Path) -> io::Result<()> {
    Ok(())
}
