//! Terms of the models that tables stand in for.

use luthier_optics::microfacet;
use luthier_optics::stack::Distribution;

/// The factors of a model that can be read from tables, in `C` channels. Layers are numbered from the top. A
/// [`Monochrome`](crate::monochrome::Monochrome) stack computes its own.
pub trait Terms<const C: usize = 3> {
    /// Fresnel reflectance of the interface of a layer.
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> [f64; C];

    /// `pi alpha^2 D(theta_h, alpha)` of the slope distribution of a layer, from the cosine and the squared sine of theta_h; the closed
    /// form unless a table holds it.
    fn distribution(
        &self,
        _layer: usize,
        distribution: Distribution,
        alpha: f64,
        cos_theta_h: f64,
        sin_theta_h_sq: f64,
    ) -> f64 {
        microfacet::scaled_distribution(distribution, alpha, cos_theta_h, sin_theta_h_sq)
    }

    /// `2 cos(2 Phi)` of the film of a layer in one colour channel, for the sum of the cosines in the film; `None` if no table holds it and it has to be
    /// computed. Elek's model does not use it.
    fn interference(&self, _layer: usize, _channel: usize, _cosines: f64) -> Option<f64> {
        None
    }
}
