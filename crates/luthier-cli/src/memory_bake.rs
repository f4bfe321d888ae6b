//! Packages for pictures.

use std::path::Path;

use luthier_export::{Bake, MemoryStore, Package, read_one};
use luthier_lut::TableKind;
use luthier_manifest::Form;
use luthier_material::Material;

use crate::cli::Shading;
use crate::failure::{Failure, Outcome};
use crate::materials::{bakeable, with_tables};

/// Tables that the environment of pictures reads beside the shader: reflectance and albedo of every interface.
const ENVIRONMENT_TABLES: [TableKind; 3] = [TableKind::Fresnel, TableKind::Fgd, TableKind::Film];

/// A material by file, which is baked for pictures, or by its name in a bake on disk, shaded as that was; and its number.
pub(crate) fn find(material: &str, shading: &Shading, out: &Path) -> Outcome<(Package, u32)> {
    let file = Path::new(material);
    if file.extension().is_some_and(|e| e == "toml") {
        return Ok((bake_lit(&bakeable(vec![read_one(file)?], shading, false)?)?, 0));
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

/// The materials with the tables that blurred environments read.
pub(crate) fn lit(materials: &[Material]) -> Vec<Material> {
    with_tables(materials.to_vec(), &ENVIRONMENT_TABLES)
}

/// Bakes materials for pictures under a blurred environment; nothing is written.
pub(crate) fn bake_lit(materials: &[Material]) -> Outcome<Package> {
    bake(&lit(materials))
}

/// Bakes materials; nothing is written.
pub(crate) fn bake(materials: &[Material]) -> Outcome<Package> {
    Ok(Package::new(materials, &Bake::wgsl(&Form::ALL), &MemoryStore::default())?)
}
