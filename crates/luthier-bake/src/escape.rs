//! Escape tiles: which part of a lobe inside a medium is not totally reflected at its surface.

use luthier_layers::statistics::total_reflection::escaping_share;
use luthier_lut::{Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use serde_json::{Value, json};

use crate::facet_grid::{DOMAIN_ALPHA, DOMAIN_COS_THETA};
use crate::job::{TileData, lone_tile};
use crate::json;

/// Points of the error scan along each axis.
const PROBES: u32 = 96;

#[derive(Debug, Clone)]
pub(crate) struct EscapeJob {
    /// Index of the medium over that outside, above 1.
    pub(crate) eta: f64,
    /// cos_theta outside, of the refracted direction, and alpha of the lobe.
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl EscapeJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "eta": self.eta,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    pub(crate) fn run(&self) -> TileData {
        let [x, y] = &self.axes;
        let mut truth = Image::zeros(x.size, y.size, 1);
        for j in 0..y.size {
            for i in 0..x.size {
                truth.texel_mut(i, j)[0] = self.value(x.node(i), y.node(j)) as f32;
            }
        }
        let atlas = lone_tile(TableKind::Escape, &[x, y], self.format, &truth);
        let scan = Scan {
            points: [PROBES, PROBES],
            from: [x.encode(DOMAIN_COS_THETA), y.encode(DOMAIN_ALPHA)],
            to: [1.0, 1.0],
            nodes: [x.intervals(), y.intervals()],
            refinements: 0,
        };
        let error = measure_scan(
            &scan,
            |u| {
                let values = [x.decode(u[0]), y.decode(u[1])];
                let read = atlas.sample(0, values, WeightBits::Fixed(8))[0];
                let expected = self.value(values[0], values[1]);
                Comparison { expected: [expected, 0.0, 0.0, 0.0], sampled: [read, 0.0, 0.0, 0.0] }
            },
            |u| vec![x.decode(u[0]), y.decode(u[1])],
        );
        let model = format!(
            "share of a GGX lobe within the critical angle of index {}; errors for cos_theta >= {DOMAIN_COS_THETA}, alpha >= \
             {DOMAIN_ALPHA}",
            self.eta
        );
        TileData { model, truth, texels: atlas.texels, bytes: atlas.bytes, error }
    }

    /// The share of the lobe around the direction into which light at `cos_theta` outside is refracted.
    fn value(&self, cos_theta: f64, alpha: f64) -> f64 {
        let eta = self.eta;
        let inside = ((cos_theta * cos_theta + (eta - 1.0) * (eta + 1.0)) / (eta * eta)).sqrt();
        escaping_share(inside, alpha, 1.0 / eta)
    }
}
