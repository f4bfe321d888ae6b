//! Tiles of the slope distribution, `pi alpha^2 D`, which is 1 at the normal for every alpha.

use luthier_lut::{Atlas, Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::stack::Distribution;
use serde_json::{Value, json};

use crate::job::{TileData, lone_tile};
use crate::json;

/// Points of the error scan per texel interval, along each axis.
const PER_CELL: [u32; 2] = [2, 2];

#[derive(Debug, Clone)]
pub(crate) struct DistributionJob {
    pub(crate) distribution: Distribution,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl DistributionJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "distribution": self.distribution.name(),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    /// The tile as an atlas of its own.
    pub(crate) fn atlas(&self) -> Atlas {
        let [angle, slope] = &self.axes;
        let mut truth = Image::zeros(angle.size, slope.size, 1);
        for j in 0..slope.size {
            for i in 0..angle.size {
                truth.texel_mut(i, j)[0] = self.value(angle.node(i), slope.node(j)) as f32;
            }
        }
        lone_tile(TableKind::Distribution, &[angle, slope], self.format, &truth)
    }

    pub(crate) fn run(&self) -> TileData {
        let [angle, slope] = &self.axes;
        let atlas = self.atlas();
        let error = measure_scan(
            &Scan::whole([angle.intervals(), slope.intervals()], PER_CELL),
            |u| {
                let values = [angle.decode(u[0]), slope.decode(u[1])];
                let expected = self.value(values[0], values[1]);
                let read = atlas.sample(0, values, WeightBits::Fixed(8))[0];
                Comparison { expected: [expected, 0.0, 0.0, 0.0], sampled: [read, 0.0, 0.0, 0.0] }
            },
            |u| vec![angle.decode(u[0]), slope.decode(u[1])],
        );
        let model = format!("pi alpha^2 D, {}; errors are relative to the peak of D", self.distribution.name());
        TileData { model, truth: atlas.truth, texels: atlas.texels, bytes: atlas.bytes, error }
    }

    fn value(&self, angle: f64, alpha: f64) -> f64 {
        let (cos, sin_sq) = if self.axes[0].quantity == "cos_theta_h" {
            (angle, (1.0 - angle) * (1.0 + angle))
        } else {
            let sin = libm::sin(angle);
            (libm::cos(angle), sin * sin)
        };
        scaled_distribution(self.distribution, alpha, cos, sin_sq)
    }
}
