//! Packages inside folders of materials.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use luthier_material::is_material;

use crate::make::file;
use crate::sources::{find, toml_files};
use crate::{ExportError, gather, input};

/// The folders inside the folders among `paths` that are packages of their own, by name: those with a material file that no surface of `paths`
/// names. Scenes, surfaces and TOML files of other programs make no package, and nothing that lies deeper does. Folders of one name are one package.
///
/// # Errors
/// [`ExportError::File`], [`ExportError::NoFiles`].
pub fn inner_packages(paths: &[PathBuf]) -> Result<BTreeMap<String, Vec<PathBuf>>, ExportError> {
    let mut packages: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    let mut candidates = inner_files(paths)?;
    candidates.retain(|(_, _, file)| holds_material(file));
    if candidates.is_empty() {
        return Ok(packages);
    }
    let outer = gather(&find(paths)?)?.materials;
    let outer: BTreeSet<PathBuf> = outer.iter().filter_map(|path| path.canonicalize().ok()).collect();
    for (name, folder, file) in candidates {
        let folders = packages.entry(name).or_default();
        if !folders.contains(&folder) && file.canonicalize().is_ok_and(|file| !outer.contains(&file)) {
            folders.push(folder);
        }
    }
    packages.retain(|_, folders| !folders.is_empty());
    Ok(packages)
}

/// The `*.toml` of the folders inside the folders among `paths`, each with the name and the path of its folder, in their order.
///
/// # Errors
/// [`ExportError::File`].
pub fn inner_files(paths: &[PathBuf]) -> Result<Vec<(String, PathBuf, PathBuf)>, ExportError> {
    let mut all = Vec::new();
    for folder in paths.iter().filter(|path| path.is_dir()) {
        for (name, inner) in folders(folder)? {
            all.extend(toml_files(&inner)?.into_iter().map(|file| (name.clone(), inner.clone(), file)));
        }
    }
    Ok(all)
}

/// Whether a file is meant to be a material. One that cannot be read is none.
fn holds_material(path: &Path) -> bool {
    input::bytes(path).is_ok_and(|bytes| is_material(&String::from_utf8_lossy(&bytes)))
}

/// The folders inside a folder, with their names.
fn folders(folder: &Path) -> Result<Vec<(String, PathBuf)>, ExportError> {
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|source| file("list", folder, source))? {
        let entry = entry.map_err(|source| file("list", folder, source))?;
        if entry.path().is_dir() {
            folders.push((entry.file_name().to_string_lossy().into_owned(), entry.path()));
        }
    }
    folders.sort();
    Ok(folders)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: &str = "schema = 1\nname = \"a\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";

    fn written(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = folder.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        folder
    }

    #[test]
    fn a_folder_with_materials_is_a_package() {
        let folder = written(&[
            ("m/a.toml", MATERIAL),
            ("m/papers/b.toml", MATERIAL),
            ("m/papers/deeper/c.toml", MATERIAL),
            ("m/scenes/d.toml", "scene = 1"),
            ("m/surfaces/e.toml", "surface = 1"),
            ("m/other/f.toml", "[package]\nname = \"f\""),
            ("m/maps/g.png", ""),
            ("n/h.toml", MATERIAL),
            ("n/papers/i.toml", MATERIAL),
        ]);
        let at = |path: &str| folder.path().join(path);
        let found = inner_packages(&[at("m"), at("n")]).unwrap();
        assert_eq!(found, BTreeMap::from([("papers".to_owned(), vec![at("m/papers"), at("n/papers")])]));
        assert_eq!(inner_packages(&[at("m/a.toml")]).unwrap(), BTreeMap::new(), "a file has no folders");
    }

    #[test]
    fn materials_of_a_surface_are_its_own() {
        let surface = "surface = 1\nname = \"s\"\n[cells]\nmaterials = [\"parts/a.toml\"]\n";
        let folder = written(&[("s.toml", surface), ("parts/a.toml", MATERIAL)]);
        let paths = [folder.path().to_owned()];
        assert!(inner_packages(&paths).unwrap().is_empty());
        std::fs::write(folder.path().join("parts/b.toml"), MATERIAL).unwrap();
        assert_eq!(inner_packages(&paths).unwrap().len(), 1);
    }
}
