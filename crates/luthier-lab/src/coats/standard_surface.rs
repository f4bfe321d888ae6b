//! Autodesk Standard Surface as MaterialX's graph `standard_surface` has it.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/bxdf/standard_surface.mtlx`, graph `NG_standard_surface_surfaceshader_100`, on the nodes of
//! [`super::materialx`]; `artistic_ior` is Gulbrandsen 2014.
//!
//! To the letter: `coat_affect_color` and `coat_affect_roughness` are 0, their defaults, so that the coat changes neither; metals are conductors by a
//! complex index from reflectivity and a white edge; plastic keeps its index in air below the coat.

use luthier_optics::Rgb;
use luthier_optics::fresnel::interface;
use luthier_optics::num_complex::Complex64;

use super::materialx::{dielectric, metal};
use super::surface::{INDEX, Shader, Surface, rgb};

/// `artistic_ior` with a white edge.
fn artistic(reflectivity: f64) -> Complex64 {
    let r = reflectivity.min(0.99);
    let n = (1.0 - r) / (1.0 + r);
    let k_sq = ((n + 1.0) * (n + 1.0) * r - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    Complex64::new(n, k_sq.max(0.0).sqrt())
}

pub(super) fn shader(surface: &Surface) -> Shader {
    let (surface, alpha) = (surface.clone(), surface.alpha_or(surface.alpha));
    let scale = surface.scale_or([1.0; 3]);
    let air = Complex64::new(1.0, 0.0);
    let indices = surface.color.map(artistic);
    Box::new(move |at| {
        let fresnel: Rgb = indices.map(|index| interface(air, index, at.d).unpolarised());
        let metal = metal(at, alpha, fresnel);
        let plastic = dielectric(at, INDEX, alpha).over(surface.color.map(|c| c * at.i / std::f64::consts::PI));
        let base = |c: usize| surface.metallic * metal[c] + (1.0 - surface.metallic) * plastic[c];
        let Some(coat) = surface.coat else { return rgb(base) };
        dielectric(at, INDEX, coat).over(rgb(|c| scale[c] * base(c)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the reflectance at normal incidence is what the artist gave.
    #[test]
    fn metals_have_their_reflectivity() {
        for r in [0.3, 0.7, 0.95] {
            let found = interface(Complex64::new(1.0, 0.0), artistic(r), 1.0).unpolarised();
            assert!((found - r).abs() < 1e-12, "{r} {found}");
        }
    }
}
