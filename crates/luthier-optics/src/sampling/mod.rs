//! Samplers of directions with a known density: cosine, visible normals, and mixtures.
//!
//! All densities are per solid angle of the light's direction `wi`, given the eye's direction `wo`; both local, +z the normal.

pub mod split_mix;

use std::f64::consts::PI;

use glam::DVec3;

use crate::microfacet::Anisotropic;
use crate::visible_normals;

/// A direction and its density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Unit direction above the horizon.
    pub wi: DVec3,
    /// Density per solid angle, 1/sr; positive.
    pub pdf_solid_angle: f64,
}

/// A way to draw directions.
pub trait Sampler {
    /// A direction from three numbers in 0..1, the third for choices. `None` where the draw is lost (`wo` at or below the horizon, a
    /// reflection into the surface): lost draws count as zero in an estimate.
    fn sample(&self, wo: DVec3, u: [f64; 3]) -> Option<Sample>;

    /// The density with which [`Sampler::sample`] draws `wi`; 0 at and below the horizon. It integrates to the share of draws that are
    /// not lost.
    fn pdf_solid_angle(&self, wo: DVec3, wi: DVec3) -> f64;
}

/// Density cos_theta_i / pi, whatever `wo` is (Malley's method: a disc lifted to the hemisphere).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CosineHemisphere;

impl Sampler for CosineHemisphere {
    fn sample(&self, wo: DVec3, u: [f64; 3]) -> Option<Sample> {
        let radius = libm::sqrt(u[0]);
        let phi = 2.0 * PI * u[1];
        let wi = DVec3::new(radius * libm::cos(phi), radius * libm::sin(phi), libm::sqrt((1.0 - u[0]).max(0.0)));
        positive(wi, self.pdf_solid_angle(wo, wi))
    }

    fn pdf_solid_angle(&self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z <= 0.0 { 0.0 } else { wi.z.max(0.0) / PI }
    }
}

/// `wo` mirrored at a micro-normal that it sees: the density is G1(wo) D(wh) / (4 cos_theta_o) (Heitz and d'Eon 2014, "Importance
/// Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals").
///
/// ```
/// use luthier_optics::{glam::DVec3, microfacet::Anisotropic, stack::Distribution};
/// use luthier_optics::sampling::{Sampler, VisibleNormals};
///
/// let sampler = VisibleNormals { ndf: Anisotropic::new(Distribution::Ggx, 0.2, 0.4).unwrap() };
/// let wo = DVec3::new(0.6, 0.0, 0.8);
/// let sample = sampler.sample(wo, [0.3, 0.7, 0.5]).unwrap();
/// let pdf = sampler.pdf_solid_angle(wo, sample.wi);
/// assert!(sample.wi.z > 0.0 && (pdf / sample.pdf_solid_angle - 1.0).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleNormals {
    /// The distribution of normals.
    pub ndf: Anisotropic,
}

impl VisibleNormals {
    /// A micro-normal with density max(0, wo.wh) D(wh) G1(wo) / cos_theta_o per solid angle of `wh`; `wo.z > 0`.
    ///
    /// Slopes stretched by 1/alpha are those of the isotropic surface of alpha 1, seen from the direction stretched by alpha.
    pub fn normal(&self, wo: DVec3, u: [f64; 2]) -> DVec3 {
        let [alpha_x, alpha_y] = self.ndf.alphas();
        let stretched = DVec3::new(alpha_x * wo.x, alpha_y * wo.y, wo.z).normalize();
        let wh = visible_normals::sample(self.ndf.kind(), 1.0, stretched, u);
        DVec3::new(alpha_x * wh.x, alpha_y * wh.y, wh.z).normalize()
    }
}

impl Sampler for VisibleNormals {
    fn sample(&self, wo: DVec3, u: [f64; 3]) -> Option<Sample> {
        if wo.z <= 0.0 {
            return None;
        }
        let wh = self.normal(wo, [u[0], u[1]]);
        let wi = (2.0 * wo.dot(wh) * wh - wo).normalize();
        if wi.z <= 0.0 {
            return None;
        }
        // From the normal itself: the half vector of wi and wo has lost its digits for small alphas.
        positive(wi, self.density_of_normal(wo, wh))
    }

    fn pdf_solid_angle(&self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        self.density_of_normal(wo, (wi + wo).normalize())
    }
}

impl VisibleNormals {
    /// Density of the mirrored direction: the normal's over 4 wo.wh.
    fn density_of_normal(&self, wo: DVec3, wh: DVec3) -> f64 {
        self.ndf.density(wh) / (4.0 * wo.z * (1.0 + self.ndf.lambda(wo)))
    }
}

/// Several ways with fixed probabilities; the density is that of all of them together (Veach and Guibas 1995, one-sample model with the
/// balance heuristic).
#[derive(Default)]
pub struct Mixture {
    parts: Vec<(f64, Box<dyn Sampler>)>,
    total: f64,
}

impl Mixture {
    /// Adds a way; weights are relative. One that is not positive and finite is never chosen.
    #[must_use]
    pub fn with(mut self, weight: f64, sampler: impl Sampler + 'static) -> Self {
        if weight > 0.0 && weight.is_finite() {
            self.total += weight;
            self.parts.push((weight, Box::new(sampler)));
        }
        self
    }
}

impl Sampler for Mixture {
    fn sample(&self, wo: DVec3, u: [f64; 3]) -> Option<Sample> {
        let mut left = u[2] * self.total;
        let last = self.parts.len().checked_sub(1)?;
        for (i, (weight, sampler)) in self.parts.iter().enumerate() {
            if left < *weight || i == last {
                let rest = (left / weight).clamp(0.0, 1.0 - f64::EPSILON);
                let wi = sampler.sample(wo, [u[0], u[1], rest])?.wi;
                return positive(wi, self.pdf_solid_angle(wo, wi));
            }
            left -= weight;
        }
        None
    }

    fn pdf_solid_angle(&self, wo: DVec3, wi: DVec3) -> f64 {
        let sum: f64 = self.parts.iter().map(|(weight, sampler)| weight * sampler.pdf_solid_angle(wo, wi)).sum();
        if self.total > 0.0 { sum / self.total } else { 0.0 }
    }
}

fn positive(wi: DVec3, pdf_solid_angle: f64) -> Option<Sample> {
    (pdf_solid_angle > 0.0 && pdf_solid_angle.is_finite()).then_some(Sample { wi, pdf_solid_angle })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stack::Distribution;

    fn rough() -> VisibleNormals {
        VisibleNormals { ndf: Anisotropic::new(Distribution::Ggx, 0.4, 0.1).unwrap() }
    }

    #[test]
    fn a_sample_carries_the_density_of_its_direction() {
        let wo = DVec3::new(0.5, -0.3, 0.6).normalize();
        let mixture = Mixture::default().with(1.0, CosineHemisphere).with(3.0, rough());
        for i in 0..200 {
            let u = [0.618, 0.414, 0.732].map(|step| (step * f64::from(i)).fract());
            for sampler in [&rough() as &dyn Sampler, &CosineHemisphere, &mixture] {
                if let Some(sample) = sampler.sample(wo, u) {
                    let density = sampler.pdf_solid_angle(wo, sample.wi);
                    assert!((sample.pdf_solid_angle / density - 1.0).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn nothing_comes_from_below() {
        let below = DVec3::new(0.6, 0.0, -0.8);
        let mixture = Mixture::default().with(1.0, CosineHemisphere).with(1.0, rough());
        for sampler in [&rough() as &dyn Sampler, &CosineHemisphere, &mixture, &Mixture::default()] {
            assert_eq!(sampler.sample(below, [0.3; 3]), None);
            assert_eq!(sampler.pdf_solid_angle(below, DVec3::Z), 0.0);
            assert_eq!(sampler.pdf_solid_angle(DVec3::Z, below), 0.0);
        }
    }
}
