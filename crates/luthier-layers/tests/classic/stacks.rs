//! Builders of stacks at one wavelength.

use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

/// A perfect reflector: an index without a real part reflects everything at every angle.
pub(crate) const WHITE: MonochromeBelow = MonochromeBelow::Conductor { ior: Complex64::new(0.0, 1.0) };

pub(crate) fn ggx(alpha: f64) -> Surface {
    Surface::isotropic(Distribution::Ggx, alpha)
}

pub(crate) fn dielectric(ior: f64, optical_depth: f64) -> MonochromeBelow {
    MonochromeBelow::Dielectric { ior, complex_ior: Complex64::new(ior, 0.0), optical_depth }
}

pub(crate) fn lambert(albedo: f64) -> MonochromeBelow {
    MonochromeBelow::Diffuse { albedo, sigma: 0.0 }
}

/// Layers from the top down under air.
pub(crate) fn stack(layers: &[(Surface, MonochromeBelow)]) -> Monochrome {
    let mut above = 1.0;
    let layers = layers
        .iter()
        .map(|&(surface, below)| {
            let layer = MonochromeLayer { surface, above, films: Vec::new(), below };
            if let MonochromeBelow::Dielectric { ior, .. } = below {
                above = ior;
            }
            layer
        })
        .collect();
    Monochrome { exterior: 1.0, layers }
}
