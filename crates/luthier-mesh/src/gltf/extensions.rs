//! Extensions of glTF: those that change meshes, and those that do not.

use super::document::Document;
use crate::MeshError;

/// Extensions that move the numbers of a mesh out of their accessors.
pub(super) const COMPRESSIONS: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Extensions of nodes that change how a mesh is shown, and what happens with them.
pub(super) const OF_NODES: [(&str, &str); 2] = [
    ("EXT_mesh_gpu_instancing", "instances (EXT_mesh_gpu_instancing): one of each is shown"),
    ("KHR_node_visibility", "hidden nodes (KHR_node_visibility): they are shown"),
];

/// Prefixes of extensions that leave meshes as they are: materials, textures, lights, motion, and descriptions of a
/// file.
const OF_OTHER_THINGS: [&str; 13] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_animation_",
    "KHR_audio",
    "KHR_xmp",
    "KHR_interactivity",
    "EXT_materials_",
    "EXT_texture_",
    "EXT_lights_",
    "EXT_animation_",
    "MSFT_texture_",
    "MSFT_lod",
];

/// The extension that allows any type of number for attributes. All types are read here.
const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Required extensions that are skipped, because they change nothing of the meshes.
///
/// # Errors
/// [`MeshError::Compressed`] and [`MeshError::Extension`].
pub(super) fn passed_over(document: &Document) -> Result<Vec<&str>, MeshError> {
    let mut names = Vec::new();
    for name in document.extensions_required.iter().map(String::as_str) {
        if COMPRESSIONS.contains(&name) {
            return Err(MeshError::Compressed(name.to_owned()));
        }
        if OF_OTHER_THINGS.iter().any(|beginning| name.starts_with(beginning)) {
            names.push(name);
        } else if name != QUANTIZATION {
            return Err(MeshError::Extension(name.to_owned()));
        }
    }
    Ok(names)
}
