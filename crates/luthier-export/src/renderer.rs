//! Packages for a renderer: in memory, with shaders in WGSL.

use luthier_bake::Store;
use luthier_lut::TableKind;
use luthier_manifest::{FunctionGroup, Functions, ShadingModel, SurfaceEntry};
use luthier_material::Material;

use crate::{Bake, ExportError, Package};

/// Tables that the environment of pictures reads beside the shader: reflectance and albedo of every interface.
const ENVIRONMENT_TABLES: [TableKind; 3] = [TableKind::Fresnel, TableKind::Fgd, TableKind::Film];

impl Package {
    /// Bakes materials for a renderer: both forms of the shader in WGSL, with what shows an environment.
    ///
    /// # Errors
    /// Those of [`Package::new`].
    pub fn for_renderer(materials: &[Material], store: &dyn Store) -> Result<Self, ExportError> {
        Self::new(materials, &Bake { functions: lit_functions(), ..Bake::wgsl(&[]) }, store)
    }

    /// Bakes materials for a renderer as [`Package::for_renderer`] does, with surfaces of them.
    ///
    /// # Errors
    /// Those of [`Package::new`].
    pub fn of_surfaces(
        materials: &[Material],
        surfaces: Vec<SurfaceEntry>,
        store: &dyn Store,
    ) -> Result<Self, ExportError> {
        Self::new(materials, &Bake { functions: lit_functions(), surfaces, ..Bake::wgsl(&[]) }, store)
    }
}

/// Groups of functions that show an environment.
pub fn lit_functions() -> Functions {
    [FunctionGroup::Environment].into_iter().collect()
}

/// The materials, each asking for the tables that blurred environments read, too.
pub fn lit(materials: &[Material]) -> Vec<Material> {
    let mut lit = materials.to_vec();
    // Lobes have their own energies.
    let of_layers = |material: &&mut Material| material.model() != ShadingModel::Lobes;
    lit.iter_mut().filter(of_layers).for_each(|material| material.bake.tables.extend(ENVIRONMENT_TABLES));
    lit
}
