//! The split sum of image-based lighting (Karis 2013, "Real Shading in Unreal Engine 4"), for the masking terms in use.
//!
//! It is the directional albedo of a rough interface under Schlick's Fresnel as `f0 * scale + bias`, single-scattering.

use crate::albedo::{ALPHA_MIN, COS_THETA_MIN, reflecting_facets};
use crate::masking::{Correlation, implicit, kelemen, schlick_smith, smith, v_cavity};
use crate::microfacet::lambda;
use crate::stack::Distribution;

/// A masking term G. Where a term depends on the artist's roughness r, alpha = r^2 is assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Masking {
    /// Smith's, correlated by height (Heitz 2014, eq. 99).
    SmithCorrelated,
    /// Smith's, the product of both directions.
    SmithSeparable,
    /// Smith's with sqrt(cos^2 (1 - alpha^2) + alpha^2) taken as cos (1 - alpha) + alpha: Unreal Engine's `Vis_SmithJointApprox`.
    SmithJointApprox,
    /// Schlick's fit with k = alpha/2, which is Karis's k = r^2/2 for image-based lighting.
    SchlickHalf,
    /// Schlick's fit with k = (r + 1)^2/8: Karis 2013 for analytic lights.
    SchlickKaris,
    /// Schlick's own k = alpha sqrt(2/pi).
    Schlick,
    /// V-shaped cavities.
    VCavity,
    /// Kelemen and Szirmay-Kalos 2001.
    Kelemen,
    /// G = cos_theta_i cos_theta_o.
    Implicit,
}

impl Masking {
    /// All terms, in the order of [`split_sums`].
    pub const ALL: [Self; 9] = [
        Self::SmithCorrelated,
        Self::SmithSeparable,
        Self::SmithJointApprox,
        Self::SchlickHalf,
        Self::SchlickKaris,
        Self::Schlick,
        Self::VCavity,
        Self::Kelemen,
        Self::Implicit,
    ];

    /// Its name on command lines and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::SmithCorrelated => "correlated",
            Self::SmithSeparable => "separable",
            Self::SmithJointApprox => "joint-approx",
            Self::SchlickHalf => "schlick-half",
            Self::SchlickKaris => "schlick-karis",
            Self::Schlick => "schlick",
            Self::VCavity => "v-cavity",
            Self::Kelemen => "kelemen",
            Self::Implicit => "implicit",
        }
    }
}

/// Albedo of a surface whose facets reflect by Schlick's formula: `f0 * scale + bias` (f90 = 1).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SplitSum {
    /// The integral of (1 - Fc) over the lobe, Fc = (1 - cos_theta_d)^5.
    pub scale: f64,
    /// The integral of Fc.
    pub bias: f64,
}

impl SplitSum {
    /// Albedo for f0 = 1: single scattering without loss at the facets.
    pub fn albedo(self) -> f64 {
        self.scale + self.bias
    }
}

/// The split sums of all of [`Masking::ALL`], by Gauss-Legendre quadrature with `points` per direction of each smooth piece.
///
/// `alpha` in 0..=1 (a mirror below [`ALPHA_MIN`]), `cos_theta` in 0..=1 (the limit at grazing below [`COS_THETA_MIN`]). At 24 points
/// within 5e-5 of 64 points for cosines from 0.01 and alpha from 0.0025, but for V-cavities, whose kinks cost up to 1e-3.
pub fn split_sums(distribution: Distribution, alpha: f64, cos_theta: f64, points: usize) -> [SplitSum; 9] {
    sums_of(Masking::ALL, distribution, alpha, cos_theta, points)
}

/// The split sum of one term, as [`split_sums`] has it.
pub fn split_sum(distribution: Distribution, masking: Masking, alpha: f64, cos_theta: f64, points: usize) -> SplitSum {
    let [sum] = sums_of([masking], distribution, alpha, cos_theta, points);
    sum
}

fn sums_of<const N: usize>(
    terms: [Masking; N],
    distribution: Distribution,
    alpha: f64,
    cos_theta: f64,
    points: usize,
) -> [SplitSum; N] {
    let cos_i = cos_theta.clamp(COS_THETA_MIN, 1.0);
    let mut sums = [SplitSum::default(); N];
    let lambda_i = lambda(distribution, alpha, cos_i);
    let mut add = |cos_d: f64, cos_o: f64, weight: f64| {
        if cos_o <= 0.0 || cos_d <= 0.0 {
            return;
        }
        let u = (1.0 - cos_d).max(0.0);
        let fc = u * u * u * u * u;
        let pair = Pair { distribution, alpha, cos_i, cos_o, cos_d: cos_d.min(1.0), lambda_i };
        for (sum, masking) in sums.iter_mut().zip(terms) {
            let reflected = weight * pair.masking(masking);
            sum.scale += reflected * (1.0 - fc);
            sum.bias += reflected * fc;
        }
    };
    if alpha < ALPHA_MIN {
        add(cos_i, cos_i, 1.0);
    } else {
        reflecting_facets(distribution, alpha, cos_i, points, add);
    }
    sums
}

/// Two directions and the facet between them.
struct Pair {
    distribution: Distribution,
    alpha: f64,
    cos_i: f64,
    cos_o: f64,
    cos_d: f64,
    lambda_i: f64,
}

impl Pair {
    fn masking(&self, masking: Masking) -> f64 {
        let Self { distribution, alpha, cos_i, cos_o, cos_d, lambda_i } = *self;
        let smith_of = |correlation| smith(correlation, lambda_i, lambda(distribution, alpha, cos_o));
        let rational = |k: f64| cos_i / (cos_i * (1.0 - k) + k) * (cos_o / (cos_o * (1.0 - k) + k));
        match masking {
            Masking::SmithCorrelated => smith_of(Correlation::Height),
            Masking::SmithSeparable => smith_of(Correlation::Separable),
            Masking::SmithJointApprox => {
                let from_i = cos_o * (cos_i * (1.0 - alpha) + alpha);
                let from_o = cos_i * (cos_o * (1.0 - alpha) + alpha);
                2.0 * cos_i * cos_o / (from_i + from_o)
            }
            Masking::SchlickHalf => rational(0.5 * alpha),
            Masking::SchlickKaris => {
                let r = 1.0 + libm::sqrt(alpha);
                rational(r * r / 8.0)
            }
            Masking::Schlick => schlick_smith(alpha, cos_i, cos_o),
            Masking::VCavity => v_cavity(cos_i, cos_o, ((cos_i + cos_o) / (2.0 * cos_d)).min(1.0), cos_d),
            Masking::Kelemen => kelemen(cos_i, cos_o, cos_d),
            Masking::Implicit => implicit(cos_i, cos_o),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::microfacet::distribution;

    /// The integral over directions by midpoints, with G as its papers print it: an independent way for all terms.
    #[test]
    fn agrees_with_midpoints_over_directions() {
        let (rings, azimuths) = (700, 480);
        for (kind, alpha, cos_i) in
            [(Distribution::Ggx, 0.5, 0.5), (Distribution::Ggx, 0.3, 0.2), (Distribution::Beckmann, 0.6, 0.7)]
        {
            let sin_i = libm::sqrt(1.0 - cos_i * cos_i);
            let mut expected = [SplitSum::default(); 9];
            let r = libm::sqrt(alpha);
            for i in 0..rings {
                let cos_o = (f64::from(i) + 0.5) / f64::from(rings);
                let sin_o = libm::sqrt(1.0 - cos_o * cos_o);
                for j in 0..azimuths {
                    let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                    let h = glam::DVec3::new(sin_i + sin_o * libm::cos(phi), sin_o * libm::sin(phi), cos_i + cos_o)
                        .normalize();
                    let cos_d = h.x * sin_i + h.z * cos_i;
                    let (li, lo) = (lambda(kind, alpha, cos_i), lambda(kind, alpha, cos_o));
                    let g1 = |k: f64, c: f64| c / (c * (1.0 - k) + k);
                    let both = |k: f64| g1(k, cos_i) * g1(k, cos_o);
                    let vis = 0.5 / (cos_o * (cos_i * (1.0 - alpha) + alpha) + cos_i * (cos_o * (1.0 - alpha) + alpha));
                    let g = [
                        1.0 / (1.0 + li + lo),
                        1.0 / ((1.0 + li) * (1.0 + lo)),
                        vis * 4.0 * cos_i * cos_o,
                        both(alpha / 2.0),
                        both((r + 1.0) * (r + 1.0) / 8.0),
                        both(alpha * libm::sqrt(2.0 / PI)),
                        (2.0 * h.z * cos_i / cos_d).min(2.0 * h.z * cos_o / cos_d).min(1.0),
                        cos_i * cos_o / (cos_d * cos_d),
                        cos_i * cos_o,
                    ];
                    let d = distribution(kind, alpha, h.z, h.x * h.x + h.y * h.y) / (4.0 * cos_i);
                    let fc = libm::pow(1.0 - cos_d, 5.0);
                    for (sum, g) in expected.iter_mut().zip(g) {
                        let part = d * g * 2.0 * PI / f64::from(rings * azimuths);
                        sum.scale += part * (1.0 - fc);
                        sum.bias += part * fc;
                    }
                }
            }
            for ((found, expected), masking) in
                split_sums(kind, alpha, cos_i, 24).iter().zip(expected).zip(Masking::ALL)
            {
                // What midpoints miss at the horizon, where light grazes.
                let close = (found.scale - expected.scale).abs() < 2e-4 && (found.bias - expected.bias).abs() < 2e-4;
                assert!(close, "{kind:?} {alpha} {cos_i} {masking:?}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn converges_as_documented() {
        for alpha in [0.0025, 0.01, 0.05, 0.2, 0.5, 1.0] {
            for cos in [0.01, 0.05, 0.3, 0.7, 1.0] {
                let (coarse, fine) =
                    (split_sums(Distribution::Ggx, alpha, cos, 24), split_sums(Distribution::Ggx, alpha, cos, 64));
                for ((a, b), masking) in coarse.iter().zip(fine).zip(Masking::ALL) {
                    let off = (a.scale - b.scale).abs().max((a.bias - b.bias).abs());
                    let limit = if masking == Masking::VCavity { 1e-3 } else { 5e-5 };
                    assert!(off < limit, "{masking:?} {alpha} {cos}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn a_mirror_is_schlick() {
        let sum = split_sums(Distribution::Ggx, 0.0, 0.3, 24)[0];
        let fc = libm::pow(0.7, 5.0);
        assert!((sum.bias - fc).abs() < 1e-15 && (sum.scale - (1.0 - fc)).abs() < 1e-15);
    }
}
