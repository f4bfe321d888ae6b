//! Thickness textures of films: Granier and Heidrich 2003, section 6.

use luthier_lut::{Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::job::{TileData, lone_tile};
use crate::json;
use crate::relief::{Field, Relief};

/// Half the step, in repeats, of the central differences that give the slopes.
const SLOPE_STEP: f64 = 1.0 / 4096.0;

/// Texels repeated around the tile.
const APRON: u32 = 1;

#[derive(Debug, Clone)]
pub(crate) struct ThicknessJob {
    pub(crate) relief: Relief,
    pub(crate) min_nm: f64,
    pub(crate) max_nm: f64,
    pub(crate) extent_um: f64,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl ThicknessJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "relief": self.relief.inputs(),
            "range_nm": [self.min_nm, self.max_nm],
            "extent_um": self.extent_um,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    pub(crate) fn run(&self) -> TileData {
        let [x, y] = &self.axes;
        let surface = Surface::new(self);
        let channels = self.format.channels();
        let mut truth = Image::zeros(x.size + 2 * APRON, y.size + 2 * APRON, channels);
        // The apron repeats the opposite edge, so that filtering wraps around.
        let node = |axis: &Axis, texel: usize| axis.node((texel as u32 + axis.size - APRON) % axis.size);
        let row = (truth.width * channels) as usize;
        truth.data.par_chunks_mut(row).enumerate().for_each(|(j, row)| {
            for (i, texel) in row.chunks_mut(channels as usize).enumerate() {
                let record = surface.record([node(x, i), node(y, j)]).map(|c| c as f32);
                texel.copy_from_slice(&record[..channels as usize]);
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
        TileData {
            model: match channels {
                1 => "d/(2 d_max); Granier and Heidrich 2003 sec. 6".into(),
                _ => "d/(2 d_max), slopes dd/dx and dd/dy, sqrt(1 + slopes^2); Granier and Heidrich 2003 sec. 6".into(),
            },
            truth,
            texels: atlas.texels,
            bytes: atlas.bytes,
            error,
        }
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
        let job = self.job;
        let thickness = |uv| job.min_nm + (job.max_nm - job.min_nm) * self.field.unit(uv);
        let run = 2.0 * SLOPE_STEP * job.extent_um * 1e3;
        let [u, v] = uv;
        let slope_x = (thickness([u + SLOPE_STEP, v]) - thickness([u - SLOPE_STEP, v])) / run;
        let slope_y = (thickness([u, v + SLOPE_STEP]) - thickness([u, v - SLOPE_STEP])) / run;
        let normalisation = libm::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
        [thickness(uv) / (2.0 * job.max_nm), slope_x, slope_y, normalisation]
    }
}
