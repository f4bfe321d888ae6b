//! Closed form of smooth coats over a mirror or a Lambertian base, with all bounces: the reference for smooth stacks.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use crate::formulas::plane_stack::{diffuse_return, rule, seen_from_above};
use crate::model::{Claims, Estimate, Estimator, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};

/// Smooth interfaces and absorbing slabs over anything, Lambert's surface included, with all bounces: powers added interface by
/// interface (Stokes 1862), the diffuse base as in Saunderson 1942 with exact Fresnel,
///
/// ```text
/// f = T(wi) T(wo) rho / (pi n^2 (1 - rho R))
/// ```
///
/// T is the power that the coats pass, R the share of diffuse light below that they return, n the index on the base over the exterior's.
/// Roughness is ignored. Light mirrored by the interfaces is no function of two directions: it counts in the albedo alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClosedForm;

/// Cosines and weights for integrals of [`share_above`], which has a kink: from one cosine up all azimuths are above the plane with the normal `up`. The
/// rule is laid on both sides of the kink.
fn nodes(up: DVec3) -> impl Iterator<Item = (f64, f64)> {
    let kink = libm::hypot(up.x, up.y).min(1.0);
    let pieces = [(0.0, kink), (kink, 1.0 - kink)].into_iter().filter(|(_, length)| *length > 0.0);
    pieces.flat_map(|(from, length)| rule().iter().map(move |&(x, w)| (from + length * x, length * w)))
}

/// The share of the azimuths at a cosine that is above the plane with the normal `up`.
fn share_above(up: DVec3, cos_theta: f64) -> f64 {
    let across = libm::sqrt((1.0 - cos_theta * cos_theta).max(0.0)) * libm::hypot(up.x, up.y);
    if across == 0.0 {
        return 1.0;
    }
    libm::acos((-cos_theta * up.z / across).clamp(-1.0, 1.0)) * FRAC_1_PI
}

/// Quantities that all directions share.
struct Parts<'a> {
    stack: &'a Monochrome,
    coats: usize,
    /// Radiosity of the base over the irradiance that comes through the coats from outside.
    diffuse: f64,
}

impl<'a> Parts<'a> {
    /// The parts of a stack of at least one layer.
    fn of(stack: &'a Monochrome) -> Option<Self> {
        let coats = stack.layers.len().checked_sub(1)?;
        let MonochromeBelow::Diffuse { albedo, .. } = stack.layers[coats].below else {
            return Some(Self { stack, coats, diffuse: 0.0 });
        };
        let returned = albedo * diffuse_return(stack, coats);
        // If the coats hold everything back, nothing comes out.
        Some(Self { stack, coats, diffuse: if returned < 1.0 { albedo / (1.0 - returned) } else { 0.0 } })
    }

    fn transmittance(&self, cos_theta: f64) -> f64 {
        seen_from_above(self.stack, self.coats, cos_theta).map_or(0.0, |(powers, _)| powers.transmittance)
    }

    /// Radiance spreads by the square of the exterior's index over that on the base.
    fn spread(&self) -> f64 {
        let ratio = self.stack.exterior / self.stack.layers[self.coats].above;
        ratio * ratio
    }

    /// Light mirrored by the interfaces, the last one included.
    fn mirrored(&self, cos_theta: f64) -> f64 {
        let Some((powers, cos_below)) = seen_from_above(self.stack, self.coats, cos_theta) else {
            return self.totally_reflected(cos_theta);
        };
        let last = self.stack.layers[self.coats].reflectance(cos_below.min(1.0));
        let echo = 1.0 - powers.below * last;
        let deep = if echo > 0.0 { powers.transmittance * powers.transmittance * last / echo } else { 0.0 };
        powers.above + deep
    }

    /// Reflected from above, when a coat reflects everything that reaches it.
    fn totally_reflected(&self, cos_theta: f64) -> f64 {
        for count in 0..self.coats {
            let (Some((powers, _)), None) =
                (seen_from_above(self.stack, count, cos_theta), seen_from_above(self.stack, count + 1, cos_theta))
            else {
                continue;
            };
            let echo = 1.0 - powers.below;
            let deep = if echo > 0.0 { powers.transmittance * powers.transmittance / echo } else { 0.0 };
            return powers.above + deep;
        }
        0.0
    }
}

impl Model for ClosedForm {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "closed-form",
            kind: Kind::Reference,
            claims: Claims::BOTH,
            source: "Stokes 1862 (interfaces); Saunderson 1942 with exact Fresnel (diffuse base)",
            domain: "smooth interfaces, films and absorbing slabs over a smooth conductor or Lambert's surface; exact there",
            leaves_out: "all roughness, the base's too; light that smooth interfaces mirror, but for the albedo",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.eval_with_error(stack, wi, wo).mean
    }

    fn estimator(&self) -> Option<&dyn Estimator> {
        Some(self)
    }
}

impl Estimator for ClosedForm {
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate {
        let parts = if wi.z > 0.0 && wo.z > 0.0 { Parts::of(stack) } else { None };
        Estimate::exact(parts.map_or(0.0, |parts| {
            let passed = parts.transmittance(wi.z.min(1.0)) * parts.transmittance(wo.z.min(1.0));
            wi.z * passed * parts.diffuse * FRAC_1_PI * parts.spread()
        }))
    }

    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3, up: DVec3) -> Estimate {
        let parts = if wo.z > 0.0 { Parts::of(stack) } else { None };
        Estimate::exact(parts.map_or(0.0, |parts| {
            let cos_theta = wo.z.min(1.0);
            let leaves = DVec3::new(-wo.x, -wo.y, wo.z).dot(up) > 0.0;
            let mirrored = if leaves { parts.mirrored(cos_theta) } else { 0.0 };
            if parts.diffuse == 0.0 {
                return mirrored;
            }
            let lit: f64 =
                nodes(up).map(|(mu, weight)| 2.0 * weight * mu * share_above(up, mu) * parts.transmittance(mu)).sum();
            mirrored + parts.transmittance(cos_theta) * parts.diffuse * lit * parts.spread()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::quadrature::gauss_legendre;
    use luthier_optics::stack::Surface;
    use num_complex::Complex64;

    fn coated(n: f64, optical_depth: f64, base: MonochromeBelow) -> Monochrome {
        Monochrome::bare(&[MonochromeBelow::dielectric(n, optical_depth), base].map(|below| (Surface::smooth(), below)))
    }

    fn towards(cos: f64) -> DVec3 {
        DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos)
    }

    /// Oracle: the published closed form, n = 1.5 at normal incidence.
    #[test]
    fn coated_lambert() {
        for (albedo, expected) in [(0.18, 0.11813908), (0.5, 0.31607089), (0.8, 0.63283341), (1.0, 1.0)] {
            let stack = coated(1.5, 0.0, MonochromeBelow::Diffuse { albedo, sigma: 0.0 });
            let found = ClosedForm.albedo_with_error(&stack, DVec3::Z, DVec3::Z).mean;
            assert!((found - expected).abs() < 1e-6, "{albedo}: {found}");
        }
    }

    /// Oracle: F + (1 - F)^2 a / (1 - F a) at 45 degrees, n = 1.5 over a mirror, to ten digits.
    #[test]
    fn coated_mirror() {
        let mirror = MonochromeBelow::Conductor { ior: Complex64::new(0.0, 1.0) };
        for (depth, expected) in [(0.1, 0.7992518131), (1.0, 0.1441269347)] {
            let found =
                ClosedForm.albedo_with_error(&coated(1.5, depth, mirror), towards(libm::sqrt(0.5)), DVec3::Z).mean;
            assert!((found - expected).abs() < 1e-9, "{depth}: {found}");
        }
        assert_eq!(ClosedForm.eval(&coated(1.5, 0.1, mirror), DVec3::Z, DVec3::Z), 0.0);
    }

    /// Light from a denser exterior that a coat reflects totally, through a slab that absorbs.
    #[test]
    fn total_reflection_on_the_way_down() {
        let [matched, air] = [MonochromeBelow::dielectric(1.5, 0.3), MonochromeBelow::dielectric(1.0, 0.0)];
        let base = MonochromeBelow::Diffuse { albedo: 0.5, sigma: 0.0 };
        let bare = Monochrome::bare(&[matched, air, base].map(|below| (Surface::smooth(), below)));
        let stack = Monochrome::joined(1.5, bare.layers);
        let found = ClosedForm.albedo_with_error(&stack, towards(0.5), DVec3::Z).mean;
        assert!((found - libm::exp(-2.0 * 0.3 / 0.5)).abs() < 1e-12, "{found}");
        assert_eq!(ClosedForm.eval(&stack, towards(0.5), DVec3::Z), 0.0);
    }

    /// The light seen from a direction is the integral of f cos_theta_i, less the mirrored light.
    #[test]
    fn albedo_is_the_integral() {
        let stack = coated(1.4, 0.2, MonochromeBelow::Diffuse { albedo: 0.7, sigma: 0.0 });
        let reference = ClosedForm;
        let wo = towards(0.6);
        let sum: f64 = gauss_legendre(64)
            .into_iter()
            .map(|(mu, weight)| 2.0 * std::f64::consts::PI * weight * reference.eval(&stack, towards(mu), wo))
            .sum();
        // F at cosine 0.6 from vacuum to 1.4.
        let mirrored = stack.layers[0].reflectance(0.6);
        let found = reference.albedo_with_error(&stack, wo, DVec3::Z).mean;
        assert!((found - mirrored - sum).abs() < 1e-9, "{found} {mirrored} {sum}");
    }
}
