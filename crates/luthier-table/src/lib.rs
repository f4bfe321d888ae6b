//! Tables that real-time renderers read beside a material: the split sum of image-based lighting.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`DfgTable`] states a function, axes, values and texels; [`DfgTable::bake`] fills it, [`DfgTable::error`] measures what a sampler reads from
//! it, [`search`] finds the smallest. [`Preset`]s are the statements of engines. [`ClosedForm::fit`] finds a form without a table: two quotients of polynomials and
//! a fifth power.
//!
//! Simplifications: tables have one level and are read by bilinear filtering. Out of scope: light from below the surface, and
//! reflectances other than Schlick's.

mod axes;
mod closed;
mod dfg;
mod preset;
pub mod rgbd;
mod search;
mod stored;
mod value;

pub use axes::{AxesError, AxisSpec, Layout, Nodes, Quantity};
pub use closed::{ClosedForm, Cost, FittedForm, Polynomial, Rational, measure_form};
pub use dfg::DfgTable;
pub use preset::{Container, Preset};
pub use search::{Found, search};
pub use stored::Stored;
pub use value::Value;
