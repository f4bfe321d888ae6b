//! Charts as inline SVG. Colours, strokes and type come from the page's style sheet by class name.

mod field;
pub(crate) mod frame;
mod pareto;
mod plot;
pub(crate) mod scale;
mod scatter;

pub(crate) use field::{Spot, field};
pub(crate) use frame::{Mark, Series, legend};
pub(crate) use pareto::{Choice, Price, pareto};
pub use plot::{Curve, Plot, PlotAxis, PlotColor};
pub use scatter::{Scatter, ScatterPanel, ScatterPoint};
