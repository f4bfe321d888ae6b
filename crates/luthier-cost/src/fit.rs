//! Fits of device costs to times: non-negative least squares of relative errors, with reads of textures beside the rest or behind it.

use std::collections::BTreeMap;

use luthier_shader::StaticCounts;
use serde::{Deserialize, Serialize};

/// Number of kinds of operations.
pub(crate) const KINDS: usize = StaticCounts::NAMES.len();

/// Pairs of shaders whose times are closer than this ratio have no order.
const TIE: f64 = 1.05;

/// Time of one shader, with what its text counts.
#[derive(Debug, Clone)]
pub struct Timing {
    /// The material, or another name by which rows are left out together.
    pub material: String,
    /// The model, or another name by which rows are left out together.
    pub model: String,
    /// Counts of its text for what was timed.
    pub counts: StaticCounts,
    /// Time, or cycles, less those of the harness.
    pub time: f64,
}

/// How well costs meet times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Misfit {
    /// Median of the relative errors.
    pub median: f64,
    /// The largest relative error.
    pub largest: f64,
    /// Share of pairs of shaders of one material, with times at least 5 % apart, that the costs put into the order of the times.
    pub in_order: f64,
}

/// Quality of a fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FitQuality {
    /// Rows that were fitted.
    pub rows: u32,
    /// Rows that took no longer than the harness.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub left_out: u32,
    /// On the rows themselves.
    pub own: Misfit,
    /// On the rows of each material, by a fit to those of the others; absent where there is one material.
    pub without_material: Option<Misfit>,
    /// On the rows of each model, by a fit to those of the others; absent where there is one model.
    pub without_model: Option<Misfit>,
    /// Of [`StaticCounts::operations`] times one number, fitted to the rows of the other models (to all, where there is one).
    pub counts_alone: Misfit,
}

fn is_zero(count: &u32) -> bool {
    *count == 0
}

impl FitQuality {
    /// Whether the costs of models that the fit has not seen are nearer to the times than the counts alone are.
    pub fn is_better_than_counts(&self) -> bool {
        self.without_model.unwrap_or(self.own).median < self.counts_alone.median
    }
}

/// Kinds of operations that the texture units carry out, in the order of [`StaticCounts::values`]: reads of textures.
const TEXTURE_KINDS: std::ops::Range<usize> = 0..3;

/// Shares of the shorter side that a fit tries.
const HIDDEN: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Numbers of reads of textures from which a search begins by taking reads for the longer side.
const STARTS: [u32; 3] = [1, 3, u32::MAX];

/// The most steps of a search.
const STEPS: usize = 12;

/// Numbers by which counts give times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Numbers {
    /// Time of each kind, in the order of [`StaticCounts::values`].
    pub(crate) values: [f64; KINDS],
    /// Share of the shorter side that hides behind the longer.
    pub(crate) hidden: f64,
}

impl Numbers {
    /// Time of reads of textures, and of the rest.
    fn sides(&self, counts: &StaticCounts) -> [f64; 2] {
        let times = counts.values().into_iter().zip(self.values).map(|(n, time)| f64::from(n) * time);
        let mut sides = [0.0; 2];
        times.enumerate().for_each(|(kind, time)| sides[usize::from(!TEXTURE_KINDS.contains(&kind))] += time);
        sides
    }

    /// Time of some counts.
    pub(crate) fn cost(&self, counts: &StaticCounts) -> f64 {
        let [reads, rest] = self.sides(counts);
        reads.max(rest) + (1.0 - self.hidden) * reads.min(rest)
    }
}

/// Numbers by which counts give times: not negative, with the least sum of squared relative errors that the search finds. A kind of operation that no
/// row has gets 0. Among dependent kinds the sum decides, not each number.
///
/// For each share of [`HIDDEN`] the search guesses which side is the longer one in each row, solves for the numbers, and guesses again by these. Each
/// solution tries all sets of kinds that may differ from 0, and so needs no starting point.
pub(crate) fn numbers(rows: &[&Timing]) -> Numbers {
    let mut best = (Numbers { values: [0.0; KINDS], hidden: 0.0 }, f64::INFINITY);
    for hidden in HIDDEN {
        for start in STARTS {
            let reads = |row: &Timing| row.counts.values()[TEXTURE_KINDS].iter().sum::<u32>();
            let mut is_bound: Vec<bool> = rows.iter().map(|row| reads(row) >= start).collect();
            for _ in 0..STEPS {
                let numbers = Numbers { values: values(rows, &is_bound, hidden), hidden };
                let misses = rows.iter().map(|row| numbers.cost(&row.counts) / row.time - 1.0);
                let squares: f64 = misses.map(|miss| miss * miss).sum();
                if squares < best.1 * (1.0 - 1e-9) {
                    best = (numbers, squares);
                }
                let sides = rows.iter().map(|row| numbers.sides(&row.counts));
                let next: Vec<bool> = sides.map(|[reads, rest]| reads > rest).collect();
                if next == is_bound {
                    break;
                }
                is_bound = next;
            }
            // Nothing hides: the guess does not matter.
            if hidden == 0.0 {
                break;
            }
        }
    }
    best.0
}

/// The times of kinds, where reads of textures are the longer side in the rows of `is_bound`.
fn values(rows: &[&Timing], is_bound: &[bool], hidden: f64) -> [f64; KINDS] {
    let rows: Vec<[f64; KINDS]> = rows
        .iter()
        .zip(is_bound)
        .map(|(row, is_bound)| {
            let counts = row.counts.values();
            std::array::from_fn(|kind| {
                let is_long = TEXTURE_KINDS.contains(&kind) == *is_bound;
                f64::from(counts[kind]) / row.time * if is_long { 1.0 } else { 1.0 - hidden }
            })
        })
        .collect();
    let (mut matrix, mut right) = ([[0.0; KINDS]; KINDS], [0.0; KINDS]);
    for row in &rows {
        for i in 0..KINDS {
            right[i] += row[i];
            (0..KINDS).for_each(|j| matrix[i][j] += row[i] * row[j]);
        }
    }
    // The sum of squares of a solution, less the number of rows: a solution of the normal equations takes away its product with the right side.
    let mut best = ([0.0; KINDS], f64::INFINITY);
    let present = (0..KINDS).filter(|&i| matrix[i][i] > 0.0).fold(0_u32, |all, i| all | 1 << i);
    for set in (1_u32..1 << KINDS).filter(|set| set & !present == 0) {
        let kinds: Vec<usize> = (0..KINDS).filter(|i| set >> i & 1 == 1).collect();
        let Some(solution) = solve(&matrix, &right, &kinds) else { continue };
        if solution.iter().any(|c| *c < 0.0) {
            continue;
        }
        let squares: f64 = -kinds.iter().zip(&solution).map(|(&i, c)| c * right[i]).sum::<f64>();
        if squares < best.1 - 1e-12 * rows.len() as f64 {
            let mut found = [0.0; KINDS];
            kinds.iter().zip(&solution).for_each(|(&i, &c)| found[i] = c);
            best = (found, squares);
        }
    }
    best.0
}

/// Solves the normal equations of some unknowns by elimination; `None` if they do not decide every unknown.
fn solve(matrix: &[[f64; KINDS]; KINDS], right: &[f64; KINDS], kinds: &[usize]) -> Option<Vec<f64>> {
    let n = kinds.len();
    // Scaled to a diagonal of ones, so that a pivot tells dependence from small numbers.
    let scale: Vec<f64> = kinds.iter().map(|&i| matrix[i][i].sqrt()).collect();
    if scale.contains(&0.0) {
        return None;
    }
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let mut row: Vec<f64> = (0..n).map(|j| matrix[kinds[i]][kinds[j]] / (scale[i] * scale[j])).collect();
            row.push(right[kinds[i]] / scale[i]);
            row
        })
        .collect();
    for i in 0..n {
        if rows[i][i] < 1e-9 {
            return None;
        }
        for k in i + 1..n {
            let factor = rows[k][i] / rows[i][i];
            let (above, below) = rows.split_at_mut(k);
            below[0].iter_mut().zip(&above[i]).skip(i).for_each(|(x, top)| *x -= factor * top);
        }
    }
    let mut solution = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| rows[i][j] * solution[j]).sum();
        solution[i] = (rows[i][n] - known) / rows[i][i];
    }
    Some(solution.iter().zip(&scale).map(|(x, s)| x / s).collect())
}

/// Quality of numbers that were fitted to rows.
pub(crate) fn quality(rows: &[Timing], fitted: &Numbers) -> FitQuality {
    let own: Vec<f64> = rows.iter().map(|row| fitted.cost(&row.counts)).collect();
    // The number that makes the squares of relative errors least.
    let alone = |others: &[&Timing]| {
        let ratios = others.iter().map(|other| f64::from(other.counts.operations()) / other.time);
        let (sum, squares) = ratios.fold((0.0, 0.0), |(sum, squares), r| (sum + r, squares + r * r));
        let scale = sum / squares;
        move |row: &Timing| f64::from(row.counts.operations()) * scale
    };
    let by_numbers = |others: &[&Timing]| {
        let numbers = numbers(others);
        move |row: &Timing| numbers.cost(&row.counts)
    };
    let counts_alone = left_out(rows, |row| &row.model, alone).unwrap_or_else(|| {
        let of_all = alone(&rows.iter().collect::<Vec<_>>());
        rows.iter().map(of_all).collect()
    });
    FitQuality {
        rows: rows.len() as u32,
        left_out: 0,
        own: misfit(rows, &own),
        without_material: left_out(rows, |row| &row.material, by_numbers).map(|costs| misfit(rows, &costs)),
        without_model: left_out(rows, |row| &row.model, by_numbers).map(|costs| misfit(rows, &costs)),
        counts_alone: misfit(rows, &counts_alone),
    }
}

/// Costs of rows by fits to the rows of other groups; `None` if there is only one group.
fn left_out<F: Fn(&Timing) -> f64>(
    rows: &[Timing],
    group: impl Fn(&Timing) -> &String,
    fit: impl Fn(&[&Timing]) -> F,
) -> Option<Vec<f64>> {
    let mut fits: BTreeMap<&String, F> = BTreeMap::new();
    for row in rows {
        let own = group(row);
        if !fits.contains_key(own) {
            let others: Vec<&Timing> = rows.iter().filter(|other| group(other) != own).collect();
            if others.is_empty() {
                return None;
            }
            fits.insert(own, fit(&others));
        }
    }
    Some(rows.iter().map(|row| fits[group(row)](row)).collect())
}

/// How well some costs, one for each row, meet the times.
pub fn misfit(rows: &[Timing], costs: &[f64]) -> Misfit {
    let mut errors: Vec<f64> = rows.iter().zip(costs).map(|(row, cost)| (cost / row.time - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    let (mut pairs, mut kept) = (0_u32, 0_u32);
    for (i, a) in rows.iter().enumerate() {
        for (j, b) in rows.iter().enumerate() {
            if a.material == b.material && b.time > TIE * a.time {
                pairs += 1;
                kept += u32::from(costs[j] > costs[i]);
            }
        }
    }
    let middle = errors.len() / 2;
    let median = match errors.len() {
        0 => 0.0,
        n if n % 2 == 1 => errors[middle],
        _ => 0.5 * (errors[middle - 1] + errors[middle]),
    };
    let in_order = if pairs == 0 { 1.0 } else { f64::from(kept) / f64::from(pairs) };
    Misfit { median, largest: errors.last().copied().unwrap_or(0.0), in_order }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(material: &str, model: &str, values: [u32; KINDS], time: f64) -> Timing {
        Timing { material: material.to_owned(), model: model.to_owned(), counts: StaticCounts::of_values(values), time }
    }

    /// Rows whose times are sums of known coefficients, with none for fetches and a negligible branch.
    fn rows() -> Vec<Timing> {
        let values = [
            [0, 0, 0, 2, 0, 5, 80, 1],
            [1, 0, 0, 4, 0, 9, 90, 2],
            [2, 0, 0, 6, 0, 30, 210, 4],
            [5, 0, 0, 3, 0, 12, 130, 0],
            [0, 0, 0, 9, 0, 60, 600, 7],
            [3, 0, 0, 8, 0, 4, 300, 3],
        ];
        let time = |v: [u32; KINDS]| {
            1.3 * f64::from(v[0]) + 0.1 * f64::from(v[3]) + 0.05 * f64::from(v[5]) + 0.01 * f64::from(v[6])
        };
        values
            .into_iter()
            .zip(["a", "b", "c", "d", "e", "f"])
            .map(|(v, model)| row("paint", model, v, time(v)))
            .collect()
    }

    fn fit(rows: &[Timing]) -> Numbers {
        numbers(&rows.iter().collect::<Vec<_>>())
    }

    /// Oracle: the numbers that the times were made from, of which the longer side alone counts.
    #[test]
    fn arithmetic_behind_reads_is_found() {
        let mut rows = rows();
        let true_numbers = Numbers { values: [0.0, 2.5, 0.0, 0.1, 0.0, 0.05, 0.01, 0.0], hidden: 1.0 };
        for (i, row) in (0..).zip(&mut rows) {
            row.counts.filtered_reads = 0;
            row.counts.wide_reads = [0, 1, 6, 5, 0, 3][i];
            row.time = true_numbers.cost(&row.counts);
        }
        // Two rows of arithmetic leave its kinds open, and six decide the reads and all costs.
        let found = fit(&rows);
        assert!(found.hidden == 1.0 && (found.values[1] - 2.5).abs() < 1e-9, "{found:?}");
        let costs: Vec<f64> = rows.iter().map(|row| found.cost(&row.counts)).collect();
        assert!(misfit(&rows, &costs).largest < 1e-9, "{costs:?}");
    }

    /// Oracle: the coefficients that the times were made from.
    #[test]
    fn coefficients_are_found_again() {
        let rows = rows();
        let found = fit(&rows);
        assert_eq!(found.hidden, 0.0);
        for (found, expected) in found.values.iter().zip([1.3, 0.0, 0.0, 0.1, 0.0, 0.05, 0.01, 0.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
        }
        let quality = quality(&rows, &found);
        assert!(quality.own.largest < 1e-9 && quality.own.in_order == 1.0, "{quality:?}");
        assert!(quality.without_material.is_none() && quality.is_better_than_counts(), "{quality:?}");
    }

    /// Times that fall where a count rises would have a negative coefficient.
    #[test]
    fn no_coefficient_is_negative() {
        let mut rows = rows();
        for row in &mut rows {
            row.time *= 1.0 - 0.02 * f64::from(row.counts.branches);
        }
        let found = fit(&rows);
        assert!(found.values.iter().all(|c| *c >= 0.0), "{found:?}");
    }

    /// By hand: errors of 0, 0.5 and 0.25; of three pairs one is out of order.
    #[test]
    fn misfits_are_medians_and_orders() {
        let rows: Vec<Timing> =
            [1.0, 2.0, 4.0].into_iter().map(|time| row("paint", "a", [0, 0, 0, 0, 0, 0, 1, 0], time)).collect();
        let found = misfit(&rows, &[1.0, 1.0, 3.0]);
        assert_eq!((found.median, found.largest), (0.25, 0.5));
        assert_eq!(found.in_order, 2.0 / 3.0);
    }
}
