//! Candidates for tables: their errors and costs, and the choice among them.
//!
//! Every kind of table has candidates: sizes, axis mappings, texel formats, a closed form beside the texels, or a
//! closed form alone. All are measured as a device samples them, against one fine truth per tile. The order of
//! measurement does not depend on the budget, so a tighter budget chooses among fewer candidates and never saves bytes.
//! Among candidates within the budget, the fewest bytes win, then the lowest cost; of rows of lobes the lowest cost, then the fewest bytes.

mod choice;
pub(crate) mod grids;

use luthier_lut::{Axis, Mapping, RowBase, TableKind, TexelFormat, WeightBits};
use luthier_manifest::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR};
use luthier_optics::color_difference::{ciede2000, lab};
use serde::{Deserialize, Serialize};

pub(crate) use self::choice::{Refusal, best_effort, choose, locked, report};

/// Budget of tables without a stated one: the error of a fixed row of 128 half floats.
pub const DEFAULT_BUDGET: Budget = Budget {
    max_abs: Some(5e-4),
    max_rel: None,
    delta_e: None,
    max_bytes: None,
    max_cost: None,
    max_lobe_err: None,
    max_albedo_err: None,
};

/// The candidates for one kind.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Found {
    pub(crate) kind: TableKind,
    /// Cost of the fixed default.
    pub(crate) fixed_cost: f64,
    pub(crate) candidates: Vec<Candidate>,
    /// True for each candidate that the bake itself has measured.
    pub(crate) confirmed: Vec<bool>,
    /// Numbers of the tiles that no candidate serves. They do not count in the choice for the others.
    pub(crate) left_out: Vec<usize>,
    /// True if every tile was measured; otherwise the other candidates' errors are scaled by the ratio found for one.
    pub(crate) is_whole: bool,
}

/// The default budget (5e-4) may be exceeded fourfold: 2e-3 is half an 8-bit step. An interface beyond it is one that
/// no table serves (the fringes of a thick film, total reflection by an absorbing medium). A choice that counted it
/// would be the best for that interface alone.
const NEAR: f64 = 4.0;

/// Error that tables should hold without a stated budget. The bake names every tile beyond it.
pub const AIM: f64 = NEAR * 5e-4;

impl Found {
    /// True if a candidate holds a budget, or exceeds it by at most [`NEAR`].
    pub(crate) fn comes_near(&self, budget: &Budget) -> bool {
        self.candidates.iter().any(|c| budget.excess(&c.error) <= NEAR)
    }

    pub(crate) fn new(kind: TableKind, fixed_cost: f64, candidates: Vec<Candidate>) -> Self {
        let confirmed = vec![false; candidates.len()];
        Self { kind, fixed_cost, candidates, confirmed, left_out: Vec::new(), is_whole: true }
    }

    /// Keeps candidates whose read costs at most half more than one of the fixed default, for bakes without a stated
    /// budget.
    pub(crate) fn affordable(mut self) -> Self {
        let most = 1.5 * self.fixed_cost;
        self.candidates.retain(|c| c.cost <= most);
        self.confirmed.truncate(self.candidates.len());
        self
    }

    /// Records the bake's measured error if it is larger. Returns true if the search's estimate held.
    pub(crate) fn confirm(&mut self, choice: usize, exact: f64) -> bool {
        let found = self.candidates[choice].error.max_abs;
        let is_new = !std::mem::replace(&mut self.confirmed[choice], true);
        if exact <= found {
            return true;
        }
        self.candidates[choice].error.max_abs = exact;
        if !self.is_whole && is_new && found > 0.0 {
            let others = self.candidates.iter_mut().zip(&self.confirmed).filter(|(_, confirmed)| !**confirmed);
            others.for_each(|(candidate, _)| candidate.error.max_abs *= exact / found);
        }
        false
    }
}

/// Estimated costs, in operations on one number: see [`Candidate::cost`].
pub(crate) mod cost {
    use super::{Axis, Mapping, TexelFormat};

    /// A root, logarithm, exponential, division, sine.
    pub(crate) const QUARTER_RATE: f64 = 4.0;
    /// Fetch of 4 bytes.
    pub(crate) const FETCH: f64 = 16.0;

    /// Cost of the computation of a node index from a value.
    pub(crate) fn axis(axis: &Axis) -> f64 {
        let offset = if axis.min == 0.0 { 0.0 } else { 1.0 };
        offset
            + match axis.mapping {
                Mapping::Linear | Mapping::Periodic | Mapping::Apart => 2.0,
                Mapping::Power { exponent: 2.0 } => 2.0 + QUARTER_RATE,
                Mapping::Power { exponent: 4.0 } => 2.0 + 2.0 * QUARTER_RATE,
                Mapping::Power { exponent: 8.0 } => 2.0 + 3.0 * QUARTER_RATE,
                Mapping::Power { .. } => 3.0 + 2.0 * QUARTER_RATE,
                Mapping::Rational { .. } | Mapping::Logarithmic => 3.0 + QUARTER_RATE,
            }
    }

    /// Cost of a filtered read. Formats that are not filterable take four fetches, and weights by hand.
    pub(crate) fn read(format: TexelFormat) -> f64 {
        let fetch = FETCH * f64::from(format.texel_bytes().max(4)) / 4.0;
        if format.is_filterable() { 4.0 + fetch } else { 4.0 * fetch + 12.0 + 9.0 * f64::from(format.channels()) }
    }
}

/// Largest errors of `read` against a function at some points. `slack` is added to absolute errors.
pub(crate) fn measured<'p>(
    points: impl Iterator<Item = (&'p [f64; 2], [f64; 4])>,
    channels: usize,
    colors: bool,
    slack: f64,
    mut read: impl FnMut([f64; 2]) -> [f64; 4],
) -> MeasuredError {
    let mut error = MeasuredError { delta_e: colors.then_some(0.0), ..MeasuredError::default() };
    for (at, expected) in points {
        let found = read(*at);
        let largest = (0..channels).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max) + slack;
        let brightest = expected[..channels.min(3)].iter().copied().fold(REL_FLOOR, f64::max);
        error.max_abs = error.max_abs.max(largest);
        error.max_rel = error.max_rel.max(largest / brightest);
        if let Some(worst) = &mut error.delta_e {
            let [found, expected] = [found, expected].map(|[r, g, b, _]| lab([r, g, b]));
            *worst = worst.max(ciede2000(found, expected));
        }
    }
    error
}

/// A table of one row.
pub(crate) fn row_form(x: Axis, format: TexelFormat, base: RowBase) -> CandidateForm {
    CandidateForm::Table { x, y: None, format, base }
}

/// Precision of a device's filter weights.
pub(crate) const WEIGHTS: WeightBits = WeightBits::Fixed(8);
