//! Materials baked in memory, for the runtime.

use std::path::Path;

use luthier_bake::Silent;
use luthier_gpu::{Artefacts, TableTexels, WgslShader};
use luthier_lut::{Atlas, TableKind};
use luthier_manifest::MapEntry;
use luthier_material::Material;
use luthier_shader::Target;
use luthier_texture::{FolderError, png};

use crate::artefacts::open;
use crate::bake_files::{BakeFiles, Shaders};
use crate::cli::Shading;
use crate::device::device;
use crate::failure::{Failure, Outcome};
use crate::materials::{bakeable, read_image, read_one, with_tables};

/// Tables that the environment of pictures reads beside the shader: reflectance and albedo of every interface.
const ENVIRONMENT_TABLES: [TableKind; 3] = [TableKind::Fresnel, TableKind::Fgd, TableKind::Film];

/// A material by file, which is baked for pictures, or by its name in a bake on disk, shaded as that was; and its number.
pub(crate) fn find(material: &str, shading: &Shading, out: &Path) -> Outcome<(Artefacts, u32)> {
    let file = Path::new(material);
    if file.extension().is_some_and(|e| e == "toml") {
        return Ok((bake_lit(&bakeable(vec![read_one(file)?], shading, false)?)?, 0));
    }
    let artefacts = Artefacts::read(&open(out)?).map_err(device)?;
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

/// The materials with the tables that blurred environments read.
pub(crate) fn lit(materials: &[Material]) -> Vec<Material> {
    with_tables(materials.to_vec(), &ENVIRONMENT_TABLES)
}

/// Bakes materials for pictures under a blurred environment; nothing is written.
pub(crate) fn bake_lit(materials: &[Material]) -> Outcome<Artefacts> {
    bake(&lit(materials))
}

/// Bakes materials; nothing is written.
pub(crate) fn bake(materials: &[Material]) -> Outcome<Artefacts> {
    let bake = luthier_bake::bake(materials, &read_image, &Silent).map_err(Failure::input)?;
    let shaders = Shaders { targets: vec![Target::Wgsl], ..Shaders::default() };
    let made = BakeFiles::new(materials, &bake, &shaders)?;
    let shaders = made
        .manifest
        .shaders
        .iter()
        .filter_map(|s| {
            let (_, bytes) = made.files.iter().find(|(path, _)| *path == s.file.path)?;
            Some(WgslShader { form: s.form, wgsl: String::from_utf8_lossy(bytes).into_owned() })
        })
        .collect();
    let artefacts =
        Artefacts::from_parts(made.manifest.clone(), table_texels(&bake.atlases), shaders).map_err(device)?;
    with_maps(artefacts, &made.files)
}

/// The artefacts with the maps that are among some files.
pub(crate) fn with_maps(artefacts: Artefacts, files: &[(String, Vec<u8>)]) -> Outcome<Artefacts> {
    let image = |map: &MapEntry| {
        let bytes = files.iter().find(|(name, _)| *name == map.file.path).map_or(&[][..], |(_, bytes)| bytes);
        png::decode(bytes).map_err(|source| FolderError::Texture { path: map.file.path.clone().into(), source }.into())
    };
    artefacts.with_maps(image).map_err(device)
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
