//! Errors of many values at once: divisors of relative errors, order statistics. Spreads of measured times.

use std::f64::consts::FRAC_1_PI;

use luthier_optics::Rgb;
use serde::{Deserialize, Serialize};

use crate::measure::directions::Pair;

/// The floor of relative errors: a tenth of the value of a white diffuser in light along its normal (`f cos_theta_i` = 1/pi).
///
/// Above the floor an error is relative to the brightest channel of the colour. Below it, a relative error of 1e-3 is an absolute one of 1e-4 of
/// diffuse white: a third of the darkest step of an 8-bit sRGB picture (1/(255 x 12.92) = 3.0e-4) that is exposed for that white.
pub const FLOOR: f64 = 0.1 * FRAC_1_PI;

/// A second floor, a hundred times lower: a thousandth of diffuse white. It shows errors that [`FLOOR`] hides, and that very long exposures or very
/// bright lights would reveal.
pub const DIM_FLOOR: f64 = 1e-3 * FRAC_1_PI;

/// The third floor, as a fraction of the largest value of the set. It shows the error of the highlight alone.
pub const PEAK_FRACTION: f64 = 0.1;

/// The target: the largest error of a shader against f64, relative to max(brightest channel of the reference, [`FLOOR`]).
/// The report lists every larger error as an exception, with its cause.
pub const TARGET_MAX_REL_ERR: f64 = 1e-3;

/// Number of standard errors by which an estimated table error must exceed the baker's before it counts.
pub(crate) const UNCERTAINTY_MARGIN: f64 = 4.0;

/// Order statistics of errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorSummary {
    /// Largest error.
    pub max: f64,
    /// 99th percentile, by nearest rank.
    pub p99: f64,
    /// Root mean square.
    pub rms: f64,
}

/// A pair of directions and the channel that is worst there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstPair {
    /// Direction to the light; exactly the f32 values that were used.
    pub wi: [f32; 3],
    /// Direction to the eye.
    pub wo: [f32; 3],
    /// Channel, 0-based.
    pub channel: u32,
    /// Reference there.
    pub expected: f64,
    /// Value that was judged.
    pub found: f64,
    /// Error relative to max(brightest channel of the reference, [`FLOOR`]).
    pub error: f64,
}

/// Errors of `f cos_theta_i` over a set of pairs. Every channel is a sample.
///
/// Values that are not finite are counted, and are in none of the other figures.
///
/// ```
/// use luthier_report::{FLOOR, statistics};
///
/// let up = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
/// // One sample of six is 0.1 off, beside a channel of 2; another is 0.001 off in the dark.
/// let found = statistics(&[up, up], &[[2.0, 1.1, 1.0], [0.001, 0.0, 0.0]], &[[2.0, 1.0, 1.0], [0.0; 3]]);
/// assert_eq!((found.above_target, found.not_finite), (2, 0));
/// assert!((found.relative.max - 0.05).abs() < 1e-12 && 0.001 / FLOOR < 0.05);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Pairs judged; three samples each.
    pub pairs: u64,
    /// Samples that are NaN or infinite.
    pub not_finite: u64,
    /// The first pair with such a sample.
    pub not_finite_at: Option<Pair>,
    /// Largest reference value of the set.
    pub peak: f64,
    /// Largest absolute error.
    pub max_abs_err: f64,
    /// Relative to max(brightest channel of the reference, [`FLOOR`]): the figure of merit.
    pub relative: ErrorSummary,
    /// Relative to max(brightest channel of the reference, [`DIM_FLOOR`]).
    pub relative_dim: ErrorSummary,
    /// Relative to max(brightest channel of the reference, [`PEAK_FRACTION`] x `peak`).
    pub relative_peak: ErrorSummary,
    /// Samples whose `relative` error exceeds [`TARGET_MAX_REL_ERR`].
    pub above_target: u64,
    /// The worst pair by `relative`.
    pub worst: Option<WorstPair>,
}

impl Statistics {
    /// The largest relative error; infinite if a sample is not finite.
    pub fn max_error(&self) -> f64 {
        if self.not_finite > 0 { f64::INFINITY } else { self.relative.max }
    }
}

/// |found - expected| / max(brightest, floor); not finite if a value is not.
pub(crate) fn relative_error(found: f64, expected: f64, brightest: f64, floor: f64) -> f64 {
    let error = (found - expected).abs() / brightest.max(floor);
    if expected.is_finite() { error } else { f64::NAN }
}

/// Divisor of a channel's error: the brightest channel of the colour. Interference or absorption may extinguish a channel, but an eye sees it beside
/// the others, not alone.
pub(crate) fn brightest(expected: &Rgb) -> f64 {
    expected.iter().fold(0.0, |sum: f64, c| sum.max(c.abs()))
}

/// Statistics of `found` against `expected`. Both are parallel to `pairs`; surplus values are ignored.
pub fn statistics(pairs: &[Pair], found: &[Rgb], expected: &[Rgb]) -> Statistics {
    let mut samples = Vec::with_capacity(3 * pairs.len());
    let mut not_finite = 0;
    let mut not_finite_at = None;
    let mut worst: Option<WorstPair> = None;
    let mut above_target = 0;
    let (mut peak, mut max_abs_err) = (0.0_f64, 0.0_f64);
    for ((&(wi, wo), found), expected) in pairs.iter().zip(found).zip(expected) {
        let bright = brightest(expected);
        for channel in 0..3 {
            let (found, expected) = (found[channel], expected[channel]);
            let error = relative_error(found, expected, bright, FLOOR);
            if !error.is_finite() {
                not_finite += 1;
                not_finite_at.get_or_insert((wi, wo));
                continue;
            }
            peak = peak.max(expected.abs());
            max_abs_err = max_abs_err.max((found - expected).abs());
            samples.push((found, expected, bright));
            above_target += u64::from(error > TARGET_MAX_REL_ERR);
            if worst.as_ref().is_none_or(|w| error > w.error) {
                worst = Some(WorstPair { wi, wo, channel: channel as u32, expected, found, error });
            }
        }
    }
    let [relative, relative_dim, relative_peak] = [FLOOR, DIM_FLOOR, PEAK_FRACTION * peak].map(|floor| {
        // A set whose reference is zero throughout has no peak to be relative to.
        let floor = if floor > 0.0 { floor } else { FLOOR };
        summarise(
            samples.iter().map(|&(found, expected, bright)| relative_error(found, expected, bright, floor)).collect(),
        )
    });
    Statistics {
        pairs: pairs.len() as u64,
        not_finite,
        not_finite_at,
        peak,
        max_abs_err,
        relative,
        relative_dim,
        relative_peak,
        above_target,
        worst,
    }
}

/// Order statistics of finite errors; zeros when there are none.
pub(crate) fn summarise(mut errors: Vec<f64>) -> ErrorSummary {
    let count = errors.len();
    if count == 0 {
        return ErrorSummary { max: 0.0, p99: 0.0, rms: 0.0 };
    }
    let max = errors.iter().copied().fold(0.0, f64::max);
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / count as f64).sqrt();
    let rank = (count * 99).div_ceil(100).clamp(1, count) - 1;
    let (_, &mut p99, _) = errors.select_nth_unstable_by(rank, f64::total_cmp);
    ErrorSummary { max, p99, rms }
}

/// Order statistics of repeated measurements, in the unit of the samples; NaN without samples.
///
/// ```
/// // One run was interrupted: median and deviation ignore it, the percentile does not.
/// let spread = luthier_report::Spread::of(&[9.0, 1.0, 2.0, 3.0, 4.0]);
/// assert_eq!((spread.median, spread.mad), (3.0, 1.0));
/// assert!(spread.p90 > 6.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// Median absolute deviation from it.
    pub mad: f64,
    /// Tenth percentile.
    pub p10: f64,
    /// Ninetieth percentile.
    pub p90: f64,
}

impl Spread {
    /// The spread of samples in any order.
    pub fn of(samples: &[f64]) -> Self {
        let median = quantile(samples, 0.5);
        let apart: Vec<f64> = samples.iter().map(|sample| (sample - median).abs()).collect();
        Self { median, mad: quantile(&apart, 0.5), p10: quantile(samples, 0.1), p90: quantile(samples, 0.9) }
    }
}

/// A quantile, interpolated linearly between the nearest two samples.
fn quantile(samples: &[f64], q: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q * last as f64;
    let (below, above) = (sorted[at as usize], sorted[(at as usize + 1).min(last)]);
    below + (above - below) * at.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_samples() {
        let samples = [4.0, 1.0, 3.0, 2.0];
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(|q| quantile(&samples, q)), [1.0, 2.5, 3.25, 4.0]);
        assert_eq!(quantile(&[7.0], 0.9), 7.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn a_spread_by_hand() {
        let s = Spread::of(&[9.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!((s.median, s.mad), (3.0, 1.0));
        assert!((s.p10 - 1.4).abs() < 1e-12 && (s.p90 - 7.0).abs() < 1e-12, "{s:?}");
    }

    const UP: Pair = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);

    #[test]
    fn order_statistics_by_hand() {
        // 1..=200: nearest rank of 99% is the 198th; mean square is (n + 1)(2n + 1)/6.
        let s = summarise((1..=200).rev().map(f64::from).collect());
        assert_eq!((s.max, s.p99), (200.0, 198.0));
        assert!((s.rms - (201.0_f64 * 401.0 / 6.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn floors_by_hand() {
        // One bright grey 1% off in one channel, one dark one off by 0.001.
        let s = statistics(&[UP, UP], &[[10.1, 10.0, 0.5], [0.001, 0.0, 0.0]], &[[10.0, 10.0, 0.5], [0.0; 3]]);
        assert_eq!(s.peak, 10.0);
        assert!((s.max_abs_err - 0.1).abs() < 1e-12);
        assert!((s.relative.max - 0.001 / FLOOR).abs() < 1e-12, "dark sample over the floor: 0.0314");
        assert!((s.relative_dim.max - 0.001 / DIM_FLOOR).abs() < 1e-9, "3.14");
        assert!((s.relative_peak.max - 0.01).abs() < 1e-12, "floor is 1.0: the bright sample's 1%");
        let worst = s.worst.unwrap();
        assert_eq!((worst.channel, worst.found), (0, 0.001));
        assert_eq!(s.above_target, 2, "both that are off");
    }

    #[test]
    fn values_that_are_not_finite_are_counted_and_make_the_error_infinite() {
        let found = [[f64::NAN, 1.0, f64::INFINITY], [1.0, 1.0, 1.0]];
        let s = statistics(&[UP, UP], &found, &[[1.0; 3], [1.0; 3]]);
        assert_eq!((s.not_finite, s.not_finite_at), (2, Some(UP)));
        assert_eq!(s.relative.max, 0.0);
        assert_eq!(s.max_error(), f64::INFINITY);
        let s = statistics(&[UP], &[[1.0; 3]], &[[f64::INFINITY; 3]]);
        assert_eq!(s.not_finite, 3, "a reference that is not finite is no reference");
    }

    #[test]
    fn the_worst_pair_is_that_of_the_largest_error() {
        let pairs = [UP; 3];
        let s = statistics(&pairs, &[[1.1; 3], [1.0, 1.0, 1.5], [1.0005; 3]], &[[1.0; 3]; 3]);
        let worst = s.worst.unwrap();
        assert_eq!((worst.error, worst.channel), (0.5, 2));
        assert_eq!(s.above_target, 4);
    }
}
