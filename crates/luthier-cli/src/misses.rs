//! Interfaces whose tables miss what a bake aims at.

use std::path::Path;

use luthier_export::{Source, origin, read_image, read_one};
use luthier_lut::TableKind;
use luthier_manifest::Manifest;
use luthier_material::{Diagnostic, Material, Severity};
use luthier_terminal::{Outcome, print_diagnostics};

/// A warning for every layer that reads a tile which misses its aim, at its line of its file; unless quiet, they are printed. Files are named from `folder`.
pub(crate) fn name(manifest: &Manifest, folder: &Path, quiet: bool) -> Outcome<Vec<Diagnostic>> {
    let mut warnings = Vec::new();
    for table in &manifest.tables {
        for material in &manifest.materials {
            for (layer, record) in material.layers.iter().enumerate() {
                let Some(tile) = record.tiles[table.kind].and_then(|tile| table.tiles.get(tile as usize)) else {
                    continue;
                };
                let Some((error, aim)) = tile.miss() else { continue };
                let source = read_one(&origin(folder, &material.source))?;
                let Ok(parsed) = &source.parsed else { continue };
                let warning = diagnostic(&parsed.material, layer, table.kind, error, aim);
                if !quiet {
                    print_diagnostics([&warning], &source.text);
                }
                warnings.push(warning);
            }
        }
    }
    Ok(warnings)
}

/// Adds a warning for every layer whose row would miss, as far as that can be said without a bake.
pub(crate) fn foresee(sources: &mut [Source]) {
    for source in sources {
        let Ok(parsed) = &mut source.parsed else { continue };
        // What keeps a material from being baked is for others to say.
        let rows = luthier_bake::kinked_rows(&parsed.material, &read_image).unwrap_or_default();
        for (layer, error) in rows {
            let warning = diagnostic(&parsed.material, layer, TableKind::Fresnel, error, luthier_bake::AIM);
            parsed.warnings.push(warning);
        }
    }
}

fn diagnostic(material: &Material, layer: usize, kind: TableKind, error: f64, aim: f64) -> Diagnostic {
    let name = kind.name();
    let message =
        format!("the {name} table of layer {layer} is off by up to {error:.1e}, where a bake aims at {aim:.1e}");
    let hint =
        "shaders of the form `full` read no tables; `max_abs` under `[budget]` limits the error of tables".to_owned();
    material.diagnostic(Severity::Warning, &format!("layer.{layer}.ior"), message, Some(hint))
}
