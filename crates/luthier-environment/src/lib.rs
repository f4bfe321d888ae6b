//! Light from all around: maps of radiance and skies by formula, filtered beforehand for smooth and rough surfaces.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! An [`Environment`] is an equirectangular map. [`Environment::levels`] makes copies of it blurred by von Mises-Fisher lobes whose widths
//! double from level to level, as a cube or as an equirectangular map: a texture with mips. [`Environment::irradiance_level`] is what white
//! Lambertian patches send out.
//!
//! Simplifications: maps with more than 512 rows are averaged down to that; blurs are sums over fixed directions, whose reads are averages
//! over about the share of each. Bytes of levels depend on the map only: sums have a fixed order, transcendental functions are those of libm.

mod cube;
mod environment;
mod error;
mod kernel;
mod levels;
mod mirror;
mod panorama;
mod scenery;
mod sky;
mod vector;

pub use environment::{Blur, Environment};
pub use error::EnvironmentError;
pub use levels::{Layout, Level};
pub use mirror::ALPHAS;
pub use scenery::Scenery;
pub use sky::{Sky, SoftLight};
