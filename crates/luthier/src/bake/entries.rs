//! Entries of the manifest: materials and tables.

use luthier_bake::{BakedMaterial, live_numbers};
use luthier_export::{Map, input, sha256};
use luthier_lut::{AtlasLayout, TableKind, TexelFormat};
use luthier_manifest::{FileEntry, MaterialEntry, TableEntry};
use luthier_material::Material;

use super::maps;
use crate::{Error, paths};

/// The manifest's entry of a table, without its tiles and files.
pub(super) fn table_entry(kind: TableKind, layout: &AtlasLayout, format: TexelFormat) -> TableEntry {
    let [width, height] = layout.size();
    TableEntry {
        kind,
        layout: layout.clone(),
        format,
        texel_bytes: u64::from(width) * u64::from(height) * u64::from(format.texel_bytes()),
        texture: FileEntry::default(),
        truth: FileEntry::default(),
        picture: FileEntry::default(),
        tiles: Vec::new(),
    }
}

/// The manifest's entries of the materials, and their maps.
pub(super) fn material_entries(
    materials: &[Material],
    baked: &[BakedMaterial],
) -> Result<(Vec<MaterialEntry>, Vec<Map>), Error> {
    let (mut entries, mut maps) = (Vec::with_capacity(materials.len()), Vec::new());
    for (number, (material, baked)) in (0..).zip(materials.iter().zip(baked)) {
        let mut own = Vec::with_capacity(baked.maps.len());
        for map in &baked.maps {
            let (entry, picture, png) = maps::shipped(material, map)?;
            maps.push(Map { material: number, slot: map.slot, layer: map.layer, picture, png });
            own.push(entry);
        }
        let entry = MaterialEntry {
            name: material.name.clone(),
            source: material.source.clone(),
            source_hash: source_hash(material)?,
            class: material.class.symbol().to_owned(),
            model: baked.model,
            color: baked.color,
            wavelengths_nm: material.bake.wavelengths_nm(),
            constants: baked.constants.clone(),
            layers: baked.records.clone(),
            maps: own,
            live: Vec::new(),
        };
        entries.push(entry.with_live(live_numbers(material)));
    }
    Ok((entries, maps))
}

/// The hash of a material file and of the files that it names: of its text, followed by the hash of each file.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// // Neither a picture nor a table of an index: the hash is that of the text.
/// let material = luthier::parse("chalk.toml", chalk)?;
/// assert_eq!(luthier::source_hash(&material)?, luthier::sha256(chalk.as_bytes()));
/// # Ok::<(), luthier::Error>(())
/// ```
///
/// # Errors
/// [`Error::File`].
pub fn source_hash(material: &Material) -> Result<String, Error> {
    let mut text = material.text.clone();
    for path in &material.files {
        text.push_str(&sha256(&named_file(material, path)?));
    }
    Ok(sha256(text.as_bytes()))
}

/// A file that a material names.
fn named_file(material: &Material, path: &str) -> Result<Vec<u8>, Error> {
    let path = paths::beside(&material.source, path);
    input::image(&path).map_err(|source| Error::file("read", &path, source))
}
