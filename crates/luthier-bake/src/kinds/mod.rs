//! Kinds of tables: the layout of each, the job that makes its tiles, and the candidates that a search compares.

pub(crate) mod distribution;
mod escape;
pub(crate) mod fgd;
pub(crate) mod film;
pub(crate) mod fresnel;
pub(crate) mod lobes;
mod phase;
mod thickness;

use std::sync::Arc;

use luthier_lut::TableKind;
use luthier_manifest::{CandidateForm, LayerRecord, MeasuredError};
use luthier_material::{BakeSettings, LayerExtras, Material};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Layer;

use crate::BakeError;
use crate::candidates::Found;
use crate::form::RowForm;
use crate::graph::{Job, Results};
use crate::plan::Plan;
use crate::relief::ImageReader;
use crate::settings::{Ask, Asked, Settings, Shape};

/// An interface that may need a tile: one layer of a material.
pub(crate) struct Site<'a> {
    pub(crate) material: &'a Material,
    pub(crate) layer: &'a Layer,
    pub(crate) extras: Option<&'a LayerExtras>,
    pub(crate) record: &'a LayerRecord,
    pub(crate) interface: &'a Interface,
    pub(crate) color: Color,
    /// Shape of the tile.
    pub(crate) shape: &'a Shape,
    /// Shape of the tile without a search.
    pub(crate) fixed: &'a Shape,
    /// Form of the rows of lobes.
    pub(crate) lobes: RowForm,
    pub(crate) read_image: ImageReader<'a>,
}

/// One kind of table: everything in a bake that differs by kind.
pub(crate) trait Kind: Sync {
    /// The shape of its tiles without a search.
    ///
    /// # Errors
    /// [`BakeError`] where the materials ask for different shapes.
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError>;

    /// The parts of that shape that a material decides.
    fn asked(&self, _: &BakeSettings) -> Asked {
        Asked::default()
    }

    /// The job that makes the tile of an interface; none if the interface needs no tile.
    ///
    /// # Errors
    /// [`BakeError::Map`] where an image cannot be read.
    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError>;

    /// The jobs of the tiles that follow the first of an interface.
    fn followers(&self, _: &Site<'_>) -> Vec<Arc<dyn Job>> {
        Vec::new()
    }

    /// The name of the tile, if it differs from the name of the layer.
    fn name(&self, _: &Layer) -> Option<&'static str> {
        None
    }

    /// Whether tiles without a stated budget should hold [`crate::AIM`].
    fn has_aim(&self) -> bool {
        false
    }

    /// The candidates for the tiles of a plan; none if nothing is left to choose. `results` has the intermediate
    /// results.
    fn candidates(&self, _plan: &Plan, _results: &Results, _colors: bool) -> Option<Found> {
        None
    }

    /// The errors of the tiles of a plan, with their numbers, in tables of this form, as a search measures them. Empty
    /// for kinds whose tiles belong to no single material.
    fn errors(&self, _plan: &Plan, _results: &Results, _form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
        Vec::new()
    }

    /// The candidates without a stated budget: only of kinds that shaders read for every interface, and that need no
    /// costly truth.
    fn candidates_by_default(&self, _: &Plan) -> Option<Found> {
        None
    }
}

/// The kind of a table.
pub(crate) fn of(kind: TableKind) -> &'static dyn Kind {
    match kind {
        TableKind::Fresnel => &fresnel::Table,
        TableKind::Distribution => &distribution::Table,
        TableKind::Fgd => &fgd::Table,
        TableKind::Phase => &phase::Table,
        TableKind::Thickness => &thickness::Table,
        TableKind::Film => &film::Table,
        TableKind::Escape => &escape::Table,
        TableKind::Lobes => &lobes::Table,
    }
}

/// Whether the bake decides the shape of the tables of a kind, and then aims at [`crate::AIM`].
pub(crate) fn is_left(settings: &Settings, kind: TableKind) -> bool {
    of(kind).has_aim() && !settings.asked(kind).is_any()
}
