//! Reflectance models, each under its own name.

pub mod belcour;
pub mod densities;
pub mod diffuse;
pub mod elek;
pub mod granier_heidrich;
pub mod microfacet;
pub(crate) mod path;
pub mod phong;
pub mod statistics;
pub mod weidlich_wilkie;
pub mod weidlich_wilkie_corrected;
pub mod weidlich_wilkie_sampling;
pub mod yamaguchi;
