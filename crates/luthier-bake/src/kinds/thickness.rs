//! Thickness textures of films: Granier and Heidrich 2003, section 6.

use std::sync::Arc;

use luthier_lut::{Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_material::Material;
use luthier_model::Family;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::graph::{Artefact, Inputs, Job, JobKind};
use crate::relief::{Field, Relief};
use crate::settings::{Ask, Shape, axis};
use crate::tile::{TileData, lone_tile};
use crate::{BakeError, json};

/// Half the step, in repeats, of the central differences that give the slopes.
const SLOPE_STEP: f64 = 1.0 / 4096.0;

/// Texels repeated around the tile.
const APRON: u32 = 1;

/// Thickness tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError> {
        let size = ask.one("bake.thickness.size", |b| b.thickness.size)?.unwrap_or(256);
        let axes = ["u", "v"].map(|name| axis(name, "", [0.0, 1.0], size, Mapping::Periodic));
        let format = ask.format("bake.thickness.format", |b| b.thickness.format, default_format(ask.0))?;
        Ok(Shape::grid(axes, format))
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let variation = site.extras.and_then(|extras| extras.film_variation.as_ref());
        let Some((film, variation)) = site.layer.films.first().zip(variation) else { return Ok(None) };
        let source = &site.material.source;
        let relief = Relief::of(&variation.source, |picture| {
            (site.read_image)(source, picture).map_err(|reason| BakeError::Map {
                material: source.clone(),
                path: picture.path.clone(),
                reason,
            })
        })?;
        Ok(Some(Arc::new(ThicknessJob {
            relief,
            min_nm: film.thickness.min_nm,
            max_nm: film.thickness.max_nm,
            extent_um: variation.extent_um,
            axes: site.shape.axes(),
            format: site.shape.format,
        })))
    }
}

/// Four channels if slopes are read: by Granier and Heidrich's model, or by a material that requests the table. Else
/// the thickness alone.
fn default_format(materials: &[Material]) -> TexelFormat {
    let reads_slopes =
        (materials.iter()).any(|m| m.model().facts().family == Family::Beams || m.bake.asks_for(TableKind::Thickness));
    if reads_slopes { TexelFormat::Rgba16Float } else { TexelFormat::R16Float }
}

#[derive(Debug)]
struct ThicknessJob {
    relief: Relief,
    min_nm: f64,
    max_nm: f64,
    extent_um: f64,
    axes: [Axis; 2],
    format: TexelFormat,
}

impl Job for ThicknessJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Thickness)
    }

    fn inputs(&self) -> Value {
        json!({
            "relief": self.relief.inputs(),
            "range_nm": [self.min_nm, self.max_nm],
            "extent_um": self.extent_um,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        let [x, y] = &self.axes;
        let surface = Surface::new(self);
        let channels = self.format.channels();
        let mut truth = Image::zeros(x.size + 2 * APRON, y.size + 2 * APRON, channels);
        let row = (truth.width * channels) as usize;
        truth.data.par_chunks_mut(row).enumerate().for_each(|(j, row)| {
            for (i, texel) in row.chunks_mut(channels as usize).enumerate() {
                // The apron repeats the opposite edge, so that filtering wraps around.
                let at = [(x, i), (y, j)].map(|(axis, k)| axis.node((k as u32 + axis.size - APRON) % axis.size));
                texel.copy_from_slice(&surface.record(at).map(|c| c as f32)[..channels as usize]);
            }
        });
        let atlas = lone_tile(TableKind::Thickness, &[x, y], self.format, &truth);
        let error = measure_scan(
            &Scan::whole([x.intervals(), y.intervals()], [1, 1]),
            |u| {
                let mut both = [surface.record(u), atlas.sample(0, u, WeightBits::Fixed(8))];
                both.iter_mut().for_each(|record| record[channels as usize..].fill(0.0));
                let [expected, sampled] = both;
                Comparison { expected, sampled }
            },
            |u| u.to_vec(),
        );
        Artefact::new(TileData {
            model: match channels {
                1 => "d/(2 d_max); Granier and Heidrich 2003 sec. 6".into(),
                _ => "d/(2 d_max), slopes dd/dx and dd/dy, sqrt(1 + slopes^2); Granier and Heidrich 2003 sec. 6".into(),
            },
            truth,
            size: atlas.texels.size(),
            bytes: atlas.bytes,
            error,
        })
    }
}

/// The film's upper boundary over one repeat.
struct Surface<'a> {
    job: &'a ThicknessJob,
    field: Field<'a>,
}

impl<'a> Surface<'a> {
    fn new(job: &'a ThicknessJob) -> Self {
        let [x, y] = &job.axes;
        Self { job, field: Field::new(&job.relief, [x.size, y.size]) }
    }

    /// Thickness record at a point; both coordinates repeat after 1.
    fn record(&self, uv: [f64; 2]) -> [f64; 4] {
        let run = 2.0 * SLOPE_STEP * self.job.extent_um * 1e3;
        let [u, v] = uv;
        let slope_x = (self.thickness_nm([u + SLOPE_STEP, v]) - self.thickness_nm([u - SLOPE_STEP, v])) / run;
        let slope_y = (self.thickness_nm([u, v + SLOPE_STEP]) - self.thickness_nm([u, v - SLOPE_STEP])) / run;
        let normalisation = libm::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
        [self.thickness_nm(uv) / (2.0 * self.job.max_nm), slope_x, slope_y, normalisation]
    }

    fn thickness_nm(&self, uv: [f64; 2]) -> f64 {
        self.job.min_nm + (self.job.max_nm - self.job.min_nm) * self.field.unit(uv)
    }
}
