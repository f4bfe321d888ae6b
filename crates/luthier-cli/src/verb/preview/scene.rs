//! A glTF file as it is: every part in its own material.

use std::path::Path;
use std::sync::Arc;

use luthier::{Bake, lit};
use luthier_export::Package;
use luthier_gpu::{Mesh, Shown};
use luthier_terminal::Outcome;

use crate::cli::Shading;
use crate::meshes::scene_file::SceneFile;
use crate::store::store;

/// A package with the materials of a glTF file, which it shows of each number, and its triangles.
pub(super) fn read(path: &Path, shading: &Shading) -> Outcome<(Package, Vec<Shown>, Arc<Mesh>)> {
    let (file, mesh, used) = SceneFile::shown(path)?;
    let laid = file.lay(&used, shading)?;
    let package = Bake::lit().package(&lit(&laid.materials), store()?)?;
    // Numbers that no triangle has show anything.
    let number = |name: &str| package.manifest.material_index(name).unwrap_or(0);
    let shown = (0..mesh.materials()).map(|material| Shown::Material(number(&file.name(material)))).collect();
    Ok((package, shown, Arc::new(mesh)))
}
