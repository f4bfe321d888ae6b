//! Small dense systems of least squares, in a fixed order of operations, because bytes of tables depend on them. `levenberg-marquardt` and
//! `nalgebra`, which fit beams, are not used here: nalgebra fuses products on some machines.

/// The solution of `a x = b` for a symmetric positive matrix, by Gaussian elimination with pivots on the diagonal alone. An unknown without a
/// pivot is left open by the system, and becomes 0.
pub(super) fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
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

/// Weight of the squared difference between the sum of the amounts and the total energy, against squared residuals: in effect a constraint.
const TOTAL_WEIGHT: f64 = 1e4;

/// The normal equations for amounts of some profiles.
pub(super) struct Amounts<'a> {
    profiles: &'a [Vec<f64>],
    weights: &'a [f64],
    matrix: Vec<Vec<f64>>,
}

/// A guess to which amounts are pulled, and its weight against squared residuals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Guess<'a> {
    pub(super) amounts: &'a [f64],
    pub(super) weight: f64,
}

impl<'a> Amounts<'a> {
    /// The equations of profiles by cell, with weights of the squared residuals.
    pub(super) fn new(profiles: &'a [Vec<f64>], weights: &'a [f64]) -> Self {
        let rows = profiles.iter().map(|a| profiles.iter().map(|b| weighted(a, b, weights) + TOTAL_WEIGHT).collect());
        Self { profiles, weights, matrix: rows.collect() }
    }

    fn right(&self, found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        let products = self.profiles.iter().enumerate().map(|(part, profile)| {
            let data = weighted(profile, found, self.weights);
            data + TOTAL_WEIGHT * total + guess.map_or(0.0, |guess| guess.weight * guess.amounts[part])
        });
        products.collect()
    }

    /// The non-negative amounts with the least residuals. Every set of profiles is tried: there are few.
    pub(super) fn positive(&self, found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        self.best(found, total, guess, (1 << self.profiles.len()) - 1)
    }

    /// [`Self::positive`] among the profiles that have an amount in `others`.
    pub(super) fn among(&self, others: &[f64], found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        let counted = others.iter().enumerate().filter(|(_, amount)| **amount > 0.0).map(|(i, _)| 1 << i).sum();
        self.best(found, total, guess, counted)
    }

    fn best(&self, found: &[f64], total: f64, guess: Option<Guess<'_>>, counted: usize) -> Vec<f64> {
        let right = self.right(found, total, guess);
        let mut best = (0.0, vec![0.0; right.len()]);
        for set in (1..=counted).filter(|set| set & !counted == 0) {
            let amounts = self.of(set, &right, guess);
            // Gain in squared residuals over amounts of 0, at the minimum within the set.
            let gain: f64 = amounts.iter().zip(&right).map(|(x, r)| x * r).sum();
            if amounts.iter().all(|x| *x >= 0.0) && gain > best.0 {
                best = (gain, amounts);
            }
        }
        best.1
    }

    fn of(&self, set: usize, right: &[f64], guess: Option<Guess<'_>>) -> Vec<f64> {
        let members: Vec<usize> = (0..right.len()).filter(|i| set >> i & 1 == 1).collect();
        let mut matrix: Vec<Vec<f64>> =
            members.iter().map(|&i| members.iter().map(|&j| self.matrix[i][j]).collect()).collect();
        let pull = guess.map_or(0.0, |guess| guess.weight);
        (0..members.len()).for_each(|i| matrix[i][i] += pull);
        let solved = solve(matrix, members.iter().map(|&i| right[i]).collect());
        let mut amounts = vec![0.0; right.len()];
        members.iter().zip(solved).for_each(|(&i, x)| amounts[i] = x);
        amounts
    }
}

/// The sum of products with weights.
fn weighted(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w).sum()
}

/// Least squares by Levenberg's and Marquardt's damping.
pub(super) struct LeastSquares {
    /// Longest step of a parameter.
    pub(super) longest: f64,
    /// Share of the sum of squares below which a gain ends the search.
    pub(super) gain: f64,
}

/// A column of a Jacobian within a block: the number of the parameter, and the slopes of the residuals.
pub(super) type Column = (usize, Vec<f64>);

/// Residuals in blocks, and their slopes.
pub(super) trait Residuals {
    /// Number of blocks.
    fn blocks(&self) -> usize;

    /// The residuals of a block.
    fn block(&self, parameters: &[f64], block: usize) -> Vec<f64>;

    /// The slopes of a block whose residuals are `now`, by parameter. Parameters that do not change the block may be left out.
    fn slopes(&self, parameters: &[f64], block: usize, now: &[f64]) -> Vec<Column>;
}

/// A place that a search has come to.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) parameters: Vec<f64>,
    /// Sum of the squares.
    pub(super) cost: f64,
    damping: f64,
    /// Whether the last step gained next to nothing.
    is_still: bool,
}

impl Place {
    /// A place to start from.
    pub(super) fn new(parameters: Vec<f64>, residuals: &impl Residuals) -> Self {
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
    pub(super) fn descend(&self, mut place: Place, residuals: &impl Residuals, steps: u32) -> Place {
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

    #[test]
    fn amounts_are_found_and_never_negative() {
        let profiles = [vec![1.0, 0.0, 0.0], vec![0.0, 0.5, 0.5], vec![0.4, 0.3, 0.3]];
        let weights = [1.0, 2.0, 3.0];
        let amounts = Amounts::new(&profiles, &weights);
        let found = amounts.positive(&[0.7, 0.6, 0.6], 1.9, None);
        assert!((found.iter().sum::<f64>() - 1.9).abs() < 1e-6, "{found:?}");
        // Light that only a negative amount of the second profile would make.
        let found = amounts.positive(&[1.0, -0.1, -0.1], 0.8, None);
        assert!(found.iter().all(|x| *x >= 0.0) && found[1] == 0.0, "{found:?}");
        // The third profile would do alone, and does not count.
        let found = amounts.among(&[1.0, 0.1, 0.0], &[0.4, 0.3, 0.3], 1.0, None);
        assert!((found[0] - 0.4).abs() < 1e-6 && (found[1] - 0.6).abs() < 1e-6 && found[2] == 0.0, "{found:?}");
    }

    /// Profiles that are alike: the residuals leave their amounts open, and the guess decides.
    #[test]
    fn a_guess_decides_what_residuals_leave_open() {
        let profiles = [vec![0.5, 0.5], vec![0.5, 0.5]];
        let amounts = Amounts::new(&profiles, &[1.0; 2]);
        let guess = Guess { amounts: &[0.9, 0.1], weight: 0.1 };
        let found = amounts.positive(&[0.5, 0.5], 1.0, Some(guess));
        assert!((found[0] - 0.9).abs() < 1e-3 && (found[1] - 0.1).abs() < 1e-3, "{found:?}");
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
