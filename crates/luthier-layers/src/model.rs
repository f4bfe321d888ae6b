//! Models by name.

use glam::DVec3;

use crate::layered_mc::Estimate;
use crate::monochrome::Monochrome;

/// What a model is, for listings and reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelInfo {
    /// The name by which `luthier eval --model` reaches it.
    pub name: &'static str,
    /// Paper and equations.
    pub source: &'static str,
    /// Stacks and parameters for which it is valid.
    pub domain: &'static str,
    /// What it leaves out.
    pub leaves_out: &'static str,
}

/// A reflectance model that evaluates at one wavelength.
pub trait Model: Sync {
    /// What it is.
    fn info(&self) -> ModelInfo;

    /// `f cos_theta_i` for light from `wi` seen from `wo`: unit, in the local frame, away from the surface. Zero when either
    /// is at or below the horizon; finite for all unit directions.
    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64;

    /// The model as an estimator, if its values are means of random samples.
    fn estimator(&self) -> Option<&dyn Estimator> {
        None
    }
}

/// A model whose values are means of random samples. The same arguments give the same numbers.
pub trait Estimator: Sync {
    /// As [`Model::eval`], with its standard error.
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate;

    /// Directional albedo: the share of the light from `wo` that leaves upward, light mirrored by smooth interfaces
    /// included.
    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3) -> Estimate;
}
