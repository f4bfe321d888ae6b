//! Statistics of light among the facets of a slope distribution, over the whole domain of a table. They are the part of
//! FGD-infinity that does not depend on a material, and are computed once for all.

use luthier_layers::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use luthier_lut::{Axis, Scan};
use luthier_optics::Rgb;
use luthier_optics::albedo::{Effort, FacetStatistics, crossed_albedo};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::interpolation::cubic_stencil;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::Distribution;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::curves::crossed_curves;
use super::smooth::savitzky_golay;
use crate::graph::{Artefact, Inputs, Job, JobKind};
use crate::json;

/// Effort at the nodes, and at the points of the error scan. Nodes take less: smoothing shares their noise among
/// neighbours.
const EFFORT: [Effort; 2] = [Effort { first: 20, later: 40 }, Effort { first: 28, later: 72 }];

/// Effort for reflectances with a kink, which quadratures resolve slowly. A point takes fewer walks than the 65536
/// members of the random sequence.
const KINKED_EFFORT: [Effort; 2] = [Effort { first: 64, later: 40 }, Effort { first: 128, later: 72 }];

/// Points of the error scan between nodes, along each axis.
const PROBES: u32 = 16;

/// Most intervals along each axis whose ends the error scan has too. The ends of the axes are among these.
const PROBED_INTERVALS: u32 = 9;

/// Least cosine at which errors are measured: 89.5 degrees.
pub(crate) const DOMAIN_COS_THETA: f64 = 0.0087;

/// Least alpha at which errors are measured.
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
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct FacetGrid {
    pub(crate) nodes: Vec<FacetStatistics>,
    /// Coordinates, and the statistics there.
    pub(crate) probes: Vec<([f64; 2], FacetStatistics)>,
}

impl Job for FacetGridJob {
    fn kind(&self) -> JobKind {
        JobKind::part("facet-grid")
    }

    fn inputs(&self) -> Value {
        json!({
            "distribution": self.distribution.name(),
            "kinked": self.kinked,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.grid())
    }

    /// Not kept: it has 300 MB, and the truths of interfaces that are made of it are kept.
    fn is_kept(&self) -> bool {
        false
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<FacetGrid>(bytes)
    }
}

impl FacetGridJob {
    fn grid(&self) -> FacetGrid {
        let [x, y] = &self.axes;
        let nodes = (0..x.size * y.size)
            .into_par_iter()
            .map(|texel| {
                let u = [x.node_coordinate(f64::from(texel % x.size)), y.node_coordinate(f64::from(texel / x.size))];
                self.at(u, self.efforts()[0], seed(texel))
            })
            .collect();
        let scan = Scan {
            points: [PROBES, PROBES],
            from: [x.encode(DOMAIN_COS_THETA), y.encode(DOMAIN_ALPHA)],
            to: [1.0, 1.0],
            nodes: [probed(x), probed(y)],
            refinements: 0,
        };
        FacetGrid { nodes, probes: self.probes(scan.coordinates()) }
    }

    /// Statistics at some coordinates, with the effort of the error scan.
    pub(crate) fn probes(&self, at: impl IntoIterator<Item = [f64; 2]>) -> Vec<([f64; 2], FacetStatistics)> {
        let at: Vec<[f64; 2]> = at.into_iter().collect();
        (0..at.len() as u32)
            .into_par_iter()
            .map(|point| (at[point as usize], self.at(at[point as usize], self.efforts()[1], seed(!point))))
            .collect()
    }

    /// Efforts at the nodes and at the points of the error scan.
    fn efforts(&self) -> [Effort; 2] {
        if self.kinked { KINKED_EFFORT } else { EFFORT }
    }

    fn at(&self, u: [f64; 2], effort: Effort, seed: u32) -> FacetStatistics {
        let [cos_theta, alpha] = [0, 1].map(|k: usize| self.axes[k].decode(u[k]));
        FacetStatistics::new(self.distribution, alpha, cos_theta, effort, seed)
    }
}

/// Number of intervals of an axis whose ends the error scan has too: the largest allowed divisor of the axis'
/// intervals.
fn probed(axis: &Axis) -> u32 {
    (1..=PROBED_INTERVALS).rev().find(|n| axis.intervals().is_multiple_of(*n)).unwrap_or(1)
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

/// Nodes for films. They are more, because films may reflect next to nothing but at grazing angles.
const CROSSED_NODES_FILM: u32 = 32;

/// Walks per node.
const CROSSED_WALKS: u32 = 256;

/// Walks per node of films, per wavelength.
const CROSSED_WALKS_FILM: u32 = 64;

/// Walks per node from the denser side. They are more, because far more of the light crosses and comes back.
const CROSSED_WALKS_DENSE: u32 = 1024;

/// Intervals along each axis whose ends, borders of the table included, the grid is checked at. It is compared with the
/// mean of some families of walks.
const CROSSED_PROBES: u32 = 6;

/// Number of families of walks that the grid is compared with. Each has as many walks as a node.
const CROSSED_FAMILIES: u32 = 4;

/// The crossed part over coordinates `u` of the table.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct CrossedGrid {
    side: usize,
    values: [Vec<f64>; 3],
    /// Largest difference found, plus the standard error of the reference.
    pub(crate) max_abs_err: f64,
    /// Root mean square of the differences, standard errors included.
    pub(crate) rms_err: f64,
}

impl Job for CrossedJob {
    fn kind(&self) -> JobKind {
        JobKind::part("crossed")
    }

    fn inputs(&self) -> Value {
        json!({
            "interface": json::interface(&self.interface),
            "color": json::color(&self.color),
            "distribution": self.distribution.name(),
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        Artefact::new(self.grid())
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<CrossedGrid>(bytes)
    }
}

impl CrossedJob {
    fn grid(&self) -> CrossedGrid {
        let crossing = self.crossing();
        let (side, walks) = match self.interface.films.len() {
            0 if self.eta() < 1.0 => (CROSSED_NODES, CROSSED_WALKS_DENSE),
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
        let mut grid = CrossedGrid { side: side as usize, values, max_abs_err: 0.0, rms_err: 0.0 };
        let count = CROSSED_PROBES + 1;
        let errors: Vec<f64> = (0..count * count)
            .into_par_iter()
            .map(|point| {
                let u = [point % count, point / count].map(|i| f64::from(i) / f64::from(CROSSED_PROBES));
                let seeds = (0..CROSSED_FAMILIES).map(|n| seed(!(point * CROSSED_FAMILIES + n)));
                let (families, read): (Vec<Rgb>, Rgb) =
                    (seeds.map(|seed| crossing(u, walks, seed)).collect(), grid.at(u));
                (0..3).map(|c| off(families.iter().map(|rgb| rgb[c]), read[c])).fold(0.0, f64::max)
            })
            .collect();
        grid.max_abs_err = errors.iter().copied().fold(0.0, f64::max);
        grid.rms_err = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        grid
    }

    /// Relative index at one wavelength, for all wavelengths: dispersion changes this small part by a few percent of
    /// itself.
    fn eta(&self) -> f64 {
        let Interface { above, below, .. } = &self.interface;
        below.at(REFRACTION_WAVELENGTH_NM).re / above.at(REFRACTION_WAVELENGTH_NM).re
    }

    /// The crossed part as a function of coordinates, number of walks and seed.
    fn crossing(&self) -> impl Fn([f64; 2], u32, u32) -> Rgb + Sync {
        let weighted = crossed_curves(&self.interface, &self.color);
        let eta = self.eta();
        move |u, walks, seed| {
            let [x, y] = &self.axes;
            let (cos_theta, alpha) = (x.decode(u[0]), y.decode(u[1]));
            let albedos: Vec<f64> = (0..weighted.curves.count())
                .map(|curve| {
                    let facets = TransparentFacets { eta, from_above: |cos| weighted.curves.at(curve, cos) };
                    crossed_albedo(self.distribution, alpha, facets, cos_theta, walks, seed)
                })
                .collect();
            weighted.rgb(&albedos)
        }
    }
}

/// Bound on the error of a value against the mean of independent estimates: the difference plus the standard error of
/// the mean.
fn off(estimates: impl ExactSizeIterator<Item = f64> + Clone, value: f64) -> f64 {
    let count = estimates.len() as f64;
    let mean = estimates.clone().sum::<f64>() / count;
    let squares: f64 = estimates.map(|estimate| (estimate - mean) * (estimate - mean)).sum();
    (mean - value).abs() + (squares / (count * (count - 1.0))).sqrt()
}

impl CrossedGrid {
    /// The crossed part at coordinates, by cubics between the coarse nodes, per channel.
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
