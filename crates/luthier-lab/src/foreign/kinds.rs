//! Kinds of foreign files, and the readers that bakes and pictures use for them.

use std::collections::BTreeSet;
use std::path::Path;

use luthier::{Bake, MemoryStore, Severity, Shading, Sources};
use luthier_environment::Environment;
use luthier_export::input;
use luthier_gpu::{Mesh, soup};
use luthier_import::Fate;
use luthier_optics::index_file::{csv, yaml};
use luthier_texture::{picture as pictures, radiance};

use crate::cli::ForeignKind;

/// Outcome of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Read {
    /// It is read, with notes on its ignored parts.
    Whole(Vec<String>),
    Refused(String),
    Panicked(String),
}

/// Notes, or the reason of a refusal.
type Outcome = Result<Vec<String>, String>;

impl ForeignKind {
    pub(super) const ALL: [Self; 5] = [Self::Mesh, Self::Sky, Self::Picture, Self::Index, Self::Material];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Sky => "sky",
            Self::Picture => "picture",
            Self::Index => "index",
            Self::Material => "material",
        }
    }

    /// Whether a file is of this kind, by its ending.
    pub(super) fn has(self, path: &Path) -> bool {
        let endings: &[&str] = match self {
            Self::Mesh => &["gltf", "glb"],
            Self::Sky => &["hdr", "exr"],
            Self::Picture => &["png", "jpg", "jpeg", "webp"],
            Self::Index => &["csv", "yml"],
            Self::Material => &["gltf", "glb", "mtlx"],
        };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| endings.contains(&ending.as_str()))
    }

    /// Reads a file of a collection in a folder as a bake or a picture would.
    pub(super) fn read(self, path: &Path, folder: &Path) -> Outcome {
        match self {
            Self::Mesh => mesh(path),
            Self::Sky => sky(path),
            Self::Picture => picture(path),
            Self::Index => index(path),
            Self::Material => material(path, folder),
        }
    }
}

fn mesh(path: &Path) -> Outcome {
    let bytes = input::mesh(path).map_err(words)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let file = soup(&bytes, &|name| input::mesh(&folder.join(name))).map_err(words)?;
    Mesh::new(file.soup).map_err(words)?;
    Ok(file.left_out.into_iter().map(|note| note.to_string()).collect())
}

fn sky(path: &Path) -> Outcome {
    let radiance::Picture { mut image, mut notes } =
        radiance::decode(&input::image(path).map_err(words)?).map_err(words)?;
    let negative = image.data.iter_mut().filter(|value| **value < 0.0).map(|value| *value = 0.0).count();
    if negative > 0 {
        notes.push(format!("{negative} values below 0"));
    }
    Environment::new(image).map_err(words)?;
    Ok(notes)
}

fn picture(path: &Path) -> Outcome {
    pictures::decode(&input::image(path).map_err(words)?).map_err(words)?;
    Ok(Vec::new())
}

fn index(path: &Path) -> Outcome {
    let is_page = path.extension().is_some_and(|ending| !ending.eq_ignore_ascii_case("csv"));
    let text = input::text(path).map_err(words)?;
    let file = if is_page { yaml(&text) } else { csv(&text) };
    Ok(file.map_err(words)?.notes)
}

/// Imports, checks and bakes the materials of a file. Notes are what is not as it was, and the model of each material.
fn material(path: &Path, folder: &Path) -> Outcome {
    let bytes = input::mesh(path).map_err(words)?;
    let own = path.parent().unwrap_or(Path::new(""));
    let label = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let import = luthier_import::import(&label, &bytes, &|beside| input::beside(folder, own, beside)).map_err(words)?;
    let place = tempfile::tempdir().map_err(words)?;
    luthier_export::lay(place.path(), import.files()).map_err(words)?;
    let mut sources = Sources::read([place.path()]).map_err(words)?;
    sources.check(&Shading::default());
    if !sources.is_usable() {
        let faults = sources.diagnostics().filter(|found| found.severity == Severity::Error);
        return Err(faults.map(|fault| fault.message.clone()).collect::<Vec<_>>().join("; "));
    }
    let package = Bake::default().of(&sources, &MemoryStore::default()).map_err(words)?;
    let models = package.manifest.materials.iter().map(|baked| format!("model {}", baked.model.name()));
    let changed = import.lines.iter().chain(import.materials.iter().flat_map(|of| &of.lines));
    let changed = changed.filter(|line| matches!(line.fate, Fate::Approximated | Fate::Dropped));
    let notes: BTreeSet<String> =
        changed.map(|line| format!("{}: {}: {}", line.fate, line.property, line.note)).chain(models).collect();
    Ok(notes.into_iter().collect())
}

/// An error with its causes.
fn words(error: impl Into<anyhow::Error>) -> String {
    format!("{:#}", error.into())
}
