//! Material files on disk.

use std::collections::BTreeSet;
use std::path::{Component, MAIN_SEPARATOR, Path, PathBuf};
use std::string::FromUtf8Error;

use luthier_material::{Diagnostic, Material, Parsed, Severity};
use rayon::prelude::*;

use crate::make::file;
use crate::{ExportError, input, refusals};

/// A file that was read, and what became of it.
#[derive(Debug, Clone)]
pub struct Source {
    /// The file, as it was named or found.
    pub label: String,
    /// Its text.
    pub text: String,
    /// The material, or why it is none.
    pub parsed: Result<Parsed, Vec<Diagnostic>>,
}

impl Source {
    /// Errors or warnings, whichever there are.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match &self.parsed {
            Ok(parsed) => &parsed.warnings,
            Err(errors) => errors,
        }
    }
}

/// The material of a text that names no other files. `label` is its file in messages and in the manifest.
///
/// # Errors
/// [`ExportError::Refused`] with everything that is wrong.
pub fn parse(label: &str, text: &str) -> Result<Material, ExportError> {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    match luthier_material::parse(label, text, &no_files) {
        Ok(parsed) => Ok(parsed.material),
        Err(diagnostics) => {
            let sentence = diagnostics.iter().map(|d| d.render(text)).collect::<Vec<_>>().join("\n");
            Err(ExportError::Refused { sentence, diagnostics })
        }
    }
}

/// Reads files, and the `*.toml` of folders, each once, in the order given and by name within a folder.
///
/// # Errors
/// [`ExportError::File`], [`ExportError::NoFiles`].
pub fn read(paths: &[PathBuf]) -> Result<Vec<Source>, ExportError> {
    read_all(&find(paths)?)
}

/// Reads files, side by side, in the order given.
///
/// # Errors
/// [`ExportError::File`], of the first that cannot be read.
pub fn read_all(paths: &[PathBuf]) -> Result<Vec<Source>, ExportError> {
    paths.par_iter().map(|path| read_one(path)).collect::<Vec<_>>().into_iter().collect()
}

/// The files that [`read`] reads.
///
/// # Errors
/// [`ExportError::File`], [`ExportError::NoFiles`].
pub fn find(paths: &[PathBuf]) -> Result<Vec<PathBuf>, ExportError> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for path in paths {
        let here = if path.is_dir() { toml_files(path)? } else { vec![path.clone()] };
        if here.is_empty() {
            return Err(ExportError::NoFiles { folder: path.display().to_string() });
        }
        found.extend(here.into_iter().filter(|p| seen.insert(p.canonicalize().unwrap_or_else(|_| p.clone()))));
    }
    Ok(found)
}

/// Reads and validates one file.
///
/// # Errors
/// [`ExportError::File`], of the file itself: what is wrong in it is in [`Source::parsed`].
pub fn read_one(path: &Path) -> Result<Source, ExportError> {
    let bytes = input::bytes(path).map_err(|source| file("read", path, source))?;
    let label = label(path);
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(source) => return Ok(not_utf8(label, &source)),
    };
    Ok(of_text(path, text))
}

/// Validates a text in the place of a file's. Files that it names are beside that file.
pub fn of_text(path: &Path, text: String) -> Source {
    let label = label(path);
    let folder = path.parent().unwrap_or(Path::new(""));
    let (material, mut diagnostics) =
        luthier_material::parse_partly(&label, &text, &|name| input::text(&folder.join(name)));
    let is_usable = !diagnostics.iter().any(Diagnostic::is_error);
    let parsed = match material {
        Some(material) if is_usable => Ok(Parsed { material, warnings: diagnostics }),
        // Who mends the file hears of its pictures in the same run.
        Some(material) => {
            // A map that is wrong for another reason is said once.
            let is_new = |found: &Diagnostic| found.is_error() && diagnostics.iter().all(|d| d.span != found.span);
            let mut of_pictures = refusals::of_pictures(&material);
            of_pictures.retain(is_new);
            diagnostics.extend(of_pictures);
            diagnostics.sort_by_key(|d| (d.span.start, d.span.end));
            Err(diagnostics)
        }
        None => Err(diagnostics),
    };
    Source { label, text, parsed }
}

/// A file of other bytes than text: they are shown as replacement characters.
fn not_utf8(label: String, source: &FromUtf8Error) -> Source {
    let start = source.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(source.as_bytes()).into_owned();
    let before = &text[..start];
    let diagnostic = Diagnostic {
        severity: Severity::Error,
        label: label.clone(),
        line: before.matches('\n').count() + 1,
        column: before.chars().rev().take_while(|&c| c != '\n').count() + 1,
        span: start..start + char::REPLACEMENT_CHARACTER.len_utf8(),
        message: "the file is not UTF-8".to_owned(),
        hint: Some("save it as UTF-8".to_owned()),
        count: 1,
    };
    Source { label, text, parsed: Err(vec![diagnostic]) }
}

/// The path of a file that a material names.
pub(crate) fn beside(material: &str, path: &str) -> PathBuf {
    Path::new(material).parent().unwrap_or(Path::new("")).join(path)
}

/// A path as messages and manifests have it: with forward slashes everywhere.
pub fn label(path: &Path) -> String {
    path.to_string_lossy().replace(MAIN_SEPARATOR, "/")
}

/// A path without the folders that `..` leaves again.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let leaves =
            part == Component::ParentDir && matches!(plain.components().next_back(), Some(Component::Normal(_)));
        if leaves {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

/// The `*.toml` of a folder, by name.
pub(crate) fn toml_files(folder: &Path) -> Result<Vec<PathBuf>, ExportError> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|source| file("list", folder, source))? {
        let path = entry.map_err(|source| file("list", folder, source))?.path();
        // A broken link is a file that cannot be read, not one to leave out in silence.
        if path.extension().is_some_and(|e| e == "toml") && !path.is_dir() {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A folder of a build that lacks a material is not baked without it.
    #[test]
    fn a_broken_link_is_not_left_out() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("nowhere.toml", folder.path().join("a.toml")).unwrap();
        std::fs::create_dir(folder.path().join("b.toml")).unwrap();
        let error = read(&[folder.path().to_owned()]).unwrap_err();
        assert!(matches!(&error, ExportError::File { .. }) && error.to_string().contains("a.toml"), "{error}");
    }
}
