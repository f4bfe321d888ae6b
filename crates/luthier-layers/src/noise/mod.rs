//! Patterns that are functions of a place: gradient noise, cells, and the random numbers behind them.

pub(crate) mod hash;
pub mod perlin;
pub mod voronoi;
