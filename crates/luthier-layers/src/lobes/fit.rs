//! The fit of lobes to simulated light.
//!
//! The unknowns are, for each lobe, shift and logarithms of widths at a few nodes over the view, and the tail; and the two numbers of the
//! wide remainder. Energies are none: at every view they are the best for the shapes, with the sum of the simulation (variable
//! projection, Golub and Pereyra 1973). Residuals are those of cells, `(e - r) / sqrt(r + c)`, all views together, so that lobes keep their
//! identity from view to view.

use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};
use thiserror::Error;

use super::parameters::{NODES, PER_LOBE, Start, parameters};
use super::problem::{Lobed, Problem, ViewProblem, direction};
use super::solve::{LeastSquares, Place};
use super::tally::{Cells, Tally};
use super::{Critical, FirstInterface, Lobes, ViewAxis};
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

/// Indices of media closer than this are one.
const INDEX_STEP: f64 = 0.05;

/// Width over which the axis of the rows turns at a critical angle, over that over which the facets of the interfaces blur it.
const BLUR: f64 = 0.5;

const SEARCH: LeastSquares = LeastSquares { longest: 0.7, gain: 1e-4 };

/// Steps from every start, and further ones from the places that were best after these.
const FIRST_STEPS: u32 = 6;
const LAST_STEPS: u32 = 20;

/// Places that are followed to the end.
const FOLLOWED: usize = 2;

/// Light of a stack, view by view, in the half vectors of every medium that lobes may be in.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(super) first: Option<FirstInterface>,
    pub(super) axis: ViewAxis,
    pub(super) cells: Vec<Cells>,
    /// Widths with which a fit starts, and with which further lobes do.
    starts: Vec<f64>,
    widths: Vec<f64>,
    pub(super) views: Vec<Tally>,
}

impl Simulation {
    /// Traces the paths of an isotropic stack, for every row.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn new(stack: &Stack, color: &Color, settings: FitSettings) -> Result<Self, FitError> {
        Self::along(ViewAxis::new(settings.rows, critical(stack, settings.rows)), stack, color, settings)
    }

    /// [`Self::new`] with rows over an axis.
    pub(super) fn along(axis: ViewAxis, stack: &Stack, color: &Color, settings: FitSettings) -> Result<Self, FitError> {
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
        self.lobes(fits.last().unwrap_or_else(|| unreachable!("there is a fit without lobes")))
    }

    /// The fewest lobes, so many at most, that are no more than `excess` farther from the light than the best, at any view. The best have
    /// the least error at their worst view.
    ///
    /// The error of a fit holds the noise of the paths, which all fits have alike: they are compared by the differences of their squared
    /// residuals. Residuals are over the roots of energies, so that half the root of a difference bounds what the lobe error gains.
    pub fn fit_fewest(&self, most: usize, excess: f64) -> Lobes {
        self.lobes(&self.fewest(most, excess))
    }

    /// The place of [`Self::fit_fewest`].
    pub(super) fn fewest(&self, most: usize, excess: f64) -> Found {
        let problems = self.problems();
        let mut fits = self.fits(&problems, most);
        let costs: Vec<Vec<f64>> = fits.iter().map(|found| found.costs(&problems)).collect();
        let worst: Vec<f64> = costs.iter().map(|costs| costs.iter().copied().fold(0.0, f64::max)).collect();
        let best = (0..fits.len()).min_by(|a, b| worst[*a].total_cmp(&worst[*b])).unwrap_or(0);
        let error = |cost: &Vec<f64>| {
            let gains = cost.iter().zip(&costs[best]).map(|(own, best)| 0.5 * (own - best).max(0.0).sqrt());
            gains.fold(0.0, f64::max)
        };
        let fewest = costs.iter().position(|cost| error(cost) <= excess).unwrap_or(best);
        fits.swap_remove(fewest)
    }

    /// The place that a search comes to from that of a stack much like this one, whose lobes are narrower or wider by a factor. Its shape of the
    /// remainder is kept.
    pub(super) fn follow(&self, from: &Found, factor: f64) -> Found {
        let lobes: Vec<Start> = from.starts().iter().map(|lobe| lobe.scaled(factor)).collect();
        let problem = Problem::new(self, from.set);
        let count = lobes.len();
        let beside = parameters(lobes, from.wide_falloff());
        let lobed = Lobed { problem: &problem, lobes: count, beside: Some(&beside) };
        let place = Place::new(beside.clone(), &lobed);
        Found { set: from.set, place: SEARCH.descend(place, &lobed, LAST_STEPS) }
    }

    /// The lobes of a place.
    pub(super) fn lobes(&self, found: &Found) -> Lobes {
        Problem::new(self, found.set).lobes(found)
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
        let problem = Lobed { problem: &problems[set], lobes: lobes.len(), beside: None };
        let place = Place::new(parameters(lobes, wide), &problem);
        Found { set, place: SEARCH.descend(place, &problem, FIRST_STEPS) }
    };
    let mut found: Vec<Found> = starts.into_iter().map(first).collect();
    found.sort_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    found.truncate(FOLLOWED);
    let last = |Found { set, place }: Found| {
        let problem = Lobed { problem: &problems[set], lobes: place.parameters.len() / PER_LOBE, beside: None };
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

/// A place that a search came to.
pub(super) struct Found {
    /// Number of the set of cells.
    pub(super) set: usize,
    pub(super) place: Place,
}

impl Found {
    /// Sum of the squared residuals of each view.
    fn costs(&self, problems: &[Problem<'_>]) -> Vec<f64> {
        let p = &self.place.parameters;
        let cost =
            |view: &ViewProblem| view.residuals(&view.profiles(p, p.len() / PER_LOBE)).iter().map(|x| x * x).sum();
        problems[self.set].views.iter().map(cost).collect()
    }

    /// Number of lobes.
    pub(super) fn lobes(&self) -> usize {
        self.place.parameters.len() / PER_LOBE
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
