//! The judge: how far the tables and the shaders of a bake are from the f64 reference, as numbers and as a page.
//!
//! [`judge`] takes what a bake shipped (manifest, decoded texels), the stacks that it was made from, and optionally a
//! [`Device`] that runs the emitted shaders. Every figure of the [`Report`] comes from that run:
//!
//! - tables are read back through the sampler of `luthier-lut` at points of the judge's own choosing;
//! - shaders are compared with `luthier_layers::elek` over deterministic sets of directions;
//! - the error of the baked shader is split into what the tables do and what f32 arithmetic does;
//! - the difference between three wavelengths and the spectrum is shown apart, so that nobody takes it for an error.
//!
//! Simplifications: only the Fresnel and distribution tables are measured again, because the model reads no others;
//! of the rest the baker's figures are repeated and marked as the baker's.
//!
//! Out of scope: baking, decoding containers, running shaders, files. The judge never uses the baker.

mod chart;
mod device;
mod directions;
mod error;
mod format;
mod judge;
mod page;
mod profile;
mod report;
mod statistics;
mod subject;
mod table_scan;
mod table_terms;

pub use device::{Device, Form};
pub use directions::{DirectionSet, Pair};
pub use error::ReportError;
pub use judge::{Progress, Settings, judge};
pub use profile::{ANGLE_BINS, AngleProfile, Exceedance};
pub use report::{
    AlphaPoint, Compared, Comparison, Curves, MaterialReport, REPORT_SCHEMA, ReflectancePoint, Report, TableReport,
    TileReport, WorstCase,
};
pub use statistics::{DIM_FLOOR, ErrorSummary, FLOOR, PEAK_FRACTION, Statistics, WorstPair, statistics};
pub use subject::Subject;
pub use table_terms::{TableTerms, Weights};
