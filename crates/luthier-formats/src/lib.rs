//! Layered materials as parameters of other formats.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! ```
//! use luthier_formats::{Format, Settings, exported};
//!
//! let text = "schema = 1\nname = \"gilt\"\n[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [1, 0.77, 0.34]\nmetallic = 1\nroughness = 0.3\n";
//! let no_texts = |_: &str| Err(std::io::ErrorKind::NotFound.into());
//! let material = luthier_material::parse("gilt.toml", text, &no_texts).unwrap().material;
//! let no_pictures = |_: &str| Err(std::io::ErrorKind::NotFound.into());
//! let gilt = exported(&material, Format::Gltf, &Settings::quick(), &no_pictures);
//! assert_eq!((gilt.numbers.metallic, gilt.numbers.roughness), (1.0, 0.3));
//! // What the formula lacks at the worst of its angles: light between facets, among others.
//! assert!(gilt.albedo_error() < 0.12, "{}", gilt.albedo_error());
//! ```
//!
//! Simplifications: a material is a coat, a film and a base, of which each may be absent; coats between the first and the base are one with the first. Numbers hold where maps have texels of 1, and there errors are measured. Films of the
//! formulas reflect by Airy's formula in the spectrum; what engines have in its place is theirs. OpenPBR describes layers, so that coats and bases are taken as they are, and errors are those of the graph of MaterialX, which approximates them.
//!
//! # Rooms
//!
//! Each uses those above it, none below.
//!
//! - `format`, `numbers`: formats, and the numbers that they have in common.
//! - `surface`: a material as coat, film and base, with what is lost on the way.
//! - `light`: the simulated light of a material, and the errors of a function against it.
//! - `formula`: the light of numbers, by the formula of a format.
//! - `fit`: the fit of numbers to a light.
//! - `closed`: numbers of a surface in closed form, format by format, with those that are left to a fit.
//! - `maps`: textures from maps.
//! - `export`: all of that for a material.
//! - `write`: files of materials: glTF, MaterialX.

mod closed;
mod export;
mod fit;
mod format;
mod formula;
mod light;
mod maps;
mod numbers;
mod surface;
mod write;

pub use export::{Exported, exported};
pub use format::Format;
pub use light::{Residual, Settings, VIEWS_DEG};
pub use luthier_import::{Fate, Line};
pub use maps::{Slot, Texture};
pub use numbers::{Coat, Film, Numbers};
pub use write::{WriteError, files};
