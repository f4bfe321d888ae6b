//! Film tiles: reflectance of an interface over the angle and the thickness of its top film.

mod search;

use std::sync::Arc;

use luthier_lut::{
    Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, incident_cosine, measure_scan,
};
use luthier_manifest::{CandidateForm, FILM_ROOT_MIN, MeasuredError};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::fresnel::coated;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::schlick::index_below_film;
use luthier_optics::stack::FilmThickness;
use num_complex::Complex64;
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
        let over_f0 = site.record.has_film_over_f0();
        let is_tabled = site.record.varies() || over_f0;
        let Some(film) = site.layer.films.first().filter(|_| is_tabled) else { return Ok(None) };
        let (interface, thickness) = (site.interface.clone(), film.thickness);
        let (axes, format) = (site.shape.axes(), site.shape.format);
        Ok(Some(Arc::new(FilmJob { interface, thickness, over_f0, color: site.color, axes, format })))
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
///
/// Where maps give each place below the film an F0, the tile is over the root of that F0 in place of the thickness: channel c of a colour has the index of
/// one F0 at every wavelength, and shaders read each channel at its own.
#[derive(Debug, Clone)]
pub(crate) struct FilmJob {
    pub(crate) interface: Interface,
    /// Range of thickness of the top film; the thickest is at fraction 1.
    pub(crate) thickness: FilmThickness,
    /// Whether fractions are roots of the F0 below the film.
    pub(crate) over_f0: bool,
    pub(crate) color: Color,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl Job for FilmJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Film)
    }

    fn inputs(&self) -> Value {
        let mut inputs = json!({
            "interface": json::interface(&self.thickest()),
            "least": self.least(),
            "color": json::color(&self.color),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        });
        if self.over_f0 {
            inputs["over"] = json!("root of F0");
        }
        inputs
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
        if self.over_f0 {
            return FILM_ROOT_MIN;
        }
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
        let over = if self.over_f0 {
            "films, Airy, over the root of the F0 below them".to_owned()
        } else {
            format!("films, Airy, over d/{} nm of the top one", self.thickness.max_nm)
        };
        TileData {
            model: format!("{over}; {}", color_in_words(&self.color)),
            truth,
            size: atlas.texels.size(),
            bytes: atlas.bytes,
            error,
        }
    }

    /// The reflectance at a fraction of the top film's greatest thickness, or at a root of the F0 below it.
    fn reflectance(&self, thickest: &Sampled, fraction: f64, cos_theta_i: f64) -> Rgb {
        if self.over_f0 {
            return thickest.sum(|at| {
                let below = Complex64::new(index_below_film(at.above.re, fraction * fraction), 0.0);
                coated(at.above, &at.films, below, cos_theta_i).unpolarised()
            });
        }
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

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::Film;

    use super::*;

    /// Tiles over the F0 are near the interface at any F0 by itself, in every channel.
    #[test]
    fn a_tile_over_f0_has_every_f0() {
        let thickness = FilmThickness { min_nm: 400.0, max_nm: 400.0 };
        let films = vec![Film { ior: Ior::constant(1.5, 0.0).unwrap(), thickness }];
        let over = |f0| Interface { above: Ior::vacuum(), films: films.clone(), below: Ior::vacuum().with_f0([f0; 3]) };
        let axes = [
            axis("cos_theta", "", [0.0, 1.0], 64, Mapping::Power { exponent: 2.0 }),
            axis("fraction", "", [0.0, 1.0], 256, Mapping::Linear),
        ];
        let color = Color::Spectral;
        let format = TexelFormat::Rgba32Float;
        let job = FilmJob { interface: over(0.04), thickness, over_f0: true, color, axes: axes.clone(), format };
        let error = job.tile().error;
        assert!(error.max_abs_err < 0.01 && error.p99_abs_err < 1e-3, "{error:?}");
        let atlas = lone_tile(TableKind::Film, &[&axes[0], &axes[1]], format, &job.truth());
        for f0 in [0.002, 0.04, 0.5, 0.97, 1.0] {
            let alone = over(f0).sampled(&color);
            for cos in [1.0, 0.6, 0.2] {
                let (read, expected) = (atlas.sample(0, [cos, f0.sqrt()], WeightBits::Exact), alone.rgb(cos));
                assert!((0..3).all(|c| (read[c] - expected[c]).abs() < 1e-3), "{f0} {cos}: {read:?} {expected:?}");
            }
        }
    }
}
