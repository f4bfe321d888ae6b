//! Fresnel rows: exact reflectance of one interface over the angle.

use luthier_lut::{Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use serde_json::{Value, json};

use crate::job::{TileData, color_in_words, lone_tile};
use crate::json;

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 4;

#[derive(Debug, Clone)]
pub(crate) struct FresnelJob {
    pub(crate) interface: Interface,
    pub(crate) color: Color,
    pub(crate) axis: Axis,
    pub(crate) format: TexelFormat,
}

impl FresnelJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.interface),
            "color": json::color(&self.color),
            "axis": json::axis(&self.axis),
            "format": self.format.name(),
        })
    }

    pub(crate) fn run(&self) -> TileData {
        let sampled = self.interface.sampled(&self.color);
        let reflectance = |value: f64| sampled.rgb(self.cos_theta(value));
        let mut truth = Image::zeros(self.axis.size, 1, 3);
        for i in 0..self.axis.size {
            let rgb = reflectance(self.axis.node(i));
            truth.texel_mut(i, 0).copy_from_slice(&rgb.map(|c| c as f32));
        }
        let atlas = lone_tile(TableKind::Fresnel, &[&self.axis], self.format, &truth);
        let error = measure_scan(
            &Scan::whole([self.axis.intervals(), 0], [PER_CELL, 0]),
            |u| {
                let value = self.axis.decode(u[0]);
                let [r, g, b] = reflectance(value);
                let read = atlas.sample(0, [value, 0.0], WeightBits::Fixed(8));
                Comparison { expected: [r, g, b, 0.0], sampled: [read[0], read[1], read[2], 0.0] }
            },
            |u| vec![self.axis.decode(u[0])],
        );
        let films = if self.interface.films.is_empty() { "bare interface" } else { "films, Airy" };
        TileData {
            model: format!("exact complex Fresnel, unpolarised; {films}; {}", color_in_words(&self.color)),
            truth,
            texels: atlas.texels,
            error,
        }
    }

    fn cos_theta(&self, value: f64) -> f64 {
        if self.axis.quantity == "theta" { libm::cos(value).max(0.0) } else { value }
    }
}
