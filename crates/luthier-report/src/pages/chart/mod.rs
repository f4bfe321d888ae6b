//! Charts of a report.

mod errors;
mod tables;

pub(crate) use errors::{by_angle, exceedance, max_by_material, series};
pub(crate) use tables::{bytes_by_table, error_by_alpha, reflectance};
