//! The ABC distribution.

use std::f64::consts::PI;

use super::{Ndf, NdfError, positive};
use crate::quadrature::gauss_legendre;

/// D = K / (1 + b (1 - cos))^c: Low, Kronander, Ynnerman and Unger 2012, "BRDF Models for Accurate and Efficient Rendering of
/// Glossy Surfaces", whose A is fixed here by the projected area. The lecture prints it without a norm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Abc {
    b: f64,
    c: f64,
    norm: f64,
}

/// Gauss-Legendre points of the norm.
const NODES: usize = 64;

/// The integral of the norm ends where its integrand has fallen by exp(-40), which is below rounding.
const DECAY: f64 = 40.0;

impl Abc {
    /// The distribution of width `b` (larger is narrower) and fall-off `c`; neither has a unit.
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless both are positive and finite; [`NdfError::NotNormalisable`] when the norm overflows.
    pub fn new(b: f64, c: f64) -> Result<Self, NdfError> {
        let (b, c) = (positive("b", b)?, positive("c", c)?);
        // With 1 - cos = (e^s - 1)/b, the integral of (1 - x)(1 + b x)^-c over x in 0..1.
        let mut end = libm::log1p(b);
        if c > 1.0 {
            end = end.min(DECAY / (c - 1.0));
        }
        let sum: f64 = gauss_legendre(NODES)
            .into_iter()
            .map(|(node, weight)| {
                let s = end * node;
                weight * (1.0 - libm::expm1(s) / b) * libm::exp((1.0 - c) * s)
            })
            .sum();
        let norm = b / (2.0 * PI * end * sum);
        if norm.is_finite() && norm > 0.0 { Ok(Self { b, c, norm }) } else { Err(NdfError::NotNormalisable) }
    }
}

impl Ndf for Abc {
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        if cos_theta_h <= 0.0 {
            return 0.0;
        }
        let versine = sin_theta_h_sq / (1.0 + cos_theta_h);
        self.norm * libm::exp(-self.c * libm::log1p(self.b * versine))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral in closed form: with B = 1 + b, (B I(c) - I(c - 1))/b^2, I(c) = (B^(1-c) - 1)/(1 - c).
    #[test]
    fn norm_matches_the_closed_form() {
        for (b, c) in [(3.0, 2.5), (100.0, 1.3), (1e5, 1.5), (50.0, 12.0)] {
            let big = 1.0 + b;
            let i = |c: f64| (libm::pow(big, 1.0 - c) - 1.0) / (1.0 - c);
            let expected = 1.0 / (2.0 * PI * (big * i(c) - i(c - 1.0)) / (b * b));
            let norm = Abc::new(b, c).unwrap().density(1.0, 0.0);
            assert!((norm / expected - 1.0).abs() < 1e-10, "{b} {c}: {norm} against {expected}");
        }
    }
}
