//! The search for the smallest table that holds an error.

mod beside;

use luthier_lut::{ErrorStats, Image};
use luthier_optics::split_sum::{Masking, SplitSumSurface};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use crate::{DfgTable, Layout, Nodes, Stored, Value};

pub use beside::search_beside_form;

/// Exponents of the axes that are tried: of cosines, and of alpha.
const EXPONENTS: [&[f64]; 2] = [&[1.5, 2.0, 2.5, 3.0], &[2.0, 2.5, 3.0, 4.0]];
/// Sides that are tried.
const SIDES: [u32; 17] = [8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 40, 48, 56, 64, 96, 128];
/// Points of the scans of candidates, along each axis.
const POINTS: u32 = 48;

/// Channels from which scale and bias follow, near 0 where half floats are fine.
pub const SPLIT_SUM: [Value; 2] = [Value::Bias, Value::Loss];

/// The outcome of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The table.
    pub table: DfgTable,
    /// Its texels.
    pub texels: Image,
    /// Its error, against quadrature.
    pub error: ErrorStats,
    /// Whether the error is within the limit.
    pub held: bool,
}

/// The smallest table of half floats whose reads err by at most `max_abs`, over cosines and alphas from the given ones
/// on. Of tables of one size the most accurate is taken; if none holds the error, the most accurate of 128 x 128
/// texels.
///
/// Axes are powers or logarithms, from the lowest cosine and alpha on; lower ones read as these. Channels are of the
/// split sum, such as [`SPLIT_SUM`].
pub fn search(
    distribution: Distribution,
    masking: Masking,
    values: &[Value],
    max_abs: f64,
    min_cos: f64,
    min_alpha: f64,
) -> Found {
    let surface = SplitSumSurface::new(distribution, masking);
    let mut best: Option<Found> = None;
    for (index, side) in SIDES.into_iter().enumerate() {
        // Between two squares comes a size with one longer side.
        let next = SIDES.get(index + 1).copied();
        let sizes = [Some([side, side]), next.map(|next| [next, side]), next.map(|next| [side, next])];
        let candidates: Vec<DfgTable> = sizes
            .into_iter()
            .flatten()
            .flat_map(|size| layouts(min_cos, min_alpha).map(move |layout| (size, layout)))
            .map(|(size, layout)| DfgTable {
                distribution,
                masking,
                layout,
                values: values.to_vec(),
                size,
                stored: Stored::Half,
                base: None,
            })
            .collect();
        let errors: Vec<f64> = candidates
            .par_iter()
            .map(|table| {
                let texels = table.bake_from(Some(&surface));
                let error = table.error_against(&texels, [min_cos, min_alpha], POINTS, |alpha, cos| {
                    table.of_split_sum(surface.row(alpha).at(cos))
                });
                error.max_abs_err
            })
            .collect();
        // Sorted by size, then by error: squares come first.
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        let texels: Vec<u32> = candidates.iter().map(|table| table.size[0] * table.size[1]).collect();
        order.sort_by(|&a, &b| texels[a].cmp(&texels[b]).then(errors[a].total_cmp(&errors[b])));
        let is_last = next.is_none();
        let promising = order.into_iter().filter(|&i| is_last || errors[i] <= max_abs);
        for i in promising.take(if is_last { 1 } else { 6 }) {
            let table = candidates[i].clone();
            let texels = table.bake_from(Some(&surface));
            let error = table.error(&texels, min_cos, min_alpha);
            let held = error.max_abs_err <= max_abs;
            let found = Found { table, texels, error, held };
            if held {
                return found;
            }
            best = Some(found);
        }
    }
    best.unwrap_or_else(|| unreachable!("the last side is always measured"))
}

fn layouts(min_cos: f64, min_alpha: f64) -> impl Iterator<Item = Layout> + Clone {
    let lowest = [min_cos, min_alpha];
    let exponents = EXPONENTS[0].iter().flat_map(|&cos| EXPONENTS[1].iter().map(move |&alpha| [cos, alpha]));
    let powers = exponents.map(move |exponents| Layout::powers(lowest, exponents, Nodes::Ends));
    let has_logarithms = min_cos > 0.0 && min_alpha > 0.0;
    powers.chain(has_logarithms.then(|| Layout::logarithms(lowest, Nodes::Ends)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_limits_take_larger_tables() {
        let bytes = |max_abs: f64| {
            let found = search(Distribution::Ggx, Masking::SmithCorrelated, &SPLIT_SUM, max_abs, 0.02, 0.02);
            assert!(found.held && found.error.max_abs_err <= max_abs);
            found.table.size[0] * found.table.size[1]
        };
        assert!(bytes(1e-2) < bytes(2e-3));
    }

    #[test]
    fn an_error_beyond_half_floats_is_not_held() {
        let found = search(Distribution::Ggx, Masking::SmithCorrelated, &SPLIT_SUM, 1e-6, 0.02, 0.02);
        assert!(!found.held && found.error.max_abs_err > 1e-6);
        assert_eq!(found.table.size, [128, 128]);
    }
}
