//! Paths of files that users name, and the files of folders.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::Error;

/// Finds the files of paths: files, and the `*.toml` of folders. Each is listed once, in the order given and by name within a folder.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// # let folder = tempfile::tempdir()?;
/// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
/// std::fs::write(folder.path().join("notes.md"), "")?;
///
/// let files = luthier::find(&[folder.path().to_owned(), folder.path().join("chalk.toml")])?;
/// assert_eq!(files, [folder.path().join("chalk.toml")]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::File`], [`Error::NoFiles`].
pub fn find(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for path in paths {
        let here = if path.is_dir() { toml_files(path)? } else { vec![path.clone()] };
        if here.is_empty() {
            return Err(Error::NoFiles { folder: path.display().to_string() });
        }
        found.extend(here.into_iter().filter(|path| seen.insert(same(path))));
    }
    Ok(found)
}

/// The `*.toml` of the folders inside the folders among `paths`, each with the name and the path of its folder, in their order.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// # let folder = tempfile::tempdir()?;
/// let inner = folder.path().join("minerals");
/// std::fs::create_dir(&inner)?;
/// std::fs::write(inner.join("chalk.toml"), chalk)?;
///
/// let found = luthier::inner_files(&[folder.path().to_owned()])?;
/// assert_eq!(found, [("minerals".to_owned(), inner.clone(), inner.join("chalk.toml"))]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::File`].
pub fn inner_files(paths: &[PathBuf]) -> Result<Vec<(String, PathBuf, PathBuf)>, Error> {
    let mut all = Vec::new();
    for folder in paths.iter().filter(|path| path.is_dir()) {
        for (name, inner) in folders(folder)? {
            all.extend(toml_files(&inner)?.into_iter().map(|file| (name.clone(), inner.clone(), file)));
        }
    }
    Ok(all)
}

/// A path without links, if the file exists. Paths of one file are then equal.
pub(crate) fn same(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// The path of a file that another file names.
pub(crate) fn beside(file: &str, named: &str) -> PathBuf {
    folder(Path::new(file)).join(named)
}

/// The folder of a file.
pub(crate) fn folder(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The `*.toml` of a folder, by name.
fn toml_files(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut paths = entries(folder)?;
    // A broken link is kept: reading it is an error, and leaving it out would bake without it in silence.
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml") && !path.is_dir());
    Ok(paths)
}

/// The folders inside a folder, with their names.
fn folders(folder: &Path) -> Result<Vec<(String, PathBuf)>, Error> {
    let inside = entries(folder)?.into_iter().filter(|path| path.is_dir());
    Ok(inside.filter_map(|path| Some((path.file_name()?.to_string_lossy().into_owned(), path))).collect())
}

/// All that a folder holds, by name.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let listed: std::io::Result<Vec<PathBuf>> =
        std::fs::read_dir(folder).and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
    let mut paths = listed.map_err(|source| Error::file("list", folder, source))?;
    paths.sort();
    Ok(paths)
}
