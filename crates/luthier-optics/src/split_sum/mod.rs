//! The split sum of image-based lighting (Karis 2013, "Real Shading in Unreal Engine 4"), for the masking terms in use.
//!
//! It is the directional albedo of a rough interface under Schlick's Fresnel as `f0 * scale + bias`, single-scattering.

mod surface;

use std::f64::consts::PI;
use std::sync::OnceLock;

use crate::albedo::{ALPHA_MIN, COS_THETA_MIN};
use crate::masking::{Correlation, implicit, kelemen, rational_g1, schlick_smith, smith, v_cavity};
use crate::microfacet::lambda;
use crate::quadrature::{GradedRules, gauss_legendre};
use crate::stack::Distribution;

pub use surface::{SplitSumRow, SplitSumSurface};

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

/// The split sums of all of [`Masking::ALL`].
///
/// `alpha` in 0..=1 (a mirror below [`ALPHA_MIN`]), `cos_theta` in 0..=1 (the limit at grazing below [`COS_THETA_MIN`]). For cosines and
/// alphas from 0.001 within 1e-6, but for V-cavities, whose kinks cost up to 4e-3.
pub fn split_sums(distribution: Distribution, alpha: f64, cos_theta: f64) -> [SplitSum; 9] {
    sums_of(rules(distribution), Masking::ALL, distribution, alpha, cos_theta)
}

/// The split sum of one term: one of [`split_sums`], computed alone.
pub fn split_sum(distribution: Distribution, masking: Masking, alpha: f64, cos_theta: f64) -> SplitSum {
    let [sum] = sums_of(rules(distribution), [masking], distribution, alpha, cos_theta);
    sum
}

/// Quadrature over reflected directions, in the plane of incidence and around the normal.
struct Rules {
    /// Over the tangent of half the angle from the mirror direction, divided by that of the horizon.
    tilt: GradedRules,
    /// Over sin^2 of half the azimuth from the plane of incidence; weights are of the azimuth.
    azimuth: GradedRules,
}

impl Rules {
    fn new(tilt: [f64; 2], azimuth: [f64; 2], behind: usize) -> Self {
        // The tangent t of half the azimuth from 0 to 1, graded; then from 1 on, where 1/t goes from 1 to 0 and nothing is narrow.
        let back: Vec<(f64, f64)> = gauss_legendre(behind)
            .into_iter()
            .map(|(t, weight)| (1.0 / (1.0 + t * t), 2.0 * weight / (1.0 + t * t)))
            .collect();
        let azimuth = GradedRules::new(azimuth[0], azimuth[1])
            .map(|t, weight| (t * t / (1.0 + t * t), 2.0 * weight / (1.0 + t * t)), &back);
        Self { tilt: GradedRules::new(tilt[0], tilt[1]), azimuth }
    }
}

/// The rules of [`split_sums`]: some 800 points for GGX, 1200 for Beckmann, whose azimuths are as narrow but end more abruptly.
fn rules(distribution: Distribution) -> &'static Rules {
    static GGX: OnceLock<Rules> = OnceLock::new();
    static BECKMANN: OnceLock<Rules> = OnceLock::new();
    let (rules, azimuth) = match distribution {
        Distribution::Beckmann => (&BECKMANN, [8.0, 4.0]),
        _ => (&GGX, [5.0, 2.5]),
    };
    rules.get_or_init(|| Rules::new([6.0, 4.0], azimuth, 5))
}

/// Slope, over alpha, beyond which Gaussian slopes are left out: exp(-36) is below rounding.
const BECKMANN_REACH: f64 = 6.0;

fn sums_of<const N: usize>(
    rules: &Rules,
    terms: [Masking; N],
    distribution: Distribution,
    alpha: f64,
    cos_theta: f64,
) -> [SplitSum; N] {
    let distribution = distribution.walked();
    let cos_i = cos_theta.clamp(COS_THETA_MIN, 1.0);
    let mut sums = [SplitSum::default(); N];
    if alpha < ALPHA_MIN {
        let mirror = Ring { cos_i, cos_o: cos_i, cos_d_sq_min: cos_i * cos_i, cos_d_sq_span: 0.0 };
        let lambda_i = lambda(distribution, alpha, cos_i);
        let fc = schlick_part(cos_i);
        for (sum, masking) in sums.iter_mut().zip(terms) {
            let reflected =
                mirror.masking(masking, distribution, alpha, lambda_i) * within(masking, &mirror, cos_i * cos_i);
            *sum = SplitSum { scale: reflected * (1.0 - fc), bias: reflected * fc };
        }
        return sums;
    }
    let sin_i = libm::sqrt((1.0 - cos_i) * (1.0 + cos_i));
    let lambda_i = lambda(distribution, alpha, cos_i);
    let alpha_sq = alpha * alpha;
    // Masking changes with the cosine to the horizon on the scale of cos_i, the distribution on that of alpha.
    let scale = alpha.min(cos_i);
    // Tangents of half the angle from the mirror direction to the normal, and to the horizon.
    let to_normal = sin_i / (1.0 + cos_i);
    let to_horizon = cos_i / (1.0 + sin_i);
    let last = match distribution {
        Distribution::Beckmann => BECKMANN_REACH * alpha,
        _ => f64::INFINITY,
    };
    for end in [-to_normal.min(last), to_horizon.min(last)] {
        let reach = end / scale;
        for &(part, weight) in rules.tilt.for_reach_squared(reach * reach) {
            let x = end * part;
            let x_sq = x * x;
            let inverse = 1.0 / (1.0 + x_sq);
            let (cos_tilt, sin_tilt) = ((1.0 - x_sq) * inverse, 2.0 * x * inverse);
            let (cos_o, sin_o) = (cos_i * cos_tilt - sin_i * sin_tilt, sin_i * cos_tilt + cos_i * sin_tilt);
            if cos_o <= 0.0 || sin_o <= 0.0 {
                continue;
            }
            // cos_theta_d^2 = c + s h, with h = sin^2 of half the azimuth; tan_theta_h^2 = x^2 + q h.
            let c = 0.5 * (1.0 + cos_i * cos_o - sin_i * sin_o);
            let s = sin_i * sin_o;
            let q = s * (1.0 + x_sq) / c;
            let ring = Ring { cos_i, cos_o, cos_d_sq_min: c, cos_d_sq_span: s };
            let rule = rules.azimuth.for_reach_squared(match distribution {
                Distribution::Beckmann => q / alpha_sq,
                _ => q / (x_sq + alpha_sq),
            });
            let density = Density { distribution, inverse_alpha_sq: 1.0 / alpha_sq, x_sq, q };
            // d(theta_o) = 2 dx / (1 + x^2), and both sides of the plane of incidence.
            let measure = weight * end.abs() * 2.0 * inverse * 2.0 * sin_o / (4.0 * cos_i * PI * alpha_sq);
            let mut plain = None;
            for (sum, masking) in sums.iter_mut().zip(terms) {
                let [all, bias] = match masking {
                    Masking::VCavity | Masking::Kelemen => {
                        density.around(&ring, rule, |cos_d_sq| within(masking, &ring, cos_d_sq))
                    }
                    _ => *plain.get_or_insert_with(|| density.around(&ring, rule, |_| 1.0)),
                };
                let outside = measure * ring.masking(masking, distribution, alpha, lambda_i);
                sum.scale += outside * (all - bias);
                sum.bias += outside * bias;
            }
        }
    }
    sums
}

/// Sums side by side in the innermost loop.
const LANES: usize = 4;

/// (1 - cos)^5.
fn schlick_part(cos_d: f64) -> f64 {
    let u = 1.0 - cos_d;
    let u_sq = u * u;
    u_sq * u_sq * u
}

/// pi alpha^2 D over the azimuth of directions of one polar angle.
struct Density {
    distribution: Distribution,
    inverse_alpha_sq: f64,
    x_sq: f64,
    q: f64,
}

impl Density {
    /// Integrals over half the azimuth of pi alpha^2 D and of its product with (1 - cos_theta_d)^5, both times `factor(cos_theta_d^2)`.
    fn around(&self, ring: &Ring, rule: &[(f64, f64)], factor: impl Fn(f64) -> f64) -> [f64; 2] {
        match self.distribution {
            Distribution::Beckmann => self.sum(ring, rule, factor, |slope_sq| {
                (1.0 + slope_sq) * (1.0 + slope_sq) * libm::exp(-slope_sq * self.inverse_alpha_sq)
            }),
            _ => self.sum(ring, rule, factor, |slope_sq| {
                let root = (1.0 + slope_sq) / (1.0 + slope_sq * self.inverse_alpha_sq);
                root * root
            }),
        }
    }

    fn sum(
        &self,
        ring: &Ring,
        rule: &[(f64, f64)],
        factor: impl Fn(f64) -> f64,
        of_slope_sq: impl Fn(f64) -> f64,
    ) -> [f64; 2] {
        // Four sums side by side, which processors add at once; their order is fixed.
        let (mut all, mut bias) = ([0.0; LANES], [0.0; LANES]);
        for points in rule.chunks(LANES) {
            for ((&(h, weight), all), bias) in points.iter().zip(&mut all).zip(&mut bias) {
                let cos_d_sq = ring.cos_d_sq_min + ring.cos_d_sq_span * h;
                let value = weight * factor(cos_d_sq) * of_slope_sq(self.x_sq + self.q * h);
                *all += value;
                *bias += value * schlick_part(cos_d_sq.sqrt().min(1.0));
            }
        }
        let [all, bias] = [all, bias].map(|[a, b, c, d]| (a + b) + (c + d));
        [all, bias]
    }
}

/// Reflected directions of one polar angle. The squared cosine at their facets is a minimum plus a part of a span.
struct Ring {
    cos_i: f64,
    cos_o: f64,
    cos_d_sq_min: f64,
    cos_d_sq_span: f64,
}

/// The part of a masking term that changes with the azimuth.
fn within(masking: Masking, ring: &Ring, cos_d_sq: f64) -> f64 {
    let Ring { cos_i, cos_o, .. } = *ring;
    let cos_d = libm::sqrt(cos_d_sq);
    match masking {
        Masking::VCavity => v_cavity(cos_i, cos_o, ((cos_i + cos_o) / (2.0 * cos_d)).min(1.0), cos_d),
        Masking::Kelemen => kelemen(cos_i, cos_o, cos_d),
        _ => 1.0,
    }
}

impl Ring {
    /// The part of a masking term that is equal at all azimuths.
    fn masking(&self, masking: Masking, distribution: Distribution, alpha: f64, lambda_i: f64) -> f64 {
        let Self { cos_i, cos_o, .. } = *self;
        match masking {
            Masking::SmithCorrelated => smith(Correlation::Height, lambda_i, lambda(distribution, alpha, cos_o)),
            Masking::SmithSeparable => smith(Correlation::Separable, lambda_i, lambda(distribution, alpha, cos_o)),
            Masking::SmithJointApprox => {
                let from_i = cos_o * (cos_i * (1.0 - alpha) + alpha);
                let from_o = cos_i * (cos_o * (1.0 - alpha) + alpha);
                2.0 * cos_i * cos_o / (from_i + from_o)
            }
            Masking::SchlickHalf => rational_g1(0.5 * alpha, cos_i) * rational_g1(0.5 * alpha, cos_o),
            Masking::SchlickKaris => {
                let r = 1.0 + libm::sqrt(alpha);
                rational_g1(r * r / 8.0, cos_i) * rational_g1(r * r / 8.0, cos_o)
            }
            Masking::Schlick => schlick_smith(alpha, cos_i, cos_o),
            Masking::Implicit => implicit(cos_i, cos_o),
            Masking::VCavity | Masking::Kelemen => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::albedo::{Effort, FacetStatistics, ReflectanceCurves};
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
            for ((found, expected), masking) in split_sums(kind, alpha, cos_i).iter().zip(expected).zip(Masking::ALL) {
                // What midpoints miss at the horizon, where light grazes; and what kinks cost quadrature.
                let limit = if masking == Masking::VCavity { 5e-4 } else { 2e-4 };
                let close = (found.scale - expected.scale).abs() < limit && (found.bias - expected.bias).abs() < limit;
                assert!(close, "{kind:?} {alpha} {cos_i} {masking:?}: {found:?} {expected:?}");
            }
        }
    }

    /// Visible normals instead of reflected directions: the quadrature of [`FacetStatistics`], which is documented to 5e-5.
    #[test]
    fn agrees_with_visible_normals() {
        let curves = ReflectanceCurves::new(2, |k, cos| if k == 0 { 1.0 } else { libm::pow(1.0 - cos, 5.0) });
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for alpha in [0.01, 0.1, 0.4, 1.0] {
                for cos in [0.01, 0.1, 0.5, 0.9] {
                    let facets = FacetStatistics::new(distribution, alpha, cos, Effort { first: 128, later: 1 }, 1);
                    let expected = facets.single_scattering(&curves);
                    let found = split_sum(distribution, Masking::SmithCorrelated, alpha, cos);
                    let off = (found.albedo() - expected[0]).abs().max((found.bias - expected[1]).abs());
                    assert!(off < 3e-5, "{distribution:?} {alpha} {cos}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn converges_as_documented() {
        let fine = Rules::new([16.0, 9.0], [16.0, 8.0], 16);
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for alpha in [0.001, 0.0025, 0.01, 0.02, 0.05, 0.2, 0.5, 1.0] {
                for cos in [0.001, 0.01, 0.05, 0.3, 0.7, 0.9, 0.99, 1.0] {
                    let found = split_sums(distribution, alpha, cos);
                    let expected = sums_of(&fine, Masking::ALL, distribution, alpha, cos);
                    for ((a, b), masking) in found.iter().zip(expected).zip(Masking::ALL) {
                        let off = (a.scale - b.scale).abs().max((a.bias - b.bias).abs());
                        let limit = if masking == Masking::VCavity { 4e-3 } else { 1e-6 };
                        assert!(off < limit, "{distribution:?} {masking:?} {alpha} {cos}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_mirror_is_schlick() {
        let sum = split_sums(Distribution::Ggx, 0.0, 0.3)[0];
        let fc = libm::pow(0.7, 5.0);
        assert!((sum.bias - fc).abs() < 1e-15 && (sum.scale - (1.0 - fc)).abs() < 1e-15);
    }
}
