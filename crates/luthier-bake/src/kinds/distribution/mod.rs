//! Tiles of the slope distribution, `pi alpha^2 D`, which is 1 at the normal for every alpha.

pub(crate) mod search;

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use luthier_layers::layers::ALPHA_MIN;
use luthier_lut::{Atlas, Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use luthier_material::{AlphaMapping, BakeSettings, DistributionMapping};
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::stack::{Distribution, Layer};
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::candidates::Found;
use crate::graph::{Artefact, Inputs, Job, JobKind, Results};
use crate::plan::Plan;
use crate::settings::{Ask, Asked, Shape, axis};
use crate::tile::{TileData, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan per texel interval, along each axis.
const PER_CELL: [u32; 2] = [2, 2];

/// Distribution tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, ask: Ask<'_>) -> Result<Shape, BakeError> {
        let size = ask.one("bake.distribution.size", |b| b.distribution.size)?.unwrap_or([512, 512]);
        let exponent = ask.one("bake.distribution.exponent", |b| b.distribution.exponent)?.unwrap_or(8.0);
        let mapping = ask.one("bake.distribution.mapping", |b| b.distribution.mapping)?;
        let angle = match mapping.unwrap_or(DistributionMapping::Power) {
            DistributionMapping::Power => {
                axis("theta_h", "rad", [0.0, FRAC_PI_2], size[0], Mapping::Power { exponent })
            }
            DistributionMapping::Linear => axis("theta_h", "rad", [0.0, FRAC_PI_2], size[0], Mapping::Linear),
            DistributionMapping::CosPower => {
                axis("cos_theta_h", "", [0.0, 1.0], size[0], Mapping::Power { exponent: 1.0 / exponent })
            }
        };
        let alpha_mapping = ask.one("bake.distribution.alpha_mapping", |b| b.distribution.alpha_mapping)?;
        let slope = match alpha_mapping.unwrap_or(AlphaMapping::Log) {
            AlphaMapping::Log => axis("alpha", "", [ALPHA_MIN, 1.0], size[1], Mapping::Logarithmic),
            AlphaMapping::Linear => axis("alpha", "", [0.0, 1.0], size[1], Mapping::Linear),
        };
        let format = ask.format("bake.distribution.format", |b| b.distribution.format, TexelFormat::Rg16Float)?;
        Ok(Shape::grid([angle, slope], format))
    }

    fn asked(&self, bake: &BakeSettings) -> Asked {
        Asked::all(bake.asks_for(TableKind::Distribution))
    }

    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let distribution = site.layer.surface.distribution;
        Ok(Some(Arc::new(DistributionJob { distribution, axes: site.shape.axes(), format: site.shape.format })))
    }

    fn name(&self, layer: &Layer) -> Option<&'static str> {
        let distribution = layer.surface.distribution;
        distribution.own_alpha().is_none().then(|| distribution.name())
    }

    fn candidates(&self, plan: &Plan, _: &Results, _: bool) -> Option<Found> {
        search::candidates(plan)
    }

    fn candidates_by_default(&self, plan: &Plan) -> Option<Found> {
        search::candidates(plan).map(Found::affordable)
    }
}

#[derive(Debug, Clone)]
pub(crate) struct DistributionJob {
    pub(crate) distribution: Distribution,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl Job for DistributionJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Distribution)
    }

    fn inputs(&self) -> Value {
        json!({
            "distribution": json::distribution_of(self.distribution),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.tile())
    }
}

impl DistributionJob {
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

    fn tile(&self) -> TileData {
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
        TileData { model, truth: atlas.truth, size: atlas.texels.size(), bytes: atlas.bytes, error }
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
