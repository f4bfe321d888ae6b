//! Directions from angles in degrees.

use glam::DVec3;

/// The direction at an angle from the normal and an azimuth, both in degrees.
pub(crate) fn direction(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (theta, phi) = (theta_deg.to_radians(), phi_deg.to_radians());
    from_cosine(theta.cos(), phi)
}

/// The direction of a given cosine and azimuth in radians.
pub(crate) fn from_cosine(cos: f64, phi: f64) -> DVec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}
