//! Warnings about tables that miss the aim of a bake, or a tenth of their largest value.

use luthier_lut::TableKind;
use luthier_manifest::Manifest;
use luthier_material::{Diagnostic, Material, Severity};

use crate::pictures::read_image;

/// Warnings for layers of a bake whose tiles miss their aim, or are off by more than a tenth of their largest value, each at the line of its layer.
/// Materials are found by name.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, refusals};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
///
/// let materials = [luthier::parse("gold.toml", text)?];
/// let package = Bake::wgsl(&[Form::Baked]).package(&materials, &MemoryStore::default())?;
/// assert!(refusals::misses(&package.manifest, &materials).is_empty());
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn misses(manifest: &Manifest, materials: &[Material]) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for table in &manifest.tables {
        for entry in &manifest.materials {
            let Some(material) = materials.iter().find(|material| material.name == entry.name) else { continue };
            for (layer, record) in entry.layers.iter().enumerate() {
                let tile = record.tiles[table.kind].and_then(|tile| table.tiles.get(tile as usize));
                let told = tile.and_then(|tile| off(tile.miss(), tile.coarse()));
                warnings.extend(told.map(|off| diagnostic(material, layer, table.kind, &off)));
            }
        }
    }
    warnings
}

/// Warnings for layers whose rows will miss their aim, as far as this is known without a bake.
///
/// ```
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
/// // Rows of gold are smooth. Those of a medium that mirrors beyond a critical angle have a kink.
/// let gold = luthier::parse("gold.toml", text)?;
/// assert!(luthier::refusals::foreseen_misses(&gold).is_empty());
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn foreseen_misses(material: &Material) -> Vec<Diagnostic> {
    // Other functions report why a material cannot be baked.
    let rows = luthier_bake::kinked_rows(material, &read_image).unwrap_or_default().into_iter();
    let told = rows.filter_map(|(layer, error)| Some((layer, off(Some((error, luthier_bake::AIM)), None)?)));
    told.map(|(layer, off)| diagnostic(material, layer, TableKind::Fresnel, &off)).collect()
}

/// The error of a tile in words, with the aim that it misses and the largest value of which it is more than a tenth; `None` for a tile that does neither.
fn off(missed: Option<(f64, f64)>, coarse: Option<(f64, f64)>) -> Option<String> {
    let (error, _) = missed.or(coarse)?;
    let part = coarse
        .map_or(String::new(), |(_, largest)| format!(", more than a tenth of its largest value ({largest:.1e})"));
    let aim = missed.map_or(String::new(), |(_, aim)| format!(", where a bake aims at {aim:.1e}"));
    Some(format!("off by up to {error:.1e}{part}{aim}"))
}

fn diagnostic(material: &Material, layer: usize, kind: TableKind, off: &str) -> Diagnostic {
    let message = format!("the {} table of layer {layer} is {off}", kind.name());
    let hint =
        "shaders of the form `full` read no tables; `max_abs` under `[budget]` limits the error of tables".to_owned();
    material.diagnostic(Severity::Warning, &format!("layer.{layer}.ior"), message, Some(hint))
}
