//! Optics in double precision: indices, Fresnel, thin films, microfacet distributions, spectra and
//! colour, quadrature, and the description of a layered surface.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Directions are unit vectors that point away from the surface; local +z is the normal. `alpha` is the
//! slope parameter. Indices are `n + i k` with `k >= 0`. Lengths carry their unit in the name. Colour
//! is linear Rec.709 with a D65 white.
//!
//! Directions are vectors of [`glam`] and indices complex numbers of [`num_complex`]; both crates are re-exported.
//!
//! Modules use each other one way only: each stands on those above it:
//!
//! | layer | modules |
//! |---|---|
//! | numerics | `rows`, `interpolation`, `quadrature` |
//! | quantities | `color`, `color_difference`, `ior`, `dispersion`, `index_file`, `constants`, `reradiation` |
//! | one boundary | `fresnel`, `schlick`, `film_color` |
//! | descriptions | `ndf`, `stack`, then `interface` and `f0_table` |
//! | micro-surfaces | `masking`, `microfacet`, `visible_normals`, `sampling`, `microsurface` |
//! | integrals over facets | `albedo`, `dielectric_albedo`, `split_sum`, `cloth`, `diffuse_albedo`, `brightening` |
//!
//! Everything is deterministic: transcendental functions come from `libm`, so that the same input gives
//! the same bits on every platform.

pub mod albedo;
pub mod brightening;
pub mod cloth;
pub mod color;
pub mod color_difference;
pub mod constants;
pub mod dielectric_albedo;
pub mod diffuse_albedo;
pub mod dispersion;
pub mod f0_table;
pub mod film_color;
pub mod film_over_f0;
pub mod fresnel;
pub mod index_file;
pub mod interface;
pub mod interpolation;
pub mod ior;
pub mod masking;
pub mod microfacet;
pub mod microsurface;
pub mod ndf;
pub mod quadrature;
pub mod reradiation;
pub mod rows;
pub mod sampling;
pub mod schlick;
pub mod split_sum;
pub mod stack;
pub mod visible_normals;

/// Vectors, for directions.
pub use glam;
/// Complex numbers, for indices and amplitudes.
pub use num_complex;

/// A value per colour channel: linear Rec.709, D65 white.
///
/// It is an array, without operators: many loops over channels call a function of the channel or read one element of many, which operators would not
/// shorten.
pub type Rgb = [f64; 3];
