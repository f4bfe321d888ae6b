//! Light from all around: maps of radiance and skies by formula, filtered beforehand for smooth and rough surfaces.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! An [`Environment`] is an equirectangular map. [`Environment::levels`] makes copies of it, as a cube or as an
//! equirectangular map, for a texture with mips. They are blurred by von Mises-Fisher lobes whose widths double from
//! level to level. [`Environment::irradiance_level`] is the light that white Lambertian patches send out.
//!
//! Texels are means over their area. A single bright texel of a map therefore has its energy, radiance times solid
//! angle, in every level within 0.4 %, wherever it is, and in the irradiance within 0.3 %. (In the last row beside a
//! pole, bilinear reads give it 8 % more.)
//!
//! Simplifications: maps with more than 512 rows are averaged down to that. Levels blur a cube with texels half as wide
//! as their lobe, and each texel counts as light from its middle. Bytes of levels depend on the map only: sums have a
//! fixed order, and transcendental functions come from libm.
//!
//! # Rooms
//!
//! Each room uses those above it, none below.
//!
//! - `vector`, `error`, `panorama`, `faces`: directions, and where these are on maps and on the faces of cubes.
//! - `integral`, `cube`, `layout`, `kernel`, `mirror`: radiance on cubes and textures, and lobes that blur it.
//! - `sky`, `environment`: skies by formula; a map with all that is made of it.
//! - `levels`, `scenery`: blurred textures of an environment; surroundings to have one of.

mod cube;
mod environment;
mod error;
mod faces;
mod integral;
mod kernel;
mod layout;
mod levels;
mod mirror;
mod panorama;
mod scenery;
mod sky;
mod vector;

pub use environment::Environment;
pub use error::EnvironmentError;
pub use layout::{Layout, Level};
pub use mirror::{ALPHAS, Blur};
pub use scenery::Scenery;
pub use sky::{Sky, SoftLight};
