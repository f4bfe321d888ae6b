//! Look-up tables as data: named axes with their mappings, texel formats, atlases of tiles, a sampler that
//! behaves as texture hardware does, and error statistics.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! Simplifications: tables have one or two axes and one mip level; filtering is bilinear with
//! clamp-to-edge.

mod atlas;
mod axis;
mod balance;
mod base;
mod bc6h;
mod critical;
mod encoding;
mod error;
mod format;
mod image;
mod kind;
mod layout;
mod measure;
mod named;
mod picture;
mod sampler;
pub mod srgb;
mod steps;

pub use atlas::{Atlas, AtlasLayout, COARSE, Tile, read};
pub use axis::{Axis, Mapping};
pub use balance::balance;
pub use base::{RowBase, SchlickBase};
pub use critical::{incident_cosine, refracted_cosine};
pub use encoding::Encoding;
pub use error::LutError;
pub use format::{FormatSet, TexelFormat};
pub use image::{Image, repeated};
pub use kind::{KindFacts, Served, TableKind, Values};
pub use layout::RowLayout;
pub use measure::{Comparison, ErrorStats, Scan, Worst, measure, measure_at, measure_scan};
pub use named::UnknownName;
pub use picture::{Picture, PictureSamples};
pub use sampler::{WeightBits, bilinear};
