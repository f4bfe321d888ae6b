//! The shifted gamma distribution.

use std::f64::consts::PI;

use super::{Ndf, NdfError, positive};
use crate::quadrature::gauss_legendre;

/// Bagher, Soler and Holzschuch 2012, "Accurate Fitting of Measured Reflectances using a Shifted Gamma Micro-facet
/// Distribution": D = P(tan^2)/(pi cos^4), P(x) = alpha^(p-1)/Gamma(1 - p, alpha) exp(-(alpha^2 + x)/alpha)/(alpha^2 + x)^p, with
/// the upper incomplete gamma function.
///
/// Its `alpha` is the paper's, not the slope parameter of the other distributions: P falls as exp(-tan^2/alpha).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sgd {
    alpha: f64,
    p: f64,
    /// The integral of e^{alpha - t} t^-p from alpha: e^alpha Gamma(1 - p, alpha).
    scaled_gamma: f64,
}

/// Gauss-Legendre points of the incomplete gamma function.
const NODES: usize = 128;

/// The integral of the incomplete gamma function ends where e^{-t} has fallen by exp(-40), which is below rounding.
const DECAY: f64 = 40.0;

impl Sgd {
    /// The distribution of the paper's parameters; neither has a unit.
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless both are positive and finite; [`NdfError::NotNormalisable`] when the norm overflows.
    pub fn new(alpha: f64, p: f64) -> Result<Self, NdfError> {
        let (alpha, p) = (positive("alpha", alpha)?, positive("p", p)?);
        let scaled_gamma = scaled_upper_gamma(p, alpha);
        let ndf = Self { alpha, p, scaled_gamma };
        let peak = ndf.density(1.0, 0.0);
        if peak.is_finite() && peak > 0.0 { Ok(ndf) } else { Err(NdfError::NotNormalisable) }
    }
}

impl Ndf for Sgd {
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        if cos_theta_h <= 0.0 {
            return 0.0;
        }
        let cos_sq = cos_theta_h * cos_theta_h;
        // In t = (alpha^2 + tan^2)/alpha the density is t^-p e^-t / Gamma, per alpha dt.
        let x = sin_theta_h_sq / (cos_sq * self.alpha);
        let slopes = libm::exp(-x - self.p * libm::log(self.alpha + x)) / (self.alpha * self.scaled_gamma);
        slopes / (PI * cos_sq * cos_sq)
    }
}

/// e^a times the integral of t^-p e^-t from a to infinity. With t = a e^y the integrand has no steep end.
fn scaled_upper_gamma(p: f64, a: f64) -> f64 {
    let end = libm::log1p(DECAY / a);
    gauss_legendre(NODES)
        .into_iter()
        .map(|(node, weight)| {
            let y = end * node;
            weight * end * libm::exp((1.0 - p) * (libm::log(a) + y) - a * libm::expm1(y))
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: Gamma(1/2, x) = sqrt(pi) erfc(sqrt x), Gamma(0, 1) = E1(1) and E1(0.01) of Abramowitz and Stegun, table 5.1, and
    /// Gamma(-1, x) = e^-x / x - E1(x).
    #[test]
    fn incomplete_gamma_matches_tables() {
        let gamma = |p: f64, a: f64| scaled_upper_gamma(p, a) * libm::exp(-a);
        for a in [0.003, 0.4, 5.0] {
            let expected = libm::sqrt(PI) * libm::erfc(libm::sqrt(a));
            assert!((gamma(0.5, a) / expected - 1.0).abs() < 1e-10, "{a}: {}", gamma(0.5, a));
        }
        let (e1_one, e1_small) = (0.219_383_934_4, 4.037_929_576_5);
        assert!((gamma(1.0, 1.0) - e1_one).abs() < 1e-9);
        assert!((gamma(1.0, 0.01) - e1_small).abs() < 1e-8);
        assert!((gamma(2.0, 1.0) - (libm::exp(-1.0) - e1_one)).abs() < 1e-9);
    }
}
