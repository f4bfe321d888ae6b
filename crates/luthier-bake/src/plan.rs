//! Plan of a bake: the jobs to run, and which tile serves which layer.

use std::collections::BTreeMap;

use luthier_lut::TableKind;
use luthier_manifest::LayerRecord;

use crate::graph::{Graph, Job, Key, Results};
use crate::settings::Settings;

/// The tiles of one kind, in the order of their first use.
#[derive(Debug, Default)]
pub(crate) struct TileList {
    pub(crate) tiles: Vec<(String, Key)>,
    numbers: BTreeMap<Key, u32>,
    /// Whether look-ups mix successive tiles, which then lie one below the other.
    pub(crate) has_runs: bool,
}

impl TileList {
    /// The number of a tile: a new one, unless its key is known.
    pub(crate) fn tile(&mut self, key: Key, name: String) -> u32 {
        *self.numbers.entry(key).or_insert_with(|| {
            self.tiles.push((name, key));
            self.tiles.len() as u32 - 1
        })
    }
}

/// Everything to compute for a set of materials.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) settings: Settings,
    pub(crate) graph: Graph,
    /// One per table kind, in binding order.
    pub(crate) tiles: [TileList; TableKind::ALL.len()],
    /// Layer records per material, tiles filled in.
    pub(crate) records: Vec<PlannedLayers>,
}

/// The records of a material.
#[derive(Debug)]
pub(crate) struct PlannedLayers {
    pub(crate) layers: Vec<LayerRecord>,
    /// The layer below a patina or a coat, as it is without that.
    pub(crate) bare: Option<LayerRecord>,
    /// Number of layers of the side of a coat or a film with a weight, see [`MaterialEntry::side`](luthier_manifest::MaterialEntry::side); 0 without one.
    pub(crate) of_side: usize,
}

impl PlannedLayers {
    /// Blocks of the material buffer, see [`MaterialEntry::blocks`](luthier_manifest::MaterialEntry::blocks).
    pub(crate) fn blocks(&self) -> usize {
        let of_side = if self.of_side > 0 { 1 + self.of_side } else { 0 };
        self.layers.len() + usize::from(self.bare.is_some()) + of_side
    }
}

impl Plan {
    /// The tables that have tiles, in binding order.
    pub(crate) fn used(&self) -> impl Iterator<Item = (TableKind, &TileList)> {
        TableKind::ALL.into_iter().zip(&self.tiles).filter(|(_, tiles)| !tiles.tiles.is_empty())
    }

    /// The jobs of the tiles of a kind by the numbers of these.
    pub(crate) fn jobs<J: Job>(&self, kind: TableKind) -> impl Iterator<Item = (usize, &J)> {
        let tiles = self.tiles[kind as usize].tiles.iter().enumerate();
        tiles.filter_map(|(tile, (_, key))| Some((tile, self.graph.get(*key)?)))
    }

    /// The first reader of a tile: numbers of the material and of the layer.
    pub(crate) fn reader(&self, kind: TableKind, tile: u32) -> Option<(usize, Option<usize>)> {
        self.records.iter().enumerate().find_map(|(number, PlannedLayers { layers, bare, .. })| {
            let layer = layers.iter().position(|layer| layer.tiles[kind] == Some(tile));
            let of_bare = bare.as_ref().filter(|record| record.tiles[kind] == Some(tile)).map(|_| 1);
            layer.or(of_bare).map(|layer| (number, Some(layer)))
        })
    }

    /// The largest error of the tiles of a kind, without some of them.
    pub(crate) fn worst(&self, results: &Results, kind: TableKind, left_out: &[usize]) -> f64 {
        let tiles = self.tiles[kind as usize].tiles.iter().enumerate();
        let counted = tiles.filter(|(tile, _)| !left_out.contains(tile)).map(|(_, (_, key))| *key);
        counted.filter_map(|key| results.find(key)).map(|t| t.error.max_abs_err).fold(0.0, f64::max)
    }
}
