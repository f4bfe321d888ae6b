//! Warnings about tables that miss the aim of a bake.

use luthier_lut::TableKind;
use luthier_manifest::Manifest;
use luthier_material::{Diagnostic, Material, Severity};

use crate::pictures::read_image;

/// Warnings for layers of a bake whose tiles miss their aim, each at the line of its layer. Materials are found by name.
pub fn misses(manifest: &Manifest, materials: &[Material]) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for table in &manifest.tables {
        for entry in &manifest.materials {
            let Some(material) = materials.iter().find(|material| material.name == entry.name) else { continue };
            for (layer, record) in entry.layers.iter().enumerate() {
                let tile = record.tiles[table.kind].and_then(|tile| table.tiles.get(tile as usize));
                if let Some((error, aim)) = tile.and_then(|tile| tile.miss()) {
                    warnings.push(diagnostic(material, layer, table.kind, error, aim));
                }
            }
        }
    }
    warnings
}

/// Warnings for layers whose rows will miss their aim, as far as this is known without a bake.
pub fn foreseen_misses(material: &Material) -> Vec<Diagnostic> {
    // Other functions report why a material cannot be baked.
    let rows = luthier_bake::kinked_rows(material, &read_image).unwrap_or_default().into_iter();
    rows.map(|(layer, error)| diagnostic(material, layer, TableKind::Fresnel, error, luthier_bake::AIM)).collect()
}

fn diagnostic(material: &Material, layer: usize, kind: TableKind, error: f64, aim: f64) -> Diagnostic {
    let name = kind.name();
    let message =
        format!("the {name} table of layer {layer} is off by up to {error:.1e}, where a bake aims at {aim:.1e}");
    let hint =
        "shaders of the form `full` read no tables; `max_abs` under `[budget]` limits the error of tables".to_owned();
    material.diagnostic(Severity::Warning, &format!("layer.{layer}.ior"), message, Some(hint))
}
