//! The white furnace: a lossless surface under uniform light of unit radiance has to vanish, radiance 1 in every direction.
//!
//! Which surface is lossless depends on what a model knows of it:
//!
//! - [`Monochrome::lossless`], for models of a whole stack;
//! - [`Monochrome::lossless_interface`], for models of the first interface.
//!
//! A radiance below 1 shows the light that a model leaves out, such as bounces between facets or layers. A radiance above 1 is invented light.

use glam::DVec3;

use crate::directional_albedo::{DirectionalAlbedo, directional_albedo};
use crate::model::Model;
use crate::monochrome::Monochrome;

/// Radiance towards `wo` (unit, above the surface) of the model's lossless stack under light of radiance 1 from everywhere: the
/// directional albedo that `wo` sees, with its error.
pub fn furnace(model: &dyn Model, stack: &Monochrome, wo: DVec3) -> DirectionalAlbedo {
    directional_albedo(model, &model.lossless(stack), wo)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::microfacet::{Components, Microfacet};
    use crate::monochrome::MonochromeBelow;
    use crate::references::closed_form::ClosedForm;
    use luthier_optics::fresnel::FilmLayer;
    use luthier_optics::stack::{Distribution, Surface};
    use num_complex::Complex64;

    fn filmed(alpha: f64, base: MonochromeBelow) -> Monochrome {
        let coat = MonochromeBelow::Dielectric { ior: 1.5, complex_ior: Complex64::new(1.5, 1e-3), optical_depth: 0.7 };
        let mut stack =
            Monochrome::bare(&[coat, base].map(|below| (Surface::isotropic(Distribution::Ggx, alpha), below)));
        stack.layers[0].films.push(FilmLayer { ior: Complex64::new(1.4, 0.3), waves: 0.4 });
        stack
    }

    fn towards(cos_theta_o: f64) -> DVec3 {
        DVec3::new(libm::sqrt(1.0 - cos_theta_o * cos_theta_o), 0.0, cos_theta_o)
    }

    /// An exact model vanishes in it, whatever the stack was.
    #[test]
    fn smooth_stacks_return_everything() {
        let gold = MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) };
        let grey = MonochromeBelow::Diffuse { albedo: 0.3, sigma: 0.0 };
        let glass = MonochromeBelow::dielectric(1.2, 0.4);
        for base in [gold, grey, glass] {
            for cos_theta_o in [0.1, 0.6, 1.0] {
                let radiance = furnace(&ClosedForm, &filmed(0.0, base), towards(cos_theta_o)).value;
                // Of the diffuse base's quadrature.
                assert!((radiance - 1.0).abs() < 1e-6, "{base:?} {cos_theta_o}: {radiance}");
            }
        }
    }

    /// Oracle: single scattering of GGX with F = 1 at alpha 0.5, whatever the film: 0.6878485151 at the normal, 0.69825 at 60 degrees.
    #[test]
    fn one_interface_lacks_what_facets_scatter_twice() {
        let grey = MonochromeBelow::Diffuse { albedo: 0.3, sigma: 0.0 };
        let microfacet = Microfacet::new(Components::PLAIN);
        for (cos_theta_o, expected) in [(1.0, 0.6878485151), (0.5, 0.69825)] {
            let radiance = furnace(&microfacet, &filmed(0.5, grey), towards(cos_theta_o));
            assert!((radiance.value - expected).abs() < 1e-4 + radiance.error, "{cos_theta_o}: {radiance:?}");
        }
    }
}
