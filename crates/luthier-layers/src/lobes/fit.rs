//! The fit of lobes to simulated light.
//!
//! The unknowns are, for each lobe, shift and logarithms of widths at a few nodes over the view, and the tail; and the two numbers of the
//! wide remainder. Energies are none: at every view they are the best for the shapes, with the sum of the simulation (variable
//! projection, Golub and Pereyra 1973). Residuals are those of cells, `(e - r) / sqrt(r + c)`, all views together, so that lobes keep their
//! identity from view to view.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};
use thiserror::Error;

use super::half_vector::{outside, refracted};
use super::solve::{Amounts, Guess, LeastSquares};
use super::tally::{CELLS, Cells, Point, Tally};
use super::{FirstInterface, Lobe, Lobes, Row, Shape, ViewAxis, Wide};
use crate::facets::{ALPHA_MIN, Facets};
use crate::layered_mc::ColorPaths;

/// Settings of a simulation and of the fit to it. The same settings give the same numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FitSettings {
    /// Rows over the view.
    pub rows: usize,
    /// Paths for each row.
    pub paths: u64,
    /// Family of random numbers.
    pub seed: u64,
}

impl Default for FitSettings {
    /// 20 rows, 50,000 paths for each.
    fn default() -> Self {
        Self { rows: 20, paths: 50_000, seed: 0 }
    }
}

/// A stack that the fit cannot take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FitError {
    /// A surface has other slopes along one axis than along the other.
    #[error("layer {layer} is anisotropic; lobes over the view alone cannot show it")]
    Anisotropic {
        /// Its number, from 1 at the top.
        layer: usize,
    },
}

/// Angles whose squared sines are the tails with which a fit starts: .09 and .79.
const TAIL_STARTS: [f64; 2] = [0.3, 1.1];

/// Nodes of shapes over the view.
const NODES: usize = 6;

/// Slope parameter from which on an interface has no critical angle to speak of.
const SMOOTH: f64 = 0.01;

/// Indices of media closer than this are one.
const INDEX_STEP: f64 = 0.05;

/// Share of a shape above the horizon below which the fit is held back.
const SHARE_WANTED: f64 = 0.35;

/// Weight of what [`SHARE_WANTED`] lacks, of second differences between nodes, and of shifts and ratios of widths by themselves.
const SHARE_WEIGHT: f64 = 0.5;
const RIPPLE_WEIGHT: f64 = 0.03;
const REST_WEIGHT: f64 = 0.003;

/// Energy that is added to that of a cell, over the mean, where residuals are weighed.
const WEIGHT_FLOOR: f64 = 0.05;

const SEARCH: LeastSquares = LeastSquares { steps: 25, difference: 1e-4, longest: 0.7, gain: 1e-4 };

/// Light of a stack, view by view, in the half vectors of every medium that lobes may be in.
#[derive(Debug, Clone)]
pub struct Simulation {
    first: Option<FirstInterface>,
    axis: ViewAxis,
    cells: Vec<Cells>,
    /// Widths with which a fit starts.
    starts: Vec<f64>,
    views: Vec<Tally>,
}

impl Simulation {
    /// Traces the paths of an isotropic stack, for every row.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn new(stack: &Stack, color: &Color, settings: FitSettings) -> Result<Self, FitError> {
        let anisotropic = stack.layers.iter().position(|layer| {
            !matches!(layer.base, Base::Diffuse(_)) && layer.surface.alpha_x != layer.surface.alpha_y
        });
        if let Some(layer) = anisotropic {
            return Err(FitError::Anisotropic { layer: layer + 1 });
        }
        let first = Interface::of(stack, 0).map(|interface| FirstInterface {
            facets: Facets::new(&stack.layers[0].surface),
            reflectance: interface.sampled(color),
        });
        let rough: Vec<f64> = (stack.layers.iter())
            .filter(|layer| !matches!(layer.base, Base::Diffuse(_)))
            .map(|layer| layer.surface.alpha_x.max(ALPHA_MIN))
            .collect();
        let least = rough.iter().copied().fold(1.0, f64::min).max(1e-3);
        let joined = rough.iter().map(|alpha| alpha * alpha).sum::<f64>().sqrt().clamp(1e-3, 0.8);
        let last = rough.last().copied().unwrap_or(0.3).max(1e-3);
        let starts = if last < 0.7 * joined { vec![joined, last] } else { vec![joined] };
        let cells: Vec<Cells> = indices(stack).into_iter().map(|index| Cells::new(index, least)).collect();
        let is_smooth = stack.layers.first().is_some_and(|layer| layer.surface.alpha_x < SMOOTH);
        let critical = first.as_ref().filter(|_| is_smooth).map_or(0.0, |first| first.reflectance.critical_cot_sq());
        let axis = ViewAxis::new(settings.rows, critical);
        let (paths, count) = (ColorPaths::new(stack, color), settings.paths);
        let view = |row: usize| {
            let wo = direction(axis.cos_theta(row as f64));
            let mut tally = Tally::new(cells.len());
            // A family of its own for every row.
            let seed = settings.seed.wrapping_mul(axis.size() as u64).wrapping_add(row as u64);
            paths.trace(seed, count, wo, |path| {
                tally.add(&cells, [path.wi, wo], path.weight.map(|w| w / count as f64), path.is_first_facet);
            });
            tally
        };
        let views = (0..axis.size()).map(view).collect();
        Ok(Self { first, axis, cells, starts, views })
    }

    /// The lobes, so many, that are nearest to the light that was traced.
    pub fn fit(&self, count: usize) -> Lobes {
        let best = |found: Option<Found>, next: Found| match found {
            Some(found) if found.cost <= next.cost => Some(found),
            _ => Some(next),
        };
        let problems: Vec<Problem<'_>> = (0..self.cells.len()).map(|set| Problem::new(self, set)).collect();
        let mut found: Option<Found> = None;
        for problem in &problems {
            if count == 0 {
                found = best(found, problem.minimise(Vec::new(), [0.3, 0.0]));
            } else {
                for &width in &self.starts {
                    for tail in TAIL_STARTS {
                        found = best(found, problem.minimise(vec![Start::new(width, tail)], [0.3, 0.0]));
                    }
                }
            }
        }
        // One lobe more at a time, beside those found, wider or narrower.
        for _ in 1..count {
            let Some(fewer) = found.take() else { break };
            let problem = &problems[fewer.set];
            for factor in [2.5, 0.4] {
                for tail in TAIL_STARTS {
                    let mut starts = fewer.starts();
                    let beside = starts[starts.len() - 1].scaled(factor);
                    starts.push(Start(beside.0, tail));
                    found = best(found, problem.minimise(starts, fewer.wide.falloff()));
                }
            }
            if found.as_ref().is_none_or(|found| found.cost >= fewer.cost) {
                found = Some(fewer);
                break;
            }
        }
        let found = found.unwrap_or_else(|| problems[0].minimise(Vec::new(), [0.0; 2]));
        problems[found.set].lobes(&found)
    }
}

/// The relative indices in whose half vectors lobes may be: 1, that of the first medium, and that of the last.
fn indices(stack: &Stack) -> Vec<f64> {
    let exterior = stack.exterior.at(REFERENCE_NM).re;
    let media = stack.layers.iter().filter_map(|layer| match &layer.base {
        Base::Dielectric { ior, .. } => Some(ior.at(REFERENCE_NM).re / exterior),
        Base::Conductor { .. } | Base::Diffuse(_) => None,
    });
    let media: Vec<f64> = media.collect();
    let mut indices = vec![1.0];
    for index in media.first().into_iter().chain(media.last()).copied() {
        if indices.iter().all(|known| index > known + INDEX_STEP || index < known - INDEX_STEP) && index > 1.0 {
            indices.push(index);
        }
    }
    indices
}

/// The wavelength at which directions are refracted: the sodium D line.
const REFERENCE_NM: f64 = 589.3;

fn direction(cos_theta: f64) -> DVec3 {
    DVec3::new((1.0 - cos_theta * cos_theta).max(0.0).sqrt(), 0.0, cos_theta)
}

/// Parameters of one lobe: shifts, logarithms of the mean width, half the logarithms of the ratio of the widths over the squared sine of the
/// view, each at the nodes; and the angle whose squared sine is the tail.
#[derive(Debug, Clone)]
struct Start([Vec<f64>; 3], f64);

impl Start {
    fn new(width: f64, tail: f64) -> Self {
        Self([vec![0.0; NODES], vec![libm::log(width); NODES], vec![0.0; NODES]], tail)
    }

    fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.0[1].iter_mut().for_each(|log| *log = (*log + libm::log(factor)).min(0.0));
        scaled
    }
}

/// Parameters of one lobe in the vector of all.
const PER_LOBE: usize = 3 * NODES + 1;

struct Found {
    /// Number of the set of cells.
    set: usize,
    cost: f64,
    parameters: Vec<f64>,
    wide: Wide,
}

impl Found {
    fn starts(&self) -> Vec<Start> {
        let of = |p: &[f64]| {
            let row = |i: usize| p[i * NODES..(i + 1) * NODES].to_vec();
            Start([row(0), row(1), row(2)], p[3 * NODES])
        };
        self.parameters[..self.parameters.len() - 2].chunks(PER_LOBE).map(of).collect()
    }
}

/// The fit in one set of cells.
struct Problem<'a> {
    simulation: &'a Simulation,
    set: usize,
    views: Vec<ViewProblem>,
}

/// One view of it.
struct ViewProblem {
    axis: ViewAxis,
    cos_theta: f64,
    sin: f64,
    /// Place among the nodes of shapes.
    place: f64,
    points: Vec<Point>,
    /// Brightness of the cells: means of the channels, over that of all light of the view.
    found: Vec<f64>,
    total: f64,
    /// Weights of squared residuals.
    weights: Vec<f64>,
}

/// A view with shapes: what every part sends to each cell, of a unit of its energy.
struct Profiles {
    cells: Vec<Vec<f64>>,
    /// Shares of the shapes above the horizon, as the cells have them.
    shares: Vec<f64>,
}

impl<'a> Problem<'a> {
    fn new(simulation: &'a Simulation, set: usize) -> Self {
        let nodes = ViewAxis::new(NODES, simulation.axis.critical_cot_sq());
        let mean = |rgb: Rgb| rgb.iter().sum::<f64>() / 3.0;
        let view = |(row, tally): (usize, &Tally)| {
            let cos_theta = simulation.axis.cos_theta(row as f64);
            let wo = direction(cos_theta);
            let all = (mean(tally.total) + mean(tally.first_facet)).max(f64::MIN_POSITIVE);
            let found: Vec<f64> = tally.rest[set].iter().map(|rgb| mean(*rgb).max(0.0) / all).collect();
            let weights = found.iter().map(|r| 1.0 / (r + WEIGHT_FLOOR / CELLS as f64)).collect();
            ViewProblem {
                axis: simulation.axis,
                cos_theta,
                sin: wo.x,
                place: nodes.place(cos_theta),
                points: simulation.cells[set].points(wo),
                total: found.iter().sum(),
                found,
                weights,
            }
        };
        Self { simulation, set, views: simulation.views.iter().enumerate().map(view).collect() }
    }

    fn minimise(&self, starts: Vec<Start>, wide: [f64; 2]) -> Found {
        let mut parameters = Vec::new();
        for Start(rows, tail) in starts {
            rows.iter().for_each(|row| parameters.extend(row));
            parameters.push(tail);
        }
        parameters.extend(wide);
        let lobes = parameters.len() / PER_LOBE;
        let ripples = self.views.len();
        let residuals = |p: &[f64], block: usize| match self.views.get(block) {
            Some(view) => view.residuals(p, lobes),
            None => ripple(p, lobes),
        };
        let touched = |j: usize| {
            let node = (j < lobes * PER_LOBE && j % PER_LOBE < 3 * NODES).then_some(j % PER_LOBE % NODES);
            let is_near = |view: &ViewProblem| node.is_none_or(|node| (view.place - node as f64).abs() < 1.0);
            let mut blocks: Vec<usize> = (0..ripples).filter(|&block| is_near(&self.views[block])).collect();
            blocks.push(ripples);
            blocks
        };
        let (parameters, cost) = SEARCH.minimise(parameters, residuals, touched, ripples + 1);
        let wide = wide_of(&parameters, self.simulation.axis);
        Found { set: self.set, cost, parameters, wide }
    }

    /// Energies by view, part and channel.
    ///
    /// Where parts look alike at a view, its light leaves open how much each of them has, and noise would decide: then between the rows the
    /// energies of one part would be seen with the shape of another. So the energies of a view are pulled to those of the rows beside it.
    fn energies(&self, p: &[f64], count: usize) -> Vec<Vec<Rgb>> {
        let profiles: Vec<Vec<Vec<f64>>> = self.views.iter().map(|view| view.profiles(p, count).cells).collect();
        let amounts: Vec<Amounts<'_>> =
            self.views.iter().zip(&profiles).map(|(view, profiles)| Amounts::new(profiles, &view.weights)).collect();
        let brightness = smoothed(amounts.len(), |view, guess| {
            amounts[view].positive(&self.views[view].found, self.views[view].total, guess)
        });
        let channels = [0, 1, 2].map(|c: usize| {
            smoothed(amounts.len(), |view, guess| {
                let tally = &self.simulation.views[view];
                let cells: Vec<f64> = tally.rest[self.set].iter().map(|rgb| rgb[c]).collect();
                let counted: Vec<bool> = brightness[view].iter().map(|amount| *amount > 0.0).collect();
                amounts[view].signed(&counted, &cells, tally.total[c], guess)
            })
        });
        // What is totally reflected does not come from below; the row at the critical angle stands for all flatter views.
        let is_total = |view: usize| view == 0 && self.simulation.axis.critical_cot_sq() > 0.0;
        let rgb = |view: usize, part: usize| {
            if is_total(view) { [0.0; 3] } else { channels.each_ref().map(|channel| channel[view][part]) }
        };
        (0..amounts.len()).map(|view| (0..=count).map(|part| rgb(view, part)).collect()).collect()
    }

    /// The lobes of the parameters found, with energies by channel.
    fn lobes(&self, found: &Found) -> Lobes {
        let p = &found.parameters;
        let count = p.len() / PER_LOBE;
        let tails = (0..count).map(|lobe| tail_of(p, lobe)).collect();
        let energies = self.energies(p, count);
        let row = |((view, tally), energies): ((&ViewProblem, &Tally), &Vec<Rgb>)| {
            let lobe = |lobe: usize| {
                let shape = view.shape(p, lobe);
                Lobe {
                    energy: energies[lobe],
                    share: share_above(&shape, direction(view.cos_theta), self.simulation.cells[self.set].index),
                    shift: if view.sin > 0.0 { shape.shift / view.sin } else { shift_at_normal(p, lobe) },
                    sharpness: shape.width.map(|width| 1.0 / width),
                }
            };
            Row { first_facet: tally.first_facet, lobes: (0..count).map(lobe).collect(), wide: energies[count] }
        };
        let Simulation { first, axis, cells, views, .. } = self.simulation;
        Lobes {
            first: first.clone(),
            index: cells[self.set].index,
            tails,
            wide: found.wide,
            axis: *axis,
            rows: self.views.iter().zip(views).zip(&energies).map(row).collect(),
        }
    }
}

/// Weight with which the energies of a view are pulled to those of its neighbours, against squared residuals over energies.
const NEIGHBOUR_WEIGHT: f64 = 0.1;

/// Rounds in which neighbours pull each other.
const NEIGHBOUR_ROUNDS: u32 = 8;

/// Amounts by view, each near the mean of its neighbours. `solve` has the amounts of a view for a guess.
fn smoothed(views: usize, solve: impl Fn(usize, Option<Guess<'_>>) -> Vec<f64>) -> Vec<Vec<f64>> {
    let mut amounts: Vec<Vec<f64>> = (0..views).map(|view| solve(view, None)).collect();
    for _ in 0..NEIGHBOUR_ROUNDS {
        for view in 0..views {
            let [before, after] = match view {
                0 => [1, 1],
                last if last + 1 == views => [last - 1, last - 1],
                view => [view - 1, view + 1],
            };
            let guess: Vec<f64> = amounts[before].iter().zip(&amounts[after]).map(|(a, b)| 0.5 * (a + b)).collect();
            amounts[view] = solve(view, Some(Guess { amounts: &guess, weight: NEIGHBOUR_WEIGHT }));
        }
    }
    amounts
}

/// Points of a shape by which its share above the horizon is counted.
const SHARE_POINTS: u32 = 4096;

/// Share of a shape that leaves the medium, by a lattice of points (Roberts 2018: multiples of the plastic number's powers); within about
/// 1e-3.
fn share_above(shape: &Shape, wo: DVec3, index: f64) -> f64 {
    const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
    let eye = refracted(wo, index);
    let is_above = |i: &u32| {
        let u = STEP.map(|step| {
            let place = 0.5 + step * f64::from(*i);
            place - libm::floor(place)
        });
        outside(shape.sample(u), eye, index).is_some()
    };
    (0..SHARE_POINTS).filter(is_above).count() as f64 / f64::from(SHARE_POINTS)
}

fn tail_of(p: &[f64], lobe: usize) -> f64 {
    let sin = libm::sin(p[lobe * PER_LOBE + 3 * NODES]);
    sin * sin
}

fn wide_of(p: &[f64], axis: ViewAxis) -> Wide {
    Wide::new([p[p.len() - 2], p[p.len() - 1]], axis)
}

/// The last node of the shifts is that of the normal.
fn shift_at_normal(p: &[f64], lobe: usize) -> f64 {
    p[lobe * PER_LOBE + NODES - 1]
}

/// Second differences of rows, and shifts and ratios themselves: against ripples.
fn ripple(p: &[f64], lobes: usize) -> Vec<f64> {
    let mut out = Vec::new();
    for lobe in p[..lobes * PER_LOBE].chunks(PER_LOBE) {
        for (i, row) in lobe[..3 * NODES].chunks(NODES).enumerate() {
            out.extend(row.windows(3).map(|t| RIPPLE_WEIGHT * (t[0] - 2.0 * t[1] + t[2])));
            if i != 1 {
                out.extend(row.iter().map(|value| REST_WEIGHT * value));
            }
        }
    }
    out
}

impl ViewProblem {
    fn shape(&self, p: &[f64], lobe: usize) -> Shape {
        let own = &p[lobe * PER_LOBE..(lobe + 1) * PER_LOBE];
        let first = (self.place as usize).min(NODES - 2);
        let t = self.place - first as f64;
        let [shift, width, ratio] = [0, 1, 2].map(|i: usize| {
            let row = &own[i * NODES..];
            row[first] + t * (row[first + 1] - row[first])
        });
        let ratio = ratio * self.sin * self.sin;
        Shape {
            shift: shift * self.sin,
            width: [libm::exp(width + ratio), libm::exp(width - ratio)],
            tail: tail_of(p, lobe),
        }
    }

    fn profiles(&self, p: &[f64], lobes: usize) -> Profiles {
        let mut cells = vec![vec![0.0; CELLS]; lobes + 1];
        for (lobe, profile) in cells[..lobes].iter_mut().enumerate() {
            let shape = self.shape(p, lobe);
            self.points.iter().for_each(|point| profile[point.cell] += shape.density(point.slope) * point.area);
        }
        let wide = wide_of(p, self.axis);
        for point in &self.points {
            cells[lobes][point.cell] += wide.value(point.cos_theta) * point.cos_theta * point.solid_angle;
        }
        let shares: Vec<f64> = cells.iter().map(|profile| profile.iter().sum()).collect();
        for (profile, share) in cells.iter_mut().zip(&shares) {
            let share = share.max(f64::MIN_POSITIVE);
            profile.iter_mut().for_each(|energy| *energy /= share);
        }
        Profiles { cells, shares }
    }

    fn residuals(&self, p: &[f64], lobes: usize) -> Vec<f64> {
        let Profiles { cells, shares } = self.profiles(p, lobes);
        let energies = Amounts::new(&cells, &self.weights).positive(&self.found, self.total, None);
        let residual = |cell: usize| {
            let sent: f64 = cells.iter().zip(&energies).map(|(profile, energy)| profile[cell] * energy).sum();
            self.weights[cell].sqrt() * (self.found[cell] - sent)
        };
        let mut out: Vec<f64> = (0..CELLS).map(residual).collect();
        out.extend(shares[..lobes].iter().map(|share| SHARE_WEIGHT * (SHARE_WANTED - share).max(0.0)));
        out
    }
}
