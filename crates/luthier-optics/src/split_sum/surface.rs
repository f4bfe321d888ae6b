//! A split sum over all directions and roughnesses as a polynomial: for tables and searches, which ask a hundred thousand times.

use super::{ALPHA_MIN, Masking, SplitSum, split_sum};
use crate::interpolation::chebyshev::{clenshaw, coefficients, nodes};
use crate::stack::Distribution;

/// Lowest cosine and lowest alpha of the polynomial.
const LOWEST: f64 = 1e-3;
/// Nodes along either axis.
const NODES: usize = 28;
/// Cosine below which the coordinate of the cosine is linear, for rough surfaces; for smooth ones it is alpha.
const LINEAR_BELOW: f64 = 0.01;

/// Split sums of one masking term: Chebyshev interpolation in ln alpha and asinh(cos_theta / b), where b is the scale on which masking changes.
///
/// Within 2e-6 of [`split_sum`] for GGX with smooth terms, and 2e-4 for Beckmann, where the cosine is at least 0.001; elsewhere it is
/// [`split_sum`]. Below an alpha of 0.001 each row has a polynomial in the cosine of its own.
#[derive(Debug, Clone)]
pub struct SplitSumSurface {
    distribution: Distribution,
    masking: Masking,
    /// Coefficients, by degree over alpha and then over the cosine.
    coefficients: Vec<[[f64; 2]; NODES]>,
}

impl SplitSumSurface {
    /// Interpolates 784 split sums.
    pub fn new(distribution: Distribution, masking: Masking) -> Self {
        let alphas = nodes().map(|x| libm::exp(libm::log(LOWEST) * 0.5 * (1.0 - x)));
        let rows: [[[f64; 2]; NODES]; NODES] = alphas.map(|alpha| over_cosines(distribution, masking, alpha));
        let mut over_both = vec![[[0.0; 2]; NODES]; NODES];
        for degree in 0..NODES {
            let down: [_; NODES] = coefficients(&std::array::from_fn(|j| rows[j][degree]));
            (0..NODES).for_each(|j| over_both[j][degree] = down[j]);
        }
        Self { distribution, masking, coefficients: over_both }
    }

    /// The split sums of one alpha, 0..=1.
    pub fn row(&self, alpha: f64) -> SplitSumRow {
        let Self { distribution, masking, .. } = *self;
        let polynomial = (ALPHA_MIN..=1.0).contains(&alpha).then(|| {
            let coefficients = if alpha < LOWEST {
                over_cosines(distribution, masking, alpha)
            } else {
                let x = 1.0 - 2.0 * libm::log(alpha) / libm::log(LOWEST);
                std::array::from_fn(|degree| clenshaw(x, self.coefficients.iter().map(|row| row[degree])))
            };
            (coefficients, scale(alpha))
        });
        SplitSumRow { distribution, masking, alpha, polynomial }
    }
}

/// Coefficients over the cosines of one alpha.
fn over_cosines(distribution: Distribution, masking: Masking, alpha: f64) -> [[f64; 2]; NODES] {
    let scale = scale(alpha);
    coefficients(&nodes().map(|x| {
        let sum = split_sum(distribution, masking, alpha, scale.cosine(x));
        [sum.scale, sum.bias]
    }))
}

/// Split sums of one alpha over all directions: a row of a [`SplitSumSurface`].
#[derive(Debug, Clone)]
pub struct SplitSumRow {
    distribution: Distribution,
    masking: Masking,
    alpha: f64,
    polynomial: Option<([[f64; 2]; NODES], Scale)>,
}

impl SplitSumRow {
    /// The split sum at a cosine, 0..=1.
    pub fn at(&self, cos_theta: f64) -> SplitSum {
        match &self.polynomial {
            Some((coefficients, scale)) if cos_theta >= LOWEST => {
                let [scale, bias] = clenshaw(scale.coordinate(cos_theta.min(1.0)), coefficients.iter().copied());
                SplitSum { scale, bias }
            }
            _ => split_sum(self.distribution, self.masking, self.alpha, cos_theta),
        }
    }
}

/// The coordinate of cosines for one alpha: -1 at the lowest, 1 at 1.
#[derive(Debug, Clone, Copy)]
struct Scale {
    linear_below: f64,
    from: f64,
    to: f64,
}

fn scale(alpha: f64) -> Scale {
    // The lesser of both, smoothly.
    let linear_below = LINEAR_BELOW * alpha / (alpha + LINEAR_BELOW);
    let [from, to] = [LOWEST, 1.0].map(|cos| libm::asinh(cos / linear_below));
    Scale { linear_below, from, to }
}

impl Scale {
    fn cosine(&self, x: f64) -> f64 {
        (self.linear_below * libm::sinh(self.from + (self.to - self.from) * 0.5 * (x + 1.0))).min(1.0)
    }

    fn coordinate(&self, cos_theta: f64) -> f64 {
        2.0 * (libm::asinh(cos_theta / self.linear_below) - self.from) / (self.to - self.from) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_quadrature_as_documented() {
        let terms = [
            (Distribution::Ggx, Masking::SmithCorrelated),
            (Distribution::Ggx, Masking::SchlickHalf),
            (Distribution::Beckmann, Masking::SmithSeparable),
        ];
        for (distribution, masking) in terms {
            let surface = SplitSumSurface::new(distribution, masking);
            for j in 0..=30 {
                let alpha = libm::pow(1e-5, 1.0 - f64::from(j) / 30.0);
                let row = surface.row(alpha.min(1.0));
                for i in 0..=40 {
                    let cos = libm::pow(1e-3, 1.0 - f64::from(i) / 40.0).min(1.0);
                    let (found, expected) = (row.at(cos), split_sum(distribution, masking, alpha.min(1.0), cos));
                    let off = (found.scale - expected.scale).abs().max((found.bias - expected.bias).abs());
                    let limit = if distribution == Distribution::Ggx { 2e-6 } else { 2e-4 };
                    assert!(off < limit, "{distribution:?} {masking:?} {alpha} {cos}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn outside_the_polynomial_it_is_quadrature() {
        let surface = SplitSumSurface::new(Distribution::Ggx, Masking::SmithCorrelated);
        for (alpha, cos) in [(0.0, 0.5), (1e-4, 1e-4), (0.5, 1e-4), (0.5, 0.0)] {
            let expected = split_sum(Distribution::Ggx, Masking::SmithCorrelated, alpha, cos);
            assert_eq!(surface.row(alpha).at(cos), expected);
        }
    }
}
