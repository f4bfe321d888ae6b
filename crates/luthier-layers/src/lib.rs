//! Evaluation of layer stacks in f64: reflectance models, twins of the emitted shaders, and the references that judge both.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! | room | holds |
//! |---|---|
//! | `models` | every reflectance model under its name, with its facets, refraction and statistics of light |
//! | `effects` | flakes, patina, particles, textures, fluorescence |
//! | `twins` | models as the shaders evaluate them, in three channels: [`real_time`], [`shaded`], their [`parts`], and the [`terms`] of tables |
//! | [`lobes`] | the stack as it was simulated, in a few lobes |
//! | `references` | [`random_walk`] for one rough interface, [`layered_mc`] for a rough stack, [`closed_form`] for a smooth one |
//! | `noise` | gradient noise and cells |
//! | `beam_fit` | with the feature `fit`: numbers of Granier and Heidrich's model for a lobe that values give |
//!
//! A [`model::Model`] evaluates a [`monochrome::Monochrome`] stack at one wavelength; [`registry`] lists all by name.
//!
//! Every model takes directions in the local frame (+z is the normal, both point away from the surface) and returns
//! `f cos_theta_i`, the BRDF times the cosine of the incident direction: that stays finite where the BRDF alone does
//! not.
//!
//! Stacks are described by [`luthier_optics`], directions are vectors of [`glam`], and indices complex numbers of [`num_complex`]; these
//! crates are re-exported.

mod effects;
pub mod lobes;
mod models;
mod noise;
mod references;
mod twins;

pub mod angles;
#[cfg(feature = "fit")]
pub mod beam_fit;
pub mod directional_albedo;
pub mod domain;
pub mod frame;
pub mod furnace;
pub mod inputs;
mod memo;
pub mod model;
pub mod monochrome;
pub mod registry;

/// Vectors, for directions and places.
pub use glam;
/// Models by name, with their facts.
pub use luthier_model;
/// Descriptions of stacks, and the optics of their parts.
pub use luthier_optics;
/// Complex numbers, for indices.
pub use num_complex;

pub use self::noise::{perlin, voronoi};
pub use effects::{flakes, fluorescence, heterogeneous, layer_sample, patina, textured};
/// Re-radiation matrices of fluorescent bases.
pub use luthier_optics::reradiation;
pub use models::{
    belcour, densities, diffuse, elek, elek_model, facets, granier_heidrich, interface_fresnel, microfacet, normals,
    oren_nayar, phong, refraction, statistics, weidlich_wilkie, weidlich_wilkie_corrected, weidlich_wilkie_sampling,
    yamaguchi,
};
pub use references::{closed_form, layered_mc, plane_stack, random_walk, transfer_matrix};
pub use twins::{parts, real_time, shaded, terms};
