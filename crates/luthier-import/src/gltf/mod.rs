//! Materials of glTF 2.0 files.

mod document;
mod points;
mod surface;
mod textures;

use std::io;

use luthier_mesh::Asset;
use serde::Deserialize;
use serde_json::Value;

use self::document::{Material, misplaced};
pub use self::points::{GltfPoint, GltfPoints, gltf_points};
use self::surface::surface;
use self::textures::Textures;
use crate::draft::plain;
use crate::name::Names;
use crate::{Fate, Import, ImportError, Imported, Line};

/// Beginnings of extensions that materials tell themselves, or that change none.
const HARMLESS: [&str; 6] =
    ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_mesh_", "KHR_draco_", "EXT_meshopt_"];

/// The materials of a glTF 2.0 file, binary or text. `label` names it in the texts. `files` reads what lies beside it by relative paths; paths that leave its folder are refused.
///
/// The core is read, and `KHR_materials_clearcoat`, `_ior`, `_specular`, `_anisotropy`, `_iridescence`, and `KHR_texture_transform`. A coat has the index 1.5 and leaves the base as bright as its
/// colour (`darkening = false`). Pictures that mean something else than maps of luthier are computed anew, in 16 bits: slope parameters are squares of roughness, tangents have the doubled angle.
///
/// # Errors
/// [`ImportError`] for bytes that are not glTF, a material that is none, and a file without materials. A picture that cannot be read is a [`Line`] that says so.
pub fn gltf(label: &str, bytes: &[u8], files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<Import, ImportError> {
    let asset = Asset::open(bytes, files)?;
    let mut textures = Textures::new(&asset);
    let mut names = Names::default();
    let mut import = Import::default();
    for (number, (source_name, material)) in materials(&asset)?.into_iter().enumerate() {
        let name = names.unique(&source_name, &format!("material-{number}"));
        let (mut draft, lines) = surface(&material, &mut textures);
        draft.name.clone_from(&name);
        let of = if source_name.is_empty() { format!("material {number}") } else { format!("`{source_name}`") };
        draft.comments.push(format!("Source: {label}, {of}"));
        draft.comments.extend(crate::told(&lines));
        import.materials.push(Imported { name, source_name, text: draft.toml(), lines });
    }
    if asset.json["extensions"]["KHR_materials_variants"].is_object() {
        import.lines.push(Line::new(
            "KHR_materials_variants",
            Fate::Host,
            "every material of a variant is imported; which part has which is with the meshes",
        ));
    }
    for name in asset.json["extensionsRequired"].as_array().into_iter().flatten().filter_map(|name| name.as_str()) {
        if !HARMLESS.iter().any(|beginning| name.starts_with(beginning)) {
            let note = "the file requires this extension, which is not read: materials may be others than it means";
            import.lines.push(Line::new(name, Fate::Dropped, note));
        }
    }
    import.pictures = textures.into_files();
    Ok(import)
}

/// The materials of a file, each with its name; at least one.
fn materials(asset: &Asset<'_>) -> Result<Vec<(String, Material)>, ImportError> {
    let found = asset.json["materials"]
        .as_array()
        .filter(|found| !found.is_empty())
        .ok_or(ImportError::Empty(String::new()))?;
    let material = |(number, value): (usize, &Value)| {
        let source_name = plain(value["name"].as_str().unwrap_or_default());
        let fail = |reason: String| ImportError::Material {
            number,
            name: if source_name.is_empty() { String::new() } else { format!(" `{source_name}`") },
            reason,
        };
        if !value.is_object() {
            return Err(fail("it is no object".to_owned()));
        }
        if let Some(name) = misplaced(value) {
            return Err(fail(format!("`{name}` is no object")));
        }
        let material = Material::deserialize(value).map_err(|error| fail(with_line(asset, &error)))?;
        Ok((source_name, material))
    };
    found.iter().enumerate().map(material).collect()
}

/// A mistake with its line and column in the text.
fn with_line(asset: &Asset<'_>, mistake: &serde_json::Error) -> String {
    /// All materials of a text.
    #[derive(Deserialize)]
    struct Materials {
        #[serde(rename = "materials")]
        _all: Vec<Material>,
    }
    let again = serde_json::from_slice::<Materials>(asset.text).map(|_| mistake.to_string());
    again.unwrap_or_else(|found| found.to_string())
}
