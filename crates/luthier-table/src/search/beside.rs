//! The cheapest closed form that a small table brings within an error.

use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use super::Found;
use crate::{Base, ClosedForm, DfgTable, Layout, Nodes, Stored, Value};

/// Errors of the forms that are tried, from the cheapest form on.
const FORMS: [f64; 6] = [0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3];
/// Exponents of the axes that are tried, which need nothing but square roots to be read: of cosines, and of alpha.
const EXPONENTS: [f64; 3] = [1.0, 2.0, 4.0];
/// Sides that are tried.
const SIDES: [u32; 16] = [3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 48, 64];
/// Points at which candidates are judged, along each axis.
const POINTS: u32 = 64;
/// Candidates beside one form that are measured at the most.
const MEASURED: usize = 4;
/// The amplitude of a base over the largest rest: bytes hold both ends.
const MARGIN: f64 = 1.001;

/// A table beside a form and its error at some points, which are not all.
struct Candidate {
    table: DfgTable,
    error: f64,
}

/// The split sums that candidates are judged by.
struct Judge {
    distribution: Distribution,
    masking: Masking,
    lowest: [f64; 2],
    surface: SplitSumSurface,
    points: Vec<([f64; 2], SplitSum)>,
}

/// The table of bytes beside a closed form ([`DfgTable::base`]) that costs the fewest operations of those whose texels take `max_bytes` at most and
/// whose reads err by `max_abs` at most over cosines and alphas from the given ones on; of tables beside one form the smallest. Where none does, the
/// most accurate of those that were measured.
///
/// Forms are those of [`ClosedForm::fit`] for six errors from 0.05 to 0.001. Axes are powers that are read with square roots, from the lowest
/// cosine and alpha on. Channels are [`Value::Bias`] and [`Value::Loss`]. There is always a table of 3 x 3 texels, whatever `max_bytes` is.
pub fn search_beside_form(
    distribution: Distribution,
    masking: Masking,
    max_abs: f64,
    [min_cos, min_alpha]: [f64; 2],
    max_bytes: usize,
) -> Found {
    let judge = Judge::new(distribution, masking, [min_cos, min_alpha]);
    let mut best: Option<Found> = None;
    for limit in FORMS {
        let form = ClosedForm::fit(distribution, masking, limit, min_cos, min_alpha).form;
        let mut candidates = judge.candidates(&Base { form, amplitude: 1.0 }, max_bytes);
        candidates.sort_by(|a, b| a.error.total_cmp(&b.error));
        let held = candidates.partition_point(|candidate| candidate.error <= max_abs);
        // Those that may hold by size; else the most accurate.
        candidates.truncate(held.max(1));
        candidates.sort_by_key(|candidate| candidate.table.bytes());
        for Candidate { table, .. } in candidates.into_iter().take(MEASURED) {
            let texels = table.bake_from(Some(&judge.surface));
            let error = table.error(&texels, min_cos, min_alpha);
            let found = Found { held: error.max_abs_err <= max_abs, table, texels, error };
            if found.held {
                return found;
            }
            if best.as_ref().is_none_or(|best| found.error.max_abs_err < best.error.max_abs_err) {
                best = Some(found);
            }
        }
    }
    best.unwrap_or_else(|| unreachable!("one candidate of every form is measured"))
}

impl Judge {
    fn new(distribution: Distribution, masking: Masking, lowest: [f64; 2]) -> Self {
        let surface = SplitSumSurface::new(distribution, masking);
        // Denser towards the lower ends, as the measurement of forms.
        let at = |axis: usize, i: u32| {
            let u = f64::from(i) / f64::from(POINTS - 1);
            (lowest[axis] + (1.0 - lowest[axis]) * u * u).min(1.0)
        };
        let points = (0..POINTS)
            .flat_map(|j| {
                let alpha = at(1, j);
                let row = surface.row(alpha);
                (0..POINTS).map(move |i| ([at(0, i), alpha], row.at(at(0, i))))
            })
            .collect();
        Self { distribution, masking, lowest, surface, points }
    }

    /// Tables beside a form, up to a size.
    fn candidates(&self, base: &Base, max_bytes: usize) -> Vec<Candidate> {
        let sizes = SIDES.into_iter().flat_map(|width| SIDES.map(|height| [width, height]));
        let exponents = EXPONENTS.into_iter().flat_map(|cos| EXPONENTS.map(|alpha| [cos, alpha]));
        let statements: Vec<DfgTable> = sizes
            .flat_map(|size| exponents.clone().map(move |exponents| (size, exponents)))
            .map(|(size, exponents)| DfgTable {
                distribution: self.distribution,
                masking: self.masking,
                layout: Layout::powers(self.lowest, exponents, Nodes::Ends),
                values: vec![Value::Bias, Value::Loss],
                size,
                stored: Stored::Unorm8,
                base: Some(base.clone()),
            })
            .filter(|table| table.bytes() <= max_bytes || table.size == [SIDES[0]; 2])
            .collect();
        let sums: Vec<SplitSum> = self.points.iter().map(|&([cos, alpha], _)| base.sum(alpha, cos)).collect();
        statements.into_par_iter().map(|table| self.candidate(table, base, &sums)).collect()
    }

    /// The table with the amplitude that its texels need, judged.
    fn candidate(&self, mut table: DfgTable, base: &Base, sums: &[SplitSum]) -> Candidate {
        let texels = DfgTable { stored: Stored::Float, ..table.clone() }.bake_from(Some(&self.surface));
        let rest = texels.data.iter().fold(0.0, |most, v| f64::max(most, (2.0 * f64::from(*v) - 1.0).abs()));
        table.base = Some(Base { amplitude: base.amplitude * rest * MARGIN, ..base.clone() });
        let texels = table.bake_from(Some(&self.surface));
        let worst = |worst: f64, (&([cos, alpha], exact), &form): (&([f64; 2], SplitSum), &SplitSum)| {
            let read = table.read_beside(&texels, [libm::acos(cos), alpha], form);
            let exact = table.of_split_sum(exact);
            read.iter().zip(exact).fold(worst, |worst, (read, exact)| worst.max((read - exact).abs()))
        };
        let error = self.points.iter().zip(sums).fold(0.0, worst);
        Candidate { table, error }
    }
}
