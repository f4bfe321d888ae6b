//! Materials baked in memory, for the runtime.

use std::path::Path;

use luthier_bake::Silent;
use luthier_gpu::{Artefacts, TableTexels, WgslShader};
use luthier_lut::Atlas;
use luthier_material::Material;

use crate::artefacts::manifest;
use crate::bake_files::BakeFiles;
use crate::cli::Shading;
use crate::device::device;
use crate::failure::{Failure, Outcome};
use crate::materials::{read_image, read_one, shaded, valid};

/// A material by file, which is baked, or by its name in a bake on disk, shaded as that was; and its number.
pub(crate) fn find(material: &str, shading: &Shading, out: &Path) -> Outcome<(Artefacts, u32)> {
    let file = Path::new(material);
    if file.extension().is_some_and(|e| e == "toml") {
        return Ok((bake(&shaded(valid(vec![read_one(file)?], false)?, shading))?, 0));
    }
    manifest(out)?;
    let artefacts = Artefacts::load(out).map_err(device)?;
    let number = artefacts.manifest.material_index(material).ok_or_else(|| {
        let known: Vec<&str> = artefacts.manifest.materials.iter().map(|m| m.name.as_str()).collect();
        Failure::Input(anyhow::anyhow!(
            "no material `{material}` in {}; known: {}; or name a .toml file",
            out.display(),
            known.join(", ")
        ))
    })?;
    Ok((artefacts, number))
}

/// Bakes materials; nothing is written.
pub(crate) fn bake(materials: &[Material]) -> Outcome<Artefacts> {
    let bake = luthier_bake::bake(materials, &read_image, &Silent).map_err(Failure::input)?;
    let made = BakeFiles::new(materials, &bake)?;
    let shaders = made
        .manifest
        .shaders
        .iter()
        .filter(|s| s.target == "wgsl")
        .filter_map(|s| {
            let (_, bytes) = made.files.iter().find(|(path, _)| *path == s.file.path)?;
            Some(WgslShader { form: s.form.clone(), wgsl: String::from_utf8_lossy(bytes).into_owned() })
        })
        .collect();
    let artefacts =
        Artefacts::from_parts(made.manifest.clone(), table_texels(&bake.atlases), shaders).map_err(device)?;
    let file = |path: &str| made.files.iter().find(|(name, _)| name == path).map(|(_, bytes)| bytes.clone());
    artefacts.with_maps(|entry| Ok(file(&entry.file.path).unwrap_or_default())).map_err(device)
}

/// The tables as a device gets them.
pub(crate) fn table_texels(atlases: &[Atlas]) -> Vec<TableTexels> {
    let table = |atlas: &Atlas| TableTexels {
        kind: atlas.kind,
        format: atlas.format,
        width: atlas.texels.width,
        height: atlas.texels.height,
        bytes: atlas.bytes.clone(),
    };
    atlases.iter().map(table).collect()
}
