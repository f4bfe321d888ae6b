//! Gauss-Legendre quadrature.

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
}
