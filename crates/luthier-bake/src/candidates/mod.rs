//! Candidates for tables: their errors and costs, and the choice among them.
//!
//! Every kind of table has candidates: sizes, axis mappings, texel formats, a closed form to add, or a closed form alone. All are
//! measured as a device samples them, against one fine truth per tile, in the same order whatever the budget: a tighter budget chooses
//! among fewer, so never fewer bytes. Of those that hold, the fewest bytes win, then the lowest cost.

mod choice;
pub(crate) mod grids;

use luthier_lut::{Axis, Mapping, RowBase, TableKind, TexelFormat, WeightBits};
use luthier_manifest::{Budget, Candidate, CandidateForm, MeasuredError, REL_FLOOR};
use luthier_optics::color_difference::{ciede2000, lab};
use serde::{Deserialize, Serialize};

pub(crate) use self::choice::{Refusal, best_effort, choose, locked, report};

/// Budget of tables for which none is stated: errors that a fixed row of 128 half floats has too.
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
    /// Whether the bake itself has measured each of the candidates.
    pub(crate) confirmed: Vec<bool>,
    /// Tiles, by number, that no candidate serves and that the others do not wait for.
    pub(crate) left_out: Vec<usize>,
    /// True if every tile was measured; otherwise the other candidates' errors are scaled by the ratio found for one.
    pub(crate) is_whole: bool,
}

/// The default budget (5e-4) may be exceeded fourfold: 2e-3 is half an 8-bit step. Beyond it some
/// interface is one that no table serves (the fringes of a thick film, total reflection by what absorbs), and the choice would be the best
/// for it alone.
const NEAR: f64 = 4.0;

/// The error that tables are to hold where no budget is stated; a tile beyond it is named by the bake.
pub const AIM: f64 = NEAR * 5e-4;

impl Found {
    /// Whether some candidate holds a budget, or nearly.
    pub(crate) fn comes_near(&self, budget: &Budget) -> bool {
        self.candidates.iter().any(|c| budget.excess(&c.error) <= NEAR)
    }

    pub(crate) fn new(kind: TableKind, fixed_cost: f64, candidates: Vec<Candidate>) -> Self {
        let confirmed = vec![false; candidates.len()];
        Self { kind, fixed_cost, candidates, confirmed, left_out: Vec::new(), is_whole: true }
    }

    /// Keeps the candidates whose read costs at most half as much again as one of the fixed default, for bakes without a stated budget.
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

    /// Cost of the way from a value to a node index.
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

    /// A filtered read; what is not filtered takes four fetches and is weighed by hand.
    pub(crate) fn read(format: TexelFormat) -> f64 {
        let fetch = FETCH * f64::from(format.texel_bytes().max(4)) / 4.0;
        if format.is_filterable() { 4.0 + fetch } else { 4.0 * fetch + 12.0 + 9.0 * f64::from(format.channels()) }
    }
}

/// Largest errors at points: `read` against the function. `slack` is added to absolute errors.
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

/// How devices weigh texels.
pub(crate) const WEIGHTS: WeightBits = WeightBits::Fixed(8);
