//! Directional albedo of a model: by its own estimate, or by quadrature over the hemisphere.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use luthier_optics::quadrature::gauss_legendre;

use crate::model::Model;
use crate::monochrome::Monochrome;

/// Points along each half axis: the first rule, and the largest.
const POINTS: [usize; 2] = [16, 128];

/// The quadrature stops at a doubling of its points that changes no value by more than this.
const CONTENT: f64 = 1e-4;

/// A directional albedo and how far it may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalAlbedo {
    /// Share of the light that is reflected.
    pub value: f64,
    /// Standard error of an estimate; for a quadrature, the change at the last doubling of its points.
    pub error: f64,
    /// Whether the model estimated the albedo itself. Such an albedo includes light mirrored by smooth interfaces.
    pub is_estimate: bool,
}

/// Directional albedo seen from `wo` (unit, above the surface; 0 below): the integral of `f cos_theta_i` over the light.
///
/// Models that are functions are integrated, see [`over_hemisphere`]. Light mirrored by smooth interfaces is no function and is left out.
pub fn directional_albedo(model: &dyn Model, stack: &Monochrome, wo: DVec3) -> DirectionalAlbedo {
    if wo.z <= 0.0 {
        return DirectionalAlbedo { value: 0.0, error: 0.0, is_estimate: false };
    }
    if let Some(estimator) = model.estimator() {
        let own = estimator.albedo_with_error(stack, wo, DVec3::Z);
        return DirectionalAlbedo { value: own.mean, error: own.std_err, is_estimate: true };
    }
    let ([value], [error]) = over_hemisphere(DVec3::new(-wo.x, -wo.y, wo.z), |wi| [model.eval(stack, wi, wo)]);
    DirectionalAlbedo { value, error, is_estimate: false }
}

/// Integrals of some functions over the directions above the surface, and the change of each at the last doubling of the points. `peak` (unit) is
/// about where the functions are greatest.
///
/// Gauss-Legendre points along theta and phi crowd at the peak, so that sharp lobes are resolved. They are doubled until no integral changes by more
/// than 1e-4, or until there are 128 on each side of the peak.
pub fn over_hemisphere<const C: usize>(peak: DVec3, f: impl Fn(DVec3) -> [f64; C]) -> ([f64; C], [f64; C]) {
    let [mut points, most] = POINTS;
    let mut value = integral(&f, peak, points);
    loop {
        points *= 2;
        let finer = integral(&f, peak, points);
        let error = std::array::from_fn(|c| f64::abs(finer[c] - value[c]));
        if points >= most || error.iter().all(|change| *change <= CONTENT) {
            return (finer, error);
        }
        value = finer;
    }
}

/// The integral over the hemisphere, with `points` on each side of the peak in theta and in phi, which crowd at the peak.
pub fn integral<const C: usize>(f: &impl Fn(DVec3) -> [f64; C], peak: DVec3, points: usize) -> [f64; C] {
    let rule = gauss_legendre(points);
    let theta_peak = libm::atan2(libm::hypot(peak.x, peak.y), peak.z).min(FRAC_PI_2);
    let phi_peak = libm::atan2(peak.y, peak.x);
    let thetas: Vec<(f64, f64)> =
        crowded(&rule, theta_peak, -theta_peak).chain(crowded(&rule, theta_peak, FRAC_PI_2 - theta_peak)).collect();
    let phis: Vec<(f64, f64)> = crowded(&rule, phi_peak, -PI).chain(crowded(&rule, phi_peak, PI)).collect();
    let mut sum = [0.0; C];
    for &(theta, d_theta) in &thetas {
        let (sin_theta, cos_theta) = libm::sincos(theta);
        for &(phi, d_phi) in &phis {
            let (sin_phi, cos_phi) = libm::sincos(phi);
            let value = f(DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta));
            let weight = d_theta * sin_theta * d_phi;
            sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    sum
}

/// A rule on 0..=1 laid from `start` over `length` (of either sign), with spacing that grows as the square of the distance along
/// it: nodes and positive weights.
fn crowded(rule: &[(f64, f64)], start: f64, length: f64) -> impl Iterator<Item = (f64, f64)> {
    rule.iter().map(move |&(t, weight)| (start + length * t * t * t, 3.0 * t * t * weight * length.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Claims, Kind, ModelInfo};

    /// `f = (n + 2) / (2 pi) cos^n` about the mirror direction for normal incidence, whose albedo is 1.
    struct Lobe(f64);

    impl Model for Lobe {
        fn info(&self) -> ModelInfo {
            let (kind, claims) = (Kind::Surface, Claims::NONE);
            ModelInfo { name: "lobe", kind, claims, source: "", domain: "", leaves_out: "", inputs: &[] }
        }

        fn eval(&self, _: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
            let mirrored = DVec3::new(-wo.x, -wo.y, wo.z);
            (self.0 + 2.0) / (2.0 * PI) * libm::pow(mirrored.dot(wi).max(0.0), self.0) * wi.z
        }
    }

    #[test]
    fn closed_forms() {
        let stack = Monochrome { exterior: 1.0, layers: Vec::new() };
        for n in [0.0, 1.0, 1e3, 1e7] {
            let albedo = directional_albedo(&Lobe(n), &stack, DVec3::Z);
            assert!((albedo.value - 1.0).abs() < 1e-6 && albedo.error < 1e-4, "{n}: {albedo:?}");
        }
        // Sharp lobes aside the normal: the cosine of the mirror direction times (n + 2) / (n + 1).
        let wo = DVec3::new(0.48, 0.64, 0.6);
        let albedo = directional_albedo(&Lobe(1e5), &stack, wo);
        assert!((albedo.value - 0.6 * 100_002.0 / 100_001.0).abs() < 1e-4, "{albedo:?}");
        assert_eq!(directional_albedo(&Lobe(1.0), &stack, -wo).value, 0.0);
    }
}
