//! Least squares: small dense systems and Levenberg's and Marquardt's method, in a fixed order of operations, because bytes of tables depend on
//! them. No library is used: nalgebra fuses products on some machines.

/// The solution of `a x = b` for a symmetric positive matrix, by Gaussian elimination with pivots on the diagonal alone. An unknown without a
/// pivot is left open by the system, and becomes 0.
pub fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for i in 0..n {
        let pivot = a[i][i];
        if pivot <= f64::MIN_POSITIVE {
            continue;
        }
        let (above, below) = a.split_at_mut(i + 1);
        for (row, value) in below.iter_mut().zip(i + 1..n) {
            let factor = row[i] / pivot;
            if factor != 0.0 {
                row.iter_mut().zip(&above[i]).skip(i).for_each(|(x, top)| *x -= factor * top);
                b[value] -= factor * b[i];
            }
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|c| a[i][c] * b[c]).sum();
        b[i] = if a[i][i] <= f64::MIN_POSITIVE { 0.0 } else { (b[i] - known) / a[i][i] };
    }
    b
}

/// Least squares by Levenberg's and Marquardt's damping.
pub struct LeastSquares {
    /// Longest step of a parameter.
    pub longest: f64,
    /// Share of the sum of squares below which a gain ends the search.
    pub gain: f64,
}

/// A column of a Jacobian within a block: the number of the parameter, and the slopes of the residuals.
pub type Column = (usize, Vec<f64>);

/// Residuals in blocks, and their slopes.
pub trait Residuals {
    /// Number of blocks.
    fn blocks(&self) -> usize;

    /// The residuals of a block.
    fn block(&self, parameters: &[f64], block: usize) -> Vec<f64>;

    /// The slopes of a block whose residuals are `now`, by parameter. Parameters that do not change the block may be left out.
    fn slopes(&self, parameters: &[f64], block: usize, now: &[f64]) -> Vec<Column>;
}

/// A place that a search has come to.
#[derive(Debug, Clone)]
pub struct Place {
    /// Where it is.
    pub parameters: Vec<f64>,
    /// Sum of the squares.
    pub cost: f64,
    damping: f64,
    /// Whether the last step gained next to nothing.
    is_still: bool,
}

impl Place {
    /// A place to start from.
    pub fn new(parameters: Vec<f64>, residuals: &impl Residuals) -> Self {
        let cost = sum(&all(residuals, &parameters));
        Self { parameters, cost, damping: 1e-2, is_still: false }
    }
}

fn all(residuals: &impl Residuals, p: &[f64]) -> Vec<Vec<f64>> {
    (0..residuals.blocks()).map(|block| residuals.block(p, block)).collect()
}

fn sum(residuals: &[Vec<f64>]) -> f64 {
    residuals.iter().flatten().map(|x| x * x).sum()
}

impl LeastSquares {
    /// Takes up to `steps` steps from a place towards the least residuals, and stops if there is nothing left to gain.
    pub fn descend(&self, mut place: Place, residuals: &impl Residuals, steps: u32) -> Place {
        let mut now = all(residuals, &place.parameters);
        for _ in 0..steps {
            if place.is_still {
                break;
            }
            let (matrix, gradient) = normal(place.parameters.len(), residuals, &place.parameters, &now);
            let before = place.cost;
            for _ in 0..6 {
                let mut damped = matrix.clone();
                (0..gradient.len()).for_each(|i| damped[i][i] += place.damping * (damped[i][i] + 1e-6));
                let step = solve(damped, gradient.clone());
                let step = step.iter().map(|s| s.clamp(-self.longest, self.longest));
                let moved: Vec<f64> = place.parameters.iter().zip(step).map(|(p, s)| p - s).collect();
                let there = all(residuals, &moved);
                let found = sum(&there);
                if found < place.cost {
                    (place.parameters, place.cost, now) = (moved, found, there);
                    place.damping = (0.2 * place.damping).max(1e-7);
                    break;
                }
                place.damping *= 5.0;
            }
            place.is_still = before - place.cost <= self.gain * before;
        }
        place
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The normal matrix and the gradient.
fn normal(n: usize, residuals: &impl Residuals, parameters: &[f64], now: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (mut matrix, mut gradient) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for (block, now) in now.iter().enumerate() {
        let columns = residuals.slopes(parameters, block, now);
        for (i, x) in &columns {
            gradient[*i] += dot(x, now);
            columns.iter().for_each(|(j, y)| matrix[*i][*j] += dot(x, y));
        }
    }
    (matrix, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved() {
        let x = solve(vec![vec![4.0, 1.0, 0.0], vec![1.0, 3.0, 1.0], vec![0.0, 1.0, 2.0]], vec![6.0, 10.0, 8.0]);
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-12, "{x:?}");
        }
        assert_eq!(solve(vec![vec![0.0]], vec![1.0]), [0.0]);
    }

    /// `p exp(-q x)` at ten places of two blocks, less that of 2 and .7.
    struct Curve;

    impl Curve {
        fn places(block: usize) -> impl Iterator<Item = f64> {
            (0..10).map(move |i| f64::from(i) * 0.1 + block as f64)
        }
    }

    impl Residuals for Curve {
        fn blocks(&self) -> usize {
            2
        }

        fn block(&self, p: &[f64], block: usize) -> Vec<f64> {
            Self::places(block).map(|x| p[0] * libm::exp(-p[1] * x) - 2.0 * libm::exp(-0.7 * x)).collect()
        }

        fn slopes(&self, p: &[f64], block: usize, _: &[f64]) -> Vec<Column> {
            let falloff = |x: f64| libm::exp(-p[1] * x);
            let along = Self::places(block).map(falloff).collect();
            vec![(0, along), (1, Self::places(block).map(|x| -x * p[0] * falloff(x)).collect())]
        }
    }

    /// Oracle: the parameters that the data were made from.
    #[test]
    fn a_curve_is_found_again() {
        let search = LeastSquares { longest: 0.5, gain: 1e-12 };
        let Place { parameters, cost, .. } = search.descend(Place::new(vec![1.0, 0.1], &Curve), &Curve, 50);
        assert!(cost < 1e-12 && (parameters[0] - 2.0).abs() < 1e-5, "{parameters:?}");
        assert!((parameters[1] - 0.7).abs() < 1e-5, "{parameters:?}");
        // In two goes as in one.
        let half = search.descend(Place::new(vec![1.0, 0.1], &Curve), &Curve, 3);
        assert_eq!(search.descend(half, &Curve, 47).parameters, parameters);
    }
}
