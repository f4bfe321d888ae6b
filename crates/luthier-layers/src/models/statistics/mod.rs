//! Layers as operators on the statistics of light: energy, mean direction, variance.
//!
//! L. Belcour, "Efficient Rendering of Layered Materials using an Atomic Decomposition with Statistical Operators", SIGGRAPH
//! 2018; Yamaguchi, Yatagawa, Tokuyoshi and Morishima, "Real-time Rendering of Layered Materials with Anisotropic Normal
//! Distributions", SIGGRAPH Asia 2019 Technical Briefs, whose eq. 1-3 restate it. A lobe of light is a point in the unit
//! disc (the mean of its directions, projected on the surface), an energy and a spread around that point. Interfaces and
//! slabs change the three; adding sums all paths between them.
//!
//! The two papers differ only in the type of a spread: a number, or a covariance matrix. Everything here is generic over [`spread::Spread`], and
//! over the number of channels. The models of this crate have one channel, a wavelength. Shaders have three channels, which share directions and
//! spreads ([`Layers::rgb`](crate::layers::Layers::rgb)).
//!
//! Out of scope: media that scatter.

pub mod adding;
pub mod diffuse_base;
pub mod energy;
pub(in crate::models) mod eval;
pub mod evaluate;
#[cfg(test)]
pub(crate) mod fixtures;
pub mod model;
pub mod spread;
pub mod total_reflection;

/// Kernels of spreads.
pub const SPREAD: &str = include_str!("spread.wgsl");

/// Kernels that add layers. `$Path`, `$spread` and `$add(` stand for the types and functions of a model.
pub const ADDING: &str = include_str!("adding.wgsl");
