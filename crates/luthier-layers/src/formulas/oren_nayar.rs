//! The full model of Oren and Nayar for rough diffuse surfaces.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;

/// BRDF of a rough diffuse base, with its inter-reflection term (Oren and Nayar 1994, "Generalization of Lambert's
/// Reflectance Model", eq. 26-30). Lambert, albedo/pi, at `sigma = 0`. Both directions above the horizon.
///
/// The model is reciprocal; it may exceed unit albedo slightly at grazing angles for large sigma and albedo near 1.
pub fn brdf<const C: usize>(albedo: [f64; C], sigma: f64, wi: DVec3, wo: DVec3) -> [f64; C] {
    if sigma == 0.0 {
        return albedo.map(|rho| rho * FRAC_1_PI);
    }
    let sigma_sq = sigma * sigma;
    let sin_i = libm::sqrt(wi.x * wi.x + wi.y * wi.y);
    let sin_o = libm::sqrt(wo.x * wo.x + wo.y * wo.y);
    let theta_i = libm::atan2(sin_i, wi.z);
    let theta_o = libm::atan2(sin_o, wo.z);
    let (alpha, beta) = (theta_i.max(theta_o), theta_i.min(theta_o));
    // The azimuth drops out when either direction is the normal: every term with it is then multiplied by zero.
    let sines = sin_i * sin_o;
    let cos_phi = if sines > 0.0 { ((wi.x * wo.x + wi.y * wo.y) / sines).clamp(-1.0, 1.0) } else { 0.0 };

    let c1 = 1.0 - 0.5 * sigma_sq / (sigma_sq + 0.33);
    let back = 2.0 * beta / PI;
    let lobe = if cos_phi >= 0.0 { libm::sin(alpha) } else { libm::sin(alpha) - back * back * back };
    let c2 = 0.45 * sigma_sq / (sigma_sq + 0.09) * lobe;
    let angles = 4.0 * alpha * beta / (PI * PI);
    let c3 = 0.125 * sigma_sq / (sigma_sq + 0.09) * angles * angles;
    let direct = c1 + cos_phi * c2 * libm::tan(beta) + (1.0 - cos_phi.abs()) * c3 * libm::tan(0.5 * (alpha + beta));
    let bounced = 0.17 * sigma_sq / (sigma_sq + 0.13) * (1.0 - cos_phi * back * back);
    albedo.map(|rho| FRAC_1_PI * (rho * direct + rho * rho * bounced).max(0.0))
}

/// [`brdf`] of a single albedo.
pub fn brdf_scalar(albedo: f64, sigma: f64, wi: DVec3, wo: DVec3) -> f64 {
    let [value] = brdf([albedo], sigma, wi, wo);
    value
}
