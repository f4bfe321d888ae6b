//! Refraction at a plane interface between clear media: the directions and cosines that all models of layers bend light by.

use glam::DVec3;

/// Wavelength at which one scalar index bends the refracted directions (sodium D).
pub const REFRACTION_WAVELENGTH_NM: f64 = 589.3;

/// Squared cosine below an interface of index ratio `eta` (below over above); not positive under total reflection. Nothing cancels
/// between nearly equal indices.
pub(crate) fn cos_theta_t_sq(cos_theta_i: f64, eta: f64) -> f64 {
    (cos_theta_i * cos_theta_i + (eta - 1.0) * (eta + 1.0)) / (eta * eta)
}

/// Cosine below an interface, or `None` under total reflection.
pub(crate) fn refracted_cosine(cos_theta_i: f64, eta: f64) -> Option<f64> {
    let cos_sq = cos_theta_t_sq(cos_theta_i, eta);
    (cos_sq > 0.0).then(|| libm::sqrt(cos_sq).min(1.0))
}

/// The direction in the medium below, turned to point up again; `None` under total reflection. The tangential part keeps its sign.
pub(crate) fn refract(w: DVec3, eta: f64) -> Option<DVec3> {
    let cos_sq = cos_theta_t_sq(w.z, eta);
    (cos_sq > 0.0).then(|| DVec3::new(w.x / eta, w.y / eta, cos_sq.sqrt()))
}

/// [`refract`] at a facet of the normal `m`.
pub(crate) fn refract_at(m: DVec3, w: DVec3, eta: f64) -> Option<DVec3> {
    let cos = w.dot(m);
    let cos_sq = cos_theta_t_sq(cos, eta);
    (cos_sq > 0.0).then(|| (w - m * cos) / eta + m * cos_sq.sqrt())
}
