//! Indices in files of others: tables in CSV, and pages of the refractiveindex.info database in YAML.
//!
//! A file is read as far as the visible range needs it, and faults beyond do not refuse it. Notes name everything that is not read as it
//! stands.

mod columns;
mod csv;
mod curves;
mod error;
#[cfg(test)]
mod tests;
mod yaml;

use crate::ior::Ior;

pub use self::csv::csv;
pub use error::{IndexFileError, Reason};
pub use yaml::yaml;

/// An index that a file gives.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexFile {
    /// The index, over the visible range and one sample beyond each of its ends.
    pub ior: Ior,
    /// Sentences about values that were not read as they stand.
    pub notes: Vec<String>,
}

/// Rows of the longest table that is read.
pub const ROWS_MAX: usize = 100_000;

/// Largest n and k: those of real media stay below 10, in the far infrared below 1000.
pub const VALUE_MAX: f64 = 1e6;

/// k down to which a negative value is noise of a measurement, and read as 0.
pub const NOISE_K: f64 = -0.02;
