//! Domains, derived from verdicts.

use luthier_manifest::ShadingModel;
use luthier_model::Quantity;
use serde::{Deserialize, Serialize};

use super::case::StressCase;
use super::{Cell, Verdict};

/// The range of a quantity over which a model may be used.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DomainRange {
    /// Name of the model.
    pub model: String,
    /// Name of the quantity.
    pub quantity: String,
    /// Ends of the tried values around the ordinary one without a failure at any level; `None` if the ordinary value failed.
    pub usable: Option<[f64; 2]>,
    /// Ends of the tried values around the ordinary one that hold at all levels.
    pub holds: Option<[f64; 2]>,
    /// Smallest and largest value that was tried.
    pub tried: [f64; 2],
}

/// The domains of the models that shaders have.
pub fn derived(cases: &[StressCase], cells: &[Cell]) -> Vec<DomainRange> {
    let mut out = Vec::new();
    for model in ShadingModel::ALL {
        for quantity in Quantity::ALL {
            let mut swept: Vec<(f64, Verdict)> = cases
                .iter()
                .filter_map(|case| {
                    let (_, value) = case.swept.filter(|(q, _)| *q == quantity)?;
                    let of_case = cells.iter().filter(|c| c.method == model.name() && c.case == case.id);
                    Some((value, of_case.map(|c| c.verdict).max()?))
                })
                .collect();
            swept.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (Some(first), Some(last)) = (swept.first(), swept.last()) else { continue };
            out.push(DomainRange {
                model: model.name().to_owned(),
                quantity: quantity.name().to_owned(),
                usable: range(&swept, quantity.ordinary(), Verdict::Degrades),
                holds: range(&swept, quantity.ordinary(), Verdict::Holds),
                tried: [first.0, last.0],
            });
        }
    }
    out
}

/// Ends of the values around the ordinary one with verdicts no worse than `worst`.
fn range(swept: &[(f64, Verdict)], ordinary: f64, worst: Verdict) -> Option<[f64; 2]> {
    let start = swept.iter().position(|(value, _)| *value >= ordinary).unwrap_or(swept.len() - 1);
    if swept[start].1 > worst {
        return None;
    }
    let fits = |index: &usize| swept[*index].1 <= worst;
    let low = (0..=start).rev().take_while(fits).last().unwrap_or(start);
    let high = (start..swept.len()).take_while(fits).last().unwrap_or(start);
    Some([swept[low].0, swept[high].0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_ends_before_the_first_failure_on_either_side() {
        use Verdict::{Degrades, Fails, Holds};
        let swept =
            [(1.0, Holds), (2.0, Fails), (3.0, Degrades), (4.0, Holds), (5.0, Holds), (6.0, Degrades), (7.0, Fails)];
        assert_eq!(range(&swept, 4.0, Degrades), Some([3.0, 6.0]));
        assert_eq!(range(&swept, 4.0, Holds), Some([4.0, 5.0]));
        assert_eq!(range(&swept, 2.0, Degrades), None);
        assert_eq!(range(&swept, 99.0, Holds), None);
    }
}
