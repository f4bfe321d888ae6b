//! Belcour's model: statistical operators with isotropic spreads, for any number of layers.
//!
//! See [`statistics`](crate::models::statistics) for the method. Surfaces count as isotropic GGX: anisotropic ones enter with the
//! geometric mean of their slope parameters, Beckmann ones with their FGD-infinity and a GGX lobe of their slope parameter.
//!
//! Choices where the paper and its code leave something open, with measurements by the tests:
//!
//! - *Total reflection* (TIR) is an integral, within 3e-4, in place of the paper's table. FGD-infinity is computed, too. A table can supply either:
//!   see [`Energy`](crate::models::statistics::energy::Energy).
//! - *The mean number of bounces* m belongs to the wavelength. The paper's code averages it over the channels. For gold below a coat of n = 1.5, both
//!   of alpha 0.2, slopes of single channels then differ by -1.6% to 1.2% at the normal and by -3.8% to 2.6% at 78 degrees.
//! - *A diffuse base* is not in the paper: see [`diffuse_base`](crate::models::statistics::diffuse_base).
//! - *Widening*: the variance of a base grows by the Jacobian j on the way out, which the fit turns into j^(1/1.1) in slope. So a base of small alpha
//!   appears 4% to 11% narrower than refraction makes it (n = 1.5, 0 to 70 degrees). At high alpha the fit itself is off: 3.59 against 0.62 at
//!   alpha 0.8. The way back to a slope undoes this error, except in sums: two surfaces of 0.2 below each other make 0.311, and light paths .25
//!   to .28.
//! - *Energy* is at most 1 if the model follows the eye. At the half vector, lobes carry the energy of another angle: a white mirror of alpha 0.3
//!   below a coat of alpha 0.05 returns 1.15 at 89 degrees.

use luthier_model::ShadingModel;

use crate::models::room::{Kernels, Room};
use crate::models::statistics::eval;
use crate::models::statistics::evaluate::Follow;
use crate::models::statistics::model::Statistical;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("spread.wgsl"), ..Kernels::NONE },
    twin: eval::twin::<f64>,
    models: || vec![Box::new(Belcour::new(Follow::Eye)), Box::new(Belcour::new(Follow::HalfVector))],
    composed: |_| None,
};

/// The model of Belcour 2018.
pub type Belcour = Statistical<f64>;

impl Belcour {
    /// The model with the statistics of one direction.
    pub fn new(follow: Follow) -> Self {
        let domain = "any number of GGX interfaces and absorbing slabs on a conductor or a diffuse base; small alpha, away from \
                      grazing angles";
        Self::published(
            follow,
            match follow {
                Follow::Eye => [
                    ShadingModel::Belcour.name(),
                    "Belcour 2018, sec. 3-5 (atomic operators, adding, total reflection)",
                    domain,
                    "reciprocity, anisotropy, shear and skew of lobes, light that lobes lose to masking, scattering media",
                ],
                Follow::HalfVector => [
                    "belcour-half-vector",
                    "Belcour 2018, sec. 3-5, at the angle against the half vector",
                    domain,
                    "conservation of energy at grazing angles, anisotropy, shear and skew of lobes, light that lobes lose \
                     to masking, scattering media",
                ],
            },
        )
    }
}

#[cfg(test)]
mod tests;
