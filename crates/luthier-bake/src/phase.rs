//! Phase rows of films: Granier and Heidrich 2003, eq. 19.

use std::f64::consts::PI;

use luthier_lut::{Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_optics::ior::Ior;
use serde_json::{Value, json};

use crate::job::{TileData, lone_tile};
use crate::json;

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 4;

/// `T_Phi(s) = 2 cos(2 pi 2 d_max n(lambda) / lambda s)` at three wavelengths.
#[derive(Debug, Clone)]
pub(crate) struct PhaseJob {
    pub(crate) film: Ior,
    pub(crate) thickness_max_nm: f64,
    pub(crate) wavelengths_nm: [f64; 3],
    pub(crate) axis: Axis,
    pub(crate) format: TexelFormat,
}

impl PhaseJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "film": json::ior(&self.film),
            "thickness_max_nm": self.thickness_max_nm,
            "wavelengths_nm": self.wavelengths_nm,
            "axis": json::axis(&self.axis),
            "format": self.format.name(),
        })
    }

    pub(crate) fn run(&self) -> TileData {
        let waves = self.wavelengths_nm.map(|nm| 2.0 * self.thickness_max_nm * self.film.at(nm).re / nm);
        let phase = |s: f64| waves.map(|w| 2.0 * libm::cos(2.0 * PI * w * s));
        let mut truth = Image::zeros(self.axis.size, 1, 3);
        for i in 0..self.axis.size {
            truth.texel_mut(i, 0).copy_from_slice(&phase(self.axis.node(i)).map(|c| c as f32));
        }
        let atlas = lone_tile(TableKind::Phase, &[&self.axis], self.format, &truth);
        let error = measure_scan(
            &Scan::whole([self.axis.intervals(), 0], [PER_CELL, 0]),
            |u| {
                let [r, g, b] = phase(self.axis.decode(u[0]));
                let read = atlas.sample(0, [self.axis.decode(u[0]), 0.0], WeightBits::Fixed(8));
                Comparison { expected: [r, g, b, 0.0], sampled: [read[0], read[1], read[2], 0.0] }
            },
            |u| vec![self.axis.decode(u[0])],
        );
        let [r, g, b] = self.wavelengths_nm;
        TileData {
            model: format!("2 cos(2 Phi) at {r}, {g} and {b} nm, Granier and Heidrich 2003 eq. 19"),
            truth,
            texels: atlas.texels,
            bytes: atlas.bytes,
            error,
        }
    }
}
