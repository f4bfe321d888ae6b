//! Spread of a lobe: a variance or a covariance matrix, and the micro-surface that stands for it.

use std::ops::{Add, Mul};

use luthier_optics::stack::{Distribution, Surface};

/// Exponent of the fit between slope parameter and variance (Belcour 2018, eq. 4; 1.1 in the papers and their code).
const EXPONENT: f64 = 1.1;

/// Rougher surfaces count as this one, because the variance of alpha = 1 is infinite.
const ALPHA_MAX: f64 = 0.9999;

/// Limit of variances, so that sums stay finite. It is far beyond the variance of any surface (9 000).
const VARIANCE_MAX: f64 = 1e9;

/// Variance of the light that a GGX surface reflects, in the projected disc: `h(alpha) = alpha^1.1 / (1 - alpha^1.1)`.
///
/// A fit to GGX: close for small alpha, several times too wide near 1 (3.59 against .62 at alpha = 0.8). Not a fit to Beckmann.
pub fn variance(alpha: f64) -> f64 {
    let power = libm::pow(alpha.clamp(0.0, ALPHA_MAX), EXPONENT);
    power / (1.0 - power)
}

/// The inverse of [`variance`]: slope parameter of the GGX surface that spreads light this far. 0..=1.
pub fn alpha(variance: f64) -> f64 {
    if variance <= 0.0 { 0.0 } else { libm::pow(1.0 / (1.0 + 1.0 / variance), 1.0 / EXPONENT) }
}

/// Operations on spreads that the statistics need. Spreads of independent events add up.
pub trait Spread: Copy + Add<Output = Self> + Mul<f64, Output = Self> {
    /// No spread: a ray.
    const ZERO: Self;

    /// The spread that a surface adds when its slope parameters are multiplied by `scale` (1 for reflection).
    fn of(surface: &Surface, scale: f64) -> Self;

    /// Slope parameter of the isotropic surface of the same mean variance.
    fn mean_alpha(self) -> f64;

    /// The spread with its variances limited to finite ones.
    fn limited(self) -> Self;

    /// The GGX surface that spreads light this way.
    fn surface(self) -> Surface;
}

impl Spread for f64 {
    const ZERO: Self = 0.0;

    fn of(surface: &Surface, scale: f64) -> Self {
        variance(scale * surface.alpha_isotropic())
    }

    fn mean_alpha(self) -> f64 {
        alpha(self)
    }

    fn limited(self) -> Self {
        self.min(VARIANCE_MAX)
    }

    fn surface(self) -> Surface {
        Surface::isotropic(Distribution::Ggx, alpha(self))
    }
}

/// A symmetric 2x2 covariance matrix in the projected disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance {
    /// Variance along x.
    pub xx: f64,
    /// Covariance of x and y.
    pub xy: f64,
    /// Variance along y.
    pub yy: f64,
}

/// Eigenvalues of a covariance matrix, and the direction of the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// Variance along the first axis, the larger one.
    pub first: f64,
    /// Variance across it, not negative.
    pub second: f64,
    /// Angle from x to the first axis, counter-clockwise, in radians; 0 if the two variances are equal.
    pub rotation: f64,
}

impl Covariance {
    /// Variances along a tangent and across it; the tangent is x turned counter-clockwise by `rotation` radians.
    pub fn along(variance_x: f64, variance_y: f64, rotation: f64) -> Self {
        let (c, s) = (libm::cos(rotation), libm::sin(rotation));
        Self {
            xx: c * c * variance_x + s * s * variance_y,
            xy: c * s * (variance_x - variance_y),
            yy: s * s * variance_x + c * c * variance_y,
        }
    }

    /// Principal axes, in closed form.
    pub fn principal(self) -> Principal {
        let mean = 0.5 * (self.xx + self.yy);
        let half_difference = 0.5 * (self.xx - self.yy);
        let radius = libm::hypot(half_difference, self.xy);
        let rotation = if radius > 0.0 { 0.5 * libm::atan2(self.xy, half_difference) } else { 0.0 };
        Principal { first: mean + radius, second: (mean - radius).max(0.0), rotation }
    }
}

impl Add for Covariance {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { xx: self.xx + other.xx, xy: self.xy + other.xy, yy: self.yy + other.yy }
    }
}

impl Mul<f64> for Covariance {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { xx: self.xx * factor, xy: self.xy * factor, yy: self.yy * factor }
    }
}

impl Spread for Covariance {
    const ZERO: Self = Self { xx: 0.0, xy: 0.0, yy: 0.0 };

    fn of(surface: &Surface, scale: f64) -> Self {
        Self::along(variance(scale * surface.alpha_x), variance(scale * surface.alpha_y), surface.rotation)
    }

    fn mean_alpha(self) -> f64 {
        alpha(0.5 * (self.xx + self.yy))
    }

    fn limited(self) -> Self {
        let trace = self.xx + self.yy;
        if trace > VARIANCE_MAX { self * (VARIANCE_MAX / trace) } else { self }
    }

    fn surface(self) -> Surface {
        let Principal { first, second, rotation } = self.principal();
        Surface { distribution: Distribution::Ggx, alpha_x: alpha(first), alpha_y: alpha(second), rotation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variance_and_alpha_are_inverse() {
        for a in [0.0, 1e-4, 0.003, 0.05, 0.3, 0.8, 0.999] {
            assert!((alpha(variance(a)) - a).abs() < 1e-12, "{a}");
        }
        assert_eq!(alpha(f64::INFINITY), 1.0);
        assert!(variance(1.0).is_finite() && variance(7.0) == variance(1.0) && variance(-1.0) == 0.0);
    }

    #[test]
    fn variance_fits_smooth_ggx_and_not_rough_ones() {
        // Oracle: trace of the covariance, on the disc, of light at normal incidence that GGX reflects upward: the mean of
        // sin^2 2 theta_h over D cos theta_h, by the midpoint rule in x = cos^2 theta_h.
        let trace = |a: f64| {
            let n = 100_000;
            let (mut sum, mut weight) = (0.0, 0.0);
            for i in 0..n {
                let x = 0.5 + 0.5 * (f64::from(i) + 0.5) / f64::from(n);
                let d = 1.0 + (a * a - 1.0) * x;
                sum += 4.0 * x * (1.0 - x) / (d * d);
                weight += 1.0 / (d * d);
            }
            sum / weight
        };
        for (a, fit, truth) in [(0.05, 0.0385, 0.0386), (0.3, 0.362, 0.350), (0.8, 3.59, 0.62)] {
            assert!((variance(a) / fit - 1.0).abs() < 2e-3, "{a}: {}", variance(a));
            assert!((trace(a) / truth - 1.0).abs() < 1e-2, "{a}: {}", trace(a));
        }
    }

    #[test]
    fn equal_variances_have_any_axis_and_no_nan() {
        let p = Covariance::along(0.2, 0.2, 0.7).principal();
        assert!((p.first - 0.2).abs() < 1e-15 && (p.second - 0.2).abs() < 1e-15 && p.rotation.is_finite());
        assert_eq!(Covariance::ZERO.principal(), Principal { first: 0.0, second: 0.0, rotation: 0.0 });
    }

    #[test]
    fn principal_axes_undo_the_rotation() {
        for angle in [-1.4, -0.3, 0.0, 0.4, 1.5] {
            let p = Covariance::along(0.5, 0.1, angle).principal();
            assert!((p.first - 0.5).abs() < 1e-14 && (p.second - 0.1).abs() < 1e-14);
            assert!((p.rotation - angle).abs() < 1e-14);
        }
    }

    #[test]
    fn a_quarter_turn_swaps_the_slopes() {
        let a = Covariance::along(0.1, 0.4, 0.3);
        let b = Covariance::along(0.4, 0.1, 0.3 + std::f64::consts::FRAC_PI_2);
        assert!((a.xx - b.xx).abs() < 1e-15 && (a.xy - b.xy).abs() < 1e-15 && (a.yy - b.yy).abs() < 1e-15);
    }
}
