//! Evaluation in f64: models, inputs, optical constants.

#[cfg(feature = "gpu")]
mod ball;
#[cfg(feature = "gpu")]
mod distributions;
#[cfg(feature = "gpu")]
mod draws;
mod fit;
mod fluorescence;
mod furnace;
#[cfg(feature = "gpu")]
mod glow;
mod inputs;
mod ior;
#[cfg(feature = "gpu")]
mod layer_maps;
#[cfg(feature = "gpu")]
mod live;
mod models;
#[cfg(feature = "gpu")]
mod parts;
mod polarised;
#[cfg(feature = "gpu")]
mod schlick;
mod shipped;
mod surfaces;
#[cfg(feature = "gpu")]
pub(crate) mod twin;
mod values;
