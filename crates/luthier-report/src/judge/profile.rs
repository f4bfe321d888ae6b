//! Profiles that charts are drawn from: errors by angle, and counts of errors above thresholds.

use serde::{Deserialize, Serialize};

use crate::measure::directions::Pair;
use crate::measure::statistics::{FLOOR, brightest, relative_error};
use crate::text::format;
use luthier_optics::Rgb;

/// Bins of [`AngleProfile`], 3 degrees each.
pub const ANGLE_BINS: usize = 30;

/// Largest relative error (floor [`FLOOR`]) by the larger of the two angles to the normal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AngleProfile {
    /// Largest errors from 0 to 90 degrees in equal bins, in four significant digits; `None` for a bin without pairs.
    pub max: Vec<Option<f64>>,
}

impl AngleProfile {
    /// A profile without pairs.
    pub(crate) fn new() -> Self {
        Self { max: vec![None; ANGLE_BINS] }
    }

    /// Adds pairs with their values. Samples that are not finite are ignored.
    pub(crate) fn add(&mut self, pairs: &[Pair], found: &[Rgb], expected: &[Rgb]) {
        for (((wi, wo), found), expected) in pairs.iter().zip(found).zip(expected) {
            let cos = f64::from(wi[2].min(wo[2]));
            let degrees = libm::acos(cos.clamp(0.0, 1.0)).to_degrees();
            let bin = ((degrees / 90.0 * ANGLE_BINS as f64) as usize).min(ANGLE_BINS - 1);
            for channel in 0..3 {
                let error = relative_error(found[channel], expected[channel], brightest(expected), FLOOR);
                let slot = &mut self.max[bin];
                if error.is_finite() && slot.is_none_or(|max| error > max) {
                    *slot = Some(format::rounded(error, 4));
                }
            }
        }
    }
}

/// Counts of relative errors (floor [`FLOOR`]) in classes of a quarter decade.
///
/// ```
/// use luthier_report::Exceedance;
///
/// // Three samples below 1e-9, one from 1e-9 to the next threshold.
/// let shares = Exceedance { counts: vec![3, 1] }.shares();
/// assert_eq!(shares, [(1e-9, 0.25), (Exceedance::threshold(1), 0.0)]);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exceedance {
    /// `counts[0]` are below [`Exceedance::MIN`]; `counts[k]` lie from `threshold(k - 1)` to `threshold(k)`; the last
    /// class is open.
    pub counts: Vec<u64>,
}

impl Exceedance {
    /// Lower end of the first closed class.
    pub const MIN: f64 = 1e-9;
    const PER_DECADE: usize = 4;
    const DECADES: usize = 10;

    /// An exceedance without samples.
    pub(crate) fn new() -> Self {
        Self { counts: vec![0; Self::PER_DECADE * Self::DECADES + 2] }
    }

    /// The k-th threshold: `MIN 10^(k/4)`.
    pub fn threshold(k: usize) -> f64 {
        Self::MIN * libm::pow(10.0, k as f64 / Self::PER_DECADE as f64)
    }

    pub(crate) fn add(&mut self, found: &[Rgb], expected: &[Rgb]) {
        for (found, expected) in found.iter().zip(expected) {
            for channel in 0..3 {
                let error = relative_error(found[channel], expected[channel], brightest(expected), FLOOR);
                if error.is_finite() {
                    let last = self.counts.len() - 1;
                    let class = if error < Self::MIN {
                        0
                    } else {
                        (libm::log10(error / Self::MIN) * Self::PER_DECADE as f64) as usize + 1
                    };
                    self.counts[class.min(last)] += 1;
                }
            }
        }
    }

    /// Adds the counts of another.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(&other.counts) {
            *mine += theirs;
        }
    }

    /// `(error, share of the samples at or above it)` at every threshold up to the first that none reaches.
    pub fn shares(&self) -> Vec<(f64, f64)> {
        let total: u64 = self.counts.iter().sum();
        let mut above = total;
        let mut out = Vec::new();
        for (k, count) in self.counts.iter().enumerate() {
            above -= count;
            if total > 0 {
                out.push((Self::threshold(k), above as f64 / total as f64));
            }
            if above == 0 {
                break;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_falls_into_the_bin_of_its_larger_angle() {
        let mut p = AngleProfile::new();
        let s = 0.5_f32.sqrt();
        p.add(&[([0.0, 0.0, 1.0], [s, 0.0, s])], &[[1.1, 1.0, f64::NAN]], &[[1.0; 3]]);
        let filled: Vec<usize> = (0..ANGLE_BINS).filter(|&b| p.max[b].is_some()).collect();
        assert!(filled == [15] || filled == [14], "45 degrees is a bin edge: {filled:?}");
        assert!((p.max[filled[0]].unwrap() - 0.1).abs() < 1e-12);
    }

    #[test]
    fn shares_by_hand() {
        let mut e = Exceedance::new();
        // Errors 0, 0.1 and 1e-4 (relative to 1).
        e.add(&[[1.0, 1.1, 1.0001]], &[[1.0; 3]]);
        let shares = e.shares();
        let share_at = |x: f64| shares.iter().rfind(|(t, _)| *t <= x * 1.000_001).unwrap().1;
        assert!((share_at(1e-6) - 2.0 / 3.0).abs() < 1e-12);
        assert!((share_at(1e-2) - 1.0 / 3.0).abs() < 1e-12);
        let (last, none) = *shares.last().unwrap();
        assert!(none == 0.0 && last > 0.09 && last < 0.2, "nothing is above 0.1: {last}");
    }
}
