//! Files that a reader sees whole: the old one, or the new one.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::Path;

/// Writes a file beside a path, and puts it in the place of what is there. A link at the path itself is replaced, and not followed.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("a.txt");
/// luthier_export::replace(&path, b"old")?;
/// luthier_export::replace(&path, b"new")?;
/// assert_eq!(std::fs::read(&path)?, b"new");
/// // Nothing else is left.
/// assert_eq!(std::fs::read_dir(folder.path())?.count(), 1);
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// Those of the system; the path has what it had before.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".new-{}", std::process::id()));
    let part = path.with_file_name(name);
    let file = OpenOptions::new().write(true).create_new(true).open(&part);
    file.and_then(|mut file| {
        let written = file.write_all(bytes).and_then(|()| fs::rename(&part, path));
        if written.is_err() {
            // The first reason counts, and not that of what is cleared away.
            let _ = fs::remove_file(&part);
        }
        written
    })
}

/// Writes files into a folder by paths relative to it, and makes the folders that they need.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// luthier_export::lay(folder.path(), [("maps/a.txt".to_owned(), b"a".as_slice())])?;
/// assert_eq!(std::fs::read(folder.path().join("maps/a.txt"))?, b"a");
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// Those of the system; files before the one that failed stay.
pub fn lay<'a>(folder: &Path, files: impl IntoIterator<Item = (String, &'a [u8])>) -> io::Result<()> {
    for (path, bytes) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap_or(folder))?;
        fs::write(path, bytes)?;
    }
    Ok(())
}
