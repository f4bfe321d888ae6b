//! The target of a fit: the reflection of a rough surface at the nodes of a quadrature.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::masking::{Correlation, smith};
use luthier_optics::microfacet::{lambda, scaled_distribution};
use luthier_optics::quadrature::{GradedRules, gauss_legendre};
use luthier_optics::stack::Distribution;

use super::Lobe;

/// Lowest alpha. Smoother surfaces are taken as this one.
pub(super) const ALPHA_MIN: f64 = 1e-5;
/// Lowest cosine. Directions nearer the surface are taken as this one.
pub(super) const COS_MIN: f64 = 1e-3;

/// Rules over reflected directions, graded as the split sum's: by the tangent of half the angle from the mirror
/// direction, and by the tangent of half the azimuth.
pub(super) struct Rules {
    tilt: GradedRules,
    azimuth: GradedRules,
}

impl Rules {
    /// Rules of some 1,500 directions over half the hemisphere, for fits.
    pub(super) fn fitting() -> Self {
        Self::new([9.0, 5.0], [8.0, 4.0], 7)
    }

    /// Rules of some 6,000 directions, for errors.
    pub(super) fn judging() -> Self {
        Self::new([20.0, 10.0], [16.0, 8.0], 14)
    }

    fn new(tilt: [f64; 2], azimuth: [f64; 2], behind: usize) -> Self {
        let back: Vec<(f64, f64)> =
            gauss_legendre(behind).into_iter().map(|(t, weight)| (1.0 / t, 2.0 * weight / (1.0 + t * t))).collect();
        Self {
            tilt: GradedRules::new(tilt[0], tilt[1]),
            azimuth: GradedRules::new(azimuth[0], azimuth[1]).map(|t, weight| (t, 2.0 * weight / (1.0 + t * t)), &back),
        }
    }
}

/// One direction in the half of the hemisphere with positive y.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Direction: the mirror direction has a negative x.
    pub(super) w: DVec3,
    /// Solid angle of both halves.
    pub(super) solid_angle: f64,
    /// The BRDF times the cosine, over the albedo: a density.
    pub(super) density: f64,
}

/// The reflection of a surface for one direction of the viewer, without losses at the facets.
#[derive(Debug, Clone)]
pub(super) struct Target {
    /// Cosine of the viewer's direction.
    pub(super) cos_theta_o: f64,
    /// Slope parameter.
    pub(super) alpha: f64,
    /// The nodes of the quadrature.
    pub(super) nodes: Vec<Node>,
    /// Directional albedo, by that quadrature.
    pub(super) albedo_dir: f64,
}

/// The distribution and the correlation of masking of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Surface {
    pub(super) distribution: Distribution,
    pub(super) correlation: Correlation,
}

impl Surface {
    /// The BRDF times the cosine, without losses at the facets, for the tangent of the half vector squared.
    fn reflection(self, alpha: f64, [cos_o, cos_i]: [f64; 2], tan_h_sq: f64, lambda_o: f64) -> f64 {
        let cos_h_sq = 1.0 / (1.0 + tan_h_sq);
        let d = scaled_distribution(self.distribution, alpha, libm::sqrt(cos_h_sq), tan_h_sq * cos_h_sq);
        let g = smith(self.correlation, lambda_o, lambda(self.distribution, alpha, cos_i));
        d * g / (4.0 * PI * alpha * alpha * cos_o)
    }

    /// The BRDF times the cosine of the light, for unit directions; facets reflect everything.
    pub(super) fn brdf_cos(self, alpha: f64, wo: DVec3, wi: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let h = wo + wi;
        let tan_h_sq = (h.x * h.x + h.y * h.y) / (h.z * h.z);
        self.reflection(alpha, [wo.z, wi.z], tan_h_sq, lambda(self.distribution, alpha, wo.z))
    }
}

impl Target {
    pub(super) fn new(rules: &Rules, surface: Surface, alpha: f64, cos_theta_o: f64) -> Self {
        let (alpha, cos_o) = (alpha.clamp(ALPHA_MIN, 1.0), cos_theta_o.clamp(COS_MIN, 1.0));
        let sin_o = libm::sqrt((1.0 - cos_o) * (1.0 + cos_o));
        let lambda_o = lambda(surface.distribution, alpha, cos_o);
        let scale = alpha.min(cos_o);
        let mut nodes = Vec::new();
        // Tangents of half the angle from the mirror direction to the normal, and to the horizon.
        for end in [-sin_o / (1.0 + cos_o), cos_o / (1.0 + sin_o)] {
            let reach = end / scale;
            for &(part, tilt_weight) in rules.tilt.for_reach_squared(reach * reach) {
                let x = end * part;
                let inverse = 1.0 / (1.0 + x * x);
                let (cos_tilt, sin_tilt) = ((1.0 - x * x) * inverse, 2.0 * x * inverse);
                let (cos_i, sin_i) = (cos_o * cos_tilt - sin_o * sin_tilt, sin_o * cos_tilt + cos_o * sin_tilt);
                if cos_i <= 0.0 || sin_i <= 0.0 {
                    continue;
                }
                // tan_theta_h^2 = x^2 + q h, with h = sin^2 of half the azimuth.
                let span = sin_o * sin_i;
                let q = span * (1.0 + x * x) / (0.5 * (1.0 + cos_o * cos_i - span));
                let g = surface.reflection(alpha, [cos_o, cos_i], x * x, lambda_o)
                    / scaled_distribution_of_tangent(surface.distribution, alpha, x * x).max(f64::MIN_POSITIVE);
                for &(t, azimuth_weight) in rules.azimuth.for_reach_squared(q / (x * x + alpha * alpha)) {
                    let h = t * t / (1.0 + t * t);
                    let (cos_phi, sin_phi) = (1.0 - 2.0 * h, 2.0 * t / (1.0 + t * t));
                    nodes.push(Node {
                        w: DVec3::new(-sin_i * cos_phi, sin_i * sin_phi, cos_i),
                        solid_angle: tilt_weight * end.abs() * 2.0 * inverse * sin_i * 2.0 * azimuth_weight,
                        density: g * scaled_distribution_of_tangent(surface.distribution, alpha, x * x + q * h),
                    });
                }
            }
        }
        let albedo_dir: f64 = nodes.iter().map(|node| node.solid_angle * node.density).sum();
        nodes.iter_mut().for_each(|node| node.density /= albedo_dir);
        Self { cos_theta_o: cos_o, alpha, nodes, albedo_dir }
    }

    /// The energy that reflection and lobe share: the integral of the lesser of both densities, that of the lobe times `amplitude`.
    ///
    /// Half the integral of the difference of two densities is 1 less this. No light of radiance 1 errs by more, over
    /// the albedo, and some light errs by as much. The lesser density is 0 wherever the reflection is, so the nodes
    /// need not follow the lobe.
    pub(super) fn shared(&self, lobe: Lobe, amplitude: f64) -> f64 {
        self.nodes
            .iter()
            .map(|node| node.solid_angle * node.density.min(amplitude * lobe.pdf_solid_angle(node.w)))
            .sum()
    }
}

fn scaled_distribution_of_tangent(distribution: Distribution, alpha: f64, tan_h_sq: f64) -> f64 {
    let cos_h_sq = 1.0 / (1.0 + tan_h_sq);
    scaled_distribution(distribution, alpha, libm::sqrt(cos_h_sq), tan_h_sq * cos_h_sq)
}

#[cfg(test)]
mod tests {
    use luthier_optics::split_sum::{Masking, split_sum};

    use super::*;

    /// The albedo of the nodes is that of another quadrature, and a density that one knows integrates to 1.
    #[test]
    fn nodes_hold_the_albedo_and_the_cosine() {
        let rules = [Rules::fitting(), Rules::judging()];
        for (distribution, limit) in [(Distribution::Ggx, 2e-5), (Distribution::Beckmann, 5e-4)] {
            let surface = Surface { distribution, correlation: Correlation::Height };
            for alpha in [1e-4, 0.01, 0.1, 0.5, 1.0] {
                for cos in [0.003, 0.1, 0.5, 0.9, 1.0] {
                    let exact = split_sum(distribution, Masking::SmithCorrelated, alpha, cos).albedo();
                    for rules in &rules {
                        let target = Target::new(rules, surface, alpha, cos);
                        let off = (target.albedo_dir - exact).abs();
                        assert!(off < limit, "{distribution:?} {alpha} {cos}: {off:e}, {} nodes", target.nodes.len());
                        let cosine: f64 = target.nodes.iter().map(|node| node.solid_angle * node.w.z / PI).sum();
                        assert!((cosine - 1.0).abs() < 2e-3, "{alpha} {cos}: {cosine}");
                    }
                }
            }
        }
    }

    /// The nodes' densities are the BRDF as its formula has it.
    #[test]
    fn densities_are_those_of_the_directions() {
        let surface = Surface { distribution: Distribution::Ggx, correlation: Correlation::Height };
        let target = Target::new(&Rules::fitting(), surface, 0.3, 0.4);
        let wo = DVec3::new(libm::sqrt(1.0 - 0.16), 0.0, 0.4);
        for node in &target.nodes {
            let expected = surface.brdf_cos(0.3, wo, node.w) / target.albedo_dir;
            assert!((node.density / expected - 1.0).abs() < 1e-9, "{:?}", node);
        }
    }
}
