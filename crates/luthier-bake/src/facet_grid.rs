//! How light meets the facets of a slope distribution, over the whole domain of a table: the part of FGD-infinity that no
//! material enters, computed once for all of them.

use luthier_lut::{Axis, Scan};
use luthier_optics::Rgb;
use luthier_optics::albedo::{Effort, FacetStatistics, crossed_albedo};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::interpolation::cubic_stencil;
use luthier_optics::ior::Ior;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::Distribution;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::fgd::crossed_curves;
use crate::json;
use crate::smooth::savitzky_golay;

/// Effort at the nodes, where neighbours share their noise, and at the points of the error scan.
const EFFORT: [Effort; 2] = [Effort { first: 20, later: 40 }, Effort { first: 28, later: 72 }];

/// The same for reflectances with a kink, which quadratures resolve slowly. The walks of a point stay below the 65536 that the sequence of
/// their random numbers has.
const KINKED_EFFORT: [Effort; 2] = [Effort { first: 64, later: 40 }, Effort { first: 128, later: 72 }];

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

/// The same for films, per wavelength.
const CROSSED_WALKS_FILM: u32 = 64;

/// Points along each axis at which the grid is compared with four times the walks.
const CROSSED_PROBES: u32 = 4;

/// Wavelength whose refraction stands for all: dispersion changes this small part by a few percent of itself.
const REFRACTION_WAVELENGTH_NM: f64 = 589.3;

/// The crossed part over coordinates `u` of the table.
#[derive(Debug)]
pub(crate) struct CrossedGrid {
    side: usize,
    values: [Vec<f64>; 3],
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
        let crossing = self.crossing();
        let (side, walks) = match self.interface.films.len() {
            0 => (CROSSED_NODES, CROSSED_WALKS),
            _ => (CROSSED_NODES_FILM, CROSSED_WALKS_FILM),
        };
        let last = f64::from(side - 1);
        let nodes: Vec<Rgb> = (0..side * side)
            .into_par_iter()
            .map(|node| crossing([node % side, node / side].map(|i| f64::from(i) / last), walks, seed(node)))
            .collect();
        let mut values = [0, 1, 2].map(|c: usize| nodes.iter().map(|rgb| rgb[c]).collect::<Vec<_>>());
        for channel in &mut values {
            savitzky_golay(channel, side as usize, side as usize);
            if self.interface.films.is_empty() {
                // Smoothing may dip below zero; only colours out of gamut, which films have, may stay there.
                channel.iter_mut().for_each(|v| *v = v.max(0.0));
            }
        }
        let mut grid = CrossedGrid { side: side as usize, values, max_abs_err: 0.0 };
        let errors: Vec<f64> = (0..CROSSED_PROBES * CROSSED_PROBES)
            .into_par_iter()
            .map(|point| {
                let u = [point % CROSSED_PROBES, point / CROSSED_PROBES]
                    .map(|i| (f64::from(i) + 0.5) / f64::from(CROSSED_PROBES));
                let (truth, read) = (crossing(u, 4 * walks, seed(!point)), grid.at(u));
                (0..3).map(|c| (truth[c] - read[c]).abs()).fold(0.0, f64::max)
            })
            .collect();
        grid.max_abs_err = errors.into_iter().fold(0.0, f64::max);
        grid
    }

    /// The crossed part as a function of coordinates, number of walks and seed.
    fn crossing(&self) -> impl Fn([f64; 2], u32, u32) -> Rgb + Sync {
        let weighted = crossed_curves(&self.interface, &self.color);
        let index = |ior: &Ior| ior.at(REFRACTION_WAVELENGTH_NM).re;
        let eta = index(&self.interface.below) / index(&self.interface.above);
        move |u, walks, seed| {
            let [x, y] = &self.axes;
            let (cos_theta, alpha) = (x.decode(u[0]), y.decode(u[1]));
            let albedos: Vec<f64> = (0..weighted.curves.count())
                .map(|curve| {
                    let facets = TransparentFacets { eta, from_above: &weighted.curves, curve };
                    crossed_albedo(self.distribution, alpha, facets, cos_theta, walks, seed)
                })
                .collect();
            weighted.rgb(&albedos)
        }
    }
}

impl CrossedGrid {
    /// Cubic between the coarse nodes, per channel.
    pub(crate) fn at(&self, u: [f64; 2]) -> Rgb {
        let [(i, x), (j, y)] = u.map(|u| cubic_stencil(u * (self.side - 1) as f64, self.side));
        let mut rgb = [0.0; 3];
        for (row, y) in (j..).zip(y) {
            for (column, x) in (i..).zip(x) {
                (0..3).for_each(|c| rgb[c] += x * y * self.values[c][row * self.side + column]);
            }
        }
        rgb
    }
}
