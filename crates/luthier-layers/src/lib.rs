//! Evaluation of layer stacks in f64: the real-time models, `real_time` with the twins of the emitted shaders, and the
//! references that judge them, `random_walk` for one interface and `layered_mc` for a whole stack.
//!
//! A [`model::Model`] evaluates a [`monochrome::Monochrome`] stack at one wavelength; [`registry`] lists all by name.
//!
//! Every model takes directions in the local frame (+z is the normal, both point away from the surface) and returns
//! `f cos_theta_i`, the BRDF times the cosine of the incident direction: that stays finite where the BRDF alone does
//! not.
//!
//! Out of scope: reading material files, tables, devices.

pub mod belcour;
pub mod closed_form;
pub mod densities;
pub mod diffuse;
pub mod directional_albedo;
pub mod domain;
pub mod elek;
pub mod elek_model;
pub mod facets;
pub mod flakes;
pub mod fluorescence;
pub mod frame;
pub mod furnace;
pub mod granier_heidrich;
mod hash;
pub mod heterogeneous;
pub mod inputs;
pub mod interface_fresnel;
pub mod layered_mc;
mod memo;
pub mod microfacet;
pub mod model;
pub mod monochrome;
pub mod normals;
pub mod oren_nayar;
pub mod patina;
pub mod perlin;
pub mod phong;
pub mod plane_stack;
pub mod random_walk;
pub mod real_time;
pub mod registry;
pub mod shaded;
pub mod statistics;
pub mod terms;
pub mod textured;
pub mod transfer_matrix;
pub mod voronoi;
pub mod weidlich_wilkie;
pub mod weidlich_wilkie_corrected;
pub mod weidlich_wilkie_sampling;
pub mod yamaguchi;
