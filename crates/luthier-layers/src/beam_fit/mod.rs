//! Fit of the numbers of Granier and Heidrich's model to values of a lobe (section 8 of their paper names it as future work).
//!
//! The numbers are the index of the film in three channels, its thickness, both exponents, the weight of the specular part, the diffuse
//! coefficients, and the lean of the inner boundary. The method of Levenberg and Marquardt minimises the sum of
//!
//! ```text
//! ((model - value) / (mean of the value's channels + a tenth of the mean of all values))^2
//! ```
//!
//! over samples and channels, from the best of a grid of starts. Linear least squares gives each start its weight and diffuse coefficients. The sum
//! has many minima: thicknesses repeat themselves, and two beams at one place with equal exponents do not tell an index from a weight. So the found
//! numbers need not be those of the object; the error says how near the lobe is.

mod lobe;
mod problem;
#[cfg(test)]
mod tests;

use luthier_optics::Rgb;

pub use lobe::{LobeError, Sample, samples};
use problem::Problem;

use crate::least_squares::{LeastSquares, Place};

/// Form of the layer that is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Wavelengths of the channels.
    pub wavelengths_nm: [f64; 3],
    /// Thinnest and thickest film that is tried; `None` for a layer too thick to interfere.
    pub thickness_nm: Option<[f64; 2]>,
    /// Whether the inner boundary may lean.
    pub leans: bool,
}

/// The numbers of a fit, and how near their lobe is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Index of the film or the layer in three channels.
    pub index: Rgb,
    /// Thickness of the film, nm.
    pub thickness_nm: Option<f64>,
    /// Exponents of the outer boundary and of the inner one.
    pub exponents: [f64; 2],
    /// Weight of the specular part.
    pub specular_weight: f64,
    /// Coefficients of the diffuse part, RGB: weight times albedo.
    pub diffuse: Rgb,
    /// Lean of the inner boundary: slopes of its height along x and y, with the signs of its normal.
    pub lean: [f64; 2],
    /// Root of the mean squared weighted difference.
    pub rms_err: f64,
    /// Sum of the absolute differences over the sum of the values.
    pub lobe_err: f64,
}

/// Number of best starts that are followed to their minimum.
const STARTS: usize = 8;
/// Most steps towards a minimum.
const STEPS: u32 = 400;
/// Numbers are logarithms, roots and slopes, of the order of 1.
const SEARCH: LeastSquares = LeastSquares { longest: 1.0, gain: 1e-9 };

/// The numbers whose lobe is nearest to the samples; `None` for fewer samples than numbers, or for values that are all 0.
pub fn fit(samples: &[Sample], form: &Form) -> Option<Fitted> {
    let problem = Problem::new(samples, form)?;
    let mut starts = problem.starts();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found =
        starts.into_iter().take(STARTS).map(|(_, start)| SEARCH.descend(Place::new(start, &problem), &problem, STEPS));
    let best = found.filter(|place| place.cost.is_finite()).min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    Some(problem.fitted(&best.parameters))
}
