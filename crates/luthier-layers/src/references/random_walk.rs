//! Random walk between the facets of one rough interface, reflecting and refracting: the reference for a single interface.
//!
//! Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model",
//! anisotropic, for conductors and for dielectrics from both sides, films included. Below the interface there is
//! nothing: light that goes through is gone.

use glam::DVec3;

use crate::model::{Claims, Estimate, Estimator, Input, Inputs, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeLayer};
use crate::references::layered_mc::{Interface, InterfaceMode, Side, Sided, Stream, both_above, mixed_seed};

/// Walks between the facets of one interface. The same fields give the same numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RandomWalk {
    /// Walks per value.
    pub samples: u64,
    /// Family of random numbers.
    pub seed: u64,
}

impl RandomWalk {
    /// The number of walks that [`Model::eval`] is registered with.
    pub const fn new() -> Self {
        Self { samples: 4096, seed: 0 }
    }

    /// Density per solid angle of the light from `a` that leaves along `b`, each a side and a unit direction in the
    /// frame of that side (+z away from the surface; x and y are those of the stack on both sides).
    ///
    /// On one side that is `f cos_theta_b`. Across, it is the same for flux: radiance takes a factor `n_b^2 / n_a^2`
    /// besides. Reciprocity: `n_a^2 cos_a density(a, b) = n_b^2 cos_b density(b, a)`. Zero for a smooth interface and
    /// below the horizon.
    pub fn density(&self, layer: &MonochromeLayer, a: (Side, DVec3), b: (Side, DVec3)) -> Estimate {
        if !both_above(a.1, b.1) {
            return Estimate::exact(0.0);
        }
        let interface = Interface::new(layer, InterfaceMode::SmithWalk);
        let (a, b) = (Sided { side: a.0, direction: a.1 }, Sided { side: b.0, direction: b.1 });
        Estimate::of(self.samples, |i| interface.kernel(&mut Stream::new(self.seed, i), a, b))
    }

    /// Shares of the light from a side that leave on this side and on the other, in all directions. The rest to 1 is
    /// absorbed.
    pub fn albedo(&self, layer: &MonochromeLayer, side: Side, direction: DVec3) -> (Estimate, Estimate) {
        [side, side.other()].map(|wanted| self.share(layer, (side, direction), wanted, DVec3::Z)).into()
    }

    /// Share of the light from `a` that leaves on a side, above the plane with the normal `up` in the frame of that side.
    fn share(&self, layer: &MonochromeLayer, (side, direction): (Side, DVec3), wanted: Side, up: DVec3) -> Estimate {
        if direction.z <= 0.0 {
            return Estimate::exact(0.0);
        }
        let interface = Interface::new(layer, InterfaceMode::SmithWalk);
        let a = Sided { side, direction };
        Estimate::of(self.samples, |i| match interface.scatter(&mut Stream::new(self.seed, i), a) {
            Some((b, weight)) if b.side == wanted && b.direction.dot(up) > 0.0 => weight,
            _ => 0.0,
        })
    }
}

impl Default for RandomWalk {
    fn default() -> Self {
        Self::new()
    }
}

impl Model for RandomWalk {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "random-walk",
            kind: Kind::Reference,
            claims: Claims::BOTH,
            source: "Heitz, Hanika, d'Eon and Dachsbacher 2016",
            domain: "one rough interface; an estimate, with noise",
            leaves_out: "everything below the top interface; smooth interfaces; polarisation between facets",
            inputs: &[Input::Samples, Input::Seed],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.eval_with_error(stack, wi, wo).mean
    }

    fn estimator(&self) -> Option<&dyn Estimator> {
        Some(self)
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let (samples, seed) = (inputs.samples.unwrap_or(self.samples), inputs.seed.unwrap_or(self.seed));
        Some(Box::new(Self { samples, seed }))
    }

    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        stack.lossless_interface()
    }
}

impl Estimator for RandomWalk {
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate {
        let Some(top) = stack.layers.first() else { return Estimate::exact(0.0) };
        let walks = Self { seed: mixed_seed(self.seed, stack, wi, wo), ..*self };
        walks.density(top, (Side::Above, wo), (Side::Above, wi))
    }

    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3, up: DVec3) -> Estimate {
        let Some(top) = stack.layers.first() else { return Estimate::exact(0.0) };
        let walks = Self { seed: mixed_seed(self.seed, stack, wo, wo), ..*self };
        walks.share(top, (Side::Above, wo), Side::Above, up)
    }
}
