//! Slope distributions of micro-surfaces and their Smith masking: isotropic by functions, with two slope parameters as [`Anisotropic`].

mod anisotropic;

use std::f64::consts::PI;

pub use anisotropic::{Anisotropic, to_layer};

use crate::masking::smith_g1_of;
use crate::ndf::{Ndf, NdfError, positive};
use crate::stack::Distribution;

/// `pi alpha^2 D(theta_h)`: the normalised distribution scaled so that it neither overflows nor vanishes as alpha goes to 0. At
/// theta_h = 0 it is 1; its maximum is 1 for GGX and at most 4/e for Beckmann.
///
/// Takes the cosine and the squared sine apart, because `1 - cos^2` has no digits left for small angles. Zero for
/// `cos_theta_h <= 0`. At alpha = 0: 1 at the normal and 0 elsewhere.
///
/// Beckmann: Elek 2010 sec. 2.1 as mended in CONVENTIONS.md. GGX: Walter et al. 2007, eq. 33. Blinn: cos^n with n = 2/alpha^2 - 2 (Walter et
/// al. 2007, section 5.2), whose D is (n + 2)/(2 pi) cos^n = cos^n/(pi alpha^2). ABC and the shifted gamma distribution: [`Shape`](crate::ndf::Shape);
/// the value at the normal is 1, as for the others; only wide shifted gamma distributions are larger elsewhere.
pub fn scaled_distribution(distribution: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
    if cos_theta_h <= 0.0 {
        return 0.0;
    }
    if alpha == 0.0 {
        return if sin_theta_h_sq == 0.0 { 1.0 } else { 0.0 };
    }
    let cos_sq = cos_theta_h * cos_theta_h;
    let alpha_sq = alpha * alpha;
    match distribution {
        Distribution::Beckmann => {
            // At the horizon the exponential is 0 long before the cosine is; 0/0 where both are.
            let fall = libm::exp(-sin_theta_h_sq / (cos_sq * alpha_sq));
            if fall == 0.0 { 0.0 } else { fall / (cos_sq * cos_sq) }
        }
        Distribution::Ggx => {
            let ratio = alpha_sq / (cos_sq * alpha_sq + sin_theta_h_sq);
            ratio * ratio
        }
        Distribution::Blinn => {
            // (cos^2)^(n/2), from the sine where the cosine rounds to 1.
            let log = if sin_theta_h_sq < 0.5 { libm::log1p(-sin_theta_h_sq) } else { libm::log(cos_sq) };
            let half_exponent = (1.0 / alpha_sq - 1.0).max(0.0);
            if half_exponent == 0.0 { 1.0 } else { libm::exp(half_exponent * log) }
        }
        Distribution::Abc(shape) => shape.scaled_abc(alpha, cos_theta_h, sin_theta_h_sq),
        Distribution::Sgd(shape) => shape.scaled_sgd(alpha, cos_theta_h, sin_theta_h_sq),
    }
}

/// The normalised distribution D; its integral times the cosine over the hemisphere is 1. `alpha` > 0.
pub fn distribution(distribution: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
    scaled_distribution(distribution, alpha, cos_theta_h, sin_theta_h_sq) / (PI * alpha * alpha)
}

/// A distribution of a surface and its slope parameter, as an [`Ndf`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    distribution: Distribution,
    alpha: f64,
}

impl Isotropic {
    /// The distribution of slope parameter `alpha`.
    ///
    /// # Errors
    /// [`NdfError::NotPositive`] unless `alpha` is positive and finite.
    pub fn new(distribution: Distribution, alpha: f64) -> Result<Self, NdfError> {
        Ok(Self { distribution, alpha: positive("alpha", alpha)? })
    }
}

impl Ndf for Isotropic {
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        distribution(self.distribution, self.alpha, cos_theta_h, sin_theta_h_sq)
    }
}

/// Smith's Lambda for a direction in the upper hemisphere, 0 <= `cos_theta` <= 1 (infinite at 0); G1 = 1 / (1 + Lambda).
///
/// Beckmann: Walter et al. 2007 (exact, not the rational fit). GGX: Heitz 2014, eq. 72. The others have no closed form and are integrated
/// ([`smith_g1_of`]), which takes 256 values of D.
pub fn lambda(distribution: Distribution, alpha: f64, cos_theta: f64) -> f64 {
    let sin_sq = (1.0 - cos_theta * cos_theta).max(0.0);
    if sin_sq == 0.0 || alpha == 0.0 {
        return 0.0;
    }
    if cos_theta <= 0.0 {
        return f64::INFINITY;
    }
    let tan_sq = sin_sq / (cos_theta * cos_theta);
    match distribution {
        Distribution::Ggx => {
            // (sqrt(1 + x) - 1) / 2 without cancellation.
            let x = alpha * alpha * tan_sq;
            if x.is_finite() { 0.5 * x / (libm::sqrt(1.0 + x) + 1.0) } else { f64::INFINITY }
        }
        Distribution::Beckmann => {
            let nu = 1.0 / (alpha * libm::sqrt(tan_sq));
            beckmann_lambda(nu)
        }
        Distribution::Blinn | Distribution::Abc(_) | Distribution::Sgd(_) => {
            Isotropic::new(distribution, alpha).map_or(0.0, |ndf| (1.0 / smith_g1_of(&ndf, cos_theta) - 1.0).max(0.0))
        }
    }
}

/// `(erf(nu) - 1)/2 + exp(-nu^2)/(2 nu sqrt(pi))`.
fn beckmann_lambda(nu: f64) -> f64 {
    if nu > 26.0 {
        return 0.0;
    }
    if nu > 6.0 {
        // The two terms cancel; asymptotic series of erfc.
        let s = 1.0 / (2.0 * nu * nu);
        return libm::exp(-nu * nu) / (2.0 * nu * libm::sqrt(PI)) * (s * (1.0 - 3.0 * s * (1.0 - 5.0 * s)));
    }
    0.5 * (libm::exp(-nu * nu) / (nu * libm::sqrt(PI)) - libm::erfc(nu))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

    /// Composite Simpson over theta, graded so that small alphas are resolved.
    fn hemisphere(f: impl Fn(f64) -> f64) -> f64 {
        let m = 40_000;
        let g = |i: u32| {
            let u = f64::from(i) / f64::from(m);
            let theta = 0.5 * PI * u * u * u;
            f(theta) * libm::sin(theta) * 2.0 * PI * 1.5 * PI * u * u
        };
        let sum: f64 = (1..m).map(|i| if i % 2 == 0 { 2.0 } else { 4.0 } * g(i)).sum::<f64>() + g(0) + g(m);
        sum / (3.0 * f64::from(m))
    }

    #[test]
    fn projected_area_is_one() {
        for d in BOTH {
            for alpha in [0.003, 0.05, 0.3, 1.0] {
                let area = hemisphere(|t| {
                    let s = libm::sin(t);
                    distribution(d, alpha, libm::cos(t), s * s) * libm::cos(t)
                });
                assert!((area - 1.0).abs() < 1e-6, "{d:?} {alpha}: {area}");
            }
        }
    }

    #[test]
    fn distributions_are_numbers_down_to_the_horizon() {
        for d in BOTH {
            for cos in [f64::MIN_POSITIVE, 1e-310, 1e-100, 1e-40, 1e-7] {
                let value = scaled_distribution(d, 0.3, cos, 1.0);
                assert!((0.0..=1.0).contains(&value), "{d:?} {cos}: {value}");
            }
        }
    }

    #[test]
    fn beckmann_peak_is_at_most_four_over_e() {
        let peak = (1..2000)
            .map(|i| f64::from(i) / 2000.0 * 0.5 * PI)
            .map(|t| scaled_distribution(Distribution::Beckmann, 1.0, libm::cos(t), libm::sin(t) * libm::sin(t)))
            .fold(0.0, f64::max);
        assert!((peak - 4.0 / std::f64::consts::E).abs() < 1e-5);
    }

    #[test]
    fn smith_matches_projected_visible_area() {
        // cos_theta = integral of D max(0, V.H) G1, checked with a product quadrature over (theta, phi).
        for d in BOTH {
            for (alpha, mu) in [(0.2, 0.3), (0.7, 0.5), (1.0, 0.9)] {
                let sin_v = libm::sqrt(1.0 - mu * mu);
                let phis = 4000;
                let area = hemisphere_coarse(|t| {
                    let (s, c) = (libm::sin(t), libm::cos(t));
                    let mean: f64 = (0..phis)
                        .map(|k| 2.0 * PI * (f64::from(k) + 0.5) / f64::from(phis))
                        .map(|phi| (sin_v * s * libm::cos(phi) + mu * c).max(0.0))
                        .sum::<f64>()
                        / f64::from(phis);
                    distribution(d, alpha, c, s * s) * mean
                });
                let g1 = 1.0 / (1.0 + lambda(d, alpha, mu));
                assert!((area * g1 - mu).abs() < 1e-5, "{d:?} {alpha} {mu}: {}", area * g1);
            }
        }
    }

    fn hemisphere_coarse(f: impl Fn(f64) -> f64) -> f64 {
        let m = 800;
        (0..m)
            .map(|i| {
                let theta = (f64::from(i) + 0.5) / f64::from(m) * 0.5 * PI;
                f(theta) * libm::sin(theta) * 2.0 * PI * 0.5 * PI / f64::from(m)
            })
            .sum()
    }

    #[test]
    fn beckmann_lambda_is_smooth_across_its_branches() {
        let (below, above) = (beckmann_lambda(6.0 - 1e-9), beckmann_lambda(6.0 + 1e-9));
        assert!((below / above - 1.0).abs() < 2e-2, "{below} {above}");
        assert!(below < 1e-17);
    }
}
