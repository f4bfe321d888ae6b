//! Files of a bake. Each is read once, then parsed, then checked.

mod file;
mod files;
mod material;
mod refuse;
mod scene;
mod surface;
mod surface_faults;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use luthier_bake::{MemoryStore, Store};
use luthier_manifest::SurfaceEntry;
use luthier_material::{Diagnostic, Material};
use rayon::prelude::*;

use self::refuse::{add, refuse_too_many};
use self::surface_faults::{doubt_surfaces, refuse_surfaces};
use crate::refusals::foreseen_misses;
use crate::{Error, Shading};

pub use file::TomlFile;
pub use files::Files;
pub use material::{Source, named_files, parse, read_materials};
pub use refuse::refuse;
pub use scene::SceneSource;
pub use surface::{SurfaceSource, surface_map};

/// Scenes, surfaces and materials that were read together, with their diagnostics.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 80\n";
/// std::fs::write(folder.path().join("chalk.toml"), text)?;
///
/// let sources = luthier::Sources::read([folder.path()])?;
/// assert!(!sources.is_usable());
/// assert_eq!(sources.diagnostics().next().map(|error| error.line), Some(5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// The scenes, each with its own materials.
    pub scenes: Vec<SceneSource>,
    /// The surfaces.
    pub surfaces: Vec<SurfaceSource>,
    /// The materials of the bake: those of the files given, then others that surfaces name.
    pub materials: Vec<Source>,
}

impl Sources {
    /// Reads files, and the `*.toml` of folders. Folders inside a folder are left out, because they are packages of their own: see
    /// [`Files::packages`].
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NoFiles`]. Faults of texts are diagnostics of the sources.
    pub fn read<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        let paths: Vec<PathBuf> = paths.into_iter().map(|path| path.as_ref().to_owned()).collect();
        Ok(Self::of(Files::read(&paths)?))
    }

    /// Parses files. Materials are parsed side by side.
    ///
    /// ```
    /// use luthier::{Files, Sources, TomlFile};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    ///
    /// let file = TomlFile { path: "chalk.toml".into(), bytes: chalk.as_bytes().to_vec() };
    /// assert!(Sources::of(Files::of(vec![file])).is_usable());
    /// ```
    pub fn of(files: Files) -> Self {
        let Files { scenes, surfaces, materials } = files;
        Self {
            scenes: scenes.into_iter().map(SceneSource::of).collect(),
            surfaces,
            materials: materials.into_par_iter().map(Source::of).collect(),
        }
    }

    /// Puts the materials of these names first, in this order; the others follow in theirs. So materials keep the numbers of an earlier bake where one is
    /// added. Call this before [`Sources::refuse`], which gives surfaces the numbers of their materials.
    ///
    /// ```
    /// use luthier::{Files, Sources, TomlFile};
    ///
    /// let file = |name: &str| {
    ///     let text = format!("schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n");
    ///     TomlFile { path: format!("{name}.toml").into(), bytes: text.into_bytes() }
    /// };
    /// let mut sources = Sources::of(Files::of(["chalk", "lime", "soot"].map(file).into()));
    /// sources.put_first(&["soot".to_owned(), "tin".to_owned(), "chalk".to_owned()]);
    /// let names = sources.materials.iter().filter_map(|source| Some(source.material()?.name.as_str()));
    /// assert_eq!(names.collect::<Vec<_>>(), ["soot", "chalk", "lime"]);
    /// ```
    pub fn put_first(&mut self, names: &[String]) {
        let place = |source: &Source| {
            let name = source.material().map(|material| &material.name);
            names.iter().position(|known| Some(known) == name).unwrap_or(names.len())
        };
        self.materials.sort_by_key(place);
    }

    /// Makes sources unusable that cannot be baked, and adds warnings about features that a model leaves out. Pictures are read; nothing is
    /// simulated.
    ///
    /// ```
    /// use luthier::{Files, Shading, ShadingModel, Sources, TomlFile};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    /// # let file = TomlFile { path: "coat.toml".into(), bytes: text.as_bytes().to_vec() };
    ///
    /// let mut sources = Sources::of(Files::of(vec![file]));
    /// sources.refuse(&Shading { model: Some(ShadingModel::Microfacet), ..Shading::default() });
    /// let warning = sources.diagnostics().next().unwrap();
    /// assert!(warning.message.contains("leaves out"), "{warning}");
    /// ```
    pub fn refuse(&mut self, shading: &Shading) {
        refuse(&mut self.materials, |material| shading.doubts(material));
        self.refuse_surfaces();
    }

    /// Makes surfaces unusable that cannot be baked with the materials, as [`Sources::refuse`] does.
    pub fn refuse_surfaces(&mut self) {
        refuse_surfaces(&mut self.surfaces, &self.materials);
    }

    /// Adds warnings where a model returns too much light, or light that differs from a simulation. This takes some hundredths of a second for each
    /// material whose albedos the store has not. Call [`Sources::refuse`] first.
    ///
    /// ```
    /// use luthier::{Files, MemoryStore, Shading, ShadingModel, Sources, TomlFile};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    /// # let file = TomlFile { path: "coat.toml".into(), bytes: text.as_bytes().to_vec() };
    ///
    /// let (mut sources, shading) = (Sources::of(Files::of(vec![file])), Shading { model: Some(ShadingModel::WeidlichWilkie), ..Shading::default() });
    /// sources.refuse(&shading);
    /// sources.doubt_energy(&shading, &MemoryStore::default());
    /// assert!(sources.diagnostics().any(|warning| warning.message.contains("times the light that falls in")));
    /// ```
    pub fn doubt_energy(&mut self, shading: &Shading, store: &dyn Store) {
        add(&mut self.materials, |material| shading.doubts_of_energy(material, store).into_iter().collect());
    }

    /// Adds every diagnostic that needs no bake: those of [`Sources::refuse`] and [`Sources::doubt_energy`], more tables than a texture holds, tables
    /// that will miss their aim, and grains of surfaces that no place shows.
    ///
    /// ```
    /// use luthier::{Files, Shading, Sources, TomlFile};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    /// # let file = TomlFile { path: "coat.toml".into(), bytes: text.as_bytes().to_vec() };
    ///
    /// let mut sources = Sources::of(Files::of(vec![file]));
    /// sources.check(&Shading::default());
    /// assert!(sources.is_usable());
    /// for diagnostic in sources.diagnostics() {
    ///     eprintln!("{diagnostic}");
    /// }
    /// ```
    pub fn check(&mut self, shading: &Shading) {
        self.refuse(shading);
        self.doubt_energy(shading, &MemoryStore::default());
        doubt_surfaces(&mut self.surfaces);
        refuse_too_many(&mut self.materials, shading);
        add(&mut self.materials, foreseen_misses);
    }

    /// True where all sources can be baked.
    pub fn is_usable(&self) -> bool {
        self.materials.iter().all(|source| source.parsed.is_ok())
            && self.surfaces.iter().all(|source| source.parsed.is_ok())
            && self.scenes.iter().all(SceneSource::is_usable)
    }

    /// All diagnostics, file by file: scenes with their materials, surfaces, materials.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        let of_scenes = self.scenes.iter().flat_map(SceneSource::diagnostics);
        let of_surfaces = self.surfaces.iter().flat_map(SurfaceSource::diagnostics);
        of_scenes.chain(of_surfaces).chain(self.materials.iter().flat_map(Source::diagnostics))
    }

    /// The materials of usable files, with the choices of `shading`.
    ///
    /// ```
    /// use luthier::{Files, Shading, ShadingModel, Sources, TomlFile};
    /// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
    /// # let file = TomlFile { path: "coat.toml".into(), bytes: text.as_bytes().to_vec() };
    ///
    /// let sources = Sources::of(Files::of(vec![file]));
    /// let shading = Shading { model: Some(ShadingModel::Elek), ..Shading::default() };
    /// assert_eq!(sources.materials(&shading)[0].model(), ShadingModel::Elek);
    /// ```
    pub fn materials(&self, shading: &Shading) -> Vec<Material> {
        shading.shaded(self.materials.iter().filter_map(|source| source.material().cloned()).collect())
    }

    /// The usable surfaces, as entries of a manifest.
    ///
    /// ```
    /// use luthier::{Files, Sources};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// std::fs::write(folder.path().join("stone.toml"), "surface = 1\nname = \"stone\"\n[cells]\nmaterials = [\"chalk.toml\"]\n")?;
    ///
    /// let sources = Sources::of(Files::read(&[folder.path().join("stone.toml")])?);
    /// assert_eq!(sources.surface_entries()[0].name, "stone");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn surface_entries(&self) -> Vec<SurfaceEntry> {
        self.surfaces.iter().filter_map(SurfaceSource::entry).collect()
    }

    /// The files that a bake of these sources reads, each once: their own files, and the files that materials name.
    ///
    /// ```
    /// use luthier::{Files, Sources};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// std::fs::write(folder.path().join("stone.toml"), "surface = 1\nname = \"stone\"\n[cells]\nmaterials = [\"chalk.toml\"]\n")?;
    ///
    /// // The surface names a material: a bake reads both.
    /// let sources = Sources::of(Files::read(&[folder.path().join("stone.toml")])?);
    /// assert_eq!(sources.files().len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn files(&self) -> Vec<PathBuf> {
        let of_scenes = self.scenes.iter().flat_map(|scene| &scene.materials);
        let materials: Vec<&Source> = of_scenes.chain(&self.materials).collect();
        let own = self.scenes.iter().map(|scene| scene.path.clone());
        let own = own.chain(self.surfaces.iter().map(|surface| surface.path.clone()));
        let own = own.chain(materials.iter().map(|source| PathBuf::from(&source.label)));
        let named = materials.iter().filter_map(|source| source.material()).flat_map(named_files);
        own.chain(named).collect::<BTreeSet<PathBuf>>().into_iter().collect()
    }
}
