//! The material of glTF 2.0: metal and plastic by `metallic` and `roughness`, below a coat.
//!
//! Sources: glTF 2.0 specification, appendix B (B.2, B.3); the extensions `KHR_materials_clearcoat` (section "Layering"), `_specular`, `_ior` and
//! `_anisotropy`, as ratified.
//!
//! - GGX. B.3.2 prints Smith's masking as the product for both directions; most viewers have the height-correlated one, and so has `_anisotropy`.
//! - Metal: Schlick's reflectance at the half vector, with the base colour as F0.
//! - Plastic: `fresnel_mix`. The facets reflect `specular (f0 + (1 - f0)(1 - cos_theta_d)^5)`, and Lambert's base has the rest by the brightest channel.
//! - Coat: `fresnel_coat` of index 1.5, by which coat and base are mixed with Schlick's reflectance at the cosine of the eye.
//!
//! Out of scope: other extensions, and light between facets, which the formula has not.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::JointMasking;
use luthier_optics::schlick::schlick;

pub use super::facets::ALPHA_MIN;
use super::facets::{Facets, cos_theta_d};

/// F0 of the coat, of index 1.5, and that of plastics without `KHR_materials_ior`.
pub const F0: f64 = 0.04;

/// A material at a place.
///
/// ```
/// use luthier_layers::engines::gltf::{Coat, Material};
/// use luthier_layers::glam::DVec3;
///
/// let lacquer = Material { base_color: [0.5; 3], coat: Some(Coat { weight: 1.0, alpha: 0.1 }), ..Material::plastic(0.5) };
/// // Along the normal D G / 4 is 1 / (4 pi alpha^2), and both interfaces reflect 0.04.
/// let base = 0.96 * 0.5 / std::f64::consts::PI + 0.04 * 0.318_309_886;
/// let expected = 0.96 * base + 0.04 * 7.957_747_155;
/// assert!((lacquer.eval(DVec3::Z, DVec3::Z)[0] - expected).abs() < 1e-8);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Colour of the metal, and of the plastic's base; linear Rec.709.
    pub base_color: Rgb,
    /// Share of the metal.
    pub metallic: f64,
    /// Slope parameters along and across the tangent: the square of the roughness; with anisotropy the first is larger.
    pub alpha: [f64; 2],
    /// Angle from the surface's tangent to that of the facets, radians.
    pub turn: f64,
    /// F0 of the plastic, RGB.
    pub f0: Rgb,
    /// Factor on all that the interface of the plastic reflects, 0..=1: `specular`.
    pub specular: f64,
    /// The coat.
    pub coat: Option<Coat>,
    /// Masking of the base and of the coat.
    pub masking: JointMasking,
}

/// A coat of index 1.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coat {
    /// Share of the surface that it covers.
    pub weight: f64,
    /// Slope parameter: the square of the roughness.
    pub alpha: f64,
}

impl Material {
    /// White plastic of a slope parameter, with the masking that the appendix prints.
    pub fn plastic(alpha: f64) -> Self {
        Self {
            base_color: [1.0; 3],
            metallic: 0.0,
            alpha: [alpha; 2],
            turn: 0.0,
            f0: [F0; 3],
            specular: 1.0,
            coat: None,
            masking: JointMasking::Separable,
        }
    }

    /// `f cos_theta_i` of unit directions to the light and to the eye; 0 where either is not above the surface.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        self.coated(self.base(wi, wo), wi, wo).map(|f| f * wi.z)
    }

    /// The BRDF without the coat, of directions above the surface.
    pub fn base(&self, wi: DVec3, wo: DVec3) -> Rgb {
        let cos = cos_theta_d(wi, wo);
        let [plastic, metal] = [self.f0, self.base_color].map(|f0| f0.map(|f0| schlick(f0, cos)));
        self.base_by([plastic, metal], wi, wo)
    }

    /// [`Self::base`] with reflectances of plastic and metal at the half vector that are the caller's, such as below a film.
    pub fn base_by(&self, [plastic, metal]: [Rgb; 2], wi: DVec3, wo: DVec3) -> Rgb {
        let lobe = Facets { alpha: self.alpha, turn: self.turn }.lobe(self.masking, wi, wo);
        let reflected = plastic.map(|f| self.specular * f);
        let passed = 1.0 - reflected.into_iter().fold(0.0, f64::max);
        [0, 1, 2].map(|c: usize| {
            let plastic = passed * self.base_color[c] * FRAC_1_PI + reflected[c] * lobe;
            plastic + self.metallic * (metal[c] * lobe - plastic)
        })
    }

    /// The BRDF of a base of the BRDF `base` below the coat, if there is one.
    pub fn coated(&self, base: Rgb, wi: DVec3, wo: DVec3) -> Rgb {
        let Some(Coat { weight, alpha }) = self.coat else { return base };
        let (share, lobe) = (weight * schlick(F0, wo.z), Facets::isotropic(alpha).lobe(self.masking, wi, wo));
        base.map(|base| base + share * (lobe - base))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use luthier_optics::dielectric_albedo::reflected_dir;
    use luthier_optics::stack::Distribution;

    use super::*;
    use crate::directional_albedo::over_hemisphere;

    fn direction(theta_deg: f64, phi_deg: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(theta_deg.to_radians());
        let (sin_phi, cos_phi) = libm::sincos(phi_deg.to_radians());
        DVec3::new(sin * cos_phi, sin * sin_phi, cos)
    }

    fn albedo(material: &Material, wo: DVec3) -> Rgb {
        over_hemisphere(DVec3::new(-wo.x, -wo.y, wo.z), |wi| material.eval(wi, wo)).0
    }

    /// By hand, along the normal: D V = 1 / (4 pi alpha^2), .5 / pi of the colour, and .04 of light for the coat and for the surface.
    #[test]
    fn along_the_normal_by_hand() {
        for (metallic, weight, expected) in [
            (0.0, 0.0, 0.152_788_745 + 0.012_732_395),
            (1.0, 0.0, 0.159_154_943),
            (0.0, 1.0, 0.165_521_140 + 0.04 * (7.957_747_155 - 0.165_521_140)),
            (0.5, 0.5, 0.162_338_042 + 0.02 * (7.957_747_155 - 0.162_338_042)),
        ] {
            for masking in [JointMasking::Separable, JointMasking::Correlated] {
                let coat = Some(Coat { weight, alpha: 0.1 });
                let material = Material { base_color: [0.5; 3], metallic, coat, masking, ..Material::plastic(0.5) };
                let found = material.eval(DVec3::Z, DVec3::Z)[0];
                assert!((found - expected).abs() < 1e-8, "{metallic} {weight}: {found}");
            }
        }
    }

    /// Oracle: a mirror of a coat over black has the albedo of Schlick's reflectance at the eye, in closed form; the white base keeps the rest of a black
    /// interface.
    #[test]
    fn smooth_coats_have_a_closed_form() {
        for theta_deg in [0.0, 30.0, 60.0, 75.0, 85.0] {
            let wo = direction(theta_deg, 30.0);
            let coat = Some(Coat { weight: 0.7, alpha: 0.0 });
            let share = 0.7 * (0.04 + 0.96 * libm::pow(1.0 - wo.z, 5.0));
            let bare = Material { base_color: [0.6; 3], specular: 0.0, coat, ..Material::plastic(0.5) };
            let [found, ..] = albedo(&bare, wo);
            assert!((found - (0.6 * (1.0 - share) + share)).abs() < 2e-3, "{theta_deg}: {found}");
        }
    }

    /// Oracle: the quadrature of luthier-optics over the slopes of facets; here directions are integrated.
    #[test]
    fn metals_have_the_albedo_of_facets() {
        for (masking, alpha) in [(JointMasking::Separable, 0.09), (JointMasking::Correlated, 0.4)] {
            let metal = Material { base_color: [0.9, 0.5, 0.2], metallic: 1.0, masking, ..Material::plastic(alpha) };
            for theta_deg in [0.0, 45.0, 75.0, 85.0] {
                let wo = direction(theta_deg, 30.0);
                let found = albedo(&metal, wo);
                for (found, f0) in found.into_iter().zip(metal.base_color) {
                    let exact = reflected_dir(Distribution::Ggx, masking, alpha, wo.z, |cos| schlick(f0, cos));
                    assert!((found - exact).abs() < 5e-4, "{masking:?} {alpha} {theta_deg}: {found} {exact}");
                }
            }
        }
    }

    /// Half of the angle of a tangent turned by 90 degrees is that of swapped slope parameters, and equal ones have no direction.
    #[test]
    fn tangents_turn_facets() {
        let (wi, wo) = (direction(40.0, 10.0), direction(30.0, 200.0));
        let metal = |alpha: [f64; 2], turn: f64| Material { metallic: 1.0, alpha, turn, ..Material::plastic(0.1) };
        let [along, across] = [metal([0.3, 0.1], 0.0), metal([0.1, 0.3], PI / 2.0)].map(|m| m.eval(wi, wo)[0]);
        assert!((along / across - 1.0).abs() < 1e-12, "{along} {across}");
        let [round, turned] = [0.0, 1.0].map(|turn| metal([0.2; 2], turn).eval(wi, wo)[0]);
        assert!((round / turned - 1.0).abs() < 1e-12);
        assert!((metal([0.3, 0.1], 0.4).eval(wi, wo)[0] / along - 1.0).abs() > 0.05);
    }
}
