//! Samples on which a shader misses the target, and their causes.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::judge::report::{Compared, Comparison};
use crate::measure::causes::{Factor, Factors, Miss, Part};
use crate::measure::directions::DirectionSet;
use crate::measure::statistics::WorstPair;

/// The most pairs whose cause is measured. They are taken evenly from all pairs that miss.
const ATTRIBUTED_MAX: usize = 512;

/// A material whose shader misses [`TARGET_MAX_REL_ERR`](crate::TARGET_MAX_REL_ERR) somewhere (without a device: whose tables do).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exception {
    /// Name of the material.
    pub material: String,
    /// Comparison in which the shader misses.
    pub compared: Compared,
    /// Finite samples, over all sets.
    pub samples: u64,
    /// Samples that miss the target.
    pub samples_above: u64,
    /// Least angle at which a pair misses, degrees: the larger of its two angles to the normal.
    pub least_angle_deg: f64,
    /// The set of the worst pair.
    pub set: DirectionSet,
    /// The worst pair.
    pub worst: WorstPair,
    /// Parts of the error of the worst pair, largest first.
    pub parts: Vec<Part>,
    /// Number of examined pairs on which each factor has the largest part, most frequent first. Up to some hundred of the pairs that miss are
    /// examined, evenly taken from all.
    pub tally: Vec<(Factor, u64)>,
}

/// The exception of a comparison; `None` if no pair misses.
pub(crate) fn exception(
    material: &str,
    comparison: &Comparison,
    misses: &[Miss],
    factors: &Factors<'_>,
) -> Option<Exception> {
    let compared = comparison.compared;
    let mut worst: Option<(DirectionSet, &WorstPair)> = None;
    for (set, statistics) in &comparison.sets {
        if let Some(pair) = &statistics.worst
            && worst.is_none_or(|(_, w)| pair.error > w.error)
        {
            worst = Some((*set, pair));
        }
    }
    let (set, worst) = worst?;
    let miss = Miss::of(worst, misses)?;

    let stride = misses.len().div_ceil(ATTRIBUTED_MAX).max(1);
    let taken: Vec<&Miss> = misses.iter().step_by(stride).collect();
    let causes: Vec<Option<Factor>> =
        taken.par_iter().map(|miss| factors.parts(miss).first().map(|part| part.cause.factor())).collect();
    let mut tally: Vec<(Factor, u64)> = Factor::ALL
        .map(|factor| (factor, causes.iter().filter(|c| **c == Some(factor)).count() as u64))
        .into_iter()
        .filter(|(_, count)| *count > 0)
        .collect();
    tally.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let statistics = comparison.sets.iter().map(|(_, s)| s);
    Some(Exception {
        material: material.to_owned(),
        compared,
        samples: statistics.clone().map(|s| 3 * s.pairs - s.not_finite).sum(),
        samples_above: statistics.map(|s| s.above_target).sum(),
        least_angle_deg: misses.iter().map(Miss::angle_deg).fold(90.0, f64::min),
        set,
        worst: worst.clone(),
        parts: factors.parts(&miss),
        tally,
    })
}
