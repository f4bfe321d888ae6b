//! glTF files as they are: triangles, and the materials of the file.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use luthier::Files;
use luthier_export::input;
use luthier_import::{GltfPoints, Import, ImportError, gltf, gltf_points};
use luthier_material::Material;
use luthier_mesh::{File as Triangles, MeshError, scene};
#[cfg(feature = "gpu")]
use luthier_terminal::complain;
use luthier_terminal::{Failure, Outcome, files};
use tempfile::TempDir;

use crate::cli::Shading;
use crate::materials::bakeable_with_surfaces;

/// The material of parts that have none: that of glTF.
const NONE: &str = "schema = 1\nname = \"NAME\"\n\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 1.0\nmetallic = 1.0\nroughness = 1.0\n";

/// Whether a name is that of a glTF file.
pub(crate) fn is_scene(subject: &str) -> bool {
    let ending = Path::new(subject).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ["gltf", "glb"].contains(&ending.as_str()))
}

/// A glTF file.
pub(crate) struct SceneFile {
    path: PathBuf,
    bytes: Vec<u8>,
    /// Triangles, each with the number of its material, and what was left out of them; or why there are none.
    pub(crate) triangles: Result<Triangles, MeshError>,
    /// The materials, in the order of the file.
    pub(crate) import: Import,
}

/// Materials of a file, with the folder where their pictures are for as long as they are used.
pub(crate) struct Laid {
    pub(crate) materials: Vec<Material>,
    _folder: TempDir,
}

impl SceneFile {
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let bytes = input::mesh(path).map_err(files(path, "read"))?;
        let label = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let beside = |name: &str| beside(path, name);
        let triangles = scene(&bytes, &beside);
        let import = gltf(&label, &bytes, &beside).map_err(|error: ImportError| unusable(path, error))?;
        Ok(Self { path: path.to_owned(), triangles, import, bytes })
    }

    /// A file for pictures: its mesh, and the numbers of the materials that it shows. Warns of what is not shown.
    #[cfg(feature = "gpu")]
    pub(crate) fn shown(path: &Path) -> Outcome<(Self, luthier_mesh::Mesh, BTreeSet<usize>)> {
        let mut file = Self::read(path)?;
        let triangles = std::mem::replace(&mut file.triangles, Err(MeshError::Empty));
        let triangles = triangles.map_err(|error| file.unusable(error))?;
        let mesh = luthier_mesh::Mesh::new(triangles.soup).map_err(|error| file.unusable(error))?;
        let used: BTreeSet<usize> = mesh.triangles().iter().map(|triangle| triangle.material as usize).collect();
        let mut notes = triangles.left_out;
        let shown = file.import.materials.iter().enumerate().filter(|(number, _)| used.contains(number));
        let lines = shown.flat_map(|(_, material)| &material.lines);
        let lost = lines.filter(|line| line.fate == luthier_import::Fate::Dropped).count();
        if lost > 0 {
            notes.push(format!("{lost} properties of materials, which `luthier import` names"));
        }
        if !notes.is_empty() {
            let notes = notes.join("; ");
            complain(&format!("warning: {} is not shown as it stands in the file: {notes}", path.display()));
        }
        Ok((file, mesh, used))
    }

    /// A failure that names the file.
    fn unusable(&self, error: impl std::error::Error + Send + Sync + 'static) -> Failure {
        unusable(&self.path, error)
    }

    /// The materials as the format means them, at texture coordinates by the number of the material.
    pub(crate) fn points(&self, places: &dyn Fn(usize) -> Vec<[f64; 2]>) -> Outcome<Vec<GltfPoints>> {
        let beside = |name: &str| beside(&self.path, name);
        gltf_points(&self.bytes, &beside, places).map_err(|error: ImportError| self.unusable(error))
    }

    /// Name of each material by its number in triangles, and of that which parts without one have.
    pub(crate) fn name(&self, number: usize) -> String {
        if let Some(material) = self.import.materials.get(number) {
            return material.name.clone();
        }
        let mut without = "without-material".to_owned();
        while self.import.materials.iter().any(|material| material.name == without) {
            without.push_str("-2");
        }
        without
    }

    /// The materials of some numbers, read as from files.
    pub(crate) fn lay(&self, used: &BTreeSet<usize>, shading: &Shading) -> Outcome<Laid> {
        let folder = tempfile::tempdir().map_err(files(&self.path, "import"))?;
        let materials = self.import.materials.iter().enumerate().filter(|(number, _)| used.contains(number));
        let mut texts: Vec<(String, Vec<u8>)> =
            materials.map(|(_, of)| (format!("{}.toml", of.name), of.text.clone().into_bytes())).collect();
        let none = self.import.materials.len();
        if used.contains(&none) {
            let name = self.name(none);
            texts.push((format!("{name}.toml"), NONE.replace("NAME", &name).into_bytes()));
        }
        let pictures = self.import.pictures.iter().map(|(path, bytes)| (path.clone(), bytes.as_slice()));
        let all = texts.iter().map(|(path, bytes)| (path.clone(), bytes.as_slice())).chain(pictures);
        luthier_export::lay(folder.path(), all).map_err(files(&self.path, "import"))?;
        let read = Files::read(&[folder.path().to_owned()]).map_err(Failure::input)?;
        let (materials, _) = bakeable_with_surfaces(read, &shading.in_forms(&[]), true)?;
        Ok(Laid { materials, _folder: folder })
    }
}

fn beside(path: &Path, name: &str) -> io::Result<Vec<u8>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    input::beside(folder, folder, name)
}

fn unusable(path: &Path, error: impl std::error::Error + Send + Sync + 'static) -> Failure {
    Failure::Input(anyhow::Error::new(error).context(path.display().to_string()))
}
