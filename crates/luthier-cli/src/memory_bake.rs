//! Packages for pictures.

use std::path::Path;

use luthier::{Bake, Files, Source, TomlFile, lit};
use luthier_export::Package;
use luthier_gpu::Shown;
use luthier_manifest::Form;
use luthier_terminal::{Failure, Outcome};

use crate::cli::Shading;
use crate::materials::{bakeable, bakeable_with_surfaces};
use crate::store::store;

/// A material or surface for a picture: by its file, which is baked in memory, or by its name in a bake on disk.
pub(crate) fn shown(subject: &str, shading: &Shading, out: &Path) -> Outcome<(Package, Shown)> {
    let file = Path::new(subject);
    if file.extension().is_some_and(|e| e == "toml") {
        let (materials, surfaces) =
            bakeable_with_surfaces(Files::of(vec![TomlFile::read(file)?]), &shading.in_forms(&[]), false)?;
        let shown = if surfaces.is_empty() { Shown::Material(0) } else { Shown::Surface(0) };
        let bake = Bake { surfaces, ..Bake::lit() };
        return Ok((bake.package(&lit(&materials), store()?)?, shown));
    }
    let package = Package::read(out)?;
    if let Some(number) = package.manifest.surface_index(subject) {
        return Ok((package, Shown::Surface(number)));
    }
    let (package, number) = find(subject, shading, &[], out)?;
    Ok((package, Shown::Material(number)))
}

/// A package with a material, and the number of the material. It is named by its file, which is baked in memory, or by its name in a bake on disk.
pub(crate) fn find(material: &str, shading: &Shading, forms: &[Form], out: &Path) -> Outcome<(Package, u32)> {
    let file = Path::new(material);
    if file.extension().is_some_and(|e| e == "toml") {
        let materials = bakeable(vec![Source::read(file)?], &shading.in_forms(forms), false)?;
        return Ok((Bake::lit().package(&lit(&materials), store()?)?, 0));
    }
    let package = Package::read(out)?;
    let number = package.manifest.material_index(material).ok_or_else(|| {
        let known: Vec<&str> = package.manifest.materials.iter().map(|m| m.name.as_str()).collect();
        Failure::Input(anyhow::anyhow!(
            "no material `{material}` in {}; known: {}; or name a .toml file",
            out.display(),
            known.join(", ")
        ))
    })?;
    Ok((package, number))
}
