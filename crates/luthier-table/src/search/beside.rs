//! The search for the cheapest closed form that holds an error together with a small table.

use luthier_optics::split_sum::{Masking, SplitSum, SplitSumSurface};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use super::Found;
use crate::{Base, ClosedForm, Cost, DfgTable, Layout, Nodes, Stored, Value};

/// Degrees of the tried forms with straight rests: of the loss in t and alpha, of the cosine in t and r.
const STRAIGHT: [[[usize; 2]; 2]; 5] =
    [[[2, 1], [1, 1]], [[2, 2], [1, 2]], [[3, 2], [1, 3]], [[3, 2], [2, 2]], [[3, 3], [2, 3]]];
/// Errors of the tried forms with small rests. They cost more than forms with straight rests.
const SMALL: [f64; 3] = [5e-3, 2e-3, 1e-3];
/// Exponents of the tried axes, of cosines and of alpha: the cheaper to read come first. All are read by square roots.
const EXPONENTS: [[f64; 2]; 4] = [[2.0, 2.0], [2.0, 4.0], [4.0, 2.0], [4.0, 4.0]];
/// Number types that are tried, the smaller first.
const STORED: [Stored; 2] = [Stored::Unorm8, Stored::Half];
/// Sides that are tried.
const SIDES: [u32; 18] = [3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 48, 64];
/// Points at which candidates are judged, along each axis.
const POINTS: u32 = 64;
/// Most candidates that are measured beside one form.
const MEASURED: usize = 4;
/// Ratio of the amplitude of a base to the largest rest. It exceeds 1, so that bytes hold both ends.
const MARGIN: f64 = 1.001;

/// A table beside a form, and its error at the points of the judge, which are few.
struct Candidate {
    table: DfgTable,
    error: f64,
}

/// The exact split sums that candidates are compared with.
struct Judge {
    distribution: Distribution,
    masking: Masking,
    /// Cosine and alpha.
    lowest: [f64; 2],
    surface: SplitSumSurface,
    /// At thetas and alphas.
    points: Vec<([f64; 2], SplitSum)>,
}

/// The cheapest table beside a closed form ([`DfgTable::base`]) whose texels take at most `max_bytes` and whose reads
/// err by at most `max_abs`, over cosines and alphas from the given ones on. The cost is [`DfgTable::cost`], to a few
/// operations; beside one form the smallest table is taken. If none holds the error, the most accurate of the measured
/// ones.
///
/// Forms are of two kinds: polynomials with straight rests, in half floats or bytes, and beyond their reach the forms
/// of [`ClosedForm::fit`] with small rests. Axes are powers that are read with square roots, from the lowest cosine and
/// alpha on. Channels are [`Value::Bias`] and [`Value::Loss`]. A table of 3 x 3 texels is always allowed, whatever
/// `max_bytes` is.
pub fn search_beside_form(
    distribution: Distribution,
    masking: Masking,
    max_abs: f64,
    [min_cos, min_alpha]: [f64; 2],
    max_bytes: usize,
) -> Found {
    let judge = Judge::new(distribution, masking, [min_cos, min_alpha]);
    let mut best: Option<Found> = None;
    for (form, layouts) in judge.straight().into_iter().chain(judge.small()) {
        let mut candidates = judge.candidates(&form, &layouts, max_bytes);
        candidates.sort_by(|a, b| a.error.total_cmp(&b.error));
        let held = candidates.partition_point(|candidate| candidate.error <= max_abs);
        // Candidates that may hold the error, by size; else the most accurate.
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
        // Denser towards the lower ends, as in the measurement of forms.
        let [cosines, alphas] = lowest.map(|lowest| {
            let parts = (0..POINTS).map(|i| f64::from(i) / f64::from(POINTS - 1));
            parts.map(|u| (lowest + (1.0 - lowest) * u * u).min(1.0)).collect::<Vec<f64>>()
        });
        let points = alphas.iter().flat_map(|&alpha| {
            let row = surface.row(alpha);
            cosines.iter().map(move |&cos| ([libm::acos(cos), alpha], row.at(cos)))
        });
        let points = points.collect();
        Self { distribution, masking, lowest, surface, points }
    }

    /// Polynomials with straight rests, each with its axes, sorted by the cost of a read.
    fn straight(&self) -> Vec<(ClosedForm, Vec<Layout>)> {
        let mut all = Vec::new();
        for degrees in STRAIGHT {
            for layout in EXPONENTS.map(|exponents| self.layout(exponents)) {
                let form = ClosedForm::straightest(self.distribution, self.masking, &self.surface, &layout, degrees);
                all.push((form, vec![layout]));
            }
        }
        all.sort_by_key(|(form, layouts)| {
            self.table(form, layouts[0], SIDES[0], SIDES[0], Stored::Half).cost().map(Cost::slots)
        });
        all
    }

    /// Forms with small rests, with all axes.
    fn small(&self) -> impl Iterator<Item = (ClosedForm, Vec<Layout>)> {
        let layouts = EXPONENTS.map(|exponents| self.layout(exponents)).to_vec();
        SMALL.into_iter().map(move |limit| {
            let [min_cos, min_alpha] = self.lowest;
            (ClosedForm::fit(self.distribution, self.masking, limit, min_cos, min_alpha).form, layouts.clone())
        })
    }

    fn layout(&self, exponents: [f64; 2]) -> Layout {
        Layout::powers(self.lowest, exponents, Nodes::Ends)
    }

    fn table(&self, form: &ClosedForm, layout: Layout, width: u32, height: u32, stored: Stored) -> DfgTable {
        DfgTable {
            distribution: self.distribution,
            masking: self.masking,
            layout,
            values: vec![Value::Bias, Value::Loss],
            size: [width, height],
            stored,
            base: Some(Base::plain(form.clone())),
        }
    }

    /// Tables beside a form, up to a size.
    fn candidates(&self, form: &ClosedForm, layouts: &[Layout], max_bytes: usize) -> Vec<Candidate> {
        let sizes = SIDES.into_iter().flat_map(|width| SIDES.map(|height| (width, height)));
        let statements: Vec<DfgTable> = sizes
            .flat_map(|(width, height)| STORED.map(|stored| (width, height, stored)))
            .flat_map(|(width, height, stored)| {
                layouts.iter().map(move |&layout| self.table(form, layout, width, height, stored))
            })
            .filter(|table| table.bytes() <= max_bytes || table.size == [SIDES[0]; 2])
            .collect();
        let base = Base::plain(form.clone());
        let sums: Vec<SplitSum> =
            self.points.iter().map(|&([theta, alpha], _)| base.sum(alpha, libm::cos(theta))).collect();
        statements.into_par_iter().map(|table| self.candidate(table, form, &sums)).collect()
    }

    /// Measures a table at the points, after its bytes got the amplitude that they need.
    fn candidate(&self, mut table: DfgTable, form: &ClosedForm, sums: &[SplitSum]) -> Candidate {
        if table.stored == Stored::Unorm8 {
            let rests = DfgTable { stored: Stored::Float, ..table.clone() }.bake_from(Some(&self.surface));
            let most = rests.data.iter().fold(0.0, |most, rest| f64::max(most, f64::from(*rest).abs()));
            table.base = Some(Base::normalised(form.clone(), most * MARGIN));
        }
        let texels = table.bake_from(Some(&self.surface));
        let mut error = 0.0_f64;
        for (&(at, exact), &form) in self.points.iter().zip(sums) {
            let (read, exact) = (table.read_beside(&texels, at, form), table.of_split_sum(exact));
            error = read.iter().zip(exact).fold(error, |worst, (read, exact)| worst.max((read - exact).abs()));
        }
        Candidate { table, error }
    }
}
