//! OpenPBR 1.1 as MaterialX's graph `open_pbr_surface` has it.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/bxdf/open_pbr_surface.mtlx`, graph `NG_open_pbr_surface_surfaceshader`, on the nodes of [`super::materialx`].
//!
//! To the letter: the base has roughness `(r^4 + 2 r_c^4)^(1/4)` below a coat; plastic the index over that of the coat, turned over where it is below 1; the base is darkened by `(1 - K)/(1 - E K)` with
//! `K = 1 - (1 - F0)/n^2`, the value of a diffuse base whatever the base, and E the base colour. Where the indices are equal, the node of the plastic's
//! interface reflects nothing and still takes the part of F90 from its throughput.
//!
//! Out of scope: transmission, subsurface, fuzz, emission. Films reflect as the caller says.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::schlick::F82;

use super::facets::{Facets, cos_theta_d};
use super::materialx::{Dielectric, metal, rough_diffuse};

/// A material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// `base_color`: of the diffuse base, and F0 of the metal.
    pub base_color: Rgb,
    /// `base_metalness`.
    pub metallic: f64,
    /// `base_diffuse_roughness`.
    pub diffuse_roughness: f64,
    /// `specular_weight`.
    pub specular_weight: f64,
    /// `specular_color`: tint of the plastic's interface, edge tint of the metal.
    pub specular_color: Rgb,
    /// `specular_ior`.
    pub ior: f64,
    /// Slopes of the base, by [`alphas`], in a roughness that no coat changed.
    pub roughness: f64,
    /// `specular_roughness_anisotropy`.
    pub anisotropy: f64,
    /// Angle of the tangent, radians.
    pub turn: f64,
    /// The coat.
    pub coat: Option<Coat>,
}

/// A coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coat {
    /// `coat_weight`.
    pub weight: f64,
    /// `coat_color`.
    pub color: Rgb,
    /// Slopes.
    pub facets: Facets,
    /// `coat_ior`.
    pub ior: f64,
    /// `coat_darkening`.
    pub darkening: f64,
}

/// Slope parameters of a roughness and an anisotropy: OpenPBR 1.1, section 3.1.
pub fn alphas(roughness: f64, anisotropy: f64) -> [f64; 2] {
    let rest = 1.0 - anisotropy;
    let along = roughness * roughness * (2.0 / (1.0 + rest * rest)).sqrt();
    [along.min(1.0), rest * along]
}

/// The base as a coat makes it look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Below {
    /// Slopes.
    pub facets: Facets,
    /// Factor on its light.
    pub scale: Rgb,
}

impl Material {
    /// White rough plastic.
    pub fn plastic(roughness: f64) -> Self {
        Self {
            base_color: [1.0; 3],
            metallic: 0.0,
            diffuse_roughness: 0.0,
            specular_weight: 1.0,
            specular_color: [1.0; 3],
            ior: 1.5,
            roughness,
            anisotropy: 0.0,
            turn: 0.0,
            coat: None,
        }
    }

    /// The base as the graph has it below the coat.
    pub fn below(&self) -> Below {
        let rough = |roughness: f64| Facets { alpha: alphas(roughness, self.anisotropy), turn: self.turn };
        let Some(coat) = self.coat else { return Below { facets: rough(self.roughness), scale: [1.0; 3] } };
        let fourth = |r: f64| r * r * r * r;
        let coat_sq = coat.facets.mean() * coat.facets.mean();
        let affected = (fourth(self.roughness) + 2.0 * coat_sq).min(1.0).sqrt().sqrt();
        let roughness = self.roughness + coat.weight * (affected - self.roughness);
        let f0 = (coat.ior - 1.0) * (coat.ior - 1.0) / ((coat.ior + 1.0) * (coat.ior + 1.0));
        let within = 1.0 - (1.0 - f0) / (coat.ior * coat.ior);
        let scale = [0, 1, 2].map(|c: usize| {
            let color = self.base_color[c];
            let estimate = color * (1.0 + self.metallic * (self.specular_weight - 1.0));
            let darker = (1.0 - within) / (1.0 - estimate * within);
            let darkened = 1.0 + coat.weight * coat.darkening * (darker - 1.0);
            darkened * (1.0 + coat.weight * (coat.color[c] - 1.0))
        });
        Below { facets: rough(roughness), scale }
    }

    /// Index of the plastic over what lies above it, by which its interface reflects.
    pub fn index(&self) -> f64 {
        let eta = self.coat.map_or(self.ior, |coat| {
            let ratio = self.ior / coat.ior;
            self.ior + coat.weight * (ratio.max(1.0 / ratio) - self.ior)
        });
        let root = (eta - 1.0) / (eta + 1.0);
        let epsilon = root.signum() * (self.specular_weight * root * root).clamp(0.0, 0.99999).sqrt();
        (1.0 + epsilon) / (1.0 - epsilon)
    }

    /// `f cos_theta_i` of unit directions to the light and to the eye; 0 where either is not above the surface.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.eval_with(&self.below(), None, wi, wo)
    }

    /// [`Self::eval`] with another base, and films: reflectances of plastic and metal by the cosine.
    pub fn eval_with(&self, below: &Below, films: Option<[&dyn Fn(f64) -> Rgb; 2]>, wi: DVec3, wo: DVec3) -> Rgb {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        let edge = cos_theta_d(wi, wo);
        let curve = |c: usize| F82 { f0: self.base_color[c], tint: self.specular_weight * self.specular_color[c] };
        let bare = [0, 1, 2].map(|c: usize| curve(c).eval(edge));
        let reflected = films.map_or(bare, |[_, film]| film(edge)).map(|f| self.specular_weight * f);
        let metal = metal(&below.facets, wi, wo, reflected);
        let interface =
            Dielectric { index: self.index(), facets: below.facets, tint: self.specular_color, weight: 1.0 };
        let diffuse = rough_diffuse(self.base_color, self.diffuse_roughness, wi, wo);
        let plastic = interface.part(wi, wo, films.map(|[film, _]| film)).over(diffuse);
        let base = [0, 1, 2].map(|c: usize| below.scale[c] * (plastic[c] + self.metallic * (metal[c] - plastic[c])));
        let Some(coat) = self.coat else { return base };
        let coat = Dielectric { index: coat.ior, facets: coat.facets, tint: [1.0; 3], weight: coat.weight };
        coat.part(wi, wo, None).over(base)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Index 1.5 below a coat of 1.6: 1.6/1.5 = 1.0667; without a coat 1.5; with half a weight of the interface an F0 of .02.
    #[test]
    fn indices_are_over_the_coat() {
        let bare = Material::plastic(0.3);
        let coat = Coat { weight: 1.0, color: [1.0; 3], facets: Facets::isotropic(0.01), ior: 1.6, darkening: 1.0 };
        let coated = Material { coat: Some(coat), ..bare };
        let half = Material { specular_weight: 0.5, ..bare };
        assert!((bare.index() - 1.5).abs() < 1e-12 && (coated.index() - 1.6 / 1.5).abs() < 1e-12);
        let root = (half.index() - 1.0) / (half.index() + 1.0);
        assert!((root * root - 0.02).abs() < 1e-12);
    }

    /// White stays white below a coat that darkens; grey gets darker by (1 - K)/(1 - K/2), K = 1 - .96/2.25.
    #[test]
    fn coats_darken_grey() {
        let coat = Coat { weight: 1.0, color: [1.0; 3], facets: Facets::isotropic(0.0), ior: 1.5, darkening: 1.0 };
        let scale =
            |grey: f64| Material { base_color: [grey; 3], coat: Some(coat), ..Material::plastic(0.3) }.below().scale[0];
        assert!((scale(1.0) - 1.0).abs() < 1e-12);
        assert!((scale(0.5) - (0.96 / 2.25) / (1.0 - 0.5 * (1.0 - 0.96 / 2.25))).abs() < 1e-12, "{}", scale(0.5));
    }
}
