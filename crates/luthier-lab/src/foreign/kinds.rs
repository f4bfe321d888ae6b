//! Kinds of foreign files, and the readers that bakes and pictures use for them.

use std::path::Path;

use luthier_environment::Environment;
use luthier_export::input;
use luthier_gpu::{Mesh, soup};
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
    pub(super) const ALL: [Self; 4] = [Self::Mesh, Self::Sky, Self::Picture, Self::Index];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Sky => "sky",
            Self::Picture => "picture",
            Self::Index => "index",
        }
    }

    /// Whether a file is of this kind, by its ending.
    pub(super) fn has(self, path: &Path) -> bool {
        let endings: &[&str] = match self {
            Self::Mesh => &["gltf", "glb"],
            Self::Sky => &["hdr", "exr"],
            Self::Picture => &["png", "jpg", "jpeg", "webp"],
            Self::Index => &["csv", "yml"],
        };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| endings.contains(&ending.as_str()))
    }

    /// Reads a file as a bake or a picture would.
    pub(super) fn read(self, path: &Path) -> Outcome {
        match self {
            Self::Mesh => mesh(path),
            Self::Sky => sky(path),
            Self::Picture => picture(path),
            Self::Index => index(path),
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

/// An error with its causes.
fn words(error: impl Into<anyhow::Error>) -> String {
    format!("{:#}", error.into())
}
