//! Anisotropic facets for single scattering: distribution, masking, sampling.
//!
//! An anisotropic surface is an isotropic one of unit roughness whose slopes are stretched by `alpha_x` and `alpha_y`
//! (Heitz 2014, "Understanding the Masking-Shadowing Function"), so that every function here is the isotropic one
//! at stretched arguments.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_model::Masking;
use luthier_optics::masking::{self, Correlation};
use luthier_optics::stack::{Distribution, Surface};
use luthier_optics::{microfacet, visible_normals};

use crate::frame::half_vector;
use crate::terms::Terms;

/// Least slope parameter of facets, a lobe 0.006 degrees wide; smaller ones are raised to it. A model of finite lobes has no other way to show a
/// mirror.
pub const ALPHA_MIN: f64 = 1e-4;

/// The lobe of facets of density D that reflect `wi` to `wo`; `None` unless both are above the horizon. `alpha` is the isotropic
/// slope parameter, `lambda` Smith's function of a direction.
pub(crate) fn masked_lobe(
    masking: Masking,
    [wi, wo]: [DVec3; 2],
    alpha: f64,
    density: impl Fn(DVec3) -> f64,
    lambda: impl Fn(DVec3) -> f64,
) -> Option<Lobe> {
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return None;
    }
    let (wh, cos_theta_d) = half_vector(wi, wo)?;
    let masked = match masking {
        Masking::Smith => masking::smith(Correlation::Height, lambda(wi), lambda(wo)),
        Masking::SmithSeparable => masking::smith(Correlation::Separable, lambda(wi), lambda(wo)),
        Masking::VCavity => masking::v_cavity(wi.z, wo.z, wh.z, cos_theta_d),
        Masking::Kelemen => masking::kelemen(wi.z, wo.z, cos_theta_d),
        Masking::SchlickSmith => masking::schlick_smith(alpha, wi.z, wo.z),
        Masking::Implicit => masking::implicit(wi.z, wo.z),
    };
    Some(Lobe { cos_theta_d, masking: masked, value: density(wh) * (masked / (4.0 * wo.z)) })
}

/// The micro-surface in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Facets {
    distribution: Distribution,
    alpha_x: f64,
    alpha_y: f64,
    cos_rotation: f64,
    sin_rotation: f64,
}

/// The facets that reflect one direction into another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Cosine between either direction and the facets' normal.
    pub cos_theta_d: f64,
    /// Part of the facets that both directions see.
    pub masking: f64,
    /// `D G / (4 cos_theta_o)`: f cos_theta_i of a perfectly reflecting surface, one bounce.
    pub value: f64,
}

impl Facets {
    /// The facets of a surface; slope parameters are clamped to [`ALPHA_MIN`]..=1.
    pub fn new(surface: &Surface) -> Self {
        Self {
            distribution: surface.distribution,
            alpha_x: surface.alpha_x.clamp(ALPHA_MIN, 1.0),
            alpha_y: surface.alpha_y.clamp(ALPHA_MIN, 1.0),
            cos_rotation: libm::cos(surface.rotation),
            sin_rotation: libm::sin(surface.rotation),
        }
    }

    /// The normalised distribution D of facet normals.
    pub fn density(&self, wh: DVec3) -> f64 {
        self.density_by(wh, |alpha, cos, sin_sq| microfacet::scaled_distribution(self.distribution, alpha, cos, sin_sq))
    }

    /// [`Facets::density`] from the isotropic `pi alpha^2 D` of alpha, the cosine and the squared sine of the angle: along one azimuth
    /// an anisotropic surface is an isotropic one of another slope parameter.
    pub fn density_by(&self, wh: DVec3, scaled: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let sin_sq = wh.x * wh.x + wh.y * wh.y;
        let area = self.alpha_x * self.alpha_y;
        let mut alpha = self.alpha_x;
        if self.alpha_x != self.alpha_y && sin_sq > 0.0 {
            let m = self.turned(wh);
            let (x, y) = (self.alpha_y * m.x, self.alpha_x * m.y);
            alpha = area * libm::sqrt(sin_sq / (x * x + y * y));
        }
        scaled(alpha, wh.z, sin_sq) / (PI * area)
    }

    /// Smith's Lambda of an upward direction. Distributions without a closed form have it by quadrature, of the isotropic slope parameter.
    pub fn lambda(&self, w: DVec3) -> f64 {
        if !self.distribution.has_walks() {
            return microfacet::lambda(self.distribution, libm::sqrt(self.alpha_x * self.alpha_y), w.z.clamp(0.0, 1.0));
        }
        microfacet::lambda(self.distribution, 1.0, self.stretched(w).z.clamp(0.0, 1.0))
    }

    /// The facets that reflect `wi` to `wo`; `None` unless both are above the horizon.
    pub fn lobe(&self, masking: Masking, wi: DVec3, wo: DVec3) -> Option<Lobe> {
        let alpha = libm::sqrt(self.alpha_x * self.alpha_y);
        masked_lobe(masking, [wi, wo], alpha, |wh| self.density(wh), |w| self.lambda(w))
    }

    /// [`Facets::lobe`] with the distribution of a layer as [`Terms`] give it, from a table or not.
    pub fn lobe_of<const C: usize>(
        &self,
        terms: &dyn Terms<C>,
        layer: usize,
        masking: Masking,
        wi: DVec3,
        wo: DVec3,
    ) -> Option<Lobe> {
        let alpha = libm::sqrt(self.alpha_x * self.alpha_y);
        let scaled = |alpha, cos, sin_sq| terms.distribution(layer, self.distribution, alpha, cos, sin_sq);
        masked_lobe(masking, [wi, wo], alpha, |wh| self.density_by(wh, scaled), |w| self.lambda(w))
    }

    /// The facets whose visible normals are drawn: GGX of the same slope parameters, if the distribution has no closed form of visible normals. Draws
    /// are weighed by the density that they come from, so means stay right.
    fn drawn(&self) -> Self {
        Self { distribution: self.distribution.walked(), ..*self }
    }

    /// The distribution whose visible normals are drawn.
    pub(crate) fn drawn_distribution(&self) -> Distribution {
        self.distribution.walked()
    }

    /// Slope parameters along both tangents.
    pub(crate) fn alphas(&self) -> [f64; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// A facet normal that `w` sees, from two numbers in 0..1: of the surface's own distribution, or of GGX for one without visible normals in
    /// closed form. `w.z > 0`.
    pub fn sample(&self, w: DVec3, u: [f64; 2]) -> DVec3 {
        let m = visible_normals::sample(self.drawn().distribution, 1.0, self.stretched(w), u);
        self.unturned(DVec3::new(self.alpha_x * m.x, self.alpha_y * m.y, m.z).normalize())
    }

    /// Density in solid angle of the reflection of `wo` at a sampled facet: `G1 D / (4 cos_theta_o)`. Zero below the horizon, although reflections at
    /// sampled facets may go there; [`Facets::pdf_of_mirrored`] counts those, too.
    pub fn pdf_solid_angle(&self, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 { 0.0 } else { self.pdf_of_mirrored(wi, wo) }
    }

    /// [`Facets::pdf_solid_angle`] over the whole sphere; its integral is 1. Facets lean by less than 90 degrees, so their reflections reach down to
    /// `wi.z = -wo.z`.
    pub fn pdf_of_mirrored(&self, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z + wo.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let wh = (wi + wo).normalize();
        let drawn = self.drawn();
        drawn.density(wh) / (4.0 * wo.z * (1.0 + drawn.lambda(wo)))
    }

    /// A direction of the surface in the frame of the tangents.
    pub(crate) fn turned(&self, w: DVec3) -> DVec3 {
        let (c, s) = (self.cos_rotation, self.sin_rotation);
        DVec3::new(c * w.x + s * w.y, c * w.y - s * w.x, w.z)
    }

    /// The inverse of [`Facets::turned`].
    pub(crate) fn unturned(&self, w: DVec3) -> DVec3 {
        let (c, s) = (self.cos_rotation, self.sin_rotation);
        DVec3::new(c * w.x - s * w.y, s * w.x + c * w.y, w.z)
    }

    fn stretched(&self, w: DVec3) -> DVec3 {
        let w = self.turned(w);
        DVec3::new(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

    fn brushed(distribution: Distribution) -> Facets {
        Facets::new(&Surface { distribution, alpha_x: 0.6, alpha_y: 0.2, rotation: 0.7 })
    }

    /// Oracle: both identities hold for any height-field surface, whatever its distribution.
    #[test]
    fn projected_and_visible_areas_are_those_of_the_plane() {
        for distribution in BOTH {
            let facets = brushed(distribution);
            let w = DVec3::new(0.6, -0.5, 0.4).normalize();
            let (mut area, mut visible) = (0.0, 0.0);
            let (thetas, phis) = (2000, 720);
            for i in 0..thetas {
                let theta = (f64::from(i) + 0.5) / f64::from(thetas) * 0.5 * PI;
                let (s, c) = (libm::sin(theta), libm::cos(theta));
                for j in 0..phis {
                    let phi = (f64::from(j) + 0.5) / f64::from(phis) * 2.0 * PI;
                    let m = DVec3::new(s * libm::cos(phi), s * libm::sin(phi), c);
                    let d = facets.density(m) * s * PI * PI / f64::from(thetas * phis);
                    area += d * c;
                    visible += d * m.dot(w).max(0.0);
                }
            }
            assert!((area - 1.0).abs() < 1e-5, "{distribution:?}: {area}");
            let g1 = 1.0 / (1.0 + facets.lambda(w));
            assert!((visible * g1 - w.z).abs() < 1e-5, "{distribution:?}: {}", visible * g1);
        }
    }

    #[test]
    fn isotropic_facets_are_those_of_the_optics_crate() {
        for distribution in BOTH {
            let facets = Facets::new(&Surface::isotropic(distribution, 0.3));
            let m = DVec3::new(0.2, 0.3, 0.9).normalize();
            let sin_sq = m.x * m.x + m.y * m.y;
            let expected = microfacet::distribution(distribution, 0.3, m.z, sin_sq);
            assert!((facets.density(m) / expected - 1.0).abs() < 1e-13);
            assert!((facets.lambda(m) / microfacet::lambda(distribution, 0.3, m.z) - 1.0).abs() < 1e-9);
        }
    }
}
