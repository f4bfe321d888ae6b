//! Reflectance models, each under its own name, and the terms that they share.

pub mod belcour;
pub mod densities;
pub mod diffuse;
pub mod elek;
pub mod elek_model;
pub mod facets;
pub mod granier_heidrich;
pub mod interface_fresnel;
pub mod microfacet;
pub mod normals;
pub mod oren_nayar;
pub mod phong;
pub mod refraction;
pub mod statistics;
pub mod weidlich_wilkie;
pub mod weidlich_wilkie_corrected;
pub mod weidlich_wilkie_sampling;
pub mod yamaguchi;
