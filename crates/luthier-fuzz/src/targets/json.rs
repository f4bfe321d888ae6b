//! JSON: manifests, reports, evidence.

use luthier_export::{Package, Table};
use luthier_lut::AtlasLayout;
use luthier_manifest::{Form, Lock, Manifest, TableEntry, material_buffer};
use luthier_report::stability::Stability;
use luthier_report::{Costs, Report, StabilitySummary};
use luthier_texture::Texture;

/// Bytes of the largest texture that is made for an entry of a manifest.
const TEXELS_MAX: u64 = 1 << 20;

/// The lock of a folder of materials.
pub(super) fn lock(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(lock) = Lock::from_json(&text) else { return };
    let printed = lock.to_json().unwrap_or_else(|error| panic!("read, but not written: {error}"));
    assert_eq!(Lock::from_json(&printed).ok().as_ref(), Some(&lock));
    assert!(lock.decides_as(&lock.clone()));
}

/// The manifest of a bake.
pub(super) fn manifest(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(manifest) = Manifest::from_json(&text) else { return };
    let printed = manifest.to_json().unwrap_or_else(|error| panic!("read, but not written: {error}"));
    assert_eq!(Manifest::from_json(&printed).ok().as_ref(), Some(&manifest));
    let _ = Form::ALL.map(|form| manifest.has(form));
    for material in &manifest.materials {
        let _ = material.varies();
        assert!(manifest.material_index(&material.name).is_some());
    }
    let Some(tables) = manifest.tables.iter().map(blank).collect::<Option<Vec<Table>>>() else { return };
    let Ok(package) = Package::from_parts(manifest, tables, Vec::new()) else { return };
    let _ = material_buffer(&package.manifest.materials);
    let _ = package.texel_bytes();
    for (entry, (kind, image)) in package.manifest.tables.iter().zip(package.textures().into_iter().flatten()) {
        assert_eq!(entry.kind, kind);
        for tile in [0, entry.layout.tiles - 1] {
            within(&entry.layout, tile, [image.width, image.height]);
        }
    }
}

/// Texels of zeros for an entry.
fn blank(entry: &TableEntry) -> Option<Table> {
    let [width, height] = entry.layout.checked_size()?;
    let side = entry.format.block_side();
    let texels = u64::from(width.div_ceil(side) * side).checked_mul(height.into())?;
    let bytes = texels.checked_mul(entry.format.texel_bytes().into()).filter(|bytes| *bytes <= TEXELS_MAX)?;
    let texture = Texture { format: entry.format, width, height, bytes: vec![0; bytes as usize] };
    Some(Table { kind: entry.kind, texture, truth: None })
}

fn within(layout: &AtlasLayout, tile: u32, size: [u32; 2]) {
    assert_eq!(layout.size(), size);
    for corner in [layout.origin(tile), layout.header(tile)] {
        assert!(corner[0] <= size[0] && corner[1] <= size[1], "tile {tile} at {corner:?} of {size:?}");
    }
}

/// A report.
pub(super) fn report(bytes: &[u8]) {
    let Ok(report) = Report::from_json(&String::from_utf8_lossy(bytes)) else { return };
    let printed = report.to_json().unwrap_or_else(|error| panic!("read, but not written: {error}"));
    assert_eq!(Report::from_json(&printed).ok().as_ref(), Some(&report));
    assert!(!report.to_markdown().is_empty());
}

/// The stability suite.
pub(super) fn stability(bytes: &[u8]) {
    let Ok(suite) = Stability::from_json(&String::from_utf8_lossy(bytes)) else { return };
    let printed = suite.to_json().unwrap_or_else(|error| panic!("read, but not written: {error}"));
    assert_eq!(Stability::from_json(&printed).ok().as_ref(), Some(&suite));
    let _ = StabilitySummary::of(&suite);
}

/// Costs of shaders.
pub(super) fn costs(bytes: &[u8]) {
    let Ok(costs) = serde_json::from_slice::<Costs>(bytes) else { return };
    let printed = serde_json::to_string(&costs).unwrap_or_else(|error| panic!("read, but not written: {error}"));
    assert_eq!(serde_json::from_str::<Costs>(&printed).ok().as_ref(), Some(&costs));
}
