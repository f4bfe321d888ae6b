//! Errors of candidates against the reference, with the noise of the reference.

use std::f64::consts::{FRAC_1_PI, PI};

use luthier_manifest::{SceneBudget, SceneError};
use luthier_optics::Rgb;
use luthier_optics::color_difference::{ciede2000, lab};

use crate::probe::Probe;

/// Floor of the divisor of relative errors: a tenth of the value of a white diffuse surface under unit light, as in reports. Without it,
/// errors in the dark would be unbounded.
pub const FLOOR: f64 = 0.1 * FRAC_1_PI;

/// Number of standard errors that count as the noise of the reference: a 95 % interval.
const SIGMAS: f64 = 2.0;

/// Largest noise of a decision, as a share of the limit.
const NOISE_SHARE: f64 = 0.25;

/// A value of the reference: mean and standard error per channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    /// `f cos theta_i`; of light from everywhere, albedo over pi.
    pub rgb: Rgb,
    /// Standard error.
    pub std_err: Rgb,
}

impl Value {
    /// Divisor of relative errors.
    fn scale(&self) -> f64 {
        self.rgb.iter().fold(FLOOR, |a, b| a.max(*b))
    }

    /// Standard error, relative.
    pub(crate) fn noise(&self) -> f64 {
        self.std_err.iter().fold(0.0_f64, |a, b| a.max(*b)) / self.scale()
    }
}

/// Relation of a value to a budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    Inside,
    Open,
    Outside,
}

/// Errors of one value, each with its standard error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Miss {
    abs: [f64; 2],
    rel: [f64; 2],
    delta_e: Option<[f64; 2]>,
}

impl Miss {
    pub(crate) fn of(found: Rgb, reference: &Value, with_delta_e: bool) -> Self {
        let mut abs = [0.0_f64; 2];
        for ((found, expected), std_err) in found.iter().zip(&reference.rgb).zip(&reference.std_err) {
            let miss = (found - expected).abs();
            // A value that is not finite gets the largest error, which still sorts among others.
            let miss = if miss.is_finite() { miss } else { f64::MAX };
            abs = [abs[0].max(miss), abs[1].max(*std_err)];
        }
        let scale = reference.scale();
        let delta_e = with_delta_e.then(|| {
            let moved = [0, 1, 2].map(|c| reference.rgb[c] + reference.std_err[c]);
            let colors = [reference.rgb, found, moved].map(|rgb| lab(rgb.map(|v| (PI * v).clamp(0.0, 1.0))));
            [ciede2000(colors[1], colors[0]), ciede2000(colors[2], colors[0])]
        });
        Self { abs, rel: abs.map(|v| v / scale), delta_e }
    }

    pub(crate) fn standing(&self, budget: &SceneBudget) -> Standing {
        let mut all = Standing::Inside;
        for (limit, [miss, noise]) in self.limited(budget) {
            if miss - SIGMAS * noise > limit {
                return Standing::Outside;
            }
            if miss + SIGMAS * noise > limit || noise > NOISE_SHARE * limit {
                all = Standing::Open;
            }
        }
        all
    }

    /// The largest ratio of an error to its limit.
    pub(crate) fn excess(&self, budget: &SceneBudget) -> f64 {
        self.limited(budget).map(|(limit, [miss, _])| miss / limit).fold(0.0, f64::max)
    }

    /// Each limit of a budget, with the error that it is for and the standard error of that.
    fn limited(&self, budget: &SceneBudget) -> impl Iterator<Item = (f64, [f64; 2])> {
        let all = [(budget.max_abs, Some(self.abs)), (budget.max_rel, Some(self.rel)), (budget.delta_e, self.delta_e)];
        all.into_iter().filter_map(|(limit, miss)| limit.zip(miss))
    }
}

/// The largest errors, one at each probe.
pub(crate) fn largest(misses: &[Miss], probes: &[Probe]) -> SceneError {
    let mut error = SceneError::default();
    for (Miss { abs, rel, delta_e }, probe) in misses.iter().zip(probes) {
        error.max_abs = error.max_abs.max(abs[0]);
        if rel[0] >= error.max_rel {
            (error.max_rel, error.std_err_rel, error.at) = (rel[0], rel[1], Some(probe.direction()));
        }
        error.delta_e = error.delta_e.into_iter().chain(delta_e.map(|[miss, _]| miss)).reduce(f64::max);
    }
    error
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn miss(found: f64, expected: f64, noise: f64) -> Miss {
        Miss::of([found; 3], &Value { rgb: [expected; 3], std_err: [noise; 3] }, true)
    }

    #[test]
    fn noise_leaves_open_what_is_near_the_limit() {
        let budget = SceneBudget { max_rel: Some(0.1), ..SceneBudget::default() };
        assert_eq!(miss(1.05, 1.0, 0.01).standing(&budget), Standing::Inside);
        assert_eq!(miss(1.09, 1.0, 0.01).standing(&budget), Standing::Open);
        assert_eq!(miss(1.11, 1.0, 0.01).standing(&budget), Standing::Open);
        assert_eq!(miss(1.13, 1.0, 0.01).standing(&budget), Standing::Outside);
        // An exact value is as good as its noise.
        assert_eq!(miss(1.0, 1.0, 0.03).standing(&budget), Standing::Open);
        assert_eq!(miss(f64::NAN, 1.0, 0.01).standing(&budget), Standing::Outside);
    }

    #[test]
    fn darkness_counts_as_the_floor() {
        let budget = SceneBudget { max_rel: Some(0.1), ..SceneBudget::default() };
        assert!((miss(0.1 * FLOOR, 0.0, 0.0).excess(&budget) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_worst_limit_counts() {
        let budget = SceneBudget { max_rel: Some(1.0), max_abs: Some(0.01), delta_e: Some(1e3) };
        assert!((miss(0.12, 0.1, 0.0).excess(&budget) - 2.0).abs() < 1e-12);
        assert_eq!(miss(0.12, 0.1, 0.0).standing(&budget), Standing::Outside);
        let [up, aside] = [DVec3::Z, DVec3::new(0.5, 0.0, libm::sqrt(0.75))];
        let probes = [Probe::Pair { wi: aside, wo: up }, Probe::Sky { wo: up }];
        let error = largest(&[miss(0.12, 0.1, 0.0), miss(0.5, 0.49, 0.001)], &probes);
        assert_eq!(error.at.map(|at| (at.eye_deg, at.light_deg)), Some((0.0, Some([30.0, 0.0]))));
        assert!(
            (error.max_abs - 0.02).abs() < 1e-12 && (error.max_rel - 0.2).abs() < 1e-12 && error.delta_e > Some(1.0)
        );
    }
}
