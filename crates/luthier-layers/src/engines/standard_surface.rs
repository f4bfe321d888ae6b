//! Autodesk Standard Surface as MaterialX's graph `standard_surface` has it.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/bxdf/standard_surface.mtlx`, graph `NG_standard_surface_surfaceshader_100`, on the nodes of
//! [`super::materialx`]; `artistic_ior` is Gulbrandsen 2014.
//!
//! To the letter: `coat_affect_color` and `coat_affect_roughness` are 0, their defaults, so that the coat changes neither; metals are conductors by a
//! complex index from reflectivity and the colour of the edge; plastic keeps its index in air below the coat.
//!
//! Out of scope: transmission, subsurface, sheen, emission. Films reflect as the caller says.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::fresnel::interface;
use num_complex::Complex64;

use super::facets::{Facets, cos_theta_d};
use super::materialx::{Dielectric, metal};
use crate::formulas::oren_nayar;

/// A material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// `base_color` times `base`.
    pub base_color: Rgb,
    /// `metalness`.
    pub metallic: f64,
    /// `diffuse_roughness`: the slope deviation of Oren and Nayar, radians.
    pub diffuse_roughness: f64,
    /// `specular`.
    pub specular: f64,
    /// `specular_color`: tint of the plastic's interface, edge of the metal.
    pub specular_color: Rgb,
    /// `specular_IOR`.
    pub ior: f64,
    /// Slopes of the base.
    pub facets: Facets,
    /// The coat.
    pub coat: Option<Coat>,
}

/// A coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coat {
    /// `coat`.
    pub weight: f64,
    /// `coat_color`.
    pub color: Rgb,
    /// Slopes.
    pub facets: Facets,
    /// `coat_IOR`.
    pub ior: f64,
}

/// Slope parameters of a roughness and an anisotropy (`roughness_anisotropy` of MaterialX).
pub fn alphas(roughness: f64, anisotropy: f64) -> [f64; 2] {
    let (alpha, aspect) = (roughness * roughness, (1.0 - anisotropy.clamp(0.0, 0.98)).sqrt());
    [(alpha / aspect).min(1.0), alpha * aspect]
}

/// `artistic_ior`: index of a metal by its reflectivity and the colour of its edge.
///
/// ```
/// use luthier_layers::engines::standard_surface::artistic;
///
/// let index = artistic(0.7, 1.0);
/// let f0 = ((index - 1.0) / (index + 1.0)).norm_sqr();
/// assert!((f0 - 0.7).abs() < 1e-12);
/// ```
pub fn artistic(reflectivity: f64, edge: f64) -> Complex64 {
    let (r, g) = (reflectivity.clamp(0.0, 0.99), edge);
    let root = r.sqrt();
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
    let k_sq = ((n + 1.0) * (n + 1.0) * r - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    Complex64::new(n, k_sq.max(0.0).sqrt())
}

impl Material {
    /// White plastic of a slope parameter.
    pub fn plastic(alpha: f64) -> Self {
        Self {
            base_color: [1.0; 3],
            metallic: 0.0,
            diffuse_roughness: 0.0,
            specular: 1.0,
            specular_color: [1.0; 3],
            ior: 1.5,
            facets: Facets::isotropic(alpha),
            coat: None,
        }
    }

    /// `f cos_theta_i` of unit directions to the light and to the eye; 0 where either is not above the surface.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.eval_with([1.0; 3], None, wi, wo)
    }

    /// [`Self::eval`] with a factor on the base below the coat, and films: reflectances of plastic and metal by the cosine.
    pub fn eval_with(&self, scale: Rgb, films: Option<[&dyn Fn(f64) -> Rgb; 2]>, wi: DVec3, wo: DVec3) -> Rgb {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        let cos = cos_theta_d(wi, wo);
        let air = Complex64::new(1.0, 0.0);
        let bare = || {
            [0, 1, 2].map(|c: usize| {
                let index = artistic(self.base_color[c], self.specular * self.specular_color[c]);
                interface(air, index, cos).unpolarised()
            })
        };
        let metal = if self.metallic > 0.0 {
            metal(&self.facets, wi, wo, films.map_or_else(bare, |[_, film]| film(cos)))
        } else {
            [0.0; 3]
        };
        let above =
            Dielectric { index: self.ior, facets: self.facets, tint: self.specular_color, weight: self.specular };
        let diffuse = oren_nayar::brdf(self.base_color, self.diffuse_roughness, wi, wo).map(|f| f * wi.z);
        let plastic = above.part(wi, wo, films.map(|[film, _]| film)).over(diffuse);
        let base = [0, 1, 2].map(|c: usize| plastic[c] + self.metallic * (metal[c] - plastic[c]));
        let Some(coat) = self.coat else { return base };
        let tinted = [0, 1, 2].map(|c: usize| scale[c] * base[c] * (1.0 + coat.weight * (coat.color[c] - 1.0)));
        let above = Dielectric { index: coat.ior, facets: coat.facets, tint: [1.0; 3], weight: coat.weight };
        above.part(wi, wo, None).over(tinted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the reflectance at normal incidence is what the artist gave, whatever the edge.
    #[test]
    fn metals_have_their_reflectivity() {
        for r in [0.3, 0.7, 0.95] {
            for edge in [0.0, 0.4, 1.0] {
                let found = interface(Complex64::new(1.0, 0.0), artistic(r, edge), 1.0).unpolarised();
                assert!((found - r).abs() < 1e-12, "{r} {edge} {found}");
            }
        }
    }
}
