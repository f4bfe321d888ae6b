//! Chebyshev interpolation on -1..=1.

use std::f64::consts::PI;

/// The nodes cos(pi (i + 1/2) / N), descending.
pub(crate) fn nodes<const N: usize>() -> [f64; N] {
    std::array::from_fn(|i| libm::cos(PI * (i as f64 + 0.5) / N as f64))
}

/// Coefficients of the Chebyshev polynomial through values at [`nodes`].
pub(crate) fn coefficients<const K: usize, const N: usize>(values: &[[f64; K]; N]) -> [[f64; K]; N] {
    std::array::from_fn(|degree| {
        let factor = if degree == 0 { 1.0 } else { 2.0 } / N as f64;
        let mut sum = [0.0; K];
        for (i, value) in values.iter().enumerate() {
            let weight = factor * libm::cos(PI * degree as f64 * (i as f64 + 0.5) / N as f64);
            (0..K).for_each(|k| sum[k] += weight * value[k]);
        }
        sum
    })
}

/// The sum of Chebyshev polynomials at x (Clenshaw 1955).
pub(crate) fn clenshaw<const K: usize>(x: f64, coefficients: impl DoubleEndedIterator<Item = [f64; K]>) -> [f64; K] {
    let (mut after, mut next) = ([0.0; K], [0.0; K]);
    for c in coefficients.rev() {
        let this = std::array::from_fn(|k| c[k] + 2.0 * x * next[k] - after[k]);
        (after, next) = (next, this);
    }
    // The recurrence has doubled the first polynomial but one.
    std::array::from_fn(|k| next[k] - x * after[k])
}
