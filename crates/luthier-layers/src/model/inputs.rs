//! Inputs that models take besides a stack and two directions.

use glam::{DVec2, DVec3};

/// Number of layers that may have weights of their own.
pub const WEIGHTS_MOST: usize = 16;

/// An input that a model takes, for listings and for telling which model takes which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// [`Inputs::uv`].
    Uv,
    /// [`Inputs::distance`].
    Distance,
    /// [`Inputs::extent`].
    Extent,
    /// [`Inputs::map`].
    Map,
    /// [`Inputs::inner_normal`].
    InnerNormal,
    /// [`Inputs::weights`].
    Weights,
    /// A second stack, see [`Model::stack_index`](crate::model::Model::stack_index).
    OtherStack,
    /// The light of an environment ([`elek::environment`](crate::models::elek::environment)).
    Environment,
    /// A re-radiation matrix ([`fluorescence`](crate::effects::fluorescence)).
    Matrix,
    /// The wavelength of the light, if another one is seen.
    Excitation,
    /// [`Inputs::samples`].
    Samples,
    /// [`Inputs::seed`].
    Seed,
}

impl Input {
    /// The name in files; on the command line it follows two hyphens.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uv => "uv",
            Self::Distance => "distance",
            Self::Extent => "extent",
            Self::Map => "map",
            Self::InnerNormal => "inner-normal",
            Self::Weights => "weights",
            Self::OtherStack => "other",
            Self::Environment => "environment",
            Self::Matrix => "matrix",
            Self::Excitation => "excitation",
            Self::Samples => "samples",
            Self::Seed => "seed",
        }
    }
}

/// Inputs of a model; `None` leaves the model's own.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Inputs {
    /// Texture coordinate of the place.
    pub uv: Option<DVec2>,
    /// Distance of the eye, in the scene's unit of length; at least 0.
    pub distance: Option<f64>,
    /// Extent of patina: below 0 none, above 1 all, see [`Patina::extent`](crate::effects::patina::Patina::extent).
    pub extent: Option<f64>,
    /// Value of the patina's map, 0..=1.
    pub map: Option<f64>,
    /// Normal of the inner boundary of a film, unit, in the surface's frame.
    pub inner_normal: Option<DVec3>,
    /// Weights of the layers from the top in a mixture of their densities, each at least 0; they count over their sum.
    pub weights: Option<[f64; WEIGHTS_MOST]>,
    /// Random samples per value of an estimate.
    pub samples: Option<u64>,
    /// Seed of the random numbers of an estimate.
    pub seed: Option<u64>,
}
