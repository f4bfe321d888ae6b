//! Gauss-Legendre quadrature, even and graded towards one end.

use std::f64::consts::PI;

/// Nodes and weights of the `n`-point Gauss-Legendre rule on 0..=1, ascending: exact for polynomials up to degree 2n - 1.
///
/// Newton's method on the Legendre polynomial from the Chebyshev guess; nodes are good to a few units in the last place.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        let mut x = libm::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        let mut derivative = 1.0;
        for _ in 0..100 {
            let (value, slope) = legendre(n, x);
            derivative = slope;
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        let weight = 1.0 / ((1.0 - x * x) * derivative * derivative);
        rule[i] = (0.5 * (1.0 - x), weight);
        rule[n - 1 - i] = (0.5 * (1.0 + x), weight);
    }
    rule
}

/// Gauss-Legendre rules on 0..=1 whose nodes crowd at 0: for integrands that change fastest there, on a known scale.
///
/// A node `u` of the even rule moves to `sinh(L u) / sinh(L)`, which spreads decades evenly: L is the inverse hyperbolic sine of the reach, the
/// length of the interval over the scale.
#[derive(Debug, Clone)]
pub struct GradedRules {
    /// Rules for the squares of reaches from 1 on, four to a doubling.
    rules: Vec<Vec<(f64, f64)>>,
}

/// Bits of the mantissa that tell rules apart.
const RULE_BITS: u32 = 2;
/// Largest power of two of the square of a reach: scales down to 2^-30 of the interval.
const LAST_EXPONENT: u64 = 60;
/// Reach of a rule over the shortest that it serves: near the middle, as the square of the longest is at most 5/4 of that of the shortest.
const REACH_WITHIN: f64 = 1.06;

impl GradedRules {
    /// Rules of `first + per_fold L` nodes, rounded up.
    pub fn new(first: f64, per_fold: f64) -> Self {
        // Kept for the next rule: neighbours often have as many nodes.
        let mut even = Vec::new();
        let rules = (0..LAST_EXPONENT << RULE_BITS).map(|index| {
            let squared = f64::from_bits(1.0f64.to_bits() + (index << (52 - RULE_BITS)));
            let length = libm::asinh(REACH_WITHIN * libm::sqrt(squared));
            let end = libm::sinh(length);
            let nodes = libm::ceil(first + per_fold * length) as usize;
            if even.len() != nodes {
                even = gauss_legendre(nodes);
            }
            let graded = even
                .iter()
                .map(|&(u, weight)| (libm::sinh(length * u) / end, weight * length * libm::cosh(length * u) / end));
            graded.collect()
        });
        Self { rules: rules.collect() }
    }

    /// Nodes and weights for an interval if the integrand changes fastest within the part `1 / reach` at its start.
    pub fn for_reach_squared(&self, reach_squared: f64) -> &[(f64, f64)] {
        // The highest bits of a positive number are its logarithm, as good as needed here.
        let index = (reach_squared.max(1.0).to_bits() - 1.0f64.to_bits()) >> (52 - RULE_BITS);
        &self.rules[(index as usize).min(self.rules.len() - 1)]
    }

    /// Rules with every node and weight changed, and more nodes behind.
    pub fn map(self, change: impl Fn(f64, f64) -> (f64, f64), behind: &[(f64, f64)]) -> Self {
        let rules = self.rules.into_iter().map(|rule| {
            rule.into_iter().map(|(node, weight)| change(node, weight)).chain(behind.iter().copied()).collect()
        });
        Self { rules: rules.collect() }
    }
}

/// The Legendre polynomial of degree n and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0));
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_its_degree_exactly() {
        for n in [1, 2, 5, 24, 64] {
            let rule = gauss_legendre(n);
            for degree in [0, 1, n, 2 * n - 1] {
                let sum: f64 = rule.iter().map(|(x, w)| w * libm::pow(*x, degree as f64)).sum();
                assert!((sum * (degree as f64 + 1.0) - 1.0).abs() < 1e-12, "n = {n}, degree {degree}: {sum}");
            }
        }
    }

    /// A Lorentzian peak at the start, against its antiderivative, an arc tangent.
    #[test]
    fn graded_rules_integrate_narrow_peaks() {
        let rules = GradedRules::new(6.0, 4.0);
        for scale in [1.0, 0.3, 0.02, 1e-3, 1e-5, 1e-8] {
            let rule = rules.for_reach_squared(1.0 / (scale * scale));
            let sum: f64 = rule.iter().map(|(x, w)| w * scale / (x * x + scale * scale)).sum();
            assert!((sum - libm::atan(1.0 / scale)).abs() < 1e-6, "{scale}: {sum}");
        }
    }
}
