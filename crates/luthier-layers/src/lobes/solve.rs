//! Small dense systems of least squares, in a fixed order of operations: bytes depend on them.

/// The solution of `a x = b` for a symmetric positive matrix, by Gaussian elimination with pivots on the diagonal alone. Unknowns without
/// a pivot are 0.
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

/// Weight of the squared difference between the sum of the amounts and `total` against squared residuals.
const TOTAL_WEIGHT: f64 = 1e4;

/// Amounts of some profiles: normal equations, and the guess that the amounts are pulled to.
pub(super) struct Amounts<'a> {
    profiles: &'a [Vec<f64>],
    weights: &'a [f64],
    matrix: Vec<Vec<f64>>,
}

/// A guess at the amounts, and its weight against squared residuals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Guess<'a> {
    pub(super) amounts: &'a [f64],
    pub(super) weight: f64,
}

impl<'a> Amounts<'a> {
    /// For profiles by cell and weights of the squared residuals.
    pub(super) fn new(profiles: &'a [Vec<f64>], weights: &'a [f64]) -> Self {
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w).sum::<f64>() + TOTAL_WEIGHT
        };
        let matrix = profiles.iter().map(|a| profiles.iter().map(|b| product(a, b)).collect()).collect();
        Self { profiles, weights, matrix }
    }

    fn right(&self, found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        let product = |(part, profile): (usize, &Vec<f64>)| -> f64 {
            let data: f64 = profile.iter().zip(found).zip(self.weights).map(|((a, f), w)| a * f * w).sum();
            data + TOTAL_WEIGHT * total + guess.map_or(0.0, |guess| guess.weight * guess.amounts[part])
        };
        self.profiles.iter().enumerate().map(product).collect()
    }

    /// The amounts, not negative, that leave the least residuals, by trying every set of profiles that count.
    pub(super) fn positive(&self, found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        let right = self.right(found, total, guess);
        let mut best = (0.0, vec![0.0; right.len()]);
        for set in 1..1_usize << right.len() {
            let amounts = self.of(set, &right, guess);
            // What the squared residuals lose against amounts of 0, at the minimum within the set.
            let gain: f64 = amounts.iter().zip(&right).map(|(x, r)| x * r).sum();
            if amounts.iter().all(|x| *x >= 0.0) && gain > best.0 {
                best = (gain, amounts);
            }
        }
        best.1
    }

    /// The amounts, of either sign, of the profiles in `counted` that leave the least residuals.
    pub(super) fn signed(&self, counted: &[bool], found: &[f64], total: f64, guess: Option<Guess<'_>>) -> Vec<f64> {
        let set = counted.iter().enumerate().filter(|(_, counts)| **counts).map(|(i, _)| 1 << i).sum();
        self.of(set, &self.right(found, total, guess), guess)
    }

    fn of(&self, set: usize, right: &[f64], guess: Option<Guess<'_>>) -> Vec<f64> {
        let members: Vec<usize> = (0..right.len()).filter(|i| set >> i & 1 == 1).collect();
        let pull = guess.map_or(0.0, |guess| guess.weight);
        let element = |i: usize, j: usize| self.matrix[i][j] + if i == j { pull } else { 0.0 };
        let matrix = members.iter().map(|&i| members.iter().map(|&j| element(i, j)).collect()).collect();
        let solved = solve(matrix, members.iter().map(|&i| right[i]).collect());
        let mut amounts = vec![0.0; right.len()];
        members.iter().zip(solved).for_each(|(&i, x)| amounts[i] = x);
        amounts
    }
}

/// Least squares by Levenberg's and Marquardt's damping. Derivatives are differences.
pub(super) struct LeastSquares {
    /// Steps at most.
    pub(super) steps: u32,
    /// Step of the differences.
    pub(super) difference: f64,
    /// Longest step of a parameter.
    pub(super) longest: f64,
    /// Share of the sum of squares below which a gain ends the search.
    pub(super) gain: f64,
}

impl LeastSquares {
    /// The parameters that make the residuals least, from a start; and the sum of squares. `residuals` has them in blocks, and `touched`
    /// tells which blocks a parameter changes.
    pub(super) fn minimise(
        &self,
        mut parameters: Vec<f64>,
        residuals: impl Fn(&[f64], usize) -> Vec<f64>,
        touched: impl Fn(usize) -> Vec<usize>,
        blocks: usize,
    ) -> (Vec<f64>, f64) {
        let n = parameters.len();
        let all = |p: &[f64]| -> Vec<Vec<f64>> { (0..blocks).map(|block| residuals(p, block)).collect() };
        let sum = |r: &[Vec<f64>]| -> f64 { r.iter().flatten().map(|x| x * x).sum() };
        let mut now = all(&parameters);
        let mut cost = sum(&now);
        let mut damping = 1e-2;
        for _ in 0..self.steps {
            let columns: Vec<Vec<(usize, Vec<f64>)>> = (0..n)
                .map(|j| {
                    let mut moved = parameters.clone();
                    moved[j] += self.difference;
                    let change = |block: usize| {
                        let there = residuals(&moved, block);
                        let slope = there.iter().zip(&now[block]).map(|(a, b)| (a - b) / self.difference);
                        (block, slope.collect())
                    };
                    touched(j).into_iter().map(change).collect()
                })
                .collect();
            let (matrix, gradient) = normal(&columns, &now);
            let before = cost;
            for _ in 0..6 {
                let mut damped = matrix.clone();
                (0..n).for_each(|i| damped[i][i] += damping * (damped[i][i] + 1e-6));
                let step = solve(damped, gradient.clone());
                let moved: Vec<f64> =
                    parameters.iter().zip(&step).map(|(p, s)| p - s.clamp(-self.longest, self.longest)).collect();
                let there = all(&moved);
                let found = sum(&there);
                if found < cost {
                    (parameters, now, cost) = (moved, there, found);
                    damping = (0.2 * damping).max(1e-7);
                    break;
                }
                damping *= 5.0;
            }
            if before - cost <= self.gain * before {
                break;
            }
        }
        (parameters, cost)
    }
}

/// The normal matrix and gradient of the columns of a Jacobian, each in ascending blocks.
fn normal(columns: &[Vec<(usize, Vec<f64>)>], residuals: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let n = columns.len();
    let mut matrix = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let (mut a, mut b) = (columns[i].iter().peekable(), columns[j].iter().peekable());
            let mut sum = 0.0;
            while let (Some((p, x)), Some((q, y))) = (a.peek(), b.peek()) {
                match p.cmp(q) {
                    std::cmp::Ordering::Less => drop(a.next()),
                    std::cmp::Ordering::Greater => drop(b.next()),
                    std::cmp::Ordering::Equal => {
                        sum += dot(x, y);
                        a.next();
                        b.next();
                    }
                }
            }
            matrix[i][j] = sum;
            matrix[j][i] = sum;
        }
    }
    let along = |column: &Vec<(usize, Vec<f64>)>| column.iter().map(|(block, x)| dot(x, &residuals[*block])).sum();
    (matrix, columns.iter().map(along).collect())
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
        let signed = amounts.signed(&[true, true, false], &[1.0, -0.1, -0.1], 0.8, None);
        assert!((signed[0] - 1.0).abs() < 1e-6 && (signed[1] + 0.2).abs() < 1e-6 && signed[2] == 0.0, "{signed:?}");
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

    /// Oracle: the parameters that the data were made from.
    #[test]
    fn a_curve_is_found_again() {
        let at = |p: &[f64], block: usize| -> Vec<f64> {
            (0..10).map(|i| f64::from(i) * 0.1 + block as f64).map(|x| p[0] * libm::exp(-p[1] * x)).collect()
        };
        let truth = [2.0, 0.7];
        let residuals = |p: &[f64], block: usize| -> Vec<f64> {
            at(p, block).iter().zip(at(&truth, block)).map(|(a, b)| a - b).collect()
        };
        let search = LeastSquares { steps: 50, difference: 1e-6, longest: 0.5, gain: 1e-12 };
        let (found, cost) = search.minimise(vec![1.0, 0.1], residuals, |_| vec![0, 1], 2);
        assert!(cost < 1e-12 && (found[0] - 2.0).abs() < 1e-5 && (found[1] - 0.7).abs() < 1e-5, "{found:?}");
    }
}
