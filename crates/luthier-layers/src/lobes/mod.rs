//! The stack as it was simulated, in lobes: a model of our own.
//!
//! A model that is a formula is as good as its assumptions. This one simulates the stack once ([`crate::layered_mc`]), keeps what has a
//! short closed form, and fits the rest:
//!
//! ```text
//! f cos_theta_i = F(theta_d) D G / (4 cos_theta_o)                    one facet of the first interface: exact
//!               + sum_k E_k(theta_o) / A_k(theta_o) p_k(s) ds/d omega_i   what comes from below, in lobes of slopes
//!               + E_w(theta_o) S(theta_i) cos_theta_i / N              a wide remainder
//! ```
//!
//! - **Slopes inside.** `s` is the slope of the half vector between the two directions *as they are refracted into a medium* of relative
//!   index n. A smooth coat over facets has there the very distribution of the facets, at all angles; a rough one nearly so. Between the
//!   directions outside, such a lobe shifts, widens by up to three times and is cut off.
//! - **Shapes.** [`Shape`]: an ellipse with a tail between Beckmann's and GGX. Shift and widths hang on the view, the tail on the lobe;
//!   channels share them.
//! - **Energies.** E are energies by channel, taken from the simulation view by view, and A is the share of a shape above the horizon. So
//!   the directional albedo of a row is that of the simulation, whatever the shapes are.
//! - **Rows.** All that hangs on the view is in rows over `cos_theta_o^(1/1.5)`, linear between.
//!
//! Sampling is exact: draw a lobe, draw a slope, mirror the eye about it, refract. What is drawn beyond the horizon has no weight.
//!
//! Simplifications: isotropic surfaces; the lobes are not reciprocal. Out of scope: places that differ, which take a row each.
//!
//! Lobes in the half vectors outside the stack are the case n = 1. The fit tries it, and takes it where it is the nearest.

mod fit;
mod half_vector;
mod prepared;
mod rows;
mod shape;
mod solve;
mod tally;
#[cfg(test)]
mod tests;

pub use fit::{FitError, FitSettings, Simulation};
pub use prepared::{Prepared, Sample};
pub use rows::{Lobe, Row, ViewAxis};
pub use shape::{Shape, Wide};

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::interface::Sampled;

use crate::facets::Facets;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::Monochrome;

/// A stack in lobes, in the colour in which it was simulated.
#[derive(Debug, Clone)]
pub struct Lobes {
    /// The first interface; none for a diffuse base alone.
    pub(crate) first: Option<FirstInterface>,
    /// Relative index n of the medium in whose half vectors the lobes are.
    pub index: f64,
    /// Tails of the lobes.
    pub tails: Vec<f64>,
    /// Shape of the wide remainder.
    pub wide: Wide,
    /// The axis of the rows.
    pub axis: ViewAxis,
    /// Rows from grazing views to the normal.
    pub rows: Vec<Row>,
}

/// The first interface: its facets, and its reflectance by channel.
#[derive(Debug, Clone)]
pub(crate) struct FirstInterface {
    pub(crate) facets: Facets,
    pub(crate) reflectance: Sampled,
}

impl Lobes {
    /// The lobes as seen from `wo` (unit, above the surface; `None` otherwise).
    pub fn prepare(&self, wo: DVec3) -> Option<Prepared<'_>> {
        Prepared::new(self, wo)
    }

    /// `f cos_theta_i` by channel.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.prepare(wo).map_or([0.0; 3], |prepared| prepared.eval(wi))
    }
}

/// One channel of lobes as a model. It holds the stack that it shows: the one that it is given counts for nothing.
#[derive(Debug, Clone, Copy)]
pub struct Channel<'a> {
    /// The lobes.
    pub lobes: &'a Lobes,
    /// The channel.
    pub channel: usize,
}

impl Model for Channel<'_> {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "lobes",
            kind: Kind::Layered,
            claims: Claims::ENERGY,
            source: "luthier: a fit to layered-mc",
            domain: "isotropic stacks",
            leaves_out: "reciprocity; what several lobes cannot show",
            inputs: &[],
        }
    }

    fn eval(&self, _stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.lobes.eval(wi, wo)[self.channel]
    }
}
