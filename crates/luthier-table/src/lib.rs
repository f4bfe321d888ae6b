//! Tables that real-time renderers read beside a material: the split sum of image-based lighting.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`DfgTable`] states a function, axes, values and texels; [`DfgTable::bake`] fills it, [`DfgTable::error`] measures what a sampler reads from
//! it, [`search`] finds the smallest. [`Preset`]s are the statements of engines.
//!
//! Simplifications: tables have one level and are read by bilinear filtering. Out of scope: light from below the surface, and
//! reflectances other than Schlick's.

mod axes;
mod dfg;
mod preset;
pub mod rgbd;
mod search;
mod stored;
mod value;

pub use axes::{AxesError, AxisSpec, Layout, Nodes, Quantity};
pub use dfg::DfgTable;
pub use preset::{Container, Preset};
pub use search::{Found, search};
pub use stored::Stored;
pub use value::Value;
