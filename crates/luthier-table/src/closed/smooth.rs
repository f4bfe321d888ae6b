//! Closed forms with straight rests, for tables beside them.

use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface};
use luthier_optics::stack::Distribution;

use super::cholesky::{add, cholesky, dot, solve};
use super::rational::{Polynomial, Rational};
use super::{ClosedForm, STRETCH};
use crate::Layout;

/// Nodes of the grid along each axis: about as many as the tables beside these forms have.
const NODES: u32 = 24;
/// Rounds of the fit of the cosine, the first half with half steps.
const ROUNDS: u32 = 12;
/// Least loss of a form at the nodes.
const LEAST_LOSS: f64 = 1e-3;
/// Share of the largest diagonal element that is added to each of the normal equations. It keeps polynomials small that
/// the data do not tell apart.
const RIDGE: f64 = 1e-8;

impl ClosedForm {
    /// The form of polynomials of some degrees, of the loss and of the cosine, with the straightest rests over the axes
    /// of a layout. Straightness is the sum of squares of second differences between nodes, to which errors of linear
    /// interpolation are proportional. Rests may be large.
    ///
    /// The loss is fitted by linear least squares. The cosine takes Gauss's and Newton's rounds, since the bias follows
    /// its fifth power.
    pub(crate) fn straightest(
        distribution: Distribution,
        masking: Masking,
        surface: &SplitSumSurface,
        layout: &Layout,
        degrees: [[usize; 2]; 2],
    ) -> Self {
        let grid = Grid::new(surface, layout);
        let loss = grid.loss(degrees[0]);
        let cosine = grid.cosine(degrees[1], &loss);
        Self {
            distribution,
            masking,
            floor: [layout.angle.min, layout.slope.map_or(0.0, |slope| slope.min)],
            loss,
            cosine,
        }
    }
}

/// Split sums at the nodes of a square table.
struct Grid {
    /// t, r and alpha.
    variables: Vec<[f64; 3]>,
    sums: Vec<SplitSum>,
}

impl Grid {
    fn new(surface: &SplitSumSurface, layout: &Layout) -> Self {
        let (mut variables, mut sums) = (Vec::new(), Vec::new());
        for j in 0..NODES {
            let row = surface.row(layout.at_texel([NODES; 2], [0, j])[1]);
            for i in 0..NODES {
                let [theta, alpha] = layout.at_texel([NODES; 2], [i, j]);
                let cos_theta = libm::cos(theta);
                let r = (cos_theta * cos_theta + STRETCH * alpha * alpha).sqrt();
                variables.push([cos_theta / r, r, alpha]);
                sums.push(row.at(cos_theta));
            }
        }
        Self { variables, sums }
    }

    fn loss(&self, degrees: [usize; 2]) -> Rational {
        let loss: Vec<f64> = self.sums.iter().map(|sum| 1.0 - sum.albedo()).collect();
        let columns = columns(self.variables.iter().map(|&[t, _, alpha]| Polynomial::powers(degrees, [t, alpha])));
        // A constant has no second differences.
        let bends: Vec<Vec<f64>> = columns[1..].iter().map(|column| second_differences(column)).collect();
        let mut coefficients = vec![0.0];
        coefficients.extend(least_squares(&bends, &second_differences(&loss)));
        let forms: Vec<f64> = (0..loss.len()).map(|i| value(&columns, &coefficients, i)).collect();
        let least_rest = least(loss.iter().zip(&forms).map(|(loss, form)| loss - form));
        let most_rest = -least(loss.iter().zip(&forms).map(|(loss, form)| form - loss));
        // The constant makes rests equal to both sides. It is raised where the form's albedo would exceed 1: the form
        // would bend where it is clamped.
        coefficients[0] = f64::max(0.5 * (least_rest + most_rest), LEAST_LOSS - least(forms.into_iter()));
        polynomial(degrees, &coefficients)
    }

    fn cosine(&self, degrees: [usize; 2], loss: &Rational) -> Rational {
        let albedos: Vec<f64> = self.variables.iter().map(|&[t, _, alpha]| 1.0 - loss.at([t, alpha])).collect();
        let columns = columns(self.variables.iter().map(|&[t, r, _]| Polynomial::powers(degrees, [t, r])));
        // The start fits the cosine itself, weighed by its effect on the bias.
        let rests: Vec<f64> =
            self.sums.iter().map(|sum| libm::pow((sum.bias / sum.albedo().max(1e-6)).clamp(0.0, 1.0), 0.2)).collect();
        let weights: Vec<f64> = self.sums.iter().zip(&rests).map(|(sum, rest)| slope(sum.albedo(), *rest)).collect();
        let cosines: Vec<f64> = rests.iter().map(|rest| 1.0 - rest).collect();
        let start: Vec<Vec<f64>> = columns.iter().map(|column| products(column, &weights)).collect();
        let mut coefficients = least_squares(&start, &products(&cosines, &weights));
        for round in 0..ROUNDS {
            let rests: Vec<f64> =
                (0..cosines.len()).map(|i| (1.0 - value(&columns, &coefficients, i)).clamp(0.0, 1.0)).collect();
            let slopes: Vec<f64> = albedos.iter().zip(&rests).map(|(albedo, rest)| -slope(*albedo, *rest)).collect();
            // The bias of the form is a fifth of its slope, times the rest.
            let lacking: Vec<f64> = self
                .sums
                .iter()
                .zip(slopes.iter().zip(&rests))
                .map(|(sum, (s, rest))| sum.bias + 0.2 * s * rest)
                .collect();
            let bends: Vec<Vec<f64>> =
                columns.iter().map(|column| second_differences(&products(column, &slopes))).collect();
            let step = least_squares(&bends, &second_differences(&lacking));
            let part = if 2 * round < ROUNDS { 0.5 } else { 1.0 };
            add(&mut coefficients, part, &step);
        }
        polynomial(degrees, &coefficients)
    }
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// Derivative of the bias, `albedo * rest^5`, by the rest.
fn slope(albedo: f64, rest: f64) -> f64 {
    5.0 * albedo * (rest * rest) * (rest * rest)
}

fn polynomial(degrees: [usize; 2], coefficients: &[f64]) -> Rational {
    Rational {
        numerator: Polynomial::rounded(degrees, coefficients.iter().copied()),
        denominator: Polynomial::rounded([0, 0], std::iter::once(1.0)),
    }
}

fn products(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// Powers at all nodes, by power.
fn columns(rows: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = rows.collect();
    (0..rows[0].len()).map(|c| rows.iter().map(|row| row[c]).collect()).collect()
}

/// A sum of columns times coefficients, at a node.
fn value(columns: &[Vec<f64>], coefficients: &[f64], node: usize) -> f64 {
    columns.iter().zip(coefficients).map(|(column, coefficient)| coefficient * column[node]).sum()
}

/// Second differences of values at the nodes, along both axes.
fn second_differences(values: &[f64]) -> Vec<f64> {
    let n = NODES as usize;
    let places = [(1, n), (n, 1)]
        .into_iter()
        .flat_map(|(step, across)| (1..n - 1).flat_map(move |i| (0..n).map(move |j| (i * step + j * across, step))));
    places.map(|(i, step)| values[i - step] - 2.0 * values[i] + values[i + step]).collect()
}

/// Factors of columns whose sum is nearest to the target, by the normal equations and Cholesky's factors.
fn least_squares(columns: &[Vec<f64>], target: &[f64]) -> Vec<f64> {
    let n = columns.len();
    let mut normal: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
    let ridge = RIDGE * (0..n).map(|i| normal[i][i]).fold(0.0, f64::max);
    (0..n).for_each(|i| normal[i][i] += ridge);
    let right = columns.iter().map(|a| dot(a, target)).collect();
    // The ridge makes the matrix positive definite, unless values are NaN.
    cholesky(normal).map_or_else(|| vec![f64::NAN; n], |factor| solve(&factor, right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Nodes;

    #[test]
    fn least_squares_find_what_is_there() {
        let columns: Vec<Vec<f64>> =
            (0..3).map(|k| (0..9).map(|i| libm::pow(f64::from(i) / 8.0, f64::from(k))).collect()).collect();
        let target: Vec<f64> = (0..9).map(|i| value(&columns, &[0.5, -1.0, 2.0], i)).collect();
        let found = least_squares(&columns, &target);
        for (found, expected) in found.iter().zip([0.5, -1.0, 2.0]) {
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
    }

    /// The rests of bias and loss bend a quarter as much as these, in the mean.
    #[test]
    fn rests_are_straighter() {
        let (distribution, masking) = (Distribution::Ggx, Masking::SmithCorrelated);
        let surface = SplitSumSurface::new(distribution, masking);
        let layout = Layout::powers([0.01; 2], [4.0, 2.0], Nodes::Ends);
        let form = ClosedForm::straightest(distribution, masking, &surface, &layout, [[3, 2], [2, 2]]);
        let grid = Grid::new(&surface, &layout);
        let bend = |of: &dyn Fn(SplitSum) -> f64, part: f64| {
            let values: Vec<f64> = (0..NODES * NODES)
                .map(|i| {
                    let [theta, alpha] = layout.at_texel([NODES; 2], [i % NODES, i / NODES]);
                    of(grid.sums[i as usize]) - part * of(form.eval(libm::cos(theta), alpha))
                })
                .collect();
            second_differences(&values).into_iter().map(|d| d * d).sum::<f64>().sqrt()
        };
        for of in [&|sum: SplitSum| sum.bias, &|sum: SplitSum| sum.albedo()] as [&dyn Fn(SplitSum) -> f64; 2] {
            let (before, after) = (bend(of, 0.0), bend(of, 1.0));
            assert!(after < 0.25 * before, "{before:e} {after:e}");
        }
    }

    /// Of x^2 + 3 y^2 at whole x and y.
    #[test]
    fn second_differences_are_of_both_axes() {
        let values: Vec<f64> = (0..NODES * NODES)
            .map(|i| (f64::from(i % NODES), f64::from(i / NODES)))
            .map(|(x, y)| x * x + 3.0 * y * y)
            .collect();
        let found = second_differences(&values);
        let half = found.len() / 2;
        assert_eq!(half, (NODES * (NODES - 2)) as usize);
        assert!(found[..half].iter().all(|d| *d == 2.0) && found[half..].iter().all(|d| *d == 6.0));
    }
}
