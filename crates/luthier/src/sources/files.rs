//! The files of packages, sorted into scenes, surfaces and materials by their keys.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use luthier_export::{label, plain};
use luthier_material::{Diagnostic, FileKind};

use super::{SurfaceSource, TomlFile};
use crate::{Error, paths};

/// A file that was found in a folder, and its bytes or why it cannot be read.
type Found = (PathBuf, Result<TomlFile, Error>);

/// The TOML files of one package, each read once. Surfaces are parsed at once, because they name materials.
///
/// ```
/// use luthier::{Bake, Files, MemoryStore, Shading, Sources};
///
/// let folder = tempfile::tempdir()?;
/// let gold = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
/// std::fs::create_dir(folder.path().join("metals"))?;
/// std::fs::write(folder.path().join("metals/gold.toml"), gold)?;
/// std::fs::write(folder.path().join("chalk.toml"), "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n")?;
///
/// for (name, _, files) in Files::packages(&[folder.path().to_owned()])? {
///     let mut sources = Sources::of(files);
///     sources.refuse(&Shading::default());
///     let package = Bake::default().of(&sources, &MemoryStore::default())?;
///     assert_eq!(package.manifest.materials[0].name, if name == "metals" { "gold" } else { "chalk" });
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Files {
    /// Scene files.
    pub scenes: Vec<TomlFile>,
    /// Surface files.
    pub surfaces: Vec<SurfaceSource>,
    /// Material files and any other TOML: the files given, then others that surfaces name.
    pub materials: Vec<TomlFile>,
}

impl Files {
    /// Reads files, and the `*.toml` of folders.
    ///
    /// ```
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// std::fs::write(folder.path().join("shelf.toml"), "scene = 1\nname = \"shelf\"\n")?;
    ///
    /// let files = luthier::Files::read(&[folder.path().to_owned()])?;
    /// assert_eq!((files.materials.len(), files.scenes.len()), (1, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NoFiles`]. A file that a surface names and that cannot be read is an error of the surface.
    pub fn read(paths: &[PathBuf]) -> Result<Self, Error> {
        let files = paths::find(paths)?.iter().map(|path| TomlFile::read(path)).collect::<Result<_, _>>()?;
        Ok(Self::of(files))
    }

    /// The packages of paths, each with its name and paths. The first has the files of `paths` and an empty name; the others are folders inside
    /// folders of `paths`, by name.
    ///
    /// A folder inside is a package of its own if it has a material file that no surface of `paths` names. Scenes, surfaces and TOML files of other
    /// programs make no package, and nothing that lies deeper does. Folders of one name are one package.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NoFiles`].
    pub fn packages(paths: &[PathBuf]) -> Result<Vec<(String, Vec<PathBuf>, Self)>, Error> {
        let outer = Self::read(paths)?;
        let named: BTreeSet<PathBuf> = outer.materials.iter().map(|file| paths::same(&file.path)).collect();
        let mut inner: BTreeMap<String, (Vec<PathBuf>, Vec<Found>)> = BTreeMap::new();
        let mut seen = BTreeSet::new();
        for (name, folder, path) in paths::inner_files(paths)? {
            let place = paths::same(&path);
            let file = TomlFile::read(&path);
            let (folders, files) = inner.entry(name).or_default();
            let is_material = file.as_ref().is_ok_and(|file| file.kind() == FileKind::Material);
            if is_material && !named.contains(&place) && !folders.contains(&folder) {
                folders.push(folder.clone());
            }
            if seen.insert(place) {
                files.push((folder, file));
            }
        }
        let mut packages = vec![(String::new(), paths.to_vec(), outer)];
        for (name, (folders, files)) in inner.into_iter().filter(|(_, (folders, _))| !folders.is_empty()) {
            let own = files.into_iter().filter(|(folder, _)| folders.contains(folder));
            let files = own.map(|(_, file)| file).collect::<Result<_, _>>()?;
            packages.push((name, folders, Self::of(files)));
        }
        Ok(packages)
    }

    /// Sorts files by kind, and adds the materials that surfaces name.
    ///
    /// ```
    /// use luthier::{Files, TomlFile};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    ///
    /// // A file that an editor holds, with its unsaved text.
    /// let file = TomlFile { path: "chalk.toml".into(), bytes: chalk.as_bytes().to_vec() };
    /// assert_eq!(Files::of(vec![file]).materials.len(), 1);
    /// ```
    pub fn of(files: Vec<TomlFile>) -> Self {
        let mut all = Self::default();
        for file in files {
            match file.kind() {
                FileKind::Scene => all.scenes.push(file),
                FileKind::Surface => all.surfaces.push(SurfaceSource::of(file)),
                FileKind::Material | FileKind::Other => all.materials.push(file),
            }
        }
        all.add_named();
        all
    }

    /// Moves the scenes to the materials, where each has an error once it is parsed.
    ///
    /// ```
    /// use luthier::{Files, Sources, TomlFile};
    ///
    /// let shelf = TomlFile { path: "shelf.toml".into(), bytes: b"scene = 1\nname = \"shelf\"\n".to_vec() };
    /// let sources = Sources::of(Files::of(vec![shelf]).without_scenes());
    /// assert!(sources.diagnostics().any(|error| error.message.contains("scene")));
    /// ```
    #[must_use]
    pub fn without_scenes(mut self) -> Self {
        self.materials.append(&mut self.scenes);
        self
    }

    /// The paths of its files.
    ///
    /// ```
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// let files = luthier::Files::read(&[folder.path().to_owned()])?;
    /// assert_eq!(files.paths().collect::<Vec<_>>(), [folder.path().join("chalk.toml")]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let surfaces = self.surfaces.iter().map(|surface| surface.path.as_path());
        let files = self.materials.iter().map(|file| file.path.as_path());
        files.chain(surfaces).chain(self.scenes.iter().map(|file| file.path.as_path()))
    }

    /// Adds the materials that surfaces name and that are not there yet.
    fn add_named(&mut self) {
        let Self { surfaces, materials, .. } = self;
        let mut numbers: BTreeMap<PathBuf, usize> =
            materials.iter().enumerate().map(|(number, file)| (paths::same(&file.path), number)).collect();
        for source in surfaces {
            let Ok(surface) = &source.parsed else { continue };
            let mut errors: Vec<Diagnostic> = Vec::new();
            for named in surface.materials() {
                let path = plain(&paths::folder(&source.path).join(&named.file));
                let number = match numbers.get(&paths::same(&path)) {
                    Some(&number) => number,
                    None => match material(&path) {
                        Ok(file) => {
                            materials.push(file);
                            numbers.insert(paths::same(&path), materials.len() - 1);
                            materials.len() - 1
                        }
                        Err((message, hint)) => {
                            errors.push(surface.diagnostic(named, message, hint));
                            continue;
                        }
                    },
                };
                source.numbers.push(number);
            }
            if !errors.is_empty() {
                source.parsed = Err(errors);
            }
        }
    }
}

/// Reads a file that a surface names. The error says why it is no material, and what to do.
fn material(path: &Path) -> Result<TomlFile, (String, &'static str)> {
    let read = luthier_export::input::bytes(path).map_err(|error| {
        (format!("cannot read {}: {error}", label(path)), "the path is relative to the surface file")
    })?;
    let file = TomlFile { path: path.to_owned(), bytes: read };
    if file.kind() == FileKind::Surface {
        let message = format!("{} is a surface, and surfaces are made of materials", label(path));
        return Err((message, "name the materials of that surface instead"));
    }
    Ok(file)
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

    fn names(paths: &[PathBuf]) -> Vec<(String, Vec<PathBuf>)> {
        Files::packages(paths).unwrap().into_iter().skip(1).map(|(name, paths, _)| (name, paths)).collect()
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
        let found = names(&[at("m"), at("n")]);
        assert_eq!(found, [("papers".to_owned(), vec![at("m/papers"), at("n/papers")])]);
        assert_eq!(names(&[at("m/a.toml")]), [], "a file has no folders");
        let packages = Files::packages(&[at("m"), at("n")]).unwrap();
        let paths: Vec<&Path> = packages[1].2.paths().collect();
        assert_eq!(paths, [at("m/papers/b.toml"), at("n/papers/i.toml")]);
    }

    #[test]
    fn materials_of_a_surface_are_its_own() {
        let surface = "surface = 1\nname = \"s\"\n[cells]\nmaterials = [\"parts/a.toml\"]\n";
        let folder = written(&[("s.toml", surface), ("parts/a.toml", MATERIAL)]);
        let paths = [folder.path().to_owned()];
        assert_eq!(names(&paths), []);
        std::fs::write(folder.path().join("parts/b.toml"), MATERIAL).unwrap();
        assert_eq!(names(&paths).len(), 1);
    }

    /// A folder of a build that lacks a material is not baked without it.
    #[cfg(unix)]
    #[test]
    fn a_broken_link_is_not_left_out() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("nowhere.toml", folder.path().join("a.toml")).unwrap();
        std::fs::create_dir(folder.path().join("b.toml")).unwrap();
        let error = Files::read(&[folder.path().to_owned()]).unwrap_err();
        assert!(matches!(&error, Error::File { .. }) && error.to_string().contains("a.toml"), "{error}");
    }
}
