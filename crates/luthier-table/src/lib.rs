//! Tables that real-time renderers read beside a material: the split sum of image-based lighting, and lobes for area lights.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`DfgTable`] states a function, axes, values and texels; [`DfgTable::bake`] fills it, [`DfgTable::error`] measures what a sampler reads from
//! it, [`search`] finds the smallest. [`Preset`]s are the statements of engines. [`LtcTable`] and [`SheenTable`] do the same for linearly transformed
//! cosines.
//!
//! Simplifications: tables have one level and are read by bilinear filtering. Out of scope: light from below the surface, and
//! reflectances other than Schlick's.

mod axes;
mod dfg;
mod ltc;
mod preset;
mod search;

pub use axes::{AxesError, AxisSpec, Layout, Nodes, Quantity};
pub use dfg::{DfgTable, Stored, Value};
pub use ltc::{
    IrradianceError, Lobe, LtcError, LtcTable, LtcTexels, PlacedError, SheenTable, clipped_sphere_form_factor,
};
pub use preset::{Container, Preset};
pub use search::{Found, search};
