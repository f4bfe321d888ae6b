//! The `Model` trait: evaluation at one wavelength, and a description for listings.

mod estimate;
mod inputs;

use glam::DVec3;
use luthier_model::ShadingModel;
use luthier_optics::Rgb;

pub use estimate::Estimate;
pub use inputs::{Input, Inputs, WEIGHTS_MOST};

use crate::monochrome::Monochrome;

/// Description of a model, for listings and reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelInfo {
    /// The name by which `luthier eval --model` reaches it.
    pub name: &'static str,
    /// Kind of model.
    pub kind: Kind,
    /// Laws that it keeps.
    pub claims: Claims,
    /// Paper and equations.
    pub source: &'static str,
    /// Stacks and parameters for which it is valid.
    pub domain: &'static str,
    /// Effects that the model leaves out.
    pub leaves_out: &'static str,
    /// Inputs that the model takes besides a stack and two directions.
    pub inputs: &'static [Input],
}

impl ModelInfo {
    /// The model of a shader, if this is its f64 twin.
    pub fn shading(&self) -> Option<ShadingModel> {
        ShadingModel::from_name(self.name)
    }
}

/// Sorts of models, in the order of listings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// One surface: a single interface, or the diffuse base.
    Surface,
    /// A whole stack.
    Layered,
    /// A whole stack that looks different from place to place.
    Place,
    /// The density of a sampling method in solid angle, in place of `f cos_theta_i`.
    Density,
    /// Right by construction: the judge of other models.
    Reference,
}

impl Kind {
    /// All kinds, in the order of listings.
    pub const ALL: [Self; 5] = [Self::Surface, Self::Layered, Self::Place, Self::Density, Self::Reference];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Layered => "layered",
            Self::Place => "place",
            Self::Density => "density",
            Self::Reference => "reference",
        }
    }
}

/// Laws of reflection that a model keeps for all stacks of its domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Claims {
    /// `f(wi, wo) = f(wo, wi)`, f without the cosine.
    pub reciprocal: bool,
    /// The directional albedo is at most 1, but for a few thousandths that `domain` states.
    pub conserves_energy: bool,
}

impl Claims {
    /// Reciprocity and energy.
    pub const BOTH: Self = Self { reciprocal: true, conserves_energy: true };
    /// Reciprocity alone.
    pub const RECIPROCAL: Self = Self { reciprocal: true, conserves_energy: false };
    /// Energy alone.
    pub const ENERGY: Self = Self { reciprocal: false, conserves_energy: true };
    /// Neither reciprocity nor energy.
    pub const NONE: Self = Self { reciprocal: false, conserves_energy: false };
}

/// A reflectance model that evaluates at one wavelength.
pub trait Model: Send + Sync {
    /// Description of the model.
    fn info(&self) -> ModelInfo;

    /// `f cos_theta_i` for light from `wi` seen from `wo`: unit, in the local frame, away from the surface. Zero when either
    /// is at or below the horizon; finite for all unit directions.
    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64;

    /// The model's own colour in linear Rec.709, D65 white; `None` if its spectral colour is the sum over wavelengths, as usual. `channels` are
    /// wavelengths in nm taken as R, G and B, and the stack at each.
    fn eval_rgb(&self, _channels: &[(f64, Monochrome); 3], _wi: DVec3, _wo: DVec3) -> Option<Rgb> {
        None
    }

    /// The model as an estimator, if its values are means of random samples.
    fn estimator(&self) -> Option<&dyn Estimator> {
        None
    }

    /// The model with other inputs in place of its own; `None` for a model that takes none. It ignores inputs that [`ModelInfo::inputs`] does not
    /// list.
    fn with_inputs(&self, _inputs: &Inputs) -> Option<Box<dyn Model>> {
        None
    }

    /// Index of the stack that the model evaluates, for a model that spreads several over places.
    fn stack_index(&self) -> usize {
        0
    }

    /// The stack of a white furnace, see [`furnace`](crate::furnace::furnace).
    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        stack.lossless()
    }
}

/// A model whose values are means of random samples. The same arguments give the same numbers.
pub trait Estimator: Sync {
    /// [`Model::eval`] with its standard error.
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate;

    /// Directional albedo: the share of the light from `wo` that leaves upward and above the plane with the normal `up` (+z but for a
    /// surface that is tilted), light mirrored by smooth interfaces included.
    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3, up: DVec3) -> Estimate;
}
