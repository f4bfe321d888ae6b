//! Plan from materials to jobs: which tile serves which layer.

use std::collections::BTreeMap;

use luthier_lut::{Image, TableKind};
use luthier_manifest::{ColorMode, LayerRecord};
use luthier_material::{LayerExtras, Material};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;

use crate::graph::{Graph, Key};
use crate::kinds::{self, Site};
use crate::records::records;
use crate::settings::Settings;
use crate::{BakeError, limits};

/// The tiles of one kind, in the order of their first use.
#[derive(Debug, Default)]
pub(crate) struct TileList {
    pub(crate) tiles: Vec<(String, Key)>,
    numbers: BTreeMap<Key, u32>,
    /// Whether look-ups mix tiles that follow each other, which are then one below the other.
    pub(crate) has_runs: bool,
}

impl TileList {
    fn tile(&mut self, key: Key, name: impl FnOnce() -> String) -> u32 {
        *self.numbers.entry(key).or_insert_with(|| {
            self.tiles.push((name(), key));
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
    /// The layer below a patina where none has grown.
    pub(crate) bare: Option<LayerRecord>,
}

/// The colour that the tables of a material hold.
pub(crate) fn color(material: &Material) -> Color {
    match color_mode(material) {
        ColorMode::Spectral => Color::Spectral,
        ColorMode::ThreeWavelengths => Color::ThreeWavelengths(material.bake.wavelengths_nm()),
    }
}

/// How the tables of a material come by their colour: spectrally, unless its file asks otherwise.
pub(crate) fn color_mode(material: &Material) -> ColorMode {
    material.bake.color.unwrap_or_default()
}

/// Reads an image that a material names: material file, path as written there.
pub type ImageReader<'a> = &'a dyn Fn(&str, &str) -> Result<Image, String>;

impl Plan {
    pub(crate) fn new(
        materials: &[Material],
        settings: Settings,
        read_image: ImageReader<'_>,
    ) -> Result<Self, BakeError> {
        let mut plan = Self { settings, graph: Graph::default(), tiles: Default::default(), records: Vec::new() };
        for material in materials {
            let records = plan.material(material, read_image)?;
            plan.records.push(records);
        }
        limits::check_buffer(&plan.records)?;
        Ok(plan)
    }

    fn material(&mut self, material: &Material, read: ImageReader<'_>) -> Result<PlannedLayers, BakeError> {
        let layers = self.layers(material, &material.stack, material.layers.as_slice(), "", read)?;
        let bare = match &material.effects.patina {
            Some(_) if material.stack.layers.len() > 1 => {
                let stack =
                    Stack { exterior: material.stack.exterior.clone(), layers: vec![material.stack.layers[1].clone()] };
                self.layers(material, &stack, &material.layers[1..2], "bare-", read)?.into_iter().next()
            }
            _ => None,
        };
        Ok(PlannedLayers { layers, bare })
    }

    /// The records of a stack of a material; names of tiles are the material's and `label`, then the layer's number.
    fn layers(
        &mut self,
        material: &Material,
        stack: &Stack,
        extras: &[LayerExtras],
        label: &str,
        read_image: ImageReader<'_>,
    ) -> Result<Vec<LayerRecord>, BakeError> {
        let (color, model) = (color(material), material.model());
        let mut records = records(stack, material.bake.wavelengths_nm());
        for (i, layer) in stack.layers.iter().enumerate() {
            let Some(interface) = Interface::of(stack, i) else { continue };
            let wanted = TableKind::ALL.map(|kind| {
                // Where some materials ask for D as a table, it is computed for the others.
                let is_offered = kind != TableKind::Distribution || !self.settings.asked(kind).is_any();
                material.bake.asks_for(kind) || is_offered && model.reads(kind, &records, i)
            });
            let wants = |kind: TableKind| wanted[kind as usize];
            if wants(TableKind::Fresnel) || wants(TableKind::Film) {
                records[i].critical_cot_sq = interface.sampled(&color).critical_cot_sq();
            }
            for kind in TableKind::ALL.into_iter().filter(|&kind| wants(kind)) {
                let Some(shape) = self.settings.shape(kind) else { continue };
                let (fixed, record) = (self.settings.fixed(kind), &records[i]);
                let (extras, interface) = (extras.get(i), &interface);
                let lobes = self.settings.lobes;
                let site = Site { material, layer, extras, record, interface, color, shape, fixed, lobes, read_image };
                let Some(job) = kinds::of(kind).job(&site)? else { continue };
                let key = self.graph.add(job);
                let own = || kinds::of(kind).name(layer).map(str::to_owned);
                let name = || own().unwrap_or_else(|| format!("{}/{label}{i}", material.name));
                let followers = kinds::of(kind).followers(&site);
                let tiles = &mut self.tiles[kind as usize];
                records[i].tiles[kind] = Some(tiles.tile(key, name));
                // The jobs of a run are those of no other material, or all of another's: their tiles follow each other.
                tiles.has_runs |= !followers.is_empty();
                for (node, job) in (1..).zip(followers) {
                    let key = self.graph.add(job);
                    tiles.tile(key, || format!("{}/{label}{i}-{node}", material.name));
                }
            }
        }
        Ok(records)
    }
}
