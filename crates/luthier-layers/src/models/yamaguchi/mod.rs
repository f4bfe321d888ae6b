//! The model of Yamaguchi et al.: Belcour's operators with covariance matrices, for anisotropic layers with a tangent each.
//!
//! Yamaguchi et al. 2019 replace variances by 2x2 matrices `M diag(h(s alpha_x), h(s alpha_y)) M^T` and keep everything else. The columns of M are
//! tangents (the print has M^T first). The Jacobians are diagonal with equal entries, so a matrix keeps its axes on its way through interfaces. Sums
//! of matrices from layers with different tangents have new axes. Lobes are evaluated in the principal axes of their matrix. See
//! [`statistics`](crate::models::statistics) for the method.
//!
//! The paper treats two layers and refers to Belcour's adding for more; the code uses this adding. Energies are those of isotropic surfaces with the
//! geometric mean of the slope parameters. FGD-infinity is exact in place of the paper's approximation, or comes from a table through
//! [`evaluate`](crate::models::statistics::evaluate::evaluate).
//!
//! The paper's Jacobians are `2 cos theta_i` for reflection and `(cos theta_i - eta cos theta_t)/eta` for refraction, where eta is n_i/n_t in its
//! eq. 2 and n_t/n_i in its eq. 5. The Jacobian of reflection drops out, because h is a fit to reflected light. That of refraction over
//! `2 cos theta_t` is Belcour's `s = 1/2 |1 - cos theta_i / (n12 cos theta_t)|`, with the eta of eq. 5. The widening of entering light, sigma/eta in
//! eq. 2, is backwards; as in Belcour's adding, spreads grow by `j = n12 cos theta_t / cos theta_i` on the way out.

use luthier_model::ShadingModel;

use crate::models::room::{Kernels, Room};
use crate::models::statistics::eval;
use crate::models::statistics::evaluate::Follow;
use crate::models::statistics::model::Statistical;
use crate::models::statistics::spread::Covariance;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("spread.wgsl"), ..Kernels::NONE },
    twin: eval::twin::<Covariance>,
    models: || vec![Box::new(Yamaguchi::new(Follow::Eye)), Box::new(Yamaguchi::new(Follow::HalfVector))],
    composed: |_| None,
};

/// The model of Yamaguchi et al. 2019.
pub type Yamaguchi = Statistical<Covariance>;

impl Yamaguchi {
    /// The model with the statistics of one direction.
    pub fn new(follow: Follow) -> Self {
        let domain = "GGX interfaces with a tangent each (two in the paper) and absorbing slabs on a conductor or a diffuse base; \
                      small alpha, away from grazing angles";
        Self::published(
            follow,
            match follow {
                Follow::Eye => [
                    ShadingModel::Yamaguchi.name(),
                    "Yamaguchi et al. 2019, eq. 1-5 and sec. 2.1, with the adding of Belcour 2018",
                    domain,
                    "reciprocity, anisotropy of energies, shear and skew of lobes, light that lobes lose to masking",
                ],
                Follow::HalfVector => [
                    "yamaguchi-half-vector",
                    "Yamaguchi et al. 2019, at the angle against the half vector",
                    domain,
                    "conservation of energy at grazing angles, anisotropy of energies, shear and skew of lobes, light that \
                     lobes lose to masking",
                ],
            },
        )
    }
}

#[cfg(test)]
mod tests;
