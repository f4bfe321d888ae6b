//! Parameters of the distributions that have two of their own, and the slope parameter that follows from these.

use std::cmp::Ordering;
use std::f64::consts::PI;
use std::hash::{Hash, Hasher};

use super::{Abc, Ndf, NdfError, Sgd};

/// Widest surface that has a slope parameter: D is 1/pi at the normal.
const ALPHA_MAX: f64 = 1.0;

/// Two parameters of a distribution, and the slope parameter alpha of its peak: D is 1/(pi alpha^2) at the normal, as for Beckmann and GGX.
///
/// Alpha holds the norm, which is computed by quadrature once. It is from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Shape {
    parameters: [f64; 2],
    alpha: f64,
}

impl Shape {
    /// The parameters `b` and `c` of [`Abc`].
    ///
    /// # Errors
    /// Those of [`Abc::new`].
    pub fn abc(b: f64, c: f64) -> Result<Self, NdfError> {
        Self::of([b, c], &Abc::new(b, c)?)
    }

    /// The parameters `alpha` and `p` of [`Sgd`].
    ///
    /// # Errors
    /// Those of [`Sgd::new`]; [`NdfError::TooWide`] where D is less than 1/pi at the normal.
    pub fn sgd(alpha: f64, p: f64) -> Result<Self, NdfError> {
        Self::of([alpha, p], &Sgd::new(alpha, p)?)
    }

    fn of(parameters: [f64; 2], ndf: &impl Ndf) -> Result<Self, NdfError> {
        let alpha = libm::sqrt(1.0 / (PI * ndf.density(1.0, 0.0)));
        // An even distribution, D = 1/pi, may round to more.
        if alpha > ALPHA_MAX * (1.0 + 1e-12) {
            return Err(NdfError::TooWide { alpha });
        }
        Ok(Self { parameters, alpha: alpha.min(ALPHA_MAX) })
    }

    /// The parameters, in the order of the constructor.
    pub fn parameters(&self) -> [f64; 2] {
        self.parameters
    }

    /// Slope parameter of the peak.
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// `pi alpha^2 D` of ABC with slopes stretched from its own alpha to `alpha`.
    ///
    /// Stretching divides the density of slopes by the squared stretch (Heitz 2014, section 5.3), so that the projected area stays 1. With theta' the angle of the slope before, D = (cos theta' / cos theta)^4 D(theta') / stretch^2.
    pub(crate) fn scaled_abc(&self, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        let [b, c] = self.parameters;
        let cos_sq = cos_theta_h * cos_theta_h;
        let narrower = self.alpha / alpha;
        let across_sq = sin_theta_h_sq * (narrower * narrower);
        let length_sq = cos_sq + across_sq;
        // 1 - cos without cancellation.
        let versine = across_sq / (length_sq + cos_theta_h * libm::sqrt(length_sq));
        let ratio = (cos_sq + sin_theta_h_sq) / length_sq;
        ratio * ratio * libm::exp(-c * libm::log1p(b * versine))
    }

    /// `pi alpha^2 D` of the shifted gamma distribution, stretched likewise; it is one of slopes.
    pub(crate) fn scaled_sgd(&self, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        let [width, p] = self.parameters;
        let cos_sq = cos_theta_h * cos_theta_h;
        let narrower = self.alpha / alpha;
        // Squared slope over alpha of the paper.
        let x = sin_theta_h_sq * (narrower * narrower) / (cos_sq * width);
        let fall = libm::exp(-x - p * libm::log1p(x / width));
        // At the horizon the exponential is 0 long before the cosine is; 0/0 where both are.
        if fall == 0.0 || !fall.is_finite() { 0.0 } else { fall / (cos_sq * cos_sq) }
    }

    fn numbers(&self) -> [f64; 3] {
        [self.parameters[0], self.parameters[1], self.alpha]
    }
}

// No parameter is NaN, and none is -0.
impl Eq for Shape {}

impl Hash for Shape {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.numbers().map(f64::to_bits).hash(state);
    }
}

impl PartialOrd for Shape {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Shape {
    fn cmp(&self, other: &Self) -> Ordering {
        self.numbers().map(f64::to_bits).cmp(&other.numbers().map(f64::to_bits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet::{distribution, scaled_distribution};
    use crate::stack::Distribution;

    fn pairs() -> Vec<(Distribution, Box<dyn Ndf>)> {
        let abc = [(1e3, 1.2), (40.0, 2.5), (1e5, 0.7), (2.0, 12.0)];
        let sgd = [(0.01, 0.7), (0.2, 1.5), (1e-3, 0.3)];
        let abc = abc.map(|(b, c)| {
            let shape = Shape::abc(b, c).unwrap();
            (Distribution::Abc(shape), Box::new(Abc::new(b, c).unwrap()) as Box<dyn Ndf>)
        });
        let sgd = sgd.map(|(alpha, p)| {
            let shape = Shape::sgd(alpha, p).unwrap();
            (Distribution::Sgd(shape), Box::new(Sgd::new(alpha, p).unwrap()) as Box<dyn Ndf>)
        });
        abc.into_iter().chain(sgd).collect()
    }

    /// Oracle: the densities with their own norms.
    #[test]
    fn at_its_own_alpha_a_shape_is_the_distribution() {
        for (kind, ndf) in pairs() {
            for theta in [0.0, 0.003, 0.1, 0.7, 1.4] {
                let (sin, cos) = (libm::sin(theta), libm::cos(theta));
                let (found, expected) =
                    (distribution(kind, kind.own_alpha().unwrap(), cos, sin * sin), ndf.density(cos, sin * sin));
                assert!((found - expected).abs() <= 1e-9 * expected, "{kind:?} {theta}: {found} for {expected}");
            }
        }
    }

    /// Oracle: the projected area of any surface is 1, by the trapezoidal rule over the logarithm of the slope.
    #[test]
    fn stretched_shapes_are_normalised() {
        for (kind, _) in pairs() {
            for stretch in [0.4, 1.0, 3.0] {
                let alpha = kind.own_alpha().unwrap() * stretch;
                let steps = 40_000;
                let area: f64 = (0..=steps)
                    .map(|i| {
                        let y = -18.0 + 50.0 * f64::from(i) / f64::from(steps);
                        let slope = libm::exp(y);
                        let cos = 1.0 / libm::sqrt(1.0 + slope * slope);
                        let d = distribution(kind, alpha, cos, slope * slope * cos * cos);
                        // d omega is cos^3 times the area of slopes, 2 pi slope d slope.
                        d * cos * cos * cos * cos * 2.0 * PI * slope * slope * 50.0 / f64::from(steps)
                    })
                    .sum();
                assert!((area - 1.0).abs() < 1e-6, "{kind:?} {stretch}: {area}");
            }
        }
    }

    #[test]
    fn shapes_are_numbers_down_to_the_horizon() {
        for (kind, _) in pairs() {
            for cos in [f64::MIN_POSITIVE, 1e-310, 1e-100, 1e-40, 1e-7] {
                let value = scaled_distribution(kind, 0.3, cos, 1.0);
                assert!((0.0..=1e6).contains(&value), "{kind:?} {cos}: {value}");
            }
        }
    }

    #[test]
    fn what_is_wider_than_an_even_surface_is_refused() {
        assert!(matches!(Shape::sgd(8.0, 0.5), Err(NdfError::TooWide { .. })));
        assert!((Shape::abc(1e-9, 1.0).unwrap().alpha() - 1.0).abs() < 1e-9);
        assert!(Shape::abc(-1.0, 1.0).is_err() && Shape::sgd(0.1, f64::NAN).is_err());
    }
}
