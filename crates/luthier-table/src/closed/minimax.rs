//! Rational functions with the least largest error.

use super::cholesky::{combined, dot, largest};
use super::linear_program::minimise;
use super::rational::{Polynomial, Rational};

/// Linear programs for one fit, at most.
const ROUNDS: usize = 24;
/// A round that lowers the error by a smaller part than this has failed.
const PROGRESS: f64 = 2e-3;
/// Target error of the first round.
const FIRST_ERROR: f64 = 0.02;
/// Number of failed rounds that end a fit.
const FAILURES: usize = 3;
/// Least divisor on the grid. The terms of the divisor have a root mean square of 1 and factors of at most 1; a smaller
/// divisor comes near a pole between the points.
const LEAST_DIVISOR: f64 = 2e-3;

/// A point of the grid of a fit, and the values there that err by a given amount at most.
pub(super) trait Target {
    /// The point.
    fn at(&self) -> [f64; 2];
    /// Least and greatest value whose error is within `error`.
    fn within(&self, error: f64) -> [f64; 2];
    /// The error of a value.
    fn error(&self, value: f64) -> f64;
}

/// Degrees of dividend and divisor, each in both variables.
pub(super) type Degrees = [[usize; 2]; 2];

/// The quotient of these degrees with the least largest error over the grid, and this error. None if every try has a
/// pole.
///
/// Differential correction (Cheney and Loeb 1961; Barrodale, Powell and Roberts, SIAM J. Numer. Anal. 9(3), 1972): a sequence of linear programs
/// that converges from any start. Errors that are not differences have their bounds renewed in every round.
pub(super) fn fit<T: Target>(degrees: Degrees, grid: &[T]) -> Option<(Rational, f64)> {
    let [numerator, denominator] = degrees.map(|degrees| Basis::new(degrees, grid));
    let (p, q) = (numerator.len(), denominator.len());
    let mut cost = vec![0.0; p + q + 1];
    cost[p + q] = 1.0;
    let mut error = FIRST_ERROR;
    let mut divisors = vec![1.0; grid.len()];
    let mut failures = 0;
    let mut best: Option<(Rational, f64)> = None;
    for _ in 0..ROUNDS {
        let (mut rows, mut limits) = (Vec::with_capacity(3 * grid.len() + 2 * q), Vec::new());
        for (i, target) in grid.iter().enumerate() {
            let [low, high] = target.within(error);
            let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
            // |P - f Q| <= half Q + delta Q_before, in units of half.
            for sign in [1.0, -1.0] {
                let mut row: Vec<f64> = numerator.at[i].iter().map(|n| sign * n).collect();
                row.extend(denominator.at[i].iter().map(|d| (-sign * centre - half) * d));
                row.push(-half * divisors[i]);
                let scale = 1.0 / half.max(1e-3);
                row.iter_mut().for_each(|v| *v *= scale);
                rows.push(row);
                limits.push(0.0);
            }
            let mut row = vec![0.0; p];
            row.extend(denominator.at[i].iter().map(|d| -d));
            row.push(0.0);
            rows.push(row);
            limits.push(-LEAST_DIVISOR);
        }
        for j in 0..q {
            for sign in [1.0, -1.0] {
                let mut row = vec![0.0; p + q + 1];
                row[p + j] = sign;
                rows.push(row);
                limits.push(1.0);
            }
        }
        let Some(x) = minimise(&cost, &rows, &limits) else { break };
        let above = combined(&numerator.coefficients, &x[..p]);
        let found = rational(&above, &combined(&denominator.coefficients, &x[p..p + q]), degrees);
        let largest = grid.iter().map(|target| target.error(found.at(target.at()))).fold(0.0, f64::max);
        let before = best.as_ref().map_or(f64::INFINITY, |(_, error)| *error);
        divisors = denominator.at.iter().map(|d| dot(d, &x[p..])).collect();
        if largest < before {
            best = Some((found, largest));
        }
        let excess = x[p + q];
        if largest < before * (1.0 - PROGRESS) {
            // Half of the improvement that the program promises: its bounds belong to another error.
            error = largest * (1.0 + 0.5 * excess.clamp(-0.9, 0.0));
        } else if failures < FAILURES && excess.abs() > PROGRESS {
            failures += 1;
            error = if excess > 0.0 { 0.5 * (error + before) } else { 0.5 * error.min(before) };
        } else {
            break;
        }
    }
    best
}

/// Polynomials up to some degrees that are orthonormal over a grid.
struct Basis {
    /// Values at the points.
    at: Vec<Vec<f64>>,
    /// Coefficients of the powers, of each.
    coefficients: Vec<Vec<f64>>,
}

impl Basis {
    fn new<T: Target>(degrees: [usize; 2], grid: &[T]) -> Self {
        let powers: Vec<Vec<f64>> = grid.iter().map(|target| Polynomial::powers(degrees, target.at())).collect();
        let count = powers[0].len();
        let mut columns: Vec<Vec<f64>> = (0..count).map(|j| powers.iter().map(|row| row[j]).collect()).collect();
        let mut coefficients: Vec<Vec<f64>> =
            (0..count).map(|j| (0..count).map(|i| if i == j { 1.0 } else { 0.0 }).collect()).collect();
        // Gram and Schmidt, twice: the second pass removes what rounding left.
        for j in (0..count).flat_map(|j| [j, j]) {
            for i in 0..j {
                let part = dot(&columns[i], &columns[j]) / grid.len() as f64;
                for vectors in [&mut columns, &mut coefficients] {
                    let (before, rest) = vectors.split_at_mut(j);
                    rest[0].iter_mut().zip(&before[i]).for_each(|(v, b)| *v -= part * b);
                }
            }
            let inverse = 1.0 / (dot(&columns[j], &columns[j]) / grid.len() as f64).sqrt();
            for vector in [&mut columns[j], &mut coefficients[j]] {
                vector.iter_mut().for_each(|v| *v *= inverse);
            }
        }
        let at = (0..grid.len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect();
        Self { at, coefficients }
    }

    fn len(&self) -> usize {
        self.coefficients.len()
    }
}

/// The quotient with rounded coefficients. They are divided by the constant of the divisor, or by its largest
/// coefficient if that is much larger.
fn rational(numerator: &[f64], denominator: &[f64], [above, below]: Degrees) -> Rational {
    let largest = largest(denominator);
    let by = if denominator[0] > 1e-3 * largest { denominator[0] } else { largest };
    Rational {
        numerator: Polynomial::rounded(above, numerator.iter().map(|c| c / by)),
        denominator: Polynomial::rounded(below, denominator.iter().map(|c| c / by)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Plain([f64; 2], f64);

    impl Target for Plain {
        fn at(&self) -> [f64; 2] {
            self.0
        }
        fn within(&self, error: f64) -> [f64; 2] {
            [self.1 - error, self.1 + error]
        }
        fn error(&self, value: f64) -> f64 {
            (value - self.1).abs()
        }
    }

    /// No quotient of two straight lines is nearer to e^x where this one errs four times by as much, with changing sign (de la Vallee Poussin);
    /// Meinardus's estimate of its error is 1/48 (Braess 1984).
    #[test]
    fn errors_alternate() {
        let grid: Vec<Plain> =
            (0..=200).map(|i| f64::from(i) / 100.0 - 1.0).map(|x| Plain([x, 0.0], libm::exp(x))).collect();
        let (found, error) = fit([[1, 0], [1, 0]], &grid).unwrap();
        let signs: Vec<bool> = grid
            .iter()
            .map(|target| found.at(target.at()) - target.1)
            .filter(|e| e.abs() > 0.99 * error)
            .map(|e| e > 0.0)
            .collect();
        let turns = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(turns == 3 && (error * 48.0 - 1.0).abs() < 0.02, "{turns} {error:e}");
    }

    #[test]
    fn a_quotient_is_found_again() {
        let f = |x: f64, y: f64| (1.0 + 2.0 * x * y) / (1.0 + x + 3.0 * y);
        let grid: Vec<Plain> = (0..100)
            .map(|i| [f64::from(i % 10) / 9.0, f64::from(i / 10) / 9.0])
            .map(|[x, y]| Plain([x, y], f(x, y)))
            .collect();
        let (found, error) = fit([[1, 1], [1, 1]], &grid).unwrap();
        assert!(error < 1e-5 && (found.at([0.3, 0.7]) - f(0.3, 0.7)).abs() < 1e-5, "{error:e} {found:?}");
    }
}
