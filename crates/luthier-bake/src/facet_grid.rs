//! How light meets the facets of a slope distribution, over the whole domain of a table: the part of FGD-infinity that no
//! material enters, computed once for all of them.

use luthier_lut::{Axis, Scan};
use luthier_optics::albedo::{Effort, FacetStatistics, crossed_albedo};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::Distribution;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::fgd::wavelength_mean;
use crate::json;
use crate::smooth::savitzky_golay;

/// Effort at the nodes, where neighbours share their noise, and at the points of the error scan.
const EFFORT: [Effort; 2] = [Effort { first: 20, later: 26 }, Effort { first: 24, later: 48 }];

/// The same for reflectances with a kink, which quadratures resolve slowly.
const KINKED_EFFORT: [Effort; 2] = [Effort { first: 64, later: 40 }, Effort { first: 128, later: 96 }];

/// Points of the error scan along each axis.
const PROBES: u32 = 16;

/// Where errors are measured: directions up to 89.5 degrees.
pub(crate) const DOMAIN_COS_THETA: f64 = 0.0087;

/// Where errors are measured: from this alpha on.
pub(crate) const DOMAIN_ALPHA: f64 = 0.01;

#[derive(Debug, Clone)]
pub(crate) struct FacetGridJob {
    pub(crate) distribution: Distribution,
    /// Whether light may be totally reflected at an angle.
    pub(crate) kinked: bool,
    /// cos_theta and alpha.
    pub(crate) axes: [Axis; 2],
}

/// Statistics at the nodes of a table (row by row), and at the points of its error scan.
#[derive(Debug)]
pub(crate) struct FacetGrid {
    pub(crate) nodes: Vec<FacetStatistics>,
    pub(crate) scan: Scan,
    pub(crate) probes: Vec<FacetStatistics>,
}

impl FacetGridJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "distribution": self.distribution.name(),
            "kinked": self.kinked,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
        })
    }

    pub(crate) fn run(&self) -> FacetGrid {
        let [x, y] = &self.axes;
        let [node_effort, probe_effort] = if self.kinked { KINKED_EFFORT } else { EFFORT };
        let nodes = (0..x.size * y.size)
            .into_par_iter()
            .map(|texel| self.at(x.node(texel % x.size), y.node(texel / x.size), node_effort, seed(texel)))
            .collect();
        let scan = Scan {
            points: [PROBES, PROBES],
            from: [x.encode(DOMAIN_COS_THETA), y.encode(DOMAIN_ALPHA)],
            to: [1.0, 1.0],
            refinements: 0,
        };
        let probes = (0..PROBES * PROBES)
            .into_par_iter()
            .map(|point| {
                let u = scan.coordinate([point % PROBES, point / PROBES]);
                self.at(x.decode(u[0]), y.decode(u[1]), probe_effort, seed(!point))
            })
            .collect();
        FacetGrid { nodes, scan, probes }
    }

    fn at(&self, cos_theta: f64, alpha: f64, effort: Effort, seed: u32) -> FacetStatistics {
        FacetStatistics::new(self.distribution, alpha, cos_theta, effort, seed)
    }
}

/// Seed of the walks of a texel: neighbours get unrelated ones (Wang's integer hash).
fn seed(texel: u32) -> u32 {
    let mut s = (texel ^ 61) ^ (texel >> 16);
    s = s.wrapping_mul(9);
    s ^= s >> 4;
    s = s.wrapping_mul(0x27d4_eb2d);
    s ^ (s >> 15)
}

/// Light that crosses a dielectric interface and comes back: small and smooth, so a coarse grid serves.
#[derive(Debug, Clone)]
pub(crate) struct CrossedJob {
    pub(crate) interface: Interface,
    pub(crate) color: Color,
    pub(crate) distribution: Distribution,
    /// cos_theta and alpha of the table; the coarse grid lies on the same coordinates.
    pub(crate) axes: [Axis; 2],
}

/// Nodes of the coarse grid along each axis.
const CROSSED_NODES: u32 = 16;

/// The same for films, which may reflect next to nothing but at grazing angles.
const CROSSED_NODES_FILM: u32 = 32;

/// Walks per node.
const CROSSED_WALKS: u32 = 256;

/// Points along each axis at which the grid is compared with four times the walks.
const CROSSED_PROBES: u32 = 4;

/// Wavelength whose refraction stands for all: dispersion changes this small part by a few percent of itself.
const REFRACTION_WAVELENGTH_NM: f64 = 589.3;

/// The crossed part over coordinates `u` of the table.
#[derive(Debug)]
pub(crate) struct CrossedGrid {
    side: usize,
    values: Vec<f64>,
    /// Largest difference found at a few points off the nodes.
    pub(crate) max_abs_err: f64,
}

impl CrossedJob {
    pub(crate) fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.interface),
            "color": json::color(&self.color),
            "distribution": self.distribution.name(),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
        })
    }

    pub(crate) fn run(&self) -> CrossedGrid {
        let curve = wavelength_mean(&self.interface, &self.color);
        let eta =
            self.interface.below.at(REFRACTION_WAVELENGTH_NM).re / self.interface.above.at(REFRACTION_WAVELENGTH_NM).re;
        let facets = TransparentFacets { eta, from_above: &curve };
        let at = |u: [f64; 2], walks, seed| self.at(facets, u, walks, seed);
        let side = if self.interface.films.is_empty() { CROSSED_NODES } else { CROSSED_NODES_FILM };
        let last = f64::from(side - 1);
        let mut values: Vec<f64> = (0..side * side)
            .into_par_iter()
            .map(|node| {
                let u = [node % side, node / side].map(|i| f64::from(i) / last);
                at(u, CROSSED_WALKS, seed(node))
            })
            .collect();
        savitzky_golay(&mut values, side as usize, side as usize);
        values.iter_mut().for_each(|v| *v = v.max(0.0));
        let mut grid = CrossedGrid { side: side as usize, values, max_abs_err: 0.0 };
        let errors: Vec<f64> = (0..CROSSED_PROBES * CROSSED_PROBES)
            .into_par_iter()
            .map(|point| {
                let u = [point % CROSSED_PROBES, point / CROSSED_PROBES]
                    .map(|i| (f64::from(i) + 0.5) / f64::from(CROSSED_PROBES));
                (at(u, 4 * CROSSED_WALKS, seed(!point)) - grid.at(u)).abs()
            })
            .collect();
        grid.max_abs_err = errors.into_iter().fold(0.0, f64::max);
        grid
    }

    fn at(&self, facets: TransparentFacets<'_>, u: [f64; 2], walks: u32, seed: u32) -> f64 {
        let [x, y] = &self.axes;
        crossed_albedo(self.distribution, y.decode(u[1]), facets, x.decode(u[0]), walks, seed)
    }
}

impl CrossedGrid {
    /// Bilinear between the coarse nodes.
    pub(crate) fn at(&self, u: [f64; 2]) -> f64 {
        let last = self.side - 1;
        let [x, y] = u.map(|u| u.clamp(0.0, 1.0) * last as f64);
        let (i, j) = ((x as usize).min(last - 1), (y as usize).min(last - 1));
        let (s, t) = (x - i as f64, y - j as f64);
        let node = |i: usize, j: usize| self.values[j * self.side + i];
        let top = node(i, j) * (1.0 - s) + node(i + 1, j) * s;
        let bottom = node(i, j + 1) * (1.0 - s) + node(i + 1, j + 1) * s;
        top * (1.0 - t) + bottom * t
    }
}
