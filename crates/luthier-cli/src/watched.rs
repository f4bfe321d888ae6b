//! States of files, by which changes are found.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use luthier::named_files;
use luthier_material::Material;

/// Time of the last change and length of a file.
pub(crate) type State = (SystemTime, u64);

/// The state of a file; `None` where it cannot be read.
pub(crate) fn state(path: &Path) -> Option<State> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// A file with its state.
pub(crate) fn seen(path: PathBuf) -> (PathBuf, Option<State>) {
    let state = state(&path);
    (path, state)
}

/// The files that materials name, each once, by their paths.
pub(crate) fn all_named(materials: &[Material]) -> Vec<PathBuf> {
    materials.iter().flat_map(named_files).collect::<BTreeSet<_>>().into_iter().collect()
}
