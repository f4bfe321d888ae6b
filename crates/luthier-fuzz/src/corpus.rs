//! Checked-in inputs: `corpus/TARGET/`, a file each, and files that the repository has for other purposes.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::Target;

/// Bytes of the longest input that tests change. Longer ones would take the time of the others.
const LENGTH_MAX: u64 = 16 << 10;

/// An input of the corpus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The file.
    pub path: PathBuf,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The inputs of a target: its own by name, then those of its other folders. Long files are left out.
///
/// # Errors
/// Errors of the system, with the path. Every target has a folder.
pub fn corpus(target: &Target) -> io::Result<Vec<Input>> {
    let mut inputs = Vec::new();
    for folder in folders(target) {
        let found = inputs_in(&folder);
        inputs.extend(found.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", folder.display())))?);
    }
    Ok(inputs)
}

fn inputs_in(folder: &Path) -> io::Result<Vec<Input>> {
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    let mut inputs = Vec::new();
    for path in paths {
        let about = path.metadata()?;
        if about.is_file() && about.len() <= LENGTH_MAX {
            inputs.push(Input { bytes: fs::read(&path)?, path });
        }
    }
    Ok(inputs)
}

/// The folders of a target, its own first.
pub fn folders(target: &Target) -> Vec<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    std::iter::once(own).chain(target.folders.iter().map(|folder| root.join(folder))).collect()
}
