//! Albedos of cloth of one alpha over all directions as a polynomial: for tables, which ask hundreds of times along a line.

use std::f64::consts::FRAC_PI_2;

use super::{CLOTH_ALPHA_MIN, ClothVisibility, NEGLIGIBLE, cloth_albedo, ln_largest, over_largest, rules};
use crate::interpolation::chebyshev::{clenshaw, coefficients, nodes};

/// Lowest cosine of the polynomial.
const LOWEST_COS: f64 = 1e-3;
/// Nodes of the polynomial.
const NODES: usize = 28;
/// Alpha below which the logarithm is interpolated.
const LOGARITHMIC_BELOW: f64 = 0.006;
/// Cosine below which the coordinate of the cosine is linear.
const LINEAR_BELOW: f64 = 0.004;

/// Albedos of cloth of one alpha under [`ClothVisibility::Neubelt`]: Chebyshev interpolation over the elevation, stretched near the horizon.
///
/// Within 2e-6 of [`cloth_albedo`], relative to the larger of 1 and the albedo, where the cosine is at least 0.001; elsewhere it is [`cloth_albedo`].
/// Other terms have kinks that polynomials do not follow.
#[derive(Debug, Clone)]
pub struct ClothRow {
    alpha: f64,
    coordinate: Coordinate,
    polynomial: [[f64; 1]; NODES],
}

impl ClothRow {
    /// Interpolates 28 albedos; `alpha` in 0..=1.
    pub fn new(alpha: f64) -> Self {
        let alpha = alpha.max(CLOTH_ALPHA_MIN);
        let coordinate = Coordinate::new(alpha);
        // For low alphas the logarithm of the albedo over the largest D is smooth where the albedo is not yet negligible, and falls slowly.
        let values = nodes().map(|x| {
            let cos = coordinate.cosine(x);
            let [over] = over_largest(rules(), [ClothVisibility::Neubelt], alpha, cos);
            [if alpha < LOGARITHMIC_BELOW { libm::log(over) } else { over * libm::exp(ln_largest(alpha, cos)) }]
        });
        Self { alpha, coordinate, polynomial: coefficients(&values) }
    }

    /// The albedo at a cosine, 0..=1.
    pub fn at(&self, cos_theta: f64) -> f64 {
        let Self { alpha, coordinate, polynomial } = self;
        if !(LOWEST_COS..=coordinate.highest).contains(&cos_theta) {
            return cloth_albedo(ClothVisibility::Neubelt, *alpha, cos_theta);
        }
        let [value] = clenshaw(coordinate.of(cos_theta), polynomial.iter().copied());
        if *alpha < LOGARITHMIC_BELOW { libm::exp(value + ln_largest(*alpha, cos_theta)) } else { value.max(0.0) }
    }
}

/// The elevation over the horizon, stretched near it.
fn stretched(cos_theta: f64) -> f64 {
    libm::asinh(libm::asin(cos_theta) / LINEAR_BELOW)
}

/// The coordinate of cosines: -1 at the lowest, 1 at the highest whose albedo is not negligible.
#[derive(Debug, Clone, Copy)]
struct Coordinate {
    highest: f64,
    from: f64,
    to: f64,
}

impl Coordinate {
    fn new(alpha: f64) -> Self {
        // The sine at which D is negligible at its largest: p ln((1 + sin) / 2) is the logarithm.
        let ln = libm::log(NEGLIGIBLE) - ln_largest(alpha, 0.0);
        let sin = (2.0 * libm::exp(2.0 * alpha * ln) - 1.0).max(0.0);
        let highest = libm::sqrt((1.0 - sin) * (1.0 + sin)).max(2.0 * LOWEST_COS);
        let [from, to] = [LOWEST_COS, highest].map(stretched);
        Self { highest, from, to }
    }

    fn cosine(&self, x: f64) -> f64 {
        let elevation = LINEAR_BELOW * libm::sinh(self.from + (self.to - self.from) * 0.5 * (x + 1.0));
        libm::sin(elevation.min(FRAC_PI_2))
    }

    fn of(&self, cos_theta: f64) -> f64 {
        2.0 * (stretched(cos_theta) - self.from) / (self.to - self.from) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_quadrature_as_documented() {
        for alpha in [0.0, 1e-5, 2e-4, 0.0032, 0.0059, 0.006, 0.007, 0.012, 0.03, 0.1, 0.4, 1.0] {
            let row = ClothRow::new(alpha);
            for i in 0..=60 {
                let cos = libm::pow(LOWEST_COS, 1.0 - f64::from(i) / 60.0).min(1.0);
                let (found, expected) = (row.at(cos), cloth_albedo(ClothVisibility::Neubelt, alpha, cos));
                let off = (found - expected).abs() / expected.max(1.0);
                assert!(off < 2e-6, "{alpha} {cos}: {off:e}");
            }
        }
    }

    #[test]
    fn below_the_polynomial_it_is_quadrature() {
        for cos in [0.0, 1e-4, 9e-4] {
            assert_eq!(ClothRow::new(0.2).at(cos), cloth_albedo(ClothVisibility::Neubelt, 0.2, cos));
        }
    }
}
