//! The choice of models for a scene, with its reasons.

use std::fmt;

use luthier_model::{Form, ShadingModel};
use serde::{Deserialize, Serialize};

use crate::color::ColorMode;
use crate::constants::LobesForm;
use crate::search::over_limit;

/// Limits on the error of a model against the reference under the light of a scene; an absent limit does not limit.
///
/// ```
/// use luthier_manifest::{SceneBudget, SceneError};
///
/// let scene = SceneBudget { max_rel: Some(0.1), ..SceneBudget::default() };
/// let own = SceneBudget { max_abs: Some(0.02), ..SceneBudget::default() }.or(&scene);
/// let error = SceneError { max_abs: 0.03, max_rel: 0.05, ..SceneError::default() };
/// // The absolute error is one and a half times its limit.
/// assert!((own.excess(&error) - 1.5).abs() < 1e-12);
/// assert_eq!(scene.excess(&error), 0.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SceneBudget {
    /// Largest absolute error of `f cos theta_i` (of albedo over pi, where light comes from everywhere), any channel.
    pub max_abs: Option<f64>,
    /// Largest error over the brightest channel of the reference, or over 0.1/pi where that is darker.
    pub max_rel: Option<f64>,
    /// Largest CIEDE2000 difference of pi times the value, clipped to white.
    pub delta_e: Option<f64>,
}

/// Largest errors of a model over the directions of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SceneError {
    /// Largest absolute error, as limited by [`SceneBudget::max_abs`].
    pub max_abs: f64,
    /// Largest relative error, as limited by [`SceneBudget::max_rel`].
    pub max_rel: f64,
    /// Largest colour difference, as limited by [`SceneBudget::delta_e`]; absent where the budget does not limit it.
    pub delta_e: Option<f64>,
    /// Standard error of the reference at the direction with the largest relative error, as a relative error.
    pub std_err_rel: f64,
    /// The direction with the largest relative error, for the program that chose; manifests do not have it.
    #[serde(skip)]
    pub at: Option<SceneDirection>,
}

/// Directions to eye and light in degrees, in tenths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneDirection {
    /// Between normal and eye.
    pub eye_deg: f64,
    /// Between normal and light, and around the normal from eye to light; absent where light comes from everywhere.
    pub light_deg: Option<[f64; 2]>,
}

impl fmt::Display for SceneDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.light_deg {
            Some([theta, around]) => {
                write!(f, "eye at {}°, light at {theta}° and {around}° around from the eye", self.eye_deg)
            }
            None => write!(f, "eye at {}°, light from everywhere", self.eye_deg),
        }
    }
}

impl SceneBudget {
    /// The budget, with missing limits taken from another.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self {
            max_abs: self.max_abs.or(other.max_abs),
            max_rel: self.max_rel.or(other.max_rel),
            delta_e: self.delta_e.or(other.delta_e),
        }
    }

    /// All limits times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let limits = [self.max_abs, self.max_rel, self.delta_e];
        let [max_abs, max_rel, delta_e] = limits.map(|limit| limit.map(|limit| factor * limit));
        Self { max_abs, max_rel, delta_e }
    }

    /// The largest quotient of an error and its limit: the budget holds if it is at most 1.
    pub fn excess(&self, error: &SceneError) -> f64 {
        over_limit(self.max_abs, Some(error.max_abs))
            .max(over_limit(self.max_rel, Some(error.max_rel)))
            .max(over_limit(self.delta_e, error.delta_e))
    }
}

/// Verdict on a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Its error is inside the budget, noise of the reference included.
    Holds,
    /// Its error is outside the budget.
    Fails,
    /// The noise of the reference leaves it open at the greatest number of samples; it is not taken.
    Undecided,
}

/// A way to shade a material, and how far it is from the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneCandidate {
    /// The model.
    pub model: ShadingModel,
    /// Colour of its Fresnel terms.
    pub color: ColorMode,
    /// Form of its rows, of a candidate of the model `lobes` that has one of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lobes: Option<LobesForm>,
    /// Names of the parts that were left out of the stack; empty for the whole stack.
    pub left_out: Vec<String>,
    /// Cost of one evaluation, in the unit of the device of the choice.
    pub cost: f64,
    /// Whether the cost was counted for the most similar surface, and not on this one.
    pub cost_is_of_similar: bool,
    /// Error of the model against the reference; tables and single precision are not in it.
    pub error: SceneError,
    /// Verdict on the candidate.
    pub verdict: Verdict,
}

/// Choice for a material, and its reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialChoice {
    /// Name of the material.
    pub name: String,
    /// Limits of its model: three quarters of the scene's limits; the rest is for tables.
    pub budget: SceneBudget,
    /// Place in `tried` of the candidate that ships.
    pub chosen: usize,
    /// The dearest of the candidates that cost less: its place in `tried`, if there is any.
    pub next_cheaper: Option<usize>,
    /// Reason of the choice, in a sentence.
    pub reason: String,
    /// Sentences on shipped devices that put the choice and the next candidate into another order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disagreements: Vec<String>,
    /// All candidates that were judged, cheapest first.
    pub tried: Vec<SceneCandidate>,
    /// Pairs of directions, and directions of view under light from everywhere.
    pub probes: u32,
    /// Samples of the reference, all directions and wavelengths.
    pub samples: u64,
    /// Errors of the shipped tables under the same directions: the model in f64 on texels, read with weights of 8 bits, against the model
    /// in f64 without tables. Absent in the form without tables.
    pub table_error: Option<SceneError>,
}

impl MaterialChoice {
    /// The candidate that ships.
    pub fn candidate(&self) -> &SceneCandidate {
        &self.tried[self.chosen]
    }

    /// Whether the candidate that ships holds the budget.
    pub fn holds(&self) -> bool {
        self.candidate().verdict == Verdict::Holds
    }
}

/// Device by whose costs models were chosen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CostDevice {
    /// Short name.
    pub name: String,
    /// The device, in the words of its driver; the chip, where a compiler counted.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Unit of costs: `ps` for picoseconds of the device for an evaluation, `cycles` for cycles per wave of 64.
    pub unit: String,
}

/// How the models of a bake came from a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneChoice {
    /// Name of the scene.
    pub scene: String,
    /// The scene file.
    pub source: String,
    /// SHA-256 of that file, hex.
    pub source_hash: String,
    /// The form of all shaders.
    pub form: Form,
    /// Device of the costs; absent in manifests from before devices were named, whose costs are cycles per wave of 64 on RDNA2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<CostDevice>,
    /// Share of neighbouring pixels that differ in material, 0 to 1.
    #[serde(default)]
    pub neighbours_differ: f64,
    /// Cost of all materials together, one evaluation each, in the unit of the device.
    #[serde(default)]
    pub cost: f64,
    /// One per material, in the order of the manifest.
    pub materials: Vec<MaterialChoice>,
}

#[cfg(test)]
mod tests {
    use super::*;

    const ERROR: SceneError = SceneError { max_abs: 0.2, max_rel: 0.3, delta_e: Some(4.0), std_err_rel: 9.0, at: None };

    #[test]
    fn a_budget_takes_what_it_lacks_from_another() {
        let own = SceneBudget { max_abs: Some(0.1), max_rel: None, delta_e: Some(2.0) };
        let other = SceneBudget { max_abs: Some(0.5), max_rel: Some(0.3), delta_e: None };
        assert_eq!(own.or(&other), SceneBudget { max_abs: Some(0.1), max_rel: Some(0.3), delta_e: Some(2.0) });
        assert_eq!(other.or(&own), SceneBudget { max_abs: Some(0.5), max_rel: Some(0.3), delta_e: Some(2.0) });
    }

    #[test]
    fn scaling_leaves_out_what_is_not_limited() {
        let budget = SceneBudget { max_abs: Some(0.5), max_rel: None, delta_e: Some(2.0) };
        assert_eq!(budget.scaled(3.0), SceneBudget { max_abs: Some(1.5), max_rel: None, delta_e: Some(6.0) });
    }

    #[test]
    fn excess_is_the_largest_ratio_of_what_is_limited() {
        let of = |max_abs, max_rel, delta_e| SceneBudget { max_abs, max_rel, delta_e }.excess(&ERROR);
        assert_eq!(of(Some(0.1), Some(0.2), Some(8.0)), 2.0);
        assert_eq!(of(Some(0.4), Some(0.1), Some(8.0)), 0.3 / 0.1);
        assert_eq!(of(Some(0.4), None, Some(1.0)), 4.0);
        assert_eq!(of(None, None, None), 0.0);
        let no_colors = SceneBudget { delta_e: Some(1e-9), ..SceneBudget::default() };
        assert_eq!(no_colors.excess(&SceneError { delta_e: None, ..ERROR }), 0.0);
    }

    #[test]
    fn a_choice_holds_if_its_candidate_does() {
        let candidate = |model, verdict| SceneCandidate {
            model,
            color: ColorMode::Spectral,
            lobes: None,
            left_out: Vec::new(),
            cost: 1.0,
            cost_is_of_similar: false,
            error: ERROR,
            verdict,
        };
        let mut choice = MaterialChoice {
            name: "enamel".to_owned(),
            budget: SceneBudget::default(),
            chosen: 1,
            next_cheaper: Some(0),
            reason: String::new(),
            disagreements: Vec::new(),
            tried: vec![
                candidate(ShadingModel::Phong, Verdict::Fails),
                candidate(ShadingModel::Elek, Verdict::Holds),
                candidate(ShadingModel::Belcour, Verdict::Undecided),
            ],
            probes: 1,
            samples: 1,
            table_error: None,
        };
        let mut found = Vec::new();
        for chosen in 0..3 {
            choice.chosen = chosen;
            found.push((choice.candidate().model, choice.holds()));
        }
        assert_eq!(found, [(ShadingModel::Phong, false), (ShadingModel::Elek, true), (ShadingModel::Belcour, false)]);
    }
}
