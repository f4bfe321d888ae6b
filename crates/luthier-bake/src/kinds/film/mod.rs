//! Film tiles: reflectance of an interface over the angle and the thickness of its top film.

mod search;

use std::sync::Arc;

use luthier_lut::{
    Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, incident_cosine, measure_scan,
};
use luthier_manifest::{CandidateForm, MeasuredError};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::fresnel::coated;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::stack::FilmThickness;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::candidates::{Found, grids};
use crate::graph::{Artefact, Inputs, Job, JobKind, Results};
use crate::plan::Plan;
use crate::settings::{Ask, Shape, axis};
use crate::tile::{TileData, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan along each axis. The climb from the worst of them finds worse places in between.
const SCAN: u32 = 128;

/// Steps of the R2 sequence in the unit square (Roberts 2018): powers of the inverse plastic number.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// Film tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, _: Ask<'_>) -> Result<Shape, BakeError> {
        let axes = [
            axis("cos_theta", "", [0.0, 1.0], 64, Mapping::Power { exponent: 2.0 }),
            axis("fraction", "", [0.0, 1.0], 256, Mapping::Linear),
        ];
        Ok(Shape::grid(axes, TexelFormat::Rgba16Float))
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let is_tabled = site.record.varies() && !site.record.has_film_over_f0();
        let Some(film) = site.layer.films.first().filter(|_| is_tabled) else { return Ok(None) };
        let (interface, thickness) = (site.interface.clone(), film.thickness);
        let (axes, format) = (site.shape.axes(), site.shape.format);
        Ok(Some(Arc::new(FilmJob { interface, thickness, color: site.color, axes, format })))
    }

    fn has_aim(&self) -> bool {
        true
    }

    fn candidates(&self, plan: &Plan, _: &Results, colors: bool) -> Option<Found> {
        search::candidates(plan, colors)
    }

    fn errors(&self, plan: &Plan, _: &Results, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
        grids::errors(&search::tiles(plan), form)
    }
}

/// Airy's reflectance over (cos_theta, d / d_max), integrated over the spectrum. Granier and Heidrich's phase row has
/// two beams at three wavelengths; this table has all beams at all wavelengths. Under total reflection the cosine is
/// that of the refracted direction.
#[derive(Debug, Clone)]
pub(crate) struct FilmJob {
    pub(crate) interface: Interface,
    /// Range of thickness of the top film; the thickest is at fraction 1.
    pub(crate) thickness: FilmThickness,
    pub(crate) color: Color,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl Job for FilmJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Film)
    }

    fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.thickest()),
            "least": self.least(),
            "color": json::color(&self.color),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.tile())
    }
}

impl FilmJob {
    /// The interface where the top film is thickest.
    fn thickest(&self) -> Interface {
        let mut interface = self.interface.clone();
        if let Some(film) = interface.films.first_mut() {
            film.thickness.min_nm = self.thickness.max_nm;
            film.thickness.max_nm = self.thickness.max_nm;
        }
        interface
    }

    /// The least fraction of the film. The tile goes on to 0, for films that a shader thins further; its error is
    /// stated from the least fraction on. At 0 and grazing angles the function is not continuous: a film of any
    /// thickness reflects all light there, no film none.
    fn least(&self) -> f64 {
        self.thickness.min_nm / self.thickness.max_nm
    }

    /// The tile's values at its nodes.
    pub(crate) fn truth(&self) -> Image {
        let thickest = self.thickest().sampled(&self.color);
        let cot_sq = thickest.critical_cot_sq();
        let [x, y] = &self.axes;
        let rows: Vec<Vec<f32>> = (0..y.size)
            .into_par_iter()
            .map(|j| {
                let cosines = (0..x.size).map(|i| incident_cosine(cot_sq, x.node(i)));
                cosines.flat_map(|cos| self.reflectance(&thickest, y.node(j), cos).map(|c| c as f32)).collect()
            })
            .collect();
        Image { width: x.size, height: y.size, channels: 3, data: rows.concat() }
    }

    /// Values of the function at `count` places within the film's range. Cosines are squares of a sequence of low
    /// discrepancy (Roberts 2018).
    pub(crate) fn probes(&self, count: u32) -> Vec<([f64; 2], [f64; 4])> {
        let thickest = self.thickest().sampled(&self.color);
        let (least, cot_sq) = (self.least(), thickest.critical_cot_sq());
        (0..count)
            .into_par_iter()
            .map(|i| {
                let [a, b] = R2.map(|r| (0.5 + f64::from(i) * r).fract());
                let (cos_theta, fraction) = (a * a, least + (1.0 - least) * b);
                let [r, g, b] = self.reflectance(&thickest, fraction, incident_cosine(cot_sq, cos_theta));
                ([cos_theta, fraction], [r, g, b, 1.0])
            })
            .collect()
    }

    fn tile(&self) -> TileData {
        let thickest = self.thickest().sampled(&self.color);
        let cot_sq = thickest.critical_cot_sq();
        let [x, y] = &self.axes;
        let truth = self.truth();
        let atlas = lone_tile(TableKind::Film, &[x, y], self.format, &truth);
        let from = [0.0, y.encode(self.least())];
        let error = measure_scan(
            &Scan {
                points: [SCAN; 2],
                from,
                to: [1.0; 2],
                nodes: [x.intervals(), y.intervals()],
                refinements: Scan::REFINEMENTS,
            },
            |u| {
                let values = [x.decode(u[0]), y.decode(u[1])];
                let [r, g, b]: Rgb = self.reflectance(&thickest, values[1], incident_cosine(cot_sq, values[0]));
                let read = atlas.sample(0, values, WeightBits::Fixed(8));
                Comparison { expected: [r, g, b, 0.0], sampled: [read[0], read[1], read[2], 0.0] }
            },
            |u| vec![x.decode(u[0]), y.decode(u[1])],
        );
        TileData {
            model: format!(
                "films, Airy, over d/{} nm of the top one; {}",
                self.thickness.max_nm,
                color_in_words(&self.color)
            ),
            truth,
            size: atlas.texels.size(),
            bytes: atlas.bytes,
            error,
        }
    }

    /// The reflectance at a fraction of the top film's greatest thickness.
    fn reflectance(&self, thickest: &Sampled, fraction: f64, cos_theta_i: f64) -> Rgb {
        let mut films = Vec::new();
        thickest.sum(|at| {
            films.clone_from(&at.films);
            if let Some(film) = films.first_mut() {
                film.waves *= fraction;
            }
            coated(at.above, &films, at.below, cos_theta_i).unpolarised()
        })
    }
}
