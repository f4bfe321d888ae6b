//! The fit of lobes to simulated light.
//!
//! The unknowns are, for each lobe, shift and logarithms of widths at a few nodes over the view, and the tail; and the two numbers of the
//! wide remainder. Energies are none: at every view they are the best for the shapes, with the sum of the simulation (variable
//! projection, Golub and Pereyra 1973). Residuals are those of cells, `(e - r) / sqrt(r + c)`, all views together, so that lobes keep their
//! identity from view to view.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};
use thiserror::Error;

use super::half_vector::{outside, refracted};
use super::solve::{Amounts, Column, Guess, LeastSquares, Place, Residuals};
use super::tally::{CELLS, Cells, Point, Tally};
use super::{Critical, FirstInterface, Frame, Lobe, Lobes, Row, Shape, TAIL_MIN, ViewAxis, Wide};
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
    /// 19 rows, 32,768 paths for each.
    fn default() -> Self {
        Self { rows: 19, paths: 32_768, seed: 0 }
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

/// Indices of media closer than this are one.
const INDEX_STEP: f64 = 0.05;

/// Width over which the axis of the rows turns at a critical angle, over that over which the facets of the interfaces blur it.
const BLUR: f64 = 0.5;

/// Share of a shape above the horizon below which the fit is held back.
const SHARE_WANTED: f64 = 0.35;

/// Weight of what [`SHARE_WANTED`] lacks, of second differences between nodes, and of shifts and ratios of widths by themselves.
const SHARE_WEIGHT: f64 = 0.5;
const RIPPLE_WEIGHT: f64 = 0.03;
const REST_WEIGHT: f64 = 0.003;

/// Energy that is added to that of a cell, over the mean, where residuals are weighed.
const WEIGHT_FLOOR: f64 = 0.05;

const SEARCH: LeastSquares = LeastSquares { longest: 0.7, gain: 1e-4 };

/// Steps from every start, and further ones from the places that were best after these.
const FIRST_STEPS: u32 = 6;
const LAST_STEPS: u32 = 20;

/// Places that are followed to the end.
const FOLLOWED: usize = 2;

/// Step of the differences that slopes of amounts are.
const DIFFERENCE: f64 = 1e-5;

/// Light of a stack, view by view, in the half vectors of every medium that lobes may be in.
#[derive(Debug, Clone)]
pub struct Simulation {
    first: Option<FirstInterface>,
    axis: ViewAxis,
    cells: Vec<Cells>,
    /// Widths with which a fit starts, and with which further lobes do.
    starts: Vec<f64>,
    widths: Vec<f64>,
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
        let widths = widths(&rough);
        let cells: Vec<Cells> = indices(stack).into_iter().map(|index| Cells::new(index, least)).collect();
        let axis = ViewAxis::new(settings.rows, critical(stack, settings.rows));
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
        Ok(Self { first, axis, cells, starts, widths, views })
    }

    /// The lobes, so many, that are nearest to the light that was traced.
    pub fn fit(&self, count: usize) -> Lobes {
        let problems = self.problems();
        let fits = self.fits(&problems, count);
        let found = fits.last().unwrap_or_else(|| unreachable!("there is a fit without lobes"));
        problems[found.set].lobes(found)
    }

    /// The fewest lobes, so many at most, that are no more than `excess` farther from the light than the best, at any view. The best have
    /// the least error at their worst view.
    ///
    /// The error of a fit holds the noise of the paths, which all fits have alike: they are compared by the differences of their squared
    /// residuals. Residuals are over the roots of energies, so that half the root of a difference bounds what the lobe error gains.
    pub fn fit_fewest(&self, most: usize, excess: f64) -> Lobes {
        let problems = self.problems();
        let fits = self.fits(&problems, most);
        let costs: Vec<Vec<f64>> = fits.iter().map(|found| found.costs(&problems)).collect();
        let worst: Vec<f64> = costs.iter().map(|costs| costs.iter().copied().fold(0.0, f64::max)).collect();
        let best = (0..fits.len()).min_by(|a, b| worst[*a].total_cmp(&worst[*b])).unwrap_or(0);
        let error = |cost: &Vec<f64>| {
            let gains = cost.iter().zip(&costs[best]).map(|(own, best)| 0.5 * (own - best).max(0.0).sqrt());
            gains.fold(0.0, f64::max)
        };
        let fewest = costs.iter().position(|cost| error(cost) <= excess).unwrap_or(best);
        problems[fits[fewest].set].lobes(&fits[fewest])
    }

    fn problems(&self) -> Vec<Problem<'_>> {
        (0..self.cells.len()).map(|set| Problem::new(self, set)).collect()
    }

    /// Fits of no lobe, of one, and so on; those that gain nothing by another are the last.
    fn fits(&self, problems: &[Problem<'_>], most: usize) -> Vec<Found> {
        let alone = |set: usize| {
            self.starts
                .iter()
                .flat_map(move |&width| TAIL_STARTS.map(|tail| (set, vec![Start::new(width, tail)], REMAINDER_START)))
        };
        let one = (most > 0).then(|| nearest(problems, (0..problems.len()).flat_map(alone).collect()));
        // In the cells of the others, so that residuals compare.
        let set = one.as_ref().map_or(0, |one| one.set);
        let mut fits = vec![nearest(problems, vec![(set, Vec::new(), REMAINDER_START)])];
        fits.extend(one);
        // One lobe more at a time, beside those found, wider or narrower.
        for count in 1..most {
            let fewer = &fits[count];
            let (lobes, wide) = (fewer.starts(), fewer.wide_falloff());
            let last = &lobes[lobes.len() - 1];
            let scaled = [2.5, 0.4].map(|factor| last.scaled(factor));
            let of_interfaces = self.widths.iter().map(|&width| Start::new(width, 0.0));
            let beside = |another: Start| {
                TAIL_STARTS.map(|tail| {
                    let mut starts = lobes.clone();
                    starts.push(Start(another.0.clone(), tail));
                    (fewer.set, starts, wide)
                })
            };
            let more = nearest(problems, scaled.into_iter().chain(of_interfaces).flat_map(beside).collect());
            if more.place.cost >= fewer.place.cost {
                break;
            }
            fits.push(more);
        }
        fits
    }
}

/// Coefficients of the remainder with which a fit starts.
const REMAINDER_START: [f64; 2] = [0.3, 0.0];

/// The best place that searches from some starts come to: in a set of cells, with lobes and falloff of the remainder.
fn nearest(problems: &[Problem<'_>], starts: Vec<(usize, Vec<Start>, [f64; 2])>) -> Found {
    let first = |(set, lobes, wide): (usize, Vec<Start>, [f64; 2])| {
        let problem = Lobed { problem: &problems[set], lobes: lobes.len() };
        let place = Place::new(parameters(lobes, wide), &problem);
        Found { set, place: SEARCH.descend(place, &problem, FIRST_STEPS) }
    };
    let mut found: Vec<Found> = starts.into_iter().map(first).collect();
    found.sort_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    found.truncate(FOLLOWED);
    let last = |Found { set, place }: Found| {
        let problem = Lobed { problem: &problems[set], lobes: place.parameters.len() / PER_LOBE };
        Found { set, place: SEARCH.descend(place, &problem, LAST_STEPS) }
    };
    let best = found.into_iter().map(last).min_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    best.unwrap_or_else(|| unreachable!("there is a start"))
}

/// Widths of lobes that interfaces below the first may send, each blurred by those above, without those that are nearly another.
fn widths(alphas: &[f64]) -> Vec<f64> {
    let mut joined_sq = 0.0;
    let mut widths: Vec<f64> = Vec::new();
    for (i, alpha) in alphas.iter().enumerate() {
        joined_sq += alpha * alpha;
        let width = f64::sqrt(joined_sq).clamp(1e-3, 0.8);
        if i > 0 && widths.iter().all(|known| width > WIDTH_STEP * known) {
            widths.push(width);
        }
    }
    widths
}

/// Ratio of widths from which on they are two.
const WIDTH_STEP: f64 = 1.6;

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

/// The critical angle of the view for the medium of the least index, blurred by the interfaces above that medium.
fn critical(stack: &Stack, rows: usize) -> Critical {
    let exterior = stack.exterior.at(REFERENCE_NM).re;
    let mut found = (1.0, 0.0);
    let mut joined_sq = 0.0;
    for layer in &stack.layers {
        let Base::Dielectric { ior, .. } = &layer.base else { break };
        let alpha = layer.surface.alpha_x.max(ALPHA_MIN);
        joined_sq += alpha * alpha;
        let index = ior.at(REFERENCE_NM).re / exterior;
        if index < found.0 {
            found = (index, joined_sq.sqrt());
        }
    }
    let (index, alpha): (f64, f64) = found;
    // A facet that tilts by alpha turns the angle by as much: the squared cosine inside by 2 alpha sqrt(1 - n^2) / n.
    let width = 2.0 * BLUR * alpha * ((1.0 - index) * (1.0 + index)).sqrt() / index;
    Critical::new(index, width, rows)
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

/// Parameters of lobes and remainder in one vector.
fn parameters(lobes: Vec<Start>, wide: [f64; 2]) -> Vec<f64> {
    let mut parameters = Vec::new();
    for Start(rows, tail) in lobes {
        rows.iter().for_each(|row| parameters.extend(row));
        parameters.push(tail);
    }
    parameters.extend(wide);
    parameters
}

/// A place that a search came to.
struct Found {
    /// Number of the set of cells.
    set: usize,
    place: Place,
}

impl Found {
    /// Sum of the squared residuals of each view.
    fn costs(&self, problems: &[Problem<'_>]) -> Vec<f64> {
        let p = &self.place.parameters;
        let cost =
            |view: &ViewProblem| view.residuals(&view.profiles(p, p.len() / PER_LOBE)).iter().map(|x| x * x).sum();
        problems[self.set].views.iter().map(cost).collect()
    }

    fn starts(&self) -> Vec<Start> {
        let of = |p: &[f64]| {
            let row = |i: usize| p[i * NODES..(i + 1) * NODES].to_vec();
            Start([row(0), row(1), row(2)], p[3 * NODES])
        };
        let p = &self.place.parameters;
        p[..p.len() - 2].chunks(PER_LOBE).map(of).collect()
    }

    fn wide_falloff(&self) -> [f64; 2] {
        let p = &self.place.parameters;
        [p[p.len() - 2], p[p.len() - 1]]
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
    /// Weights of squared residuals, and their roots.
    weights: Vec<f64>,
    roots: Vec<f64>,
}

/// A view with shapes: what every part sends to each cell, of a unit of its energy.
struct Profiles {
    cells: Vec<Vec<f64>>,
    /// Shares of the shapes above the horizon, as the cells have them.
    shares: Vec<f64>,
}

/// A problem with a number of lobes. Its blocks are the views, and last the ripples.
struct Lobed<'a> {
    problem: &'a Problem<'a>,
    lobes: usize,
}

impl Residuals for Lobed<'_> {
    fn blocks(&self) -> usize {
        self.problem.views.len() + 1
    }

    fn block(&self, p: &[f64], block: usize) -> Vec<f64> {
        match self.problem.views.get(block) {
            Some(view) => view.residuals(&view.profiles(p, self.lobes)),
            None => ripple(p, self.lobes),
        }
    }

    fn slopes(&self, p: &[f64], block: usize, now: &[f64]) -> Vec<Column> {
        match self.problem.views.get(block) {
            Some(view) => view.slopes(p, self.lobes, now),
            None => ripple_slopes(p, self.lobes),
        }
    }
}

impl<'a> Problem<'a> {
    fn new(simulation: &'a Simulation, set: usize) -> Self {
        let nodes = ViewAxis::new(NODES, simulation.axis.critical());
        let mean = |rgb: Rgb| rgb.iter().sum::<f64>() / 3.0;
        let view = |(row, tally): (usize, &Tally)| {
            let cos_theta = simulation.axis.cos_theta(row as f64);
            let wo = direction(cos_theta);
            let all = (mean(tally.total) + mean(tally.first_facet)).max(f64::MIN_POSITIVE);
            let found: Vec<f64> = tally.rest[set].iter().map(|rgb| mean(*rgb).max(0.0) / all).collect();
            let weights: Vec<f64> = found.iter().map(|r| 1.0 / (r + WEIGHT_FLOOR / CELLS as f64)).collect();
            ViewProblem {
                axis: simulation.axis,
                cos_theta,
                sin: wo.x,
                place: nodes.place(cos_theta),
                points: simulation.cells[set].points(wo),
                total: found.iter().sum(),
                found,
                roots: weights.iter().map(|weight| weight.sqrt()).collect(),
                weights,
            }
        };
        Self { simulation, set, views: simulation.views.iter().enumerate().map(view).collect() }
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
                amounts[view].among(&brightness[view], &cells, tally.total[c], guess)
            })
        });
        let rgb = |view: usize, part: usize| channels.each_ref().map(|channel| channel[view][part]);
        (0..amounts.len()).map(|view| (0..=count).map(|part| rgb(view, part)).collect()).collect()
    }

    /// The lobes of the parameters found, with energies by channel.
    fn lobes(&self, found: &Found) -> Lobes {
        let p = &found.place.parameters;
        let count = p.len() / PER_LOBE;
        let energies = self.energies(p, count);
        let row = |((view, tally), energies): ((&ViewProblem, &Tally), &Vec<Rgb>)| {
            let lobe = |lobe: usize| {
                let shape = view.shape(p, lobe);
                let share = share_above(&shape, direction(view.cos_theta), self.simulation.cells[self.set].index);
                Lobe {
                    strength: energies[lobe].map(|energy| energy / share.max(SHARE_MIN)),
                    share,
                    shift: if view.sin > 0.0 { shape.shift / view.sin } else { shift_at_normal(p, lobe) },
                    sharpness: shape.width.map(|width| 1.0 / width),
                    tail: shape.tail,
                }
            };
            let sum = |c: usize| tally.first_facet[c] + energies.iter().map(|energy| energy[c]).sum::<f64>();
            Row { albedo_dir: [0, 1, 2].map(sum), lobes: (0..count).map(lobe).collect(), wide: energies[count] }
        };
        let Simulation { first, axis, cells, views, .. } = self.simulation;
        Lobes {
            first: first.clone(),
            frame: Frame { index: cells[self.set].index, wide: wide_of(p, *axis) },
            axis: *axis,
            rows: self.views.iter().zip(views).zip(&energies).map(row).collect(),
        }
    }
}

/// Shares above the horizon are no less than this, where energies are divided by them.
const SHARE_MIN: f64 = 1e-3;

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

/// Slopes of [`ripple`], which is linear.
fn ripple_slopes(p: &[f64], lobes: usize) -> Vec<Column> {
    let unit = |j: usize| {
        let mut unit = vec![0.0; p.len()];
        unit[j] = 1.0;
        (j, ripple(&unit, lobes))
    };
    (0..lobes * PER_LOBE).filter(|j| j % PER_LOBE < 3 * NODES).map(unit).collect()
}

/// Light that a shape or the remainder sends to each cell, and its slopes by a few numbers.
struct Sent<const N: usize> {
    cells: Vec<f64>,
    slopes: [Vec<f64>; N],
}

impl<const N: usize> Sent<N> {
    fn new() -> Self {
        Self { cells: vec![0.0; CELLS], slopes: std::array::from_fn(|_| vec![0.0; CELLS]) }
    }

    /// Adds a value and its relative slopes to a cell.
    fn add(&mut self, cell: usize, value: f64, relative: [f64; N]) {
        self.cells[cell] += value;
        self.slopes.iter_mut().zip(relative).for_each(|(slopes, relative)| slopes[cell] += value * relative);
    }

    /// The slopes of a unit of the energy, and those of the share.
    fn normalised(&self) -> [(Vec<f64>, f64); N] {
        let share = self.cells.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        self.slopes.each_ref().map(|slopes| {
            let slope: f64 = slopes.iter().sum();
            let of_unit = |(slopes, cell): (&f64, &f64)| (slopes - cell / share * slope) / share;
            (slopes.iter().zip(&self.cells).map(of_unit).collect(), slope)
        })
    }
}

impl ViewProblem {
    /// The node of shapes before the view, and the share of the next.
    fn node(&self) -> (usize, f64) {
        let first = (self.place as usize).min(NODES - 2);
        (first, self.place - first as f64)
    }

    fn shape(&self, p: &[f64], lobe: usize) -> Shape {
        let own = &p[lobe * PER_LOBE..(lobe + 1) * PER_LOBE];
        let (first, t) = self.node();
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

    /// Light of a shape by cell, with slopes by the middle, by the logarithms of the widths, and by the angle of the tail.
    fn sent(&self, shape: &Shape, tail_angle: f64) -> Sent<4> {
        let mut sent = Sent::new();
        let tail = shape.tail.max(TAIL_MIN);
        let tail_slope = if shape.tail > TAIL_MIN { libm::sin(2.0 * tail_angle) } else { 0.0 };
        let norm = 1.0 / (PI * shape.width[0] * shape.width[1]);
        for point in &self.points {
            let (x, y) = ((point.slope[0] - shape.shift) / shape.width[0], point.slope[1] / shape.width[1]);
            let q = x * x + y * y;
            let log = libm::log1p(tail * q);
            let density = norm * libm::exp(-(1.0 + 1.0 / tail) * log);
            let steep = 2.0 * (1.0 + tail) / (1.0 + tail * q);
            let by_tail = log / (tail * tail) - 0.5 * steep * q / tail;
            let relative = [steep * x / shape.width[0], steep * x * x - 1.0, steep * y * y - 1.0, by_tail * tail_slope];
            sent.add(point.cell, density * point.area, relative);
        }
        sent
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

    fn residuals(&self, profiles: &Profiles) -> Vec<f64> {
        let Profiles { cells, shares } = profiles;
        let energies = Amounts::new(cells, &self.weights).positive(&self.found, self.total, None);
        let residual = |cell: usize| {
            let sent: f64 = cells.iter().zip(&energies).map(|(profile, energy)| profile[cell] * energy).sum();
            self.roots[cell] * (self.found[cell] - sent)
        };
        let mut out: Vec<f64> = (0..CELLS).map(residual).collect();
        let lobes = shares.len() - 1;
        out.extend(shares[..lobes].iter().map(|share| SHARE_WEIGHT * (SHARE_WANTED - share).max(0.0)));
        out
    }

    /// Slopes of the residuals: those of profiles are analytic, those of the amounts that go with them are differences.
    fn slopes(&self, p: &[f64], lobes: usize, now: &[f64]) -> Vec<Column> {
        let mut profiles = self.profiles(p, lobes);
        let mut along = |part: usize, (slopes, share): &(Vec<f64>, f64)| -> Vec<f64> {
            let (before, share_before) = (profiles.cells[part].clone(), profiles.shares[part]);
            profiles.cells[part].iter_mut().zip(slopes).for_each(|(cell, slope)| *cell += DIFFERENCE * slope);
            profiles.shares[part] += DIFFERENCE * share;
            let there = self.residuals(&profiles);
            (profiles.cells[part], profiles.shares[part]) = (before, share_before);
            there.iter().zip(now).map(|(a, b)| (a - b) / DIFFERENCE).collect()
        };
        let (first, t) = self.node();
        let mut columns = Vec::new();
        for lobe in 0..lobes {
            let of_tail = lobe * PER_LOBE + 3 * NODES;
            let [middle, wide, across, tail] = self.sent(&self.shape(p, lobe), p[of_tail]).normalised();
            let mixed = |a: f64, b: f64| -> (Vec<f64>, f64) {
                let cells = wide.0.iter().zip(&across.0).map(|(x, y)| a * x + b * y).collect();
                (cells, a * wide.1 + b * across.1)
            };
            let sin_sq = self.sin * self.sin;
            let shift = (middle.0.iter().map(|x| self.sin * x).collect(), self.sin * middle.1);
            for (row, slopes) in [shift, mixed(1.0, 1.0), mixed(sin_sq, -sin_sq)].iter().enumerate() {
                let column = along(lobe, slopes);
                for (node, share) in [(first, 1.0 - t), (first + 1, t)] {
                    let number = lobe * PER_LOBE + row * NODES + node;
                    columns.push((number, column.iter().map(|x| share * x).collect()));
                }
            }
            columns.push((of_tail, along(lobe, &tail)));
        }
        let wide = wide_of(p, self.axis);
        let mut sent = Sent::<2>::new();
        for point in &self.points {
            let value = wide.value(point.cos_theta);
            if value > 0.0 {
                let relative = wide.slopes(point.cos_theta).map(|slope| slope / value);
                sent.add(point.cell, value * point.cos_theta * point.solid_angle, relative);
            }
        }
        for (number, slopes) in (p.len() - 2..).zip(&sent.normalised()) {
            columns.push((number, along(lobes, slopes)));
        }
        columns
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Distribution, Layer, Slab, Surface};

    use super::*;

    /// Oracle: differences of the residuals.
    #[test]
    fn slopes_are_those_of_the_residuals() {
        let layer =
            |alpha, base| Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, alpha), base };
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.2; 3] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let metal = Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer(0.3, coat), layer(0.1, metal)] };
        let settings = FitSettings { rows: 4, paths: 2000, seed: 1 };
        let simulation = Simulation::new(&stack, &Color::ThreeWavelengths([550.0; 3]), settings).unwrap();
        let problem = Problem::new(&simulation, 1);
        let lobed = Lobed { problem: &problem, lobes: 2 };
        let mut p = parameters(vec![Start::new(0.2, 0.6), Start::new(0.5, 1.0)], [0.3, 0.1]);
        (0..p.len()).for_each(|j| p[j] += 0.05 * (j % 7) as f64);
        for block in 0..lobed.blocks() {
            let now = lobed.block(&p, block);
            for (j, slopes) in lobed.slopes(&p, block, &now) {
                let ends = [1e-5, -1e-5].map(|step| {
                    let mut moved = p.clone();
                    moved[j] += step;
                    lobed.block(&moved, block)
                });
                for (i, slope) in slopes.iter().enumerate() {
                    let expected = (ends[0][i] - ends[1][i]) / 2e-5;
                    assert!(
                        (slope - expected).abs() < 2e-3 * (1.0 + expected.abs()),
                        "{block} {j} {i}: {slope} {expected}"
                    );
                }
            }
        }
    }
}
