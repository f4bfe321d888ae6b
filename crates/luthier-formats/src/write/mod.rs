//! Files of materials.

mod gltf;
mod mtlx;

use std::collections::BTreeMap;

use crate::{Exported, Format, Texture};

/// Folder of the textures.
const TEXTURES: &str = "textures";

/// Why files cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WriteError {
    /// Materials of several formats in one file.
    #[error("{name} is of another format than the materials before it")]
    Mixed {
        /// The material.
        name: String,
    },
}

/// The files of materials by path, relative to one folder: one file of the format, and its textures. Materials of one name get numbers.
///
/// # Errors
/// [`WriteError::Mixed`].
pub fn files(format: Format, materials: &[Exported], generator: &str) -> Result<BTreeMap<String, Vec<u8>>, WriteError> {
    if let Some(other) = materials.iter().find(|material| material.format != format) {
        return Err(WriteError::Mixed { name: other.name.clone() });
    }
    let mut files = BTreeMap::new();
    let mut named: Vec<Named<'_>> = Vec::new();
    for material in materials {
        let mut names = std::iter::once(material.name.clone()).chain((2..).map(|n| format!("{}-{n}", material.name)));
        let name = names.find(|name| named.iter().all(|known| known.name != *name)).unwrap_or_default();
        let textures = material.textures.iter().map(|texture| (placed(&mut files, texture), texture)).collect();
        named.push(Named { name, of: material, textures });
    }
    let text = match format {
        Format::Gltf => gltf::text(&named, generator),
        Format::OpenPbr | Format::StandardSurface => mtlx::text(format, &named, generator),
    };
    files.insert(format.file_name().to_owned(), text.into_bytes());
    Ok(files)
}

/// A material with its name in the file, and the paths of its textures.
struct Named<'m> {
    name: String,
    of: &'m Exported,
    textures: Vec<(String, &'m Texture)>,
}

/// Adds the picture of a texture, under a name that no other bytes have, on file systems without case, too.
fn placed(files: &mut BTreeMap<String, Vec<u8>>, texture: &Texture) -> String {
    let (stem, ending) = texture.name.rsplit_once('.').unwrap_or((&texture.name, "png"));
    let numbered = (2..).map(|number| format!("{TEXTURES}/{stem}-{number}.{ending}"));
    let mut names = std::iter::once(format!("{TEXTURES}/{stem}.{ending}")).chain(numbered);
    let is_free = |path: &String| {
        let known = files.iter().find(|(known, _)| known.eq_ignore_ascii_case(path));
        known.is_none_or(|(known, bytes)| known == path && *bytes == texture.bytes)
    };
    let path = names.find(is_free).unwrap_or_default();
    files.insert(path.clone(), texture.bytes.clone());
    path
}

/// A number with at most six digits behind the point.
fn rounded(value: f64) -> f64 {
    // Of 0 with a sign, too.
    libm::round(value * 1e6) / 1e6 + 0.0
}
