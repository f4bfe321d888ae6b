//! The fit of lobes to simulated light.
//!
//! Each lobe has as unknowns its shift and the logarithms of its widths at a few nodes over the view, and its tail. The wide remainder has two
//! more. Energies are no unknowns: every view takes the energies that suit the shapes best, with the sum of the simulation (variable
//! projection, Golub and Pereyra 1973). Cells have residuals `(e - r) / sqrt(r + c)`. One fit has all views, so that lobes keep their identity
//! from view to view; with an anisotropic stack it has all azimuths, too ([`Basis`]).

mod amounts;
mod part;
mod problem;

use std::f64::consts::FRAC_PI_2;

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Diffuse, Stack, Surface};

use super::ellipse::{Numbers, Plane, logarithm};
use super::parameters::{Basis, NODES, Start, parameters};
use super::tally::{Cells, Tally};
use super::{Axes, Critical, FirstInterface, Lobes, Painted, Row, ViewAxis, Wide, base_below};
use crate::formulas::facets::ALPHA_MIN;
use crate::least_squares::{LeastSquares, Place};
use crate::references::layered_mc::ColorPaths;
pub(super) use problem::seen_from;
use problem::{Lobed, Problem};

/// Settings of a simulation and of the fit to it. The same settings give the same numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FitSettings {
    /// Rows over the view.
    pub rows: usize,
    /// Paths for each row. A row with two views gives half of them to each; an anisotropic stack traces a third of them at each azimuth.
    pub paths: u64,
    /// Family of random numbers.
    pub seed: u64,
}

impl FitSettings {
    /// Rows by default. There are 18 steps between them, which 2, 3 and 6 divide: bakes try every second, third and sixth row.
    pub const DEFAULT_ROWS: usize = 19;
}

impl Default for FitSettings {
    /// [`Self::DEFAULT_ROWS`], 32,768 paths for each.
    fn default() -> Self {
        Self { rows: Self::DEFAULT_ROWS, paths: 32_768, seed: 0 }
    }
}

/// A fit starts with tails of .09 and .79: the squared sines of these angles.
const TAIL_STARTS: [f64; 2] = [0.3, 1.1];

/// The angle of the tail of GGX, which is 1.
const GGX: f64 = FRAC_PI_2;

/// Indices of media closer than this are one.
const INDEX_STEP: f64 = 0.05;

/// Width over which the axis of the rows bends at a critical angle, over the width to which facets blur that angle.
const BLUR: f64 = 0.5;

const SEARCH: LeastSquares = LeastSquares { longest: 0.7, gain: 1e-4 };

/// Steps from every start, and further ones from the places that were best after these.
const FIRST_STEPS: u32 = 6;
const LAST_STEPS: u32 = 20;

/// Places that are followed to the end.
const FOLLOWED: usize = 2;

/// A row of an anisotropic stack traces one in so many of its paths at each azimuth.
const AZIMUTH_SHARE: u64 = 3;

/// A row with two views traces one in so many of its paths for each.
const VIEW_SHARE: u64 = 2;

/// Steps of an anisotropic fit with all views.
const POLISH_STEPS: u32 = 4;

/// Bounds of the widths with which a fit starts.
const START_WIDTHS: [f64; 2] = [1e-3, 0.8];

/// Light of a stack, view by view, in the half vectors of every medium that lobes may be in.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(super) first: Option<FirstInterface>,
    /// The axis of the rows.
    pub(super) axis: ViewAxis,
    /// The axis of the views.
    pub(super) seen: ViewAxis,
    /// Tangents of an anisotropic stack.
    pub(super) axes: Option<Axes>,
    pub(super) cells: Vec<Cells>,
    /// Ellipses with which a fit starts, and with which further lobes do.
    starts: Vec<Numbers>,
    widths: Vec<Numbers>,
    /// Light by view, in the order of [`Views`].
    pub(super) views: Vec<Tally>,
    /// The diffuse base below interfaces.
    pub(super) base: Option<Painted>,
    /// Coefficients of the remainder of a Lambertian base.
    pub(super) base_falloff: Option<[f64; 2]>,
    /// Whether the light has a wide remainder beside its lobes: all but the parts that a family splits it into.
    has_remainder: bool,
    /// Whether tails of lobes are unknowns of a fit.
    has_tail: bool,
    /// Whether lobes may have their middles beside the normal.
    has_shift: bool,
}

/// Numbers of views: from grazing views up, one azimuth after the other. All azimuths share the view along the normal, which comes last.
#[derive(Debug, Clone, Copy)]
pub(super) struct Views {
    pub(super) rows: usize,
    pub(super) axes: Option<Axes>,
}

impl Views {
    /// Number of azimuths.
    pub(super) fn azimuths(self) -> usize {
        self.axes.map_or(1, Axes::azimuths)
    }

    /// The number of a view.
    pub(super) fn number(self, azimuth: usize, row: usize) -> usize {
        let own = self.rows - 1;
        if row < own { azimuth * own + row } else { self.azimuths() * own }
    }

    /// Azimuth and row of each view.
    pub(super) fn all(self) -> impl Iterator<Item = (usize, usize)> {
        let own = self.rows - 1;
        (0..self.azimuths()).flat_map(move |azimuth| (0..own).map(move |row| (azimuth, row))).chain([(0, own)])
    }

    /// Cosine and sine of an azimuth, in the axes.
    pub(super) fn azimuth(self, number: usize) -> [f64; 2] {
        self.axes.map_or([1.0, 0.0], |axes| axes.azimuth(number as f64))
    }

    /// The azimuths before and after one. At an axis of mirror symmetry both are the azimuth on this side, the mirror image of the one beyond.
    pub(super) fn next_azimuths(self, azimuth: usize) -> [usize; 2] {
        let count = self.azimuths();
        match self.axes {
            None => [azimuth; 2],
            Some(axes) if axes.is_mirrored && azimuth == 0 => [1; 2],
            Some(axes) if axes.is_mirrored && azimuth + 1 == count => [azimuth - 1; 2],
            Some(_) => [(azimuth + count - 1) % count, (azimuth + 1) % count],
        }
    }

    /// Views around one, without itself: up to `rows` rows above and below, and both next azimuths.
    pub(super) fn around(self, azimuth: usize, row: usize, rows: usize) -> Vec<usize> {
        let along = (row.saturating_sub(rows)..(row + rows + 1).min(self.rows)).map(|row| self.number(azimuth, row));
        let across = self.next_azimuths(azimuth).map(|azimuth| self.number(azimuth, row));
        along.chain(across).filter(|view| *view != self.number(azimuth, row)).collect()
    }

    /// Views beside each: of the next rows, and of the next azimuths.
    pub(super) fn beside(self) -> Vec<Vec<usize>> {
        let (azimuths, last) = (self.azimuths(), self.rows - 1);
        let views = self.all().map(|(azimuth, row)| {
            if row == last {
                return (0..azimuths).map(|azimuth| self.number(azimuth, last - 1)).collect();
            }
            let mut beside = vec![];
            if row > 0 {
                beside.push(self.number(azimuth, row - 1));
            }
            beside.push(self.number(azimuth, row + 1));
            if self.axes.is_some() {
                beside.extend(self.next_azimuths(azimuth).map(|azimuth| self.number(azimuth, row)));
            }
            beside
        });
        views.collect()
    }
}

impl ViewAxis {
    /// The axis of so many rows of a stack.
    pub(super) fn of(stack: &Stack, rows: usize) -> Self {
        Self::new(rows, critical(stack, rows))
    }
}

impl Simulation {
    /// Traces the paths of a stack, for every row.
    pub fn new(stack: &Stack, color: &Color, settings: FitSettings) -> Self {
        Self::along(ViewAxis::of(stack, settings.rows), stack, color, settings)
    }

    /// [`Self::new`] with rows over an axis. If the axis has a critical angle, the stack is seen half way between rows, too: rows then lie so that
    /// lines between them err no more half way than at the rows ([`ViewAxis::nearest`]). Without a critical angle the noise hides that gain.
    pub(super) fn along(axis: ViewAxis, stack: &Stack, color: &Color, settings: FitSettings) -> Self {
        Self::within(&indices(stack), axis, stack, color, settings)
    }

    /// [`Self::along`] with lobes in the half vectors of media of these relative indices.
    pub(super) fn within(indices: &[f64], axis: ViewAxis, stack: &Stack, color: &Color, settings: FitSettings) -> Self {
        let first = FirstInterface::of(stack, color);
        let axes = Axes::of(stack);
        let rough = covariances(stack, axes);
        let joined = rough.iter().fold([0.0; 3], |sum, own| plus(sum, own, 1.0));
        let last = rough.last().copied().unwrap_or([0.09, 0.09, 0.0]);
        let joined_alone = alpha(&last) >= 0.7 * alpha(&joined).clamp(START_WIDTHS[0], START_WIDTHS[1]);
        let mut starts = vec![logarithm(joined, START_WIDTHS)];
        if !joined_alone {
            starts.push(logarithm(last, [START_WIDTHS[0], 1.0]));
        }
        let cells: Vec<Cells> = indices.iter().map(|&index| cells(index, &rough, axes)).collect();
        let (paths, count) = (ColorPaths::new(stack, color), settings.paths);
        let is_half = axes.is_none() && axis.critical().cot_sq > 0.0;
        let seen = if is_half { ViewAxis::new(2 * axis.size() - 1, axis.critical()) } else { axis };
        let views = Views { rows: seen.size(), axes };
        let base = base_below(stack)
            .map(|Diffuse { albedo, sigma }| Painted { albedo, is_lambertian: sigma == 0.0 && albedo != [0.0; 3] });
        let tallies = views.all().enumerate().map(|(number, (azimuth, row))| {
            let wo = seen_from(seen, views.azimuth(azimuth), row);
            // The light is traced in the tangents of the stack.
            let outside = axes.map_or(wo, |axes| axes.outside(wo));
            let count = match axes {
                None if is_half => count / VIEW_SHARE,
                None => count,
                Some(_) if row + 1 < seen.size() => count / AZIMUTH_SHARE,
                Some(_) => count,
            };
            let mut tally = Tally::new(&cells, base.is_some_and(|base| base.is_lambertian));
            // Every view has its own family of random numbers.
            let seed =
                settings.seed.wrapping_mul(views.azimuths() as u64 * seen.size() as u64).wrapping_add(number as u64);
            paths.trace(seed, count, outside, |path| {
                let wi = axes.map_or(path.wi, |axes| axes.inside(path.wi));
                // The light of one facet of the first interface is known.
                if !path.is_first_facet {
                    tally.add(&cells, [wi, wo], path.weight.map(|w| w / count as f64), path.base_visits);
                }
            });
            if let Some(first) = &first {
                tally.first_facet = first.energy(outside);
            }
            tally
        });
        let tallies: Vec<Tally> = tallies.collect();
        let base_falloff = Wide::falloff_of(axis, &tallies);
        Self {
            first,
            axis,
            seen,
            axes,
            cells,
            starts,
            widths: widths(&rough),
            views: tallies,
            base,
            base_falloff,
            has_remainder: true,
            has_tail: true,
            has_shift: true,
        }
    }

    /// The light in one set of its cells.
    pub(super) fn in_cells(&self, set: usize) -> Self {
        let mut alone = self.clone();
        alone.cells = vec![self.cells[set]];
        for view in &mut alone.views {
            view.rest = vec![view.rest.swap_remove(set)];
        }
        alone
    }

    /// The unknowns of a lobe.
    pub(super) fn basis(&self) -> Basis {
        self.axes.map_or(Basis::Isotropic, |axes| if axes.is_mirrored { Basis::Mirrored } else { Basis::Turned })
    }

    /// The numbers of the views.
    pub(super) fn numbers(&self) -> Views {
        Views { rows: self.seen.size(), axes: self.axes }
    }

    /// The `count` lobes that are nearest to the traced light.
    pub fn fit(&self, count: usize) -> Lobes {
        let problems = self.problems();
        let mut fits = self.fits(&problems, count);
        self.lobes(&self.polished(fits.pop().unwrap_or_else(|| unreachable!("there is a fit without lobes"))))
    }

    /// The fewest lobes, up to `most`, that at no view are farther from the light than the best fit by more than `excess`. The best fit has the
    /// least error at its worst view.
    ///
    /// Fits are compared by differences of squared residuals, because all of them have the noise of the paths in their errors. Residuals are
    /// divided by the roots of energies, so half the root of a difference bounds the difference of the lobe errors.
    pub fn fit_fewest(&self, most: usize, excess: f64) -> Lobes {
        self.lobes(&self.fewest(most, excess))
    }

    /// [`Self::fit_fewest`] without excess for every number of lobes from 0 up to `most`.
    pub fn fit_each(&self, most: usize) -> Vec<Lobes> {
        let problems = self.problems();
        let fits = self.fits(&problems, most);
        let founds = (0..=most).map(|most| fewest(&problems, &fits[..fits.len().min(most + 1)], 0.0));
        founds.map(|found| self.lobes(&self.polished(found))).collect()
    }

    /// One short lobe ([`Lobes::of_short`]): the nearest with the tail of GGX, for all light. `None` where the stack has none, as in [`Lobes::of_short`].
    pub fn fit_short(&self) -> Option<Lobes> {
        if self.axes.is_some() || self.base.is_some() || self.first.is_none() {
            return None;
        }
        let alone = Self { has_remainder: false, has_tail: false, ..self.clone() };
        let (problems, basis) = (alone.problems(), alone.basis());
        let starts = (0..problems.len()).flat_map(|set| {
            let shapes = alone.starts.iter();
            shapes.map(move |&shape| (set, vec![Start::new(basis, shape, GGX)], REMAINDER_START))
        });
        alone.lobes(&nearest(&problems, starts.collect())).of_short()
    }

    /// The place of [`Self::fit_fewest`].
    pub(super) fn fewest(&self, most: usize, excess: f64) -> Found {
        let problems = self.problems();
        self.polished(fewest(&problems, &self.fits(&problems, most), excess))
    }

    /// The place that a search with all views comes to.
    fn polished(&self, Found { set, place }: Found) -> Found {
        if self.axes.is_none() {
            return Found { set, place };
        }
        let problem = Problem::new(self, set);
        let lobed = Lobed::new(&problem, place.parameters.len() / self.basis().per_lobe());
        let place = Place::new(place.parameters, &lobed);
        Found { set, place: SEARCH.descend(place, &lobed, POLISH_STEPS) }
    }

    /// The place that a search finds from the place of a similar stack; the lobes of this stack are wider by `factor`. The remainder keeps its shape,
    /// unless this stack has a Lambertian base.
    pub(super) fn follow(&self, from: &Found, factor: f64) -> Found {
        self.beside(from, factor, self.base_falloff.unwrap_or(from.wide_falloff()))
    }

    /// [`Self::follow`] with a given shape of the remainder.
    pub(super) fn with_falloff(&self, from: &Found, falloff: [f64; 2]) -> Found {
        self.beside(from, 1.0, falloff)
    }

    fn beside(&self, from: &Found, factor: f64, falloff: [f64; 2]) -> Found {
        let lobes: Vec<Start> = from.starts(self.basis()).iter().map(|lobe| lobe.scaled(factor)).collect();
        let problem = Problem::new(self, from.set);
        let count = lobes.len();
        let beside = parameters(lobes, falloff);
        let lobed = Lobed { problem: &problem, lobes: count, beside: Some(&beside) };
        let place = Place::new(beside.clone(), &lobed);
        Found { set: from.set, place: SEARCH.descend(place, &lobed, LAST_STEPS) }
    }

    /// The lobes of a place.
    pub(super) fn lobes(&self, found: &Found) -> Lobes {
        let mut lobes = Problem::new(self, found.set).lobes(found);
        lobes.rows = lobes.rows.into_iter().map(Row::bounded).collect();
        lobes
    }

    /// Share of the light from a diffuse base that the layers send back to it.
    ///
    /// Light forgets at a Lambertian base where it came from, so the layers send back the same share of it after every visit. Each further visit
    /// scales the light by albedo times share: this product is the part of the base's light that met the base more than once.
    pub(super) fn internal(&self) -> Option<Rgb> {
        let albedo = self.base?.albedo;
        Some([0, 1, 2].map(|c: usize| {
            let once: f64 = self.views.iter().map(|tally| tally.base_once[c]).sum();
            let all: f64 = self.views.iter().map(|tally| tally.base[c]).sum();
            ratio(ratio(all - once, all), albedo[c]).clamp(0.0, 1.0)
        }))
    }

    fn problems(&self) -> Vec<Problem<'_>> {
        (0..self.cells.len()).map(|set| Problem::coarse(self, set)).collect()
    }

    /// Fits without a lobe, with one, and so on, until another lobe gains nothing.
    fn fits(&self, problems: &[Problem<'_>], most: usize) -> Vec<Found> {
        let (basis, falloff) = (self.basis(), self.base_falloff.unwrap_or(REMAINDER_START));
        let mut alone = Vec::new();
        for (set, &shape) in (0..problems.len()).flat_map(|set| self.starts.iter().map(move |shape| (set, shape))) {
            alone.extend(TAIL_STARTS.map(|tail| (set, vec![Start::new(basis, shape, tail)], falloff)));
        }
        let one = (most > 0).then(|| nearest(problems, alone));
        // The fit without lobes uses the cells of the others, so that residuals compare.
        let set = one.as_ref().map_or(0, |one| one.set);
        let mut fits = vec![nearest(problems, vec![(set, Vec::new(), falloff)])];
        fits.extend(one);
        // Each round adds a lobe to the last fit: its last lobe made wider or narrower, or an interface's.
        for count in 1..most {
            let fewer = &fits[count];
            let (lobes, wide) = (fewer.starts(basis), fewer.wide_falloff());
            let last = &lobes[lobes.len() - 1];
            let scaled = [2.5, 0.4].map(|factor| last.scaled(factor));
            let of_interfaces = self.widths.iter().map(|&shape| Start::new(basis, shape, 0.0));
            let starts = scaled.into_iter().chain(of_interfaces).flat_map(|another| {
                TAIL_STARTS.map(|tail| {
                    let mut starts = lobes.clone();
                    starts.push(Start { tail, ..another.clone() });
                    (fewer.set, starts, wide)
                })
            });
            let more = nearest(problems, starts.collect());
            if more.place.cost >= fewer.place.cost {
                break;
            }
            fits.push(more);
        }
        fits
    }
}

/// The fit of the fewest lobes that suffices, see [`Simulation::fit_fewest`].
fn fewest(problems: &[Problem<'_>], fits: &[Found], excess: f64) -> Found {
    let costs: Vec<Vec<f64>> = fits.iter().map(|found| found.costs(problems)).collect();
    let worst: Vec<f64> = costs.iter().map(|costs| costs.iter().copied().fold(0.0, f64::max)).collect();
    let best = (0..fits.len()).min_by(|a, b| worst[*a].total_cmp(&worst[*b])).unwrap_or(0);
    let fewest = costs.iter().position(|cost| {
        let gains = cost.iter().zip(&costs[best]).map(|(own, best)| 0.5 * (own - best).max(0.0).sqrt());
        gains.fold(0.0, f64::max) <= excess
    });
    fits[fewest.unwrap_or(best)].clone()
}

/// `a / b`; 0 unless b is positive.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// Coefficients of the remainder with which a fit starts.
const REMAINDER_START: [f64; 2] = [0.3, 0.0];

/// The best place of searches from some starts. A start has the number of a set of cells, lobes, and the falloff of the remainder.
fn nearest(problems: &[Problem<'_>], starts: Vec<(usize, Vec<Start>, [f64; 2])>) -> Found {
    let first = starts.into_iter().map(|(set, lobes, wide)| {
        let problem = Lobed::new(&problems[set], lobes.len());
        let place = Place::new(parameters(lobes, wide), &problem);
        Found { set, place: SEARCH.descend(place, &problem, FIRST_STEPS) }
    });
    let mut first: Vec<Found> = first.collect();
    first.sort_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    let last = first.into_iter().take(FOLLOWED).map(|Found { set, place }| {
        let problem = Lobed::new(&problems[set], place.parameters.len() / problems[set].basis.per_lobe());
        Found { set, place: SEARCH.descend(place, &problem, LAST_STEPS) }
    });
    let best = last.min_by(|a, b| a.place.cost.total_cmp(&b.place.cost));
    best.unwrap_or_else(|| unreachable!("there is a start"))
}

/// Squares of slope parameters, as a matrix: along x, along y, and between them.
pub(super) type Covariance = [f64; 3];

/// Covariances of the interfaces of a stack in axes.
pub(super) fn covariances(stack: &Stack, axes: Option<Axes>) -> Vec<Covariance> {
    let rough = stack.layers.iter().filter(|layer| !matches!(layer.base, Base::Diffuse(_)));
    rough.map(|layer| covariance(&layer.surface, axes)).collect()
}

/// The covariance of a surface in axes.
fn covariance(surface: &Surface, axes: Option<Axes>) -> Covariance {
    let [x, y] = [surface.alpha_x, surface.alpha_y].map(|alpha| alpha.max(ALPHA_MIN) * alpha.max(ALPHA_MIN));
    let Some(axes) = axes.filter(|_| x != y) else { return [x, y, 0.0] };
    let (sin, cos) = libm::sincos(surface.rotation);
    let [cos, sin] = [axes.turn[0] * cos + axes.turn[1] * sin, axes.turn[0] * sin - axes.turn[1] * cos];
    [cos * cos * x + sin * sin * y, sin * sin * x + cos * cos * y, cos * sin * (x - y)]
}

fn plus(a: Covariance, b: &Covariance, factor: f64) -> Covariance {
    [0, 1, 2].map(|i: usize| a[i] + factor * b[i])
}

/// The slope parameter of the circle that has the area of an ellipse.
fn alpha([xx, yy, xy]: &Covariance) -> f64 {
    (xx * yy - xy * xy).max(0.0).sqrt().sqrt()
}

/// Ellipses of lobes that interfaces below the first may send, each blurred by the interfaces above. Nearly equal ones count once.
fn widths(surfaces: &[Covariance]) -> Vec<Numbers> {
    let mut joined = [0.0; 3];
    let mut widths: Vec<(f64, Numbers)> = Vec::new();
    for (i, own) in surfaces.iter().enumerate() {
        joined = plus(joined, own, 1.0);
        let width = alpha(&joined).clamp(START_WIDTHS[0], START_WIDTHS[1]);
        if i > 0 && widths.iter().all(|(known, _)| width > WIDTH_STEP * known) {
            widths.push((width, logarithm(joined, START_WIDTHS)));
        }
    }
    widths.into_iter().map(|(_, shape)| shape).collect()
}

/// Ratio of widths from which on two ellipses differ.
const WIDTH_STEP: f64 = 1.6;

/// Least share of the first interface's covariance in the lobe of the next interface: refraction by an index of 1.5, along the normal.
const BLURRED: f64 = 1.0 / 16.0;

/// Greatest stretch of cells: half the logarithm of the ratio of widths, which is 8. There is a limit because wide light is seen in the same cells.
const STRETCH: f64 = 1.04;

/// Cells in the half vectors of a medium. Those of an anisotropic stack are stretched as the narrowest lobe from below.
pub(super) fn cells(index: f64, surfaces: &[Covariance], axes: Option<Axes>) -> Cells {
    if axes.is_none() {
        return Cells::new(index, surfaces.iter().map(alpha).fold(1.0, f64::min).max(1e-3));
    }
    let narrowest = match surfaces {
        [first, second, ..] => plus(*second, first, BLURRED),
        // One interface: light comes from a diffuse base or from several facets, and is wide.
        rest => {
            rest.first().map_or([1.0, 1.0, 0.0], |only| [alpha(only) * alpha(only), alpha(only) * alpha(only), 0.0])
        }
    };
    let [_, mean, b, c] = logarithm(narrowest, [1e-3, 1.0]);
    let share = (STRETCH / libm::hypot(b, c).max(STRETCH)).min(1.0);
    Cells::stretched(index, Plane::OfTangents([0.0; 2]).shape([0.0, mean, share * b, share * c], 0.0))
}

/// The relative indices in whose half vectors lobes may be: one next to 1, the index of the first medium, and the index of the last.
///
/// Half vectors outside have index 1, but lobes in them do not fall towards the horizon. Facets of slope parameter alpha mask flat light, in
/// proportion to `2 cos / alpha` (Smith's G1 of GGX). Lobes of index n fall as `cos / sqrt(n^2 - 1)`, so `n^2 = 1 + alpha^2 / 4` masks alike.
pub(super) fn indices(stack: &Stack) -> Vec<f64> {
    let exterior = stack.exterior.at(REFERENCE_NM).re;
    let media = stack.layers.iter().filter_map(|layer| match &layer.base {
        Base::Dielectric { ior, .. } => Some(ior.at(REFERENCE_NM).re / exterior),
        Base::Conductor { .. } | Base::Diffuse(_) => None,
    });
    let media: Vec<f64> = media.collect();
    let masked = stack.layers.first().filter(|first| !matches!(first.base, Base::Diffuse(_)));
    let alpha = masked.map_or(0.0, |first| first.surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0));
    let mut indices = vec![(1.0 + 0.25 * alpha * alpha).sqrt()];
    for index in media.first().into_iter().chain(media.last()).copied() {
        if indices.iter().all(|known| index > known + INDEX_STEP || index < known - INDEX_STEP) && index > 1.0 {
            indices.push(index);
        }
    }
    indices
}

/// The critical angle of the view for the medium of the least index, blurred by the interfaces above that medium. A sharp kink of a medium above is
/// preferred to a blurred one.
fn critical(stack: &Stack, rows: usize) -> Critical {
    let exterior = stack.exterior.at(REFERENCE_NM).re;
    let mut found = (1.0, 0.0);
    let mut joined_sq = 0.0;
    for layer in &stack.layers {
        let Base::Dielectric { ior, .. } = &layer.base else { break };
        let alpha = layer.surface.alpha_isotropic().max(ALPHA_MIN);
        joined_sq += alpha * alpha;
        let index = ior.at(REFERENCE_NM).re / exterior;
        let is_sharp = found.0 == 1.0 || joined_sq.sqrt() < SHARPEST * found.1;
        if index < found.0 && is_sharp {
            found = (index, joined_sq.sqrt());
        }
    }
    let (index, alpha): (f64, f64) = found;
    // A facet that tilts by alpha turns the angle by as much: the squared cosine inside by 2 alpha sqrt(1 - n^2) / n.
    let width = 2.0 * BLUR * alpha * ((1.0 - index) * (1.0 + index)).sqrt() / index;
    Critical::new(index, width, rows)
}

/// A kink yields the rows to another if its blur is at least so many times as wide.
const SHARPEST: f64 = 2.0;

/// The wavelength at which directions are refracted: the sodium D line.
const REFERENCE_NM: f64 = 589.3;

/// A place that a search came to.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// Number of the set of cells.
    pub(super) set: usize,
    pub(super) place: Place,
}

impl Found {
    /// Sum of the squared residuals of each view.
    fn costs(&self, problems: &[Problem<'_>]) -> Vec<f64> {
        let (p, problem) = (&self.place.parameters, &problems[self.set]);
        let count = p.len() / problem.basis.per_lobe();
        let residuals = problem.views.iter().map(|view| view.residuals(&view.profiles(p, count)));
        residuals.map(|residuals| residuals.iter().map(|x| x * x).sum()).collect()
    }

    /// The lobes found.
    pub(super) fn starts(&self, basis: Basis) -> Vec<Start> {
        let p = &self.place.parameters;
        let lobes = p[..p.len() - 2].chunks(basis.per_lobe()).map(|lobe| Start {
            rows: lobe.chunks_exact(NODES).map(<[f64]>::to_vec).collect(),
            tail: lobe[lobe.len() - 1],
        });
        lobes.collect()
    }

    pub(super) fn wide_falloff(&self) -> [f64; 2] {
        let p = &self.place.parameters;
        [p[p.len() - 2], p[p.len() - 1]]
    }
}
