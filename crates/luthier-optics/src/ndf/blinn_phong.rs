//! The Blinn-Phong distribution: a power of the cosine.

use std::f64::consts::PI;

use super::{Ndf, NdfError, positive};

/// Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures", normalised:
/// D = (e + 2)/(2 pi) cos^e.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlinnPhong {
    exponent: f64,
}

impl BlinnPhong {
    /// The distribution of an exponent.
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless `exponent` is positive and finite.
    pub fn new(exponent: f64) -> Result<Self, NdfError> {
        Ok(Self { exponent: positive("exponent", exponent)? })
    }

    /// The exponent whose lobe matches Beckmann's of that slope around the normal: 2/alpha^2 - 2 (Walter et al. 2007, sec. 5.2).
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless `0 < alpha < 1`.
    pub fn from_alpha(alpha: f64) -> Result<Self, NdfError> {
        let alpha = positive("alpha", alpha)?;
        Self::new(2.0 / (alpha * alpha) - 2.0)
    }

    /// The exponent.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }
}

impl Ndf for BlinnPhong {
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        if cos_theta_h <= 0.0 {
            return 0.0;
        }
        // cos^e = (1 - sin^2)^(e/2), which keeps the digits near the normal where e is large.
        let log_cos = if sin_theta_h_sq < 0.5 { 0.5 * libm::log1p(-sin_theta_h_sq) } else { libm::log(cos_theta_h) };
        (self.exponent + 2.0) / (2.0 * PI) * libm::exp(self.exponent * log_cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet;
    use crate::stack::Distribution;

    #[test]
    fn matches_beckmann_near_the_normal() {
        let ndf = BlinnPhong::from_alpha(0.01).unwrap();
        for theta in [0.0, 0.003, 0.01, 0.02] {
            let (cos, sin) = (libm::cos(theta), libm::sin(theta));
            let ratio =
                ndf.density(cos, sin * sin) / microfacet::distribution(Distribution::Beckmann, 0.01, cos, sin * sin);
            assert!((ratio - 1.0).abs() < 2e-3, "{theta}: {ratio}");
        }
    }
}
