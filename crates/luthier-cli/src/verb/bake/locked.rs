//! The lock beside the materials: decisions of a search that stay until a budget breaks, and numbers of materials.

use std::path::{Path, PathBuf};

use luthier_export::input;
use luthier_manifest::{Decision, Lock, Manifest};
use luthier_terminal::{Failure, Outcome, files};

/// Name of the file.
const NAME: &str = "luthier.lock";

/// The lock of a folder of materials; empty where there is none.
pub(super) struct LockFile {
    path: PathBuf,
    text: Option<String>,
    lock: Option<Lock>,
    /// Names of materials in the order of their numbers.
    names: Vec<String>,
    /// True where the decisions are made anew.
    is_asked: bool,
}

impl LockFile {
    /// The lock in the folder of the first path.
    ///
    /// # Errors
    /// [`Failure::Files`] where it cannot be read, [`Failure::Input`] where it is no lock.
    pub(super) fn beside(paths: &[PathBuf], is_asked: bool) -> Outcome<Self> {
        let first = paths.first().map_or(Path::new(""), PathBuf::as_path);
        let folder = if first.is_dir() { first } else { first.parent().unwrap_or(Path::new("")) };
        let path = folder.join(NAME);
        let text = if path.exists() { Some(input::text(&path).map_err(files(&path, "read"))?) } else { None };
        let found = text.as_ref().map(|text| {
            Lock::from_json(text).map_err(|reason| {
                let path = path.display();
                Failure::Input(anyhow::anyhow!(
                    "{path}: it is no lock of luthier: {reason}\nhint: write it anew with --relock"
                ))
            })
        });
        // Decisions are made anew where that is asked for, and numbers stay.
        let (lock, names) = match found {
            Some(Ok(lock)) => (Some(lock.clone()).filter(|_| !is_asked), lock.materials),
            Some(Err(_)) if is_asked => (None, Vec::new()),
            Some(Err(failure)) => return Err(failure),
            None => (None, Vec::new()),
        };
        Ok(Self { path, text, lock, names, is_asked })
    }

    /// The file, if it is there.
    pub(super) fn file(&self) -> Option<&Path> {
        self.text.as_ref().map(|_| self.path.as_path())
    }

    /// The text of the file.
    pub(super) fn text(&self) -> &str {
        self.text.as_deref().unwrap_or_default()
    }

    /// Names of the materials whose numbers stay, in their order.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The decisions that stay.
    pub(super) fn decisions(&self) -> &[Decision] {
        self.lock.as_ref().map_or(&[], |lock| &lock.decisions)
    }

    /// The lock that a bake would write: if a budget broke a decision of the lock, if the lock lacks a material, or if a lock was asked for.
    pub(super) fn next(&self, manifest: &Manifest) -> Option<Lock> {
        let next = Lock::of(manifest);
        match &self.lock {
            Some(lock) => {
                let mut next = next.after(&self.names);
                // Decisions that stay are written as they are, with what was measured when they were made.
                if lock.serves_as(&next) {
                    next.decisions.clone_from(&lock.decisions);
                }
                (!lock.decides_as(&next)).then_some(next)
            }
            None => self.is_asked.then_some(next),
        }
    }

    /// The path of the file where a bake would write it.
    pub(super) fn stale(&self, manifest: &Manifest) -> Option<String> {
        self.next(manifest).map(|_| self.path.display().to_string())
    }

    /// Writes the decisions of a bake into a lock that lacks them. Returns a sentence about it.
    ///
    /// # Errors
    /// [`Failure::Files`].
    pub(super) fn write(&self, manifest: &Manifest) -> Outcome<Option<String>> {
        let Some(next) = self.next(manifest) else { return Ok(None) };
        let text = next.to_json().map_err(|reason| Failure::Input(anyhow::anyhow!("{reason}")))?;
        luthier_export::replace(&self.path, text.as_bytes()).map_err(files(&self.path, "write"))?;
        let path = self.path.display();
        let added = next.materials.len().saturating_sub(self.names.len());
        Ok(Some(match &self.lock {
            None => format!("wrote {path}"),
            Some(lock) if lock.serves_as(&next) => {
                let s = if added == 1 { "" } else { "s" };
                format!("wrote {path}: {added} material{s} more; the others keep their numbers")
            }
            Some(_) => format!(
                "warning: the tables that {path} decides no longer serve all materials: they were searched anew, and it was written anew"
            ),
        }))
    }
}
