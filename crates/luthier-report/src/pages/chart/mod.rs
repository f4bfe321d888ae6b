//! Charts as inline SVG. Colours, strokes and type come from the page's style sheet by class name.

mod errors;
mod field;
mod frame;
mod pareto;
mod plot;
mod scale;
mod tables;

pub(crate) use errors::{by_angle, exceedance, max_by_material, series};
pub(crate) use field::{Spot, field};
pub(crate) use frame::{Mark, Series, legend};
pub(crate) use pareto::{Choice, Price, pareto};
pub use plot::{Curve, Plot, PlotAxis, PlotColor};
pub(crate) use tables::{bytes_by_table, error_by_alpha, reflectance};
