//! Phase rows of films: Granier and Heidrich 2003, eq. 19; or, for films over an F0 of the place, means of interference over the channels.

mod search;

use std::f64::consts::PI;
use std::sync::Arc;

use luthier_lut::{Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_manifest::{CandidateForm, MeasuredError};
use luthier_material::{BakeSettings, Material};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::film_over_f0::{WAVES_MAX, interference};
use luthier_optics::ior::Ior;
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::candidates::Found;
use crate::graph::{Artefact, Inputs, Job, JobKind, Results};
use crate::plan::Plan;
use crate::settings::{Ask, Asked, Shape, axis};
use crate::tile::{TileData, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 4;

/// Phase tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError> {
        let size = ask.one("bake.phase.size", |b| b.phase.size)?.unwrap_or(default_size(ask.0));
        let format = ask.format("bake.phase.format", |b| b.phase.format, TexelFormat::Rgba16Float)?;
        Ok(Shape::row(axis("s", "", [0.0, 1.0], size, Mapping::Linear), format))
    }

    fn asked(&self, bake: &BakeSettings) -> Asked {
        Asked::all(bake.asks_for(TableKind::Phase))
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let Some(film) = site.layer.films.first() else { return Ok(None) };
        let color = site.record.has_film_over_f0().then_some(site.color);
        // Of an index that is the same at every wavelength only paths count.
        let is_any = color.is_some() && film.ior.is_constant();
        Ok(Some(Arc::new(PhaseJob {
            film: if is_any { Ior::vacuum() } else { film.ior.clone() },
            thickness_max_nm: if color.is_some() { 0.0 } else { film.thickness.max_nm },
            color,
            wavelengths_nm: site.material.bake.wavelengths_nm(),
            axis: site.shape.x.clone(),
            format: site.shape.format,
        })))
    }

    fn candidates(&self, plan: &Plan, _: &Results, _: bool) -> Option<Found> {
        search::candidates(plan)
    }

    fn errors(&self, plan: &Plan, _: &Results, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
        search::errors(plan, form)
    }
}

/// Texels of a row without a search: those over an F0 are longer.
fn default_size(materials: &[Material]) -> u32 {
    if materials.iter().any(Material::has_closed_film) { 1024 } else { 256 }
}

/// `T_Phi(s) = 2 cos(2 pi 2 d_max n(lambda) / lambda s)` at three wavelengths; or, over an F0 of the place, the mean of `2 cos` of the phase over the wavelengths of
/// each channel ([`interference`]), at paths of up to [`WAVES_MAX`] waves of the middle channel.
#[derive(Debug, Clone)]
pub(crate) struct PhaseJob {
    pub(crate) film: Ior,
    pub(crate) thickness_max_nm: f64,
    /// The colour of means over channels; `None` for three wavelengths.
    pub(crate) color: Option<Color>,
    pub(crate) wavelengths_nm: [f64; 3],
    pub(crate) axis: Axis,
    pub(crate) format: TexelFormat,
}

impl Job for PhaseJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Phase)
    }

    fn inputs(&self) -> Value {
        let mut inputs = json!({
            "film": json::ior(&self.film),
            "thickness_max_nm": self.thickness_max_nm,
            "wavelengths_nm": self.wavelengths_nm,
            "axis": json::axis(&self.axis),
            "format": self.format.name(),
        });
        if let Some(color) = &self.color {
            inputs["means"] = json!({ "color": json::color(color), "waves": WAVES_MAX });
        }
        inputs
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.tile())
    }
}

impl PhaseJob {
    /// The values of a row at a normalised thickness.
    fn phase(&self, s: f64) -> Rgb {
        if let Some(color) = &self.color {
            return interference(&self.film, &color.nodes(), self.wavelengths_nm[1], s * WAVES_MAX);
        }
        let waves = self.wavelengths_nm.map(|nm| 2.0 * self.thickness_max_nm * self.film.at(nm).re / nm);
        waves.map(|w| 2.0 * libm::cos(2.0 * PI * w * s))
    }

    fn tile(&self) -> TileData {
        let mut truth = Image::zeros(self.axis.size, 1, 3);
        for i in 0..self.axis.size {
            truth.texel_mut(i, 0).copy_from_slice(&self.phase(self.axis.node(i)).map(|c| c as f32));
        }
        let atlas = lone_tile(TableKind::Phase, &[&self.axis], self.format, &truth);
        let error = measure_scan(
            &Scan::whole([self.axis.intervals(), 0], [PER_CELL, 0]),
            |u| {
                let [r, g, b] = self.phase(self.axis.decode(u[0]));
                let read = atlas.sample(0, [self.axis.decode(u[0]), 0.0], WeightBits::Fixed(8));
                Comparison { expected: [r, g, b, 0.0], sampled: [read[0], read[1], read[2], 0.0] }
            },
            |u| vec![self.axis.decode(u[0])],
        );
        let [r, g, b] = self.wavelengths_nm;
        TileData {
            model: match &self.color {
                Some(color) => format!("means of 2 cos over {WAVES_MAX} waves of {g} nm; {}", color_in_words(color)),
                None => format!("2 cos(2 Phi) at {r}, {g} and {b} nm, Granier and Heidrich 2003 eq. 19"),
            },
            truth,
            size: atlas.texels.size(),
            bytes: atlas.bytes,
            error,
        }
    }
}
