//! Tables that real-time renderers read beside a material: the split sum of image-based lighting.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! A [`DfgTable`] states a function, axes, values and texels; [`DfgTable::bake`] fills it, [`DfgTable::error`] measures what a sampler reads from
//! it, [`search`] finds the smallest. [`Preset`]s are the statements of engines. [`ClosedForm::fit`] finds a form without a table: two quotients of polynomials and
//! a fifth power. [`DfgTable::wgsl`] and [`ClosedForm::wgsl`] write the function that a shader calls, `luthier_dfg`.
//!
//! Simplifications: tables have one level and are read by bilinear filtering. Out of scope: light from below the surface, and
//! reflectances other than Schlick's.

mod axes;
mod closed;
mod dfg;
mod lookup;
mod preset;
mod search;

pub use axes::{AxesError, AxisSpec, Layout, Nodes, Quantity};
pub use closed::{ClosedForm, Cost, FittedForm, Polynomial, Rational, measure_form};
pub use dfg::{DfgTable, Stored, Value};
pub use lookup::{Bindings, LOOKUP, SAMPLER, TEXTURE};
pub use preset::{Container, Preset};
pub use search::{Found, search};
