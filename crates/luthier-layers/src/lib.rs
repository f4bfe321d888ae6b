//! Evaluation of layer stacks in f64: reflectance models, twins of the emitted shaders, and the references that judge both.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Modules use each other one way only: each stands on those above it.
//!
//! | layer | modules |
//! |---|---|
//! | directions, numbers | [`angles`], [`frame`], [`noise`]: gradient noise and cells |
//! | factors of models | [`terms`] that tables stand in for |
//! | a stack at one wavelength | [`monochrome`] |
//! | formulas | [`formulas`] that models share |
//! | a stack in channels | [`layers`], whose channels share their directions |
//! | the trait | [`model`]: `Model`, its inputs and its estimates; [`directional_albedo`] and [`furnace`] integrate any |
//! | references | [`references`]: random walks through one rough interface or a rough stack, a closed form for a smooth one |
//! | models | [`models`], each under its name; `lobes` are fitted to a reference |
//! | above the models | [`effects`]: flakes, patina, particles, textures, fluorescence |
//! | shaders | [`twins`]: models as shaders evaluate them, in three channels |
//! | beside the models | [`engines`]: formulas of exchange formats, to compare with |
//! | lists | [`registry`] of all models by name, [`domain`] of each |
//!
//! With the feature `fit`, `beam_fit` finds numbers of Granier and Heidrich's model for a lobe that values give.
//!
//! A [`model::Model`] evaluates a [`monochrome::Monochrome`] stack at one wavelength.
//!
//! Every model takes directions in the local frame (+z is the normal, both point away from the surface) and returns
//! `f cos_theta_i`, the BRDF times the cosine of the incident direction: that stays finite where the BRDF alone does
//! not.
//!
//! Stacks are described by [`luthier_optics`], directions are vectors of [`glam`], and indices complex numbers of [`num_complex`]; these
//! crates are re-exported.

pub mod angles;
pub mod beam_fit;
pub mod directional_albedo;
pub mod domain;
pub mod effects;
pub mod engines;
pub mod formulas;
pub mod frame;
pub mod furnace;
pub mod layers;
pub mod least_squares;
mod memo;
pub mod model;
pub mod models;
pub mod monochrome;
pub mod noise;
pub mod references;
pub mod registry;
pub mod terms;
pub mod twins;

/// Vectors, for directions and places.
pub use glam;
/// Models by name, with their facts.
pub use luthier_model;
/// Descriptions of stacks, and the optics of their parts.
pub use luthier_optics;
/// Complex numbers, for indices.
pub use num_complex;
