//! Materials that a command works on.

use luthier_export::{Source, of_model, refuse};
use luthier_material::Material;
use luthier_terminal::{Outcome, valid};

use crate::cli::Shading;

/// The materials that can be baked, shaded by the model that the command line asks for; or, when anything is refused, its diagnostics
/// and a failure.
pub(crate) fn bakeable(mut sources: Vec<Source>, shading: &Shading, quiet: bool) -> Outcome<Vec<Material>> {
    refuse(&mut sources, |material| of_model(material, shading.model));
    Ok(shaded(valid(sources, quiet)?, shading))
}

/// The materials, shaded by the model that the command line asks for, with its tables.
pub(crate) fn shaded(mut materials: Vec<Material>, shading: &Shading) -> Vec<Material> {
    if shading.model.is_some() {
        materials.iter_mut().for_each(|material| material.bake.model = shading.model);
    }
    materials.iter_mut().for_each(|material| material.bake.tables.extend(&shading.tables));
    materials
}
