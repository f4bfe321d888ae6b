//! A glTF file as it is: every part in its own material.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use luthier::{Bake, Files, lit};
use luthier_export::{Package, input};
use luthier_gpu::{Mesh, MeshError, Shown, scene};
use luthier_import::{Fate, gltf};
use luthier_terminal::{Failure, Outcome, complain, files};

use crate::cli::Shading;
use crate::materials::bakeable_with_surfaces;
use crate::store::store;

/// The material of parts that have none: that of glTF.
const NONE: &str = "schema = 1\nname = \"NAME\"\n\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 1.0\nmetallic = 1.0\nroughness = 1.0\n";

/// Whether a name is that of a glTF file.
pub(super) fn is_scene(subject: &str) -> bool {
    let ending = Path::new(subject).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ["gltf", "glb"].contains(&ending.as_str()))
}

/// A package with the materials of a glTF file, which it shows of each number, and its triangles.
pub(super) fn read(path: &Path, shading: &Shading) -> Outcome<(Package, Vec<Shown>, Arc<Mesh>)> {
    let bytes = input::mesh(path).map_err(files(path, "read"))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let beside = |name: &str| input::beside(folder, folder, name);
    let unusable = |error: anyhow::Error| Failure::Input(error.context(path.display().to_string()));
    let of_mesh = |error: MeshError| unusable(anyhow::Error::new(error));
    let file = scene(&bytes, &beside).map_err(of_mesh)?;
    let mesh = Mesh::new(file.soup).map_err(of_mesh)?;
    let label = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut import = gltf(&label, &bytes, &beside).map_err(|error| unusable(anyhow::Error::new(error)))?;
    let place = tempfile::tempdir().map_err(files(path, "import"))?;
    let used: BTreeSet<usize> = mesh.triangles().iter().map(|triangle| triangle.material as usize).collect();
    let mut without = "without-material".to_owned();
    while import.materials.iter().any(|material| material.name == without) {
        without.push_str("-2");
    }
    let names: Vec<String> = (0..mesh.materials())
        .map(|number| import.materials.get(number).map_or(&without, |material| &material.name).to_owned())
        .collect();
    let has_none = used.contains(&import.materials.len());
    let mut number = 0;
    import.materials.retain(|_| {
        number += 1;
        used.contains(&(number - 1))
    });
    let lines = import.materials.iter().flat_map(|material| &material.lines);
    let lost = lines.filter(|line| line.fate == Fate::Dropped).count();
    let none = NONE.replace("NAME", &without);
    let none = has_none.then(|| (format!("{without}.toml"), none.as_bytes()));
    luthier_export::lay(place.path(), import.files().chain(none)).map_err(files(path, "import"))?;
    let mut notes = file.left_out;
    if lost > 0 {
        notes.push(format!("{lost} properties of materials, which `luthier import` names"));
    }
    if !notes.is_empty() {
        complain(&format!("warning: {} is not shown as it stands in the file: {}", path.display(), notes.join("; ")));
    }
    let files = Files::read(&[place.path().to_owned()]).map_err(Failure::input)?;
    let (materials, _) = bakeable_with_surfaces(files, &shading.in_forms(&[]), true)?;
    let package = Bake::lit().package(&lit(&materials), store()?)?;
    // Numbers that no triangle has show anything.
    let number = |name: &String| package.manifest.material_index(name).unwrap_or(0);
    let shown = names.iter().map(|name| Shown::Material(number(name))).collect();
    Ok((package, shown, Arc::new(mesh)))
}
