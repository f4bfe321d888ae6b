//! Builders of stacks at one wavelength.

use luthier_layers::monochrome::MonochromeBelow;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

/// A perfect reflector: an index without a real part reflects everything at every angle.
pub(crate) const WHITE: MonochromeBelow = MonochromeBelow::Conductor { ior: Complex64::new(0.0, 1.0) };

pub(crate) fn ggx(alpha: f64) -> Surface {
    Surface::isotropic(Distribution::Ggx, alpha)
}

pub(crate) fn dielectric(ior: f64, optical_depth: f64) -> MonochromeBelow {
    MonochromeBelow::dielectric(ior, optical_depth)
}

pub(crate) fn lambert(albedo: f64) -> MonochromeBelow {
    MonochromeBelow::Diffuse { albedo, sigma: 0.0 }
}
