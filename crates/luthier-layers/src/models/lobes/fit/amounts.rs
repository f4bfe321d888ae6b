//! Amounts of profiles by linear least squares.

use crate::least_squares::solve;

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

#[cfg(test)]
mod tests {
    use super::*;

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
}
