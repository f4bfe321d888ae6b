//! Output that appears all at once, or not at all.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::failure::{Outcome, files};

/// A folder beside the final files. What is written here is moved into place by [`Staging::publish`]; dropped before that, it
/// leaves no trace.
pub(crate) struct Staging {
    target: PathBuf,
    folder: TempDir,
    written: Vec<String>,
}

impl Staging {
    /// Stages files for a folder, which is made if it does not exist.
    pub(crate) fn for_folder(target: &Path) -> Outcome<Self> {
        std::fs::create_dir_all(target).map_err(files(target, "make the folder"))?;
        let folder =
            tempfile::Builder::new().prefix(".staging-").tempdir_in(target).map_err(files(target, "write to"))?;
        Ok(Self { target: target.to_owned(), folder, written: Vec::new() })
    }

    /// Writes a file under a path relative to the target, with forward slashes.
    pub(crate) fn write(&mut self, path: &str, bytes: &[u8]) -> Outcome {
        let file = self.folder.path().join(path);
        if let Some(parent) = file.parent() {
            std::fs::create_dir_all(parent).map_err(files(parent, "make the folder"))?;
        }
        std::fs::write(&file, bytes).map_err(files(&file, "write"))?;
        self.written.push(path.to_owned());
        Ok(())
    }

    /// Moves all files into place in the order in which they were written, once every folder for them is there and no folder is
    /// in a file's place.
    pub(crate) fn publish(self) -> Outcome {
        for path in &self.written {
            let to = self.target.join(path);
            if let Some(parent) = to.parent() {
                std::fs::create_dir_all(parent).map_err(files(parent, "make the folder"))?;
            }
            if to.is_dir() {
                return Err(files(&to, "write")(std::io::ErrorKind::IsADirectory.into()));
            }
        }
        for path in &self.written {
            let to = self.target.join(path);
            std::fs::rename(self.folder.path().join(path), &to).map_err(files(&to, "write"))?;
        }
        Ok(())
    }
}
