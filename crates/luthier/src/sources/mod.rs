//! Files of a bake: each is read once, then parsed, then looked at for all that is wrong with it.

mod file;
mod files;
mod material;
mod refuse;
mod scene;
mod surface;
mod surface_faults;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

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

/// Scenes, surfaces and materials that were read together, with all that is wrong with them.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// The scenes. Their materials are their own.
    pub scenes: Vec<SceneSource>,
    /// The surfaces.
    pub surfaces: Vec<SurfaceSource>,
    /// The materials of the bake: those of the files given, then others that surfaces name.
    pub materials: Vec<Source>,
}

impl Sources {
    /// Reads files, and the `*.toml` of folders. The package of a folder is the one of its files, not those of folders inside: see
    /// [`Files::packages`].
    ///
    /// ```no_run
    /// let sources = luthier::Sources::read(["materials"])?;
    /// # Ok::<(), luthier::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NoFiles`]. Faults of texts are diagnostics of the sources.
    pub fn read<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        let paths: Vec<PathBuf> = paths.into_iter().map(|path| path.as_ref().to_owned()).collect();
        Ok(Self::of(Files::read(&paths)?))
    }

    /// Parses files. Materials are parsed side by side.
    pub fn of(files: Files) -> Self {
        let Files { scenes, surfaces, materials } = files;
        Self {
            scenes: scenes.into_iter().map(SceneSource::of).collect(),
            surfaces,
            materials: materials.into_par_iter().map(Source::of).collect(),
        }
    }

    /// Makes unusable what cannot be baked, and adds warnings of what a model leaves out. Pictures are read; nothing is simulated.
    pub fn refuse(&mut self, shading: &Shading) {
        refuse(&mut self.materials, |material| shading.doubts(material));
        self.refuse_surfaces();
    }

    /// Makes surfaces unusable that cannot be baked with the materials, as [`Sources::refuse`] does.
    pub fn refuse_surfaces(&mut self) {
        refuse_surfaces(&mut self.surfaces, &self.materials);
    }

    /// Adds warnings of models that return too much light, or other light than a simulation: some hundredths of a second for a material.
    /// To be called after [`Sources::refuse`].
    pub fn doubt_energy(&mut self, shading: &Shading) {
        add(&mut self.materials, |material| shading.doubts_of_energy(material).into_iter().collect());
    }

    /// All that can be known without a bake: [`Sources::refuse`], [`Sources::doubt_energy`], more tables than a texture holds, tables that will miss
    /// their aim, and grains of surfaces that are nowhere to be seen.
    pub fn check(&mut self, shading: &Shading) {
        self.refuse(shading);
        self.doubt_energy(shading);
        doubt_surfaces(&mut self.surfaces);
        refuse_too_many(&mut self.materials, shading);
        add(&mut self.materials, foreseen_misses);
    }

    /// Whether all can be baked.
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

    /// The materials of files that can be used, as `shading` has them shaded.
    pub fn materials(&self, shading: &Shading) -> Vec<Material> {
        shading.shaded(self.materials.iter().filter_map(|source| source.material().cloned()).collect())
    }

    /// The surfaces that can be used, as a manifest has them.
    pub fn surface_entries(&self) -> Vec<SurfaceEntry> {
        self.surfaces.iter().filter_map(SurfaceSource::entry).collect()
    }

    /// All files that a bake of these reads, each once: theirs, and those that materials name.
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
