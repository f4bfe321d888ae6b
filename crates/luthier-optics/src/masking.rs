//! Masking and shadowing: the fraction of micro-facets that is both seen and lit.
//!
//! G multiplies F D / (4 cos_theta_i cos_theta_o). A G1 is right for a distribution D if the facets seen fill the view: the integral of
//! D max(0, wo.wh) G1 over the normals is cos_theta_o (Heitz 2014, eq. 15). That holds for V-cavities and for Smith; it does not for
//! the implicit, Kelemen's and Schlick's terms, which are here because real-time models use them.
//!
//! Cosines are of directions above the horizon, in 0..=1; every function is 0 where one of them is not positive, and finite.

use std::f64::consts::PI;
use std::sync::OnceLock;

use crate::ndf::Ndf;
use crate::quadrature::gauss_legendre;

/// Whether masking and shadowing are independent, or correlated because high facets are both lit and seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Correlation {
    /// The product of both G1.
    Separable,
    /// Correlation by height: 1/(1 + Lambda_i + Lambda_o) (Ross, Dion and Potvin 2005; Heitz 2014, eq. 99).
    Height,
}

/// Smith's G for reflection from the Lambdas of both directions
/// ([`microfacet::lambda`](crate::microfacet::lambda), [`Anisotropic::lambda`](crate::microfacet::Anisotropic::lambda)). Infinite Lambdas
/// give 0.
pub fn smith(correlation: Correlation, lambda_i: f64, lambda_o: f64) -> f64 {
    match correlation {
        Correlation::Separable => 1.0 / ((1.0 + lambda_i) * (1.0 + lambda_o)),
        Correlation::Height => 1.0 / (1.0 + lambda_i + lambda_o),
    }
}

/// Masking that only cancels the denominator: G = cos_theta_i cos_theta_o (Hoffman 2013, "implicit").
pub fn implicit(cos_theta_i: f64, cos_theta_o: f64) -> f64 {
    if cos_theta_i <= 0.0 || cos_theta_o <= 0.0 { 0.0 } else { cos_theta_i * cos_theta_o }
}

/// Masking of V-shaped cavities for one direction: min(1, 2 cos_theta_h cos_theta / cos_theta_d).
pub fn v_cavity_g1(cos_theta: f64, cos_theta_h: f64, cos_theta_d: f64) -> f64 {
    if cos_theta <= 0.0 || cos_theta_h <= 0.0 || cos_theta_d <= 0.0 {
        return 0.0;
    }
    (2.0 * cos_theta_h * cos_theta / cos_theta_d).min(1.0)
}

/// V-cavities of Torrance and Sparrow 1967, as printed by Cook and Torrance 1982 and by Elek 2010: the lesser of both directions'
/// masking. 1 at mirror directions for all angles, so that f grows as 1/cos^2 at grazing incidence.
pub fn v_cavity(cos_theta_i: f64, cos_theta_o: f64, cos_theta_h: f64, cos_theta_d: f64) -> f64 {
    v_cavity_g1(cos_theta_i, cos_theta_h, cos_theta_d).min(v_cavity_g1(cos_theta_o, cos_theta_h, cos_theta_d))
}

/// Kelemen and Szirmay-Kalos 2001: G/(cos_theta_i cos_theta_o) = 1/cos_theta_d^2, an approximation of the V-cavities.
pub fn kelemen(cos_theta_i: f64, cos_theta_o: f64, cos_theta_d: f64) -> f64 {
    if cos_theta_i <= 0.0 || cos_theta_o <= 0.0 || cos_theta_d <= 0.0 {
        return 0.0;
    }
    // Never above 1 for directions that belong to a half vector.
    (cos_theta_i * cos_theta_o / (cos_theta_d * cos_theta_d)).min(1.0)
}

/// Schlick 1994's rational fit to Smith's masking, as the lecture prints it: cos/(cos (1 - k) + k) with k = m sqrt(2/pi). Its m, the
/// rms slope, is Beckmann's `alpha`.
pub fn schlick_smith_g1(alpha: f64, cos_theta: f64) -> f64 {
    if cos_theta <= 0.0 {
        return 0.0;
    }
    rational_g1(alpha * libm::sqrt(2.0 / PI), cos_theta)
}

/// Schlick's fit for any k: cos/(cos (1 - k) + k).
pub(crate) fn rational_g1(k: f64, cos_theta: f64) -> f64 {
    cos_theta / (cos_theta * (1.0 - k) + k)
}

/// Separable product of [`schlick_smith_g1`] for both directions.
pub fn schlick_smith(alpha: f64, cos_theta_i: f64, cos_theta_o: f64) -> f64 {
    schlick_smith_g1(alpha, cos_theta_i) * schlick_smith_g1(alpha, cos_theta_o)
}

/// Gauss-Legendre points per piece of [`smith_g1_of`].
const NODES: usize = 128;

/// The rule of [`NODES`] points, made once.
fn rule() -> &'static [(f64, f64)] {
    static RULE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    RULE.get_or_init(|| gauss_legendre(NODES))
}

/// Smith's G1 of any isotropic distribution, by quadrature over the facets that a direction sees (Heitz 2014, eq. 42). It gives Blinn-Phong,
/// ABC and SGD, which have no closed form, a masking that conserves area.
///
/// Within 1e-6 for lobes wider than a hundredth of a radian; costs 256 evaluations of D.
pub fn smith_g1_of(ndf: &impl Ndf, cos_theta: f64) -> f64 {
    if cos_theta <= 0.0 {
        return 0.0;
    }
    let cos_theta = cos_theta.min(1.0);
    let sin_theta = libm::sqrt((1.0 - cos_theta) * (1.0 + cos_theta));
    // Facets flatter than this are seen at every azimuth.
    let all_seen = libm::asin(cos_theta);
    let mut seen = 0.0;
    for (start, length) in [(0.0, all_seen), (all_seen, 0.5 * PI - all_seen)] {
        for &(u, weight) in rule() {
            // Graded to the start: the lobe of the first piece, the square root of the second.
            let theta_h = start + length * u * u * u * u;
            let (sin, cos) = (libm::sin(theta_h), libm::cos(theta_h));
            let (mean, amplitude) = (cos * cos_theta, sin * sin_theta);
            let azimuths = if mean >= amplitude {
                2.0 * PI * mean
            } else {
                let last = libm::acos(-mean / amplitude);
                2.0 * (mean * last + amplitude * libm::sin(last))
            };
            seen += weight * length * 4.0 * u * u * u * ndf.density(cos, sin * sin) * azimuths * sin;
        }
    }
    if seen > 0.0 { (cos_theta / seen).min(1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet::Isotropic;
    use crate::microfacet::{distribution, lambda};
    use crate::ndf::{Abc, BlinnPhong, Sgd};
    use crate::stack::Distribution;

    /// The integral of D max(0, wo.wh) G1(wh), by midpoints.
    fn visible(ndf: &impl Ndf, cos_theta: f64, g1: impl Fn(f64, f64) -> f64) -> f64 {
        let sin_theta = libm::sqrt(1.0 - cos_theta * cos_theta);
        let (thetas, phis) = (1500, 720);
        let mut sum = 0.0;
        for i in 0..thetas {
            let u = (f64::from(i) + 0.5) / f64::from(thetas);
            let theta = 0.5 * PI * u * u;
            let (sin, cos) = (libm::sin(theta), libm::cos(theta));
            let density = ndf.density(cos, sin * sin) * sin * u * PI;
            for j in 0..phis {
                let phi = PI * (f64::from(j) + 0.5) / f64::from(phis);
                let cos_d = sin * sin_theta * libm::cos(phi) + cos * cos_theta;
                if cos_d > 0.0 {
                    sum += density * cos_d * g1(cos, cos_d);
                }
            }
        }
        sum * 2.0 * PI / f64::from(thetas * phis)
    }

    #[test]
    fn v_cavities_conserve_the_visible_area() {
        for kind in [Distribution::Beckmann, Distribution::Ggx] {
            for (alpha, cos) in [(0.1, 0.3), (0.5, 0.1), (1.0, 0.7)] {
                let ndf = Isotropic::new(kind, alpha).unwrap();
                let area = visible(&ndf, cos, |cos_h, cos_d| v_cavity_g1(cos, cos_h, cos_d));
                assert!((area - cos).abs() < 1e-4, "{kind:?} {alpha} {cos}: {area}");
            }
        }
    }

    #[test]
    fn numeric_smith_conserves_it_for_any_distribution() {
        let (blinn, abc, sgd) =
            (BlinnPhong::new(30.0).unwrap(), Abc::new(60.0, 1.8).unwrap(), Sgd::new(0.05, 0.9).unwrap());
        for cos in [0.05, 0.3, 0.8] {
            let areas = [
                visible(&blinn, cos, |_, _| 1.0) * smith_g1_of(&blinn, cos),
                visible(&abc, cos, |_, _| 1.0) * smith_g1_of(&abc, cos),
                visible(&sgd, cos, |_, _| 1.0) * smith_g1_of(&sgd, cos),
            ];
            for area in areas {
                assert!((area - cos).abs() < 1e-4, "{cos}: {areas:?}");
            }
        }
    }

    #[test]
    fn numeric_smith_is_the_closed_form() {
        for kind in [Distribution::Beckmann, Distribution::Ggx] {
            for (alpha, cos) in [(0.01, 0.5), (0.1, 0.01), (0.3, 0.4), (1.0, 0.9), (1.0, 1e-3)] {
                let closed = 1.0 / (1.0 + lambda(kind, alpha, cos));
                let found = smith_g1_of(&Isotropic::new(kind, alpha).unwrap(), cos);
                assert!((found / closed - 1.0).abs() < 1e-6, "{kind:?} {alpha} {cos}: {found} against {closed}");
            }
        }
    }

    /// Masking functions that do not conserve the visible area, and what they show of it at alpha 0.5, cosine 0.3. By hand: Smith's G1 is
    /// 0.8968, Schlick's 0.5179, the implicit one 0.3.
    #[test]
    fn the_others_do_not() {
        let cos = 0.3;
        let ndf = Isotropic::new(Distribution::Beckmann, 0.5).unwrap();
        let schlick = visible(&ndf, cos, |_, _| schlick_smith_g1(0.5, cos)) / cos;
        let implicit = visible(&ndf, cos, |_, _| implicit(cos, 1.0)) / cos;
        assert!((schlick - 0.5179 / 0.8968).abs() < 1e-3, "{schlick}");
        assert!((implicit - 0.3 / 0.8968).abs() < 1e-3, "{implicit}");
    }

    /// Single-scattering albedo of GGX at cos 0.5 with F = 1 under height-correlated masking: oracle .69825 at alpha 0.5.
    #[test]
    fn height_correlated_albedo() {
        let (alpha, cos) = (0.5, 0.5);
        let sin = libm::sqrt(1.0 - cos * cos);
        let (rings, azimuths) = (1200, 720);
        let mut albedo = 0.0;
        for i in 0..rings {
            let mu = (f64::from(i) + 0.5) / f64::from(rings);
            let across = libm::sqrt(1.0 - mu * mu);
            let g =
                smith(Correlation::Height, lambda(Distribution::Ggx, alpha, mu), lambda(Distribution::Ggx, alpha, cos));
            for j in 0..azimuths {
                let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                let h = glam::DVec3::new(sin + across * libm::cos(phi), across * libm::sin(phi), cos + mu).normalize();
                albedo += g * distribution(Distribution::Ggx, alpha, h.z, h.x * h.x + h.y * h.y) / (4.0 * cos);
            }
        }
        albedo *= 2.0 * PI / f64::from(rings * azimuths);
        assert!((albedo - 0.69825).abs() < 2e-5, "{albedo}");
    }

    #[test]
    fn terms_at_and_below_the_horizon_are_zero() {
        for cos in [0.0, -0.2] {
            assert_eq!(implicit(cos, 0.5), 0.0);
            assert_eq!(v_cavity(cos, 0.5, 0.9, 0.4), 0.0);
            assert_eq!(kelemen(cos, 0.5, 0.4), 0.0);
            assert_eq!(schlick_smith(0.3, cos, 0.5), 0.0);
        }
        assert_eq!(smith(Correlation::Height, f64::INFINITY, 0.3), 0.0);
        assert_eq!(smith(Correlation::Separable, f64::INFINITY, 0.3), 0.0);
    }
}
