//! From materials to the plan of their bake.

use luthier_lut::TableKind;
use luthier_manifest::reads;
use luthier_manifest::{ColorMode, Feature, Form, LayerRecord};
use luthier_material::{LayerExtras, Material};
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

use crate::form::RowForm;
use crate::graph::{Graph, Key};
use crate::kinds::{self, Site};
use crate::plan::{Plan, PlannedLayers};
use crate::records::{Parts, records, tint};
use crate::relief::ImageReader;
use crate::settings::{Ask, Asked, Settings};
use crate::{BakeError, limits};

/// How the tables of a material turn spectra into colours: spectrally, unless its file asks otherwise.
pub(crate) fn color_mode(material: &Material) -> ColorMode {
    material.bake.color.unwrap_or_default()
}

/// Number of materials that are planned at once. It bounds memory: a large bake has many more.
const SIDE_BY_SIDE: usize = 256;

/// The plan of one material.
#[derive(Default)]
struct Part {
    graph: Graph,
    layers: Vec<LayerRecord>,
    bare: Option<LayerRecord>,
    of_side: usize,
    /// Tiles in the order in which they stand in their tables.
    tiles: Vec<Wanted>,
}

/// A tile that a material reads.
struct Wanted {
    kind: TableKind,
    key: Key,
    name: String,
    reader: Reader,
}

/// Reader of a tile.
enum Reader {
    /// The record of a layer.
    Layer(usize),
    /// The record of the layer below a patina or a coat, as it is without that.
    Bare,
    /// A look-up in the tile before it.
    Run,
}

/// The settings on which the materials agree, and fixed defaults for the rest.
///
/// # Errors
/// [`BakeError::Conflict`] where materials ask for different values.
pub(crate) fn settings(materials: &[Material]) -> Result<Settings, BakeError> {
    let mut fixed = Vec::with_capacity(TableKind::ALL.len());
    for kind in TableKind::ALL {
        fixed.push(kinds::of(kind).fixed(Ask(materials))?);
    }
    let fixed = fixed.try_into().unwrap_or_else(|_| unreachable!("there is one of each kind"));
    let asked = TableKind::ALL.map(|kind| {
        materials.iter().map(|material| kinds::of(kind).asked(&material.bake)).fold(Asked::default(), Asked::or)
    });
    Ok(Settings::new(fixed, asked))
}

/// The plan of a set of materials with these settings.
///
/// # Errors
/// See [`BakeError`].
pub(crate) fn plan(materials: &[Material], settings: Settings, read_image: ImageReader<'_>) -> Result<Plan, BakeError> {
    let mut plan = Plan { settings, graph: Graph::default(), tiles: Default::default(), records: Vec::new() };
    for materials in materials.chunks(SIDE_BY_SIDE) {
        let parts = materials.par_iter().map(|material| Part::new(material, &plan.settings, read_image));
        for part in parts.collect::<Vec<Result<Part, BakeError>>>() {
            part?.enter(&mut plan);
        }
    }
    limits::check_buffer(&plan.records)?;
    Ok(plan)
}

impl Part {
    /// Adds the plan of a material, and numbers its tiles.
    fn enter(self, plan: &mut Plan) {
        let Self { graph, mut layers, mut bare, of_side, tiles } = self;
        plan.graph.merge(graph);
        for Wanted { kind, key, name, reader } in tiles {
            let list = &mut plan.tiles[kind as usize];
            let tile = Some(list.tile(key, name));
            match reader {
                Reader::Layer(i) => layers[i].tiles[kind] = tile,
                Reader::Bare => bare.iter_mut().for_each(|record| record.tiles[kind] = tile),
                // Two materials share all jobs of a run or none: its tiles follow each other.
                Reader::Run => list.has_runs = true,
            }
        }
        plan.records.push(PlannedLayers { layers, bare, of_side });
    }

    fn new(material: &Material, settings: &Settings, read_image: ImageReader<'_>) -> Result<Self, BakeError> {
        let mut part = Self::default();
        part.layers =
            part.records(material, settings, &material.reflecting_stack(), &material.layers, None, read_image)?;
        if material.is_bare_in_places() {
            part.bare = match material.side() {
                Some(side) => {
                    part.of_side = side.stack.layers.len();
                    // Its lobes are those of all its layers, of which shaders read the first one.
                    let records =
                        part.records(&side, settings, &side.stack, &side.layers, Some("bare-"), read_image)?;
                    records.into_iter().next()
                }
                // Models of statistics and of one interface do not show where a film is not.
                None if material.weighs_film() && !material.model().is_path() => None,
                None => {
                    let Stack { exterior, mut layers } = material.bare(&material.reflecting_stack());
                    layers.truncate(1);
                    let stack = Stack { exterior, layers };
                    let second = usize::from(!material.weighs_film());
                    let extras = &material.layers[second..=second];
                    let records = part.records(material, settings, &stack, extras, Some("bare-"), read_image)?;
                    records.into_iter().next()
                }
            };
            // The base beside it is no layer of this stack.
            let second = usize::from(!material.weighs_film());
            let diffuse_part = part.layers.get(second).map(|below| below.diffuse_part).unwrap_or_default();
            part.bare.iter_mut().for_each(|bare| bare.diffuse_part = diffuse_part);
        }
        Ok(part)
    }

    /// The records of a stack of a material. A tile is named after the material, then `bare` (a label for the layer
    /// below a patina or a coat), then the number of the layer.
    fn records(
        &mut self,
        material: &Material,
        settings: &Settings,
        stack: &Stack,
        extras: &[LayerExtras],
        bare: Option<&str>,
        read_image: ImageReader<'_>,
    ) -> Result<Vec<LayerRecord>, BakeError> {
        let (color, model) = (material.color(), material.model());
        let mut records = records(stack, material.bake.wavelengths_nm(), &Parts::of(material));
        for (record, extras) in records.iter_mut().zip(extras) {
            record.metal_f82_tint = extras.metallic.and_then(|metal| tint(metal.f82_tint));
            record.is_metal = extras.metallic.is_some_and(|metal| metal.is_metal);
        }
        // Other models show the base's colour under white light, as an albedo.
        if let (Some(last), true) = (records.last_mut(), model.honours(Feature::Reradiation, Form::Baked)) {
            last.reradiation = extras.last().and_then(|extras| extras.reradiation);
            if let Some(rows) = last.reradiation {
                last.albedo = rows.map(|row| row.iter().sum::<f64>().max(0.0));
            }
        }
        // Maps give each place an F0, or a film on the base of a family has another thickness there: it reflects by a series in the F0.
        let family = material.family().filter(|family| family.is_filmed && model.is_fitted());
        for (i, (record, extras)) in records.iter_mut().zip(extras).enumerate() {
            if extras.metallic.is_some() || family.is_some_and(|family| family.interface == i) {
                record.f0 = Interface::of(stack, i).and_then(|interface| interface.below.f0());
            }
        }
        let count = if bare.is_some() { 1 } else { stack.layers.len() };
        for (i, layer) in stack.layers.iter().enumerate().take(count) {
            let Some(interface) = Interface::of(stack, i) else { continue };
            let wanted = TableKind::ALL.into_iter().filter(|&kind| {
                // If a material requests D as a table, layers without a request compute it.
                let is_offered = kind != TableKind::Distribution || !settings.asked(kind).is_any();
                material.bake.asks_for(kind) || is_offered && reads(model, kind, &records, i)
            });
            let wanted: Vec<TableKind> = wanted.collect();
            if wanted.contains(&TableKind::Fresnel) || wanted.contains(&TableKind::Film) {
                records[i].critical_cot_sq = interface.sampled(&color).critical_cot_sq();
            }
            for kind in wanted {
                let Some(shape) = settings.shape(kind) else { continue };
                let (fixed, record) = (settings.fixed(kind), &records[i]);
                let (extras, interface) = (extras.get(i), &interface);
                // The key of a fit takes a while.
                let has_form = kind == TableKind::Lobes;
                let lobes = if has_form { kinds::lobes::form(material, settings) } else { RowForm::NEEDED };
                let site = Site { material, layer, extras, record, interface, color, shape, fixed, lobes, read_image };
                let Some(job) = kinds::of(kind).job(&site)? else { continue };
                let place = format!("{}/{}{i}", material.name, bare.unwrap_or_default());
                let name = kinds::of(kind).name(layer).map_or_else(|| place.clone(), str::to_owned);
                let reader = if bare.is_some() { Reader::Bare } else { Reader::Layer(i) };
                self.tiles.push(Wanted { kind, key: self.graph.add(job), name, reader });
                for (node, job) in (1..).zip(kinds::of(kind).followers(&site)) {
                    let (key, name) = (self.graph.add(job), format!("{place}-{node}"));
                    self.tiles.push(Wanted { kind, key, name, reader: Reader::Run });
                }
            }
        }
        Ok(records)
    }
}
