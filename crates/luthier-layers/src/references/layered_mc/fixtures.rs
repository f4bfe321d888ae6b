//! Stacks that tests share.

use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use crate::monochrome::{Monochrome, MonochromeBelow};

/// A GGX coat of index 1.5 over a GGX metal.
pub(crate) fn rough_coat_on_metal(alpha_coat: f64, alpha_base: f64) -> Monochrome {
    let surface = |alpha| Surface::isotropic(Distribution::Ggx, alpha);
    let metal = MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.5) };
    Monochrome::bare(&[(surface(alpha_coat), MonochromeBelow::dielectric(1.5, 0.1)), (surface(alpha_base), metal)])
}
