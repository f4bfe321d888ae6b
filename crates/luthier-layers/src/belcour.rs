//! Belcour's statistical operators with isotropic spreads, for any number of layers.
//!
//! See [`statistics`](crate::statistics) for the method. Surfaces count as isotropic GGX: anisotropic ones enter with the
//! geometric mean of their slope parameters, Beckmann ones with their FGD-infinity and a GGX lobe of their slope parameter.

use glam::DVec3;

use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::Monochrome;
use crate::statistics::evaluate::{Follow, Memory};

/// Belcour 2018, with FGD-infinity computed exactly. To read it from a table, see
/// [`evaluate`](crate::statistics::evaluate::evaluate).
#[derive(Debug)]
pub struct Belcour {
    follow: Follow,
    memory: Memory,
}

impl Belcour {
    /// The model, following one of the directions.
    pub fn new(follow: Follow) -> Self {
        Self { follow, memory: Memory::default() }
    }
}

impl Model for Belcour {
    fn info(&self) -> ModelInfo {
        let name = match self.follow {
            Follow::Eye => "belcour",
            Follow::HalfVector => "belcour-half-vector",
        };
        ModelInfo {
            name,
            kind: Kind::Layered,
            claims: match self.follow {
                Follow::Eye => Claims::ENERGY,
                Follow::HalfVector => Claims::BOTH,
            },
            inputs: &[],
            source: match self.follow {
                Follow::Eye => "Belcour 2018, sec. 3-5 (atomic operators, adding, total reflection)",
                Follow::HalfVector => "Belcour 2018, sec. 3-5, at the angle against the half vector",
            },
            domain: "any number of GGX interfaces and absorbing slabs on a conductor or a diffuse base; small alpha, away from \
                     grazing angles",
            leaves_out: match self.follow {
                Follow::Eye => {
                    "reciprocity, anisotropy, shear and skew of lobes, light that lobes lose to masking, scattering media"
                }
                Follow::HalfVector => {
                    "anisotropy, shear and skew of lobes, light that lobes lose to masking, scattering media"
                }
            },
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.memory.prepared(stack).eval::<f64>(self.follow, wi, wo)
    }
}

#[cfg(test)]
mod tests;
