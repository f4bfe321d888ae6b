//! Plan from materials to jobs: which tile serves which layer.

use std::collections::BTreeMap;

use luthier_lut::{Image, TableKind};
use luthier_manifest::{ColorMode, LayerRecord, ShadingModel};
use luthier_material::{FilmVariation, LayerExtras, Material};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Film, FilmThickness, Layer, Stack};

use crate::BakeError;
use crate::distribution::DistributionJob;
use crate::escape::EscapeJob;
use crate::fgd::{FgdJob, FgdTruthJob};
use crate::film::FilmJob;
use crate::fresnel::FresnelJob;
use crate::graph::Graph;
use crate::job::{Job, Key};
use crate::limits;
use crate::phase::PhaseJob;
use crate::records::records;
use crate::relief::Relief;
use crate::settings::Settings;
use crate::thickness::ThicknessJob;

/// The tiles of one kind, in the order of their first use.
#[derive(Debug, Default)]
pub(crate) struct Tiles {
    pub(crate) tiles: Vec<(String, Key)>,
    numbers: BTreeMap<Key, u32>,
}

impl Tiles {
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
    pub(crate) tiles: [Tiles; TableKind::ALL.len()],
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

/// The model that shades a material: Elek's, unless its file asks for another.
pub(crate) fn shading_model(material: &Material) -> ShadingModel {
    material.bake.model.unwrap_or_default()
}

/// Whether a model follows light through the layers as statistics, and reads what they send back downward.
pub(crate) fn is_statistical(model: ShadingModel) -> bool {
    matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi)
}

/// Whether the `baked` shader of a model reads a kind of table for a layer of a stack, by its number.
fn reads(model: ShadingModel, kind: TableKind, stack: &Stack, number: usize, record: &LayerRecord) -> bool {
    let has_film = !stack.layers[number].films.is_empty();
    match model {
        ShadingModel::Phong => false,
        // They look at the first layer alone.
        ShadingModel::Microfacet | ShadingModel::GranierHeidrich if number > 0 => false,
        ShadingModel::Elek | ShadingModel::WeidlichWilkie | ShadingModel::Microfacet => match kind {
            TableKind::Fresnel => !record.varies(),
            TableKind::Film => record.varies(),
            TableKind::Thickness => record.varies() && number == 0,
            TableKind::Distribution => true,
            TableKind::Fgd | TableKind::Phase | TableKind::Escape => false,
        },
        ShadingModel::Belcour | ShadingModel::Yamaguchi => match kind {
            TableKind::Fgd => true,
            TableKind::Escape => Interface::of(stack, number + 1).is_some(),
            _ => false,
        },
        // Transparent interfaces without a film are Schlick's form.
        ShadingModel::GranierHeidrich => match kind {
            TableKind::Phase | TableKind::Thickness => has_film,
            TableKind::Fresnel => !has_film && matches!(stack.layers[number].base, Base::Conductor { .. }),
            _ => false,
        },
    }
}

/// Whether the file of a material, or whoever bakes it, asks for a kind of table.
pub(crate) fn asks_for(material: &Material, kind: TableKind) -> bool {
    material.bake.asks_for(kind)
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
        read: ImageReader<'_>,
    ) -> Result<Vec<LayerRecord>, BakeError> {
        let wavelengths_nm = material.bake.wavelengths_nm();
        let (color, model) = (color(material), shading_model(material));
        let mut records = records(stack, wavelengths_nm);
        for (i, (record, layer)) in records.iter_mut().zip(&stack.layers).enumerate() {
            let Some(interface) = Interface::of(stack, i) else { continue };
            let name = || format!("{}/{label}{i}", material.name);
            let wanted = TableKind::ALL.map(|kind| {
                // Where some materials ask for D as a table, it is computed for the others.
                let is_offered = kind != TableKind::Distribution || !self.settings.asked.distribution;
                asks_for(material, kind) || is_offered && reads(model, kind, stack, i, record)
            });
            let wants = |kind: TableKind| wanted[kind as usize];
            if wants(TableKind::Fresnel) || wants(TableKind::Film) {
                record.critical_cot_sq = interface.sampled(&color).critical_cot_sq();
            }
            if wants(TableKind::Fresnel) {
                self.fresnel(record, interface.clone(), color, &name);
            }
            if wants(TableKind::Distribution) {
                self.distribution(record, layer);
            }
            if wants(TableKind::Fgd) {
                self.fgd(record, layer, interface.clone(), color, &name);
            }
            if wants(TableKind::Escape) {
                self.escape(record, &name);
            }
            let Some(film) = layer.films.first() else { continue };
            if wants(TableKind::Phase) {
                self.phase(record, film, wavelengths_nm, &name);
            }
            if record.varies() && wants(TableKind::Film) {
                self.film(record, interface, film.thickness, color, &name);
            }
            let variation = extras.get(i).and_then(|l| l.film_variation.as_ref());
            if let Some(variation) = variation.filter(|_| wants(TableKind::Thickness)) {
                self.thickness(record, film, variation, material, read, &name)?;
            }
        }
        Ok(records)
    }

    fn film(
        &mut self,
        record: &mut LayerRecord,
        interface: Interface,
        thickness: FilmThickness,
        color: Color,
        name: &dyn Fn() -> String,
    ) {
        let (axes, format) = self.settings.film.clone();
        let job = FilmJob { interface, thickness, color, axes, format };
        record.film_tile = Some(self.add(TableKind::Film, Job::Film(job), name));
    }

    fn fresnel(&mut self, record: &mut LayerRecord, interface: Interface, color: Color, name: &dyn Fn() -> String) {
        let job = FresnelJob { interface, color, shape: self.settings.fresnel.clone() };
        record.fresnel_tile = Some(self.add(TableKind::Fresnel, Job::Fresnel(job), name));
    }

    fn distribution(&mut self, record: &mut LayerRecord, layer: &Layer) {
        let Some((axes, format)) = self.settings.distribution.clone() else { return };
        let distribution = layer.surface.distribution;
        let job = Job::Distribution(DistributionJob { distribution, axes, format });
        let tile = self.add(TableKind::Distribution, job, &|| distribution.name().to_owned());
        record.distribution_tile = Some(tile);
    }

    fn fgd(
        &mut self,
        record: &mut LayerRecord,
        layer: &Layer,
        interface: Interface,
        color: Color,
        name: &dyn Fn() -> String,
    ) {
        let (axes, format) = self.settings.fgd.clone();
        let transparent = matches!(layer.base, Base::Dielectric { .. });
        let (distribution, grid) = (layer.surface.distribution, self.settings.fgd_grid.clone());
        let truth = FgdTruthJob { interface, transparent, distribution, color, grid };
        let job = FgdJob { truth, axes, format };
        record.fgd_tile = Some(self.add(TableKind::Fgd, Job::Fgd(job), name));
    }

    /// Adds the escape tile of a layer that totally reflects some of the lobes of an interface below; other layers need none.
    fn escape(&mut self, record: &mut LayerRecord, name: &dyn Fn() -> String) {
        if record.eta > 1.0 {
            let (axes, format) = self.settings.escape.clone();
            let job = EscapeJob { eta: record.eta, axes, format };
            record.escape_tile = Some(self.add(TableKind::Escape, Job::Escape(job), name));
        }
    }

    fn phase(&mut self, record: &mut LayerRecord, film: &Film, wavelengths_nm: [f64; 3], name: &dyn Fn() -> String) {
        let Some((axis, format)) = self.settings.phase.clone() else { return };
        let thickness_max_nm = film.thickness.max_nm;
        let job = PhaseJob { film: film.ior.clone(), thickness_max_nm, wavelengths_nm, axis, format };
        record.phase_tile = Some(self.add(TableKind::Phase, Job::Phase(job), name));
    }

    fn thickness(
        &mut self,
        record: &mut LayerRecord,
        film: &Film,
        variation: &FilmVariation,
        material: &Material,
        read: ImageReader<'_>,
        name: &dyn Fn() -> String,
    ) -> Result<(), BakeError> {
        let relief = Relief::of(&variation.source, |path| {
            let map = |reason| BakeError::Map { material: material.source.clone(), path: path.to_owned(), reason };
            read(&material.source, path).map_err(map)
        })?;
        let (axes, format) = self.settings.thickness.clone();
        let job = ThicknessJob {
            relief,
            min_nm: film.thickness.min_nm,
            max_nm: film.thickness.max_nm,
            extent_um: variation.extent_um,
            axes,
            format,
        };
        record.thickness_tile = Some(self.add(TableKind::Thickness, Job::Thickness(job), name));
        Ok(())
    }

    fn add(&mut self, kind: TableKind, job: Job, name: &dyn Fn() -> String) -> u32 {
        let key = self.graph.add(job);
        self.tiles[kind as usize].tile(key, name)
    }
}
