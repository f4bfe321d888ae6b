//! Packages for a renderer: in memory, with shaders in WGSL.

use luthier_bake::Store;
use luthier_lut::TableKind;
use luthier_manifest::{FunctionGroup, Functions, SurfaceEntry};
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

/// Groups of functions that show an environment: blurred beforehand, and in directions that are drawn.
pub fn lit_functions() -> Functions {
    [FunctionGroup::Environment, FunctionGroup::Sample].into_iter().collect()
}

/// Texels of the energies of rough interfaces, over the view and the slope parameter, where pictures alone read them. A table of the size that a bake
/// looks for takes three times as long, more than all the rest of a first picture.
const ENERGY_SIZE: [u32; 2] = [32, 16];

/// The materials, each asking for the tables that blurred environments read, too, as far as its distributions of slopes have them.
pub fn lit(materials: &[Material]) -> Vec<Material> {
    let mut lit = materials.to_vec();
    let is_of_pictures =
        |material: &Material| !material.model().is_statistical() && !material.bake.asks_for(TableKind::Fgd);
    let is_small = materials.iter().all(is_of_pictures);
    // Lobes have their own energies.
    let of_layers = |material: &&mut Material| !material.model().is_fitted();
    for material in lit.iter_mut().filter(of_layers) {
        // Of facets without walks there are no albedos: renderers draw directions.
        let has_walks = material.stack.layers.iter().all(|layer| layer.surface.distribution.has_walks());
        let tables = ENVIRONMENT_TABLES.into_iter().filter(|kind| has_walks || *kind != TableKind::Fgd);
        material.bake.tables.extend(tables);
        if is_small && has_walks {
            material.bake.fgd.size = Some(ENERGY_SIZE);
        }
    }
    lit
}
