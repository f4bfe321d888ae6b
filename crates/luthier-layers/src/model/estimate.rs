//! Monte Carlo mean with its standard error.

/// Squares of smaller means underflow.
const TINY: f64 = 1e-150;

/// Relative spread that rounding leaves between equal samples: weights are products of up to a few thousand factors.
const ROUNDING: f64 = 1e-12;

/// Fewer samples than this do not carry a standard error: see [`Estimate::is_settled`].
const SUPPORT_MIN: f64 = 8.0;

/// Mean of independent samples, with its standard error.
///
/// ```
/// use luthier_layers::model::Estimate;
///
/// // The error of a sum of independent estimates: the root of 3^2 + 4^2.
/// let sum = Estimate::sum([(1.0, Estimate::known(2.0, 3.0)), (2.0, Estimate::known(1.0, 2.0))]);
/// assert_eq!((sum.mean, sum.std_err), (4.0, 5.0));
/// assert!(sum.agrees_with(13.0, 2.0) && !sum.agrees_with(15.0, 2.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Standard error of the mean, from the spread of the samples; 0 for exact values. It is infinite if the estimate has not settled: the observed
    /// spread then says nothing about the error, see [`Estimate::is_settled`].
    pub std_err: f64,
    /// Observed variance of the mean.
    variance: f64,
    /// Number of samples that the variance rests on.
    support: f64,
}

impl Estimate {
    /// An exact value.
    pub fn exact(mean: f64) -> Self {
        Self::known(mean, 0.0)
    }

    /// A value whose standard error is known.
    pub fn known(mean: f64, std_err: f64) -> Self {
        Self { mean, std_err, variance: std_err * std_err, support: f64::INFINITY }
    }

    /// A value without any known error.
    fn unsettled(mean: f64) -> Self {
        Self { mean, std_err: f64::INFINITY, variance: f64::INFINITY, support: 0.0 }
    }

    fn new(mean: f64, variance: f64, support: f64) -> Self {
        let std_err = if support < SUPPORT_MIN { f64::INFINITY } else { libm::sqrt(variance) };
        Self { mean, std_err, variance, support }
    }

    /// Whether the standard error can be believed.
    ///
    /// A variance is itself a mean, of squared deviations. If a few samples make most of it, rare paths carry the light: more of them may have been
    /// missed than met, and the observed spread says nothing about the error. With d the deviations from the mean, the samples that count are
    /// `(sum of d^2)^2 / sum of d^4`: n if all deviations are alike, n/3 if they are normal, 1 if one sample makes everything. An estimate with less
    /// than 8 has not settled; more samples settle it.
    pub fn is_settled(&self) -> bool {
        self.std_err.is_finite()
    }

    /// Observed variance of the mean, whether or not the estimate has settled: further samples can be joined to it.
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// The interval of `sigmas` standard errors on both sides of the mean: 1.96 for 95%.
    pub fn interval(&self, sigmas: f64) -> (f64, f64) {
        (self.mean - sigmas * self.std_err, self.mean + sigmas * self.std_err)
    }

    /// Whether a value lies within `sigmas` standard errors of the mean. Nothing is off an estimate that has not settled.
    pub fn agrees_with(&self, value: f64, sigmas: f64) -> bool {
        let (low, high) = self.interval(sigmas);
        (low..=high).contains(&value)
    }

    /// The weighted sum of independent estimates.
    pub fn sum(parts: impl IntoIterator<Item = (f64, Self)>) -> Self {
        let (mut mean, mut variance, mut doubt, mut missed) = (0.0, 0.0, 0.0, false);
        for (weight, part) in parts.into_iter().filter(|(weight, _)| *weight != 0.0) {
            let own = weight * weight * part.variance;
            mean += weight * part.mean;
            variance += own;
            missed |= part.support == 0.0;
            // A variance from a few samples is itself uncertain, as one over their number.
            doubt += if own > 0.0 { own * (own / part.support) } else { 0.0 };
        }
        if missed {
            return Self { variance, ..Self::unsettled(mean) };
        }
        let support = if doubt > 0.0 { variance * (variance / doubt) } else { f64::INFINITY };
        Self::new(mean, variance, support)
    }

    /// The estimate with a further, independent error.
    pub fn loosened(self, std_err: f64) -> Self {
        Self::sum([(1.0, self), (1.0, Self::known(0.0, std_err))])
    }

    /// The estimate of `count` samples.
    pub(crate) fn of(count: u64, mut sample: impl FnMut(u64) -> f64) -> Self {
        // Welford 1962, with the moments of Pebay 2008: no cancellation where the spread is small.
        let (mut mean, mut m2, mut m3, mut m4) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..count {
            let (before, n) = (i as f64, (i + 1) as f64);
            let step = sample(i) - mean;
            let part = step / n;
            let square = step * part * before;
            let part_sq = part * part;
            mean += part;
            m4 += square * part_sq * (n * n - 3.0 * n + 3.0) + 6.0 * part_sq * m2 - 4.0 * part * m3;
            m3 += square * part * (n - 2.0) - 3.0 * part * m2;
            m2 += square;
        }
        if count < 2 {
            return Self::unsettled(mean);
        }
        let n = count as f64;
        if mean.abs() < TINY {
            // Samples met no light, or light whose square underflows: their spread measures nothing.
            return Self { variance: 0.0, ..Self::unsettled(mean) };
        }
        if m2 <= n * (ROUNDING * mean) * (ROUNDING * mean) {
            return Self::new(mean, 0.0, f64::INFINITY);
        }
        Self::new(mean, m2 / (n * (n - 1.0)), m2 * (m2 / m4.max(f64::MIN_POSITIVE)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_error_of_samples() {
        let e = Estimate::of(100, |i| [1.0, 2.0, 3.0, 6.0][i as usize % 4]);
        // Mean square deviation 7/2: the variance of the mean is 7/2 over 99.
        assert!((e.mean - 3.0).abs() < 1e-14 && (e.std_err - libm::sqrt(3.5 / 99.0)).abs() < 1e-14, "{e:?}");
        assert!(e.agrees_with(3.3, 2.0) && !e.agrees_with(3.5, 2.0));
        // d = -2, -1, 0, 3: d^2 sum to 14, d^4 to 98, so that 14^2 / 98 = 2 of four count, and 50 of a hundred.
        assert!((e.support - 50.0).abs() < 1e-9, "{e:?}");
        let shifted = Estimate::of(100, |i| 1e6 + [1.0, 2.0, 3.0, 6.0][i as usize % 4]);
        assert!((shifted.support - 50.0).abs() < 1e-6, "{shifted:?}");
    }

    #[test]
    fn what_few_samples_carry_has_not_settled() {
        let rare = |hits: u64| Estimate::of(10_000, |i| if i % (10_000 / hits) == 7 { 100.0 } else { 1.0 });
        assert!(!rare(1).is_settled() && !rare(5).is_settled() && rare(25).is_settled());
        assert!(rare(1).std_err.is_infinite() && (rare(25).mean - 1.2475).abs() < 1e-12);
        assert!(Estimate::of(10, |_| 0.25).is_settled() && Estimate::of(1000, |_| 0.1).std_err == 0.0);
        assert!(!Estimate::of(1, |_| 1.0).is_settled() && !Estimate::of(0, |_| 1.0).is_settled());
    }

    /// The sum of many that have not settled has, where none of them makes most of it.
    #[test]
    fn sums_settle_before_their_parts() {
        let rare = Estimate::of(1000, |i| if i % 250 == 0 { 1.0 } else { 0.0 });
        assert!(!rare.is_settled());
        let sum = Estimate::sum((0..20).map(|_| (0.5, rare)));
        assert!(sum.is_settled() && (sum.mean - 10.0 * rare.mean).abs() < 1e-15);
        let expected = libm::sqrt(20.0 * 0.25 * rare.variance);
        assert!((sum.std_err - expected).abs() < 1e-15);
        assert!(!Estimate::sum([(100.0, rare), (1.0, sum)]).is_settled());
        assert_eq!(Estimate::sum([(2.0, Estimate::exact(3.0)), (0.0, rare)]), Estimate::exact(6.0));
        assert_eq!(Estimate::known(1.0, 3.0).loosened(4.0).std_err, 5.0);
    }
}
