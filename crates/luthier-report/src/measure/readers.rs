//! Readers of tiles.

use std::ops::Range;

use luthier_lut::TableKind;
use luthier_manifest::MaterialEntry;

use crate::measure::subject::Subject;

/// A layer that reads a tile: numbers of the material and of the layer.
pub(crate) type User = (usize, usize);

/// Tiles that the nominal surface of a layer reads, counted from the layer's own tile. Lobes of an anisotropic stack have a tile for each azimuth.
/// Lobes under a film that varies have one for each thickness, with the nominal thickness in the middle.
pub(crate) fn run(material: &MaterialEntry, kind: TableKind) -> Range<u32> {
    let lobes = material.constants.lobes.filter(|_| kind == TableKind::Lobes);
    let nominal = lobes.and_then(|lobes| lobes.varying).map_or(0, |varying| varying.nominal() as u32);
    nominal..nominal + lobes.and_then(|lobes| lobes.axes).map_or(1, |axes| axes.tiles)
}

/// Number of tiles that a layer of a material reads, counted from its own tile, over all views and all values of maps.
pub(crate) fn tiles(material: &MaterialEntry, kind: TableKind) -> u32 {
    let varying = material.constants.lobes.filter(|_| kind == TableKind::Lobes).and_then(|lobes| lobes.varying);
    run(material, kind).end.max(varying.map_or(1, |varying| varying.tiles))
}

/// The layers whose nominal surface reads a tile.
pub(crate) fn users(subject: &Subject<'_>, kind: TableKind, tile: u32) -> Vec<User> {
    let mut out = Vec::new();
    for (m, material) in subject.manifest.materials.iter().enumerate() {
        let run = run(material, kind);
        for (l, layer) in material.layers.iter().enumerate() {
            if layer.tiles[kind].is_some_and(|first| tile >= first && run.contains(&(tile - first))) {
                out.push((m, l));
            }
        }
    }
    out
}

/// The materials whose bare layers under a patina or a coat read a tile.
pub(crate) fn bare_users(subject: &Subject<'_>, kind: TableKind, tile: u32) -> Vec<usize> {
    let materials = subject.manifest.materials.iter().enumerate();
    let reads = |m: &MaterialEntry| {
        let first = m.constants.bare().and_then(|bare| bare.tiles[kind]);
        // Lobes of layers below a coat have a tile for each node.
        let count = m.side().map_or(1, |side| tiles(&side, kind));
        first.is_some_and(|first| (first..first + count).contains(&tile))
    };
    materials.filter(|(_, material)| reads(material)).map(|(number, _)| number).collect()
}
