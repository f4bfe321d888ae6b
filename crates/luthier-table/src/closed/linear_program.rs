//! Small dense linear programs by an interior-point method.

use super::cholesky::{add, cholesky, combined, dot, largest, solve};

/// Steps after which a program is given up.
const STEPS: usize = 60;
/// Complementarity at which a program is solved. Limits are bounds of errors, of which three digits count.
const GAP: f64 = 1e-10;
/// Share of the way to the boundary that a step goes. At 1, a slack or dual would become 0 and divide the next step.
const STAY_INSIDE: f64 = 0.99;
/// Share by which the diagonal of the normal equations is raised, so that the last, nearly singular steps have a factor
/// too.
const RAISED: f64 = 1e-13;

/// The x with the least `cost . x` among those with `rows[i] . x <= limits[i]`, to some eight digits; none if the
/// method finds no such x.
///
/// Mehrotra's predictor and corrector (SIAM J. Optim. 2(4), 1992) on the normal equations. Every row has as many numbers as `cost`.
pub(super) fn minimise(cost: &[f64], rows: &[Vec<f64>], limits: &[f64]) -> Option<Vec<f64>> {
    let n = cost.len();
    let mut x = vec![0.0; n];
    let mut slacks: Vec<f64> = limits.iter().map(|limit| limit.max(1.0)).collect();
    let mut duals = vec![1.0; rows.len()];
    for _ in 0..STEPS {
        let gap = mean_product(&slacks, &duals);
        let primal: Vec<f64> = (0..rows.len()).map(|i| dot(&rows[i], &x) + slacks[i] - limits[i]).collect();
        let dual: Vec<f64> = combined(rows, &duals).iter().zip(cost).map(|(a, c)| a + c).collect();
        if gap < GAP && largest(&primal) < 1e-9 && largest(&dual) < 1e-7 {
            return Some(x);
        }
        let weights: Vec<f64> = (0..rows.len()).map(|i| duals[i] / slacks[i]).collect();
        let mut normal = normal_matrix(n, rows, &weights);
        (0..n).for_each(|i| normal[i][i] *= 1.0 + RAISED);
        let factor = cholesky(normal)?;
        let step = |products: &[f64]| {
            let inner: Vec<f64> = (0..rows.len()).map(|i| (duals[i] * primal[i] - products[i]) / slacks[i]).collect();
            let right: Vec<f64> = combined(rows, &inner).iter().zip(&dual).map(|(a, d)| -d - a).collect();
            let dx = solve(&factor, right);
            let along: Vec<f64> = rows.iter().map(|row| dot(row, &dx)).collect();
            let ds: Vec<f64> = (0..rows.len()).map(|i| -primal[i] - along[i]).collect();
            let dl: Vec<f64> = (0..rows.len()).map(|i| (-products[i] - duals[i] * ds[i]) / slacks[i]).collect();
            (dx, ds, dl)
        };
        let products: Vec<f64> = (0..rows.len()).map(|i| slacks[i] * duals[i]).collect();
        let (_, ds, dl) = step(&products);
        let (to_primal, to_dual) = (reach(&slacks, &ds), reach(&duals, &dl));
        let predicted =
            (0..rows.len()).map(|i| (slacks[i] + to_primal * ds[i]) * (duals[i] + to_dual * dl[i])).sum::<f64>()
                / rows.len() as f64;
        let ratio = predicted / gap;
        let centre = ratio * ratio * ratio * gap;
        let corrected: Vec<f64> = (0..rows.len()).map(|i| products[i] + ds[i] * dl[i] - centre).collect();
        let (dx, ds, dl) = step(&corrected);
        let (to_primal, to_dual) = (STAY_INSIDE * reach(&slacks, &ds), STAY_INSIDE * reach(&duals, &dl));
        add(&mut x, to_primal.min(1.0), &dx);
        add(&mut slacks, to_primal.min(1.0), &ds);
        add(&mut duals, to_dual.min(1.0), &dl);
        if !x.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    // The last steps fight rounding: a point within the limits will do.
    let holds = rows.iter().zip(limits).all(|(row, limit)| dot(row, &x) <= limit + 1e-7);
    holds.then_some(x)
}

fn mean_product(a: &[f64], b: &[f64]) -> f64 {
    dot(a, b) / a.len() as f64
}

/// The largest step up to 1 that keeps all values at or above 0, or what goes beyond 1 if nothing falls.
fn reach(values: &[f64], steps: &[f64]) -> f64 {
    values
        .iter()
        .zip(steps)
        .filter(|(_, d)| **d < 0.0)
        .fold(1.0 / STAY_INSIDE, |most, (v, d)| most.min(-v / d))
        .max(0.0)
}

/// The lower half of the sum of outer products of rows, each times its weight.
fn normal_matrix(n: usize, rows: &[Vec<f64>], weights: &[f64]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; n]; n];
    for (row, weight) in rows.iter().zip(weights) {
        for i in 0..n {
            add(&mut matrix[i][..=i], weight * row[i], row);
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The textbook's factory (Hillier and Lieberman): 3 x + 5 y under x <= 4, 2 y <= 12, 3 x + 2 y <= 18 is 36 at (2, 6).
    #[test]
    fn finds_the_corner_of_a_textbook() {
        let rows = [[1.0, 0.0], [0.0, 2.0], [3.0, 2.0], [-1.0, 0.0], [0.0, -1.0]].map(Vec::from);
        let found = minimise(&[-3.0, -5.0], &rows, &[4.0, 12.0, 18.0, 0.0, 0.0]).unwrap();
        assert!((found[0] - 2.0).abs() < 1e-7 && (found[1] - 6.0).abs() < 1e-7, "{found:?}");
    }

    /// The straight line nearest to x^2 on 0..1 is x - 1/8, and errs by 1/8 (Chebyshev).
    #[test]
    fn finds_the_minimax_line() {
        let (mut rows, mut limits) = (Vec::new(), Vec::new());
        for i in 0..=100 {
            let x = f64::from(i) / 100.0;
            rows.extend([vec![1.0, x, -1.0], vec![-1.0, -x, -1.0]]);
            limits.extend([x * x, -x * x]);
        }
        let found = minimise(&[0.0, 0.0, 1.0], &rows, &limits).unwrap();
        for (found, expected) in found.iter().zip([-0.125, 1.0, 0.125]) {
            assert!((found - expected).abs() < 1e-7, "{found}");
        }
    }

    #[test]
    fn contradictions_have_no_solution() {
        assert_eq!(minimise(&[1.0], &[vec![1.0], vec![-1.0]], &[-1.0, -1.0]), None);
    }
}
