//! Stacks that tests share.

use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// A GGX coat of index 1.5 over a GGX metal.
pub(crate) fn rough_coat_on_metal(alpha_coat: f64, alpha_base: f64) -> Monochrome {
    let surface = |alpha| Surface::isotropic(Distribution::Ggx, alpha);
    let coat = MonochromeBelow::Dielectric { ior: 1.5, complex_ior: Complex64::new(1.5, 0.0), optical_depth: 0.1 };
    let metal = MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.5) };
    let layer = |alpha, above, below| MonochromeLayer { surface: surface(alpha), above, films: Vec::new(), below };
    Monochrome { exterior: 1.0, layers: vec![layer(alpha_coat, 1.0, coat), layer(alpha_base, 1.5, metal)] }
}
