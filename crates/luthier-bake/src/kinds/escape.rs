//! Escape tiles: the share of a lobe inside a medium that is not totally reflected at its surface.

use std::sync::Arc;

use luthier_layers::models::statistics::total_reflection::escaping_share;
use luthier_lut::{Axis, Comparison, Image, Mapping, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use serde_json::{Value, json};

use super::fgd::{DOMAIN_ALPHA, DOMAIN_COS_THETA};
use super::{Kind, Site};
use crate::graph::{Artefact, Inputs, Job, JobKind};
use crate::settings::{Ask, Shape, axis};
use crate::tile::{TileData, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan along each axis.
const PROBES: u32 = 96;

/// Escape tables. Their shape is fixed.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, _: Ask<'_>) -> Result<Shape, BakeError> {
        let axes = [
            axis("cos_theta", "", [0.0, 1.0], 64, Mapping::Linear),
            axis("alpha", "", [0.0, 1.0], 64, Mapping::Power { exponent: 2.0 }),
        ];
        Ok(Shape::grid(axes, TexelFormat::R16Float))
    }

    /// A tile for a layer that totally reflects a part of the lobes of an interface below. Other layers need none.
    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let job = EscapeJob { eta: site.record.eta, axes: site.shape.axes(), format: site.shape.format };
        Ok((job.eta > 1.0).then(|| Arc::new(job) as Arc<dyn Job>))
    }
}

#[derive(Debug)]
struct EscapeJob {
    /// Index of the medium over the index outside, above 1.
    eta: f64,
    /// cos_theta of the refracted direction outside, and alpha of the lobe.
    axes: [Axis; 2],
    format: TexelFormat,
}

impl Job for EscapeJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Escape)
    }

    fn inputs(&self) -> Value {
        json!({
            "eta": self.eta,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
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
        Artefact::new(TileData { model, truth, size: atlas.texels.size(), bytes: atlas.bytes, error })
    }
}

impl EscapeJob {
    /// The escaping share of the lobe around the refracted direction of light that arrives at `cos_theta` outside.
    fn value(&self, cos_theta: f64, alpha: f64) -> f64 {
        let eta = self.eta;
        let inside = ((cos_theta * cos_theta + (eta - 1.0) * (eta + 1.0)) / (eta * eta)).sqrt();
        escaping_share(inside, alpha, 1.0 / eta)
    }
}
