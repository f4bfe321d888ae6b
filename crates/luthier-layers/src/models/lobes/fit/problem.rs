//! The least-squares problem of a fit: residuals of all views in one set of cells, and their slopes.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;

use super::amounts::{Amounts, Guess};
use super::{Found, Simulation, Views};
use crate::least_squares::{Column, Residuals};
use crate::models::lobes::ellipse::{Numbers, Plane};
use crate::models::lobes::half_vector::{outside, refracted};
use crate::models::lobes::parameters::{Basis, NODES, SHIFT, Term};
use crate::models::lobes::tally::{Cells, Point, Tally, mean};
use crate::models::lobes::{Axes, BaseLight, Frame, Lobe, Lobes, Row, Shape, TAIL_MIN, ViewAxis, Wide};

/// Shapes with less than this share above the horizon are penalised: energies are divided by the share.
const SHARE_WANTED: f64 = 0.35;

/// Weight of a share's lack to [`SHARE_WANTED`].
const SHARE_WEIGHT: f64 = 0.5;

/// Both for the lobe of a part of the light: shapes beyond the horizon would be good at their own view alone.
const SHARE_OF_PART: [f64; 2] = [0.2, 5.0];

/// Weight of second differences between nodes.
const RIPPLE_WEIGHT: f64 = 0.03;
/// Weight of shifts and of ratios of widths, which are pulled to 0.
const REST_WEIGHT: f64 = 0.003;

/// Weight of the distance to the parameters of a neighbour.
const BESIDE_WEIGHT: f64 = 0.05;

/// Added to the energy of a cell before its residual is weighed, over the mean energy of cells: dark cells would weigh without bound.
const WEIGHT_FLOOR: f64 = 0.05;

/// Mean number of paths per cell at which half of a cell's weight comes from its own light, see [`expected`].
const MANY_PATHS: f64 = 64.0;

/// The light of so many rows above and below a view weighs its residuals; in steps of the axis of the lobes.
const WEIGHT_ROWS: usize = 2;

/// Step of the difference quotients along profiles.
const DIFFERENCE: f64 = 1e-5;

/// The fit in one set of cells.
pub(super) struct Problem<'a> {
    simulation: &'a Simulation,
    set: usize,
    pub(super) basis: Basis,
    pub(super) views: Vec<ViewProblem>,
}

/// One view of a problem.
pub(in crate::models::lobes) struct ViewProblem {
    axis: ViewAxis,
    /// Whether the light has a wide remainder beside its lobes.
    has_remainder: bool,
    /// Whether tails are unknowns.
    has_tail: bool,
    basis: Basis,
    wo: DVec3,
    plane: Plane,
    /// Terms of each number of an ellipse.
    terms: [Vec<Term>; 4],
    /// Place among the nodes of shapes.
    place: f64,
    points: Vec<Point>,
    /// Brightness of the cells, see [`brightness`].
    found: Vec<f64>,
    total: f64,
    /// Weights of squared residuals, see [`expected`], and their roots.
    weights: Vec<f64>,
    roots: Vec<f64>,
}

/// Light that every part of given shapes sends to each cell of a view, of a unit of its energy.
pub(super) struct Profiles {
    cells: Vec<Vec<f64>>,
    /// Shares of the shapes above the horizon, as the cells have them.
    shares: Vec<f64>,
}

/// A problem with a number of lobes. Its blocks are the views, the ripples, and last the distance to the parameters of a neighbour.
pub(super) struct Lobed<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) lobes: usize,
    /// Parameters of a neighbouring node, if rows are to be mixed with its rows. The remainder keeps the neighbour's shape, and lobes stay near the
    /// neighbour's, so that they keep their identity.
    pub(super) beside: Option<&'a [f64]>,
}

impl<'a> Lobed<'a> {
    /// The problem of a stack without neighbours.
    pub(super) fn new(problem: &'a Problem<'a>, lobes: usize) -> Self {
        Self { problem, lobes, beside: None }
    }
}

impl Residuals for Lobed<'_> {
    fn blocks(&self) -> usize {
        self.problem.views.len() + 1 + usize::from(self.beside.is_some())
    }

    fn block(&self, p: &[f64], block: usize) -> Vec<f64> {
        match (self.problem.views.get(block), self.beside) {
            (Some(view), _) => view.residuals(&view.profiles(p, self.lobes)),
            (None, Some(beside)) if block > self.problem.views.len() => p[..self.lobes * self.problem.basis.per_lobe()]
                .iter()
                .zip(beside)
                .map(|(p, beside)| BESIDE_WEIGHT * (p - beside))
                .collect(),
            (None, _) => ripple(p, self.lobes, self.problem.basis),
        }
    }

    fn slopes(&self, p: &[f64], block: usize, now: &[f64]) -> Vec<Column> {
        match self.problem.views.get(block) {
            Some(view) => {
                let mut columns = view.slopes(p, self.lobes, now);
                let is_kept = self.beside.is_some() || self.problem.simulation.base_falloff.is_some();
                columns.retain(|(number, _)| !is_kept || *number < p.len() - 2);
                columns
            }
            None if block > self.problem.views.len() => {
                let count = self.lobes * self.problem.basis.per_lobe();
                let mut columns: Vec<Column> = (0..count).map(|j| (j, vec![0.0; count])).collect();
                columns.iter_mut().for_each(|(j, slopes)| slopes[*j] = BESIDE_WEIGHT);
                columns
            }
            None => ripple_slopes(p, self.lobes, self.problem.basis),
        }
    }
}

impl<'a> Problem<'a> {
    pub(super) fn new(simulation: &'a Simulation, set: usize) -> Self {
        Self::of(simulation, set, |_, _| true)
    }

    /// The problem of a few views of an anisotropic stack: every other row at the first azimuth, one or two in the middle, and the last. An
    /// isotropic stack keeps all views.
    pub(super) fn coarse(simulation: &'a Simulation, set: usize) -> Self {
        let Some(axes) = simulation.axes else { return Self::new(simulation, set) };
        let kept: &[usize] = if axes.is_mirrored { &[0, 3, 7] } else { &[0, 2, 4, 5] };
        let last = simulation.seen.size() - 1;
        Self::of(simulation, set, |azimuth, row| (last - row).is_multiple_of(2) && kept.contains(&azimuth))
    }

    fn of(simulation: &'a Simulation, set: usize, keep: impl Fn(usize, usize) -> bool) -> Self {
        let (axis, basis, numbers) = (simulation.seen, simulation.basis(), simulation.numbers());
        let found: Vec<Vec<f64>> = simulation.views.iter().map(|tally| brightness(tally, set)).collect();
        let nodes = ViewAxis::new(NODES, axis.critical());
        let cells = &simulation.cells[set];
        let views = numbers.all().filter(|(azimuth, row)| keep(*azimuth, *row)).map(|(azimuth, row)| {
            let [cos, sin] = numbers.azimuth(azimuth);
            let wo = seen_from(axis, [cos, sin], row);
            let sin_theta = direction(wo.z).x;
            let number = numbers.number(azimuth, row);
            let around = numbers.around(azimuth, row, WEIGHT_ROWS * (axis.size() - 1) / (simulation.axis.size() - 1));
            let around: Vec<&[f64]> = around.iter().map(|view| found[*view].as_slice()).collect();
            let expected = expected(cells, &found[number], &around, simulation.views[number].paths());
            let floor = WEIGHT_FLOOR / cells.count() as f64;
            let weights: Vec<f64> = expected.iter().map(|energy| 1.0 / (energy + floor)).collect();
            let found = found[number].clone();
            let mut terms = basis.terms(sin_theta * sin_theta, [(cos - sin) * (cos + sin), 2.0 * cos * sin]);
            terms.retain(|term| simulation.has_shift || term.number != SHIFT);
            ViewProblem {
                axis,
                has_remainder: simulation.has_remainder,
                has_tail: simulation.has_tail,
                basis,
                wo,
                plane: if simulation.axes.is_some() {
                    Plane::OfTangents([wo.x, wo.y])
                } else {
                    Plane::OfEye(sin_theta)
                },
                terms: [0, 1, 2, 3].map(|number| terms.iter().copied().filter(|t| t.number == number).collect()),
                place: nodes.place(wo.z),
                points: cells.points(wo),
                total: found.iter().sum(),
                found,
                roots: weights.iter().map(|weight| weight.sqrt()).collect(),
                weights,
            }
        });
        Self { simulation, set, basis, views: views.collect() }
    }

    /// Energies by view, part and channel.
    ///
    /// At views where parts look alike, light does not tell how much each of them has. Noise would decide, and between rows the energy of one part
    /// would be seen with the shape of another. So the energies of a view are pulled to those of the views beside it. All light of a Lambertian
    /// base goes to the remainder: a lobe with some of it would keep the base's colour.
    pub(super) fn energies(&self, p: &[f64], count: usize) -> Vec<Vec<Rgb>> {
        let profiles: Vec<Vec<Vec<f64>>> = self.views.iter().map(|view| view.profiles(p, count).cells).collect();
        let amounts: Vec<Amounts<'_>> =
            self.views.iter().zip(&profiles).map(|(view, profiles)| Amounts::new(profiles, &view.weights)).collect();
        let beside = self.simulation.numbers().beside();
        let tallies = &self.simulation.views;
        let brightness = smoothed(&beside, |view, guess| {
            amounts[view].positive(&self.views[view].found, self.views[view].total, guess)
        });
        let channels = [0, 1, 2].map(|c: usize| {
            smoothed(&beside, |view, guess| {
                let tally = &tallies[view];
                let cells: Vec<f64> = tally.rest[self.set].iter().map(|rgb| rgb[c]).collect();
                amounts[view].among(&brightness[view], &cells, tally.total[c], guess)
            })
        });
        let energies = (0..amounts.len()).map(|view| {
            let parts = (0..=count).map(|part| {
                let of_base = if part == count { tallies[view].of_lambertian() } else { [0.0; 3] };
                // Without a remainder there is no such part.
                [0, 1, 2].map(|c: usize| channels[c][view].get(part).copied().unwrap_or(0.0) + of_base[c])
            });
            parts.collect()
        });
        energies.collect()
    }

    /// The lobes of the parameters found, with energies by channel.
    pub(super) fn lobes(&self, found: &Found) -> Lobes {
        let p = &found.place.parameters;
        let count = p.len() / self.basis.per_lobe();
        let energies = self.energies(p, count);
        let Simulation { first, axis, seen, axes, cells, .. } = self.simulation;
        let (index, internal, wide) = (cells[self.set].index, self.simulation.internal(), wide_of(p, *axis));
        let views = self.views.iter().zip(&self.simulation.views).zip(&energies);
        let rows = views.map(|((view, tally), energies)| Row {
            albedo_dir: [0, 1, 2].map(|c: usize| tally.first_facet[c] + energies.iter().map(|rgb| rgb[c]).sum::<f64>()),
            lobes: (0..count).map(|lobe| view.lobe(p, lobe, index, energies[lobe])).collect(),
            wide: energies[count],
            base: internal.map(|internal| BaseLight {
                energy: tally.base,
                internal,
                falloff: self.simulation.base_falloff.map_or([0.0; 2], |_| wide.falloff()),
                lengths: [0.0; 3],
                met: None,
            }),
        });
        let rows: Vec<Row> = rows.collect();
        let numbers = self.simulation.numbers();
        let rows = if seen == axis {
            let azimuths = (0..axes.map_or(1, |_| Axes::TILES)).map(|tile| tile % numbers.azimuths());
            let views = azimuths.flat_map(|azimuth| (0..axis.size()).map(move |row| (azimuth, row)));
            views.map(|(azimuth, row)| balanced(&rows, numbers, azimuth, row)).collect()
        } else {
            let cosines: Vec<f64> = self.views.iter().map(|view| view.wo.z).collect();
            axis.nearest(&rows, &cosines)
        };
        Lobes {
            first: first.clone(),
            frame: Frame { axes: *axes, base: self.simulation.base, ..Frame::new(index, wide) },
            axis: *axis,
            rows,
        }
    }
}

/// Brightness of the cells, a mean of the channels, over the brightness of all light of the view.
fn brightness(tally: &Tally, set: usize) -> Vec<f64> {
    let all = [tally.total, tally.first_facet, tally.of_lambertian()].map(mean).iter().sum::<f64>();
    let all = all.max(f64::MIN_POSITIVE);
    tally.rest[set].iter().map(|rgb| mean(*rgb).max(0.0) / all).collect()
}

/// Expected brightness of the cells of a view, by which residuals are weighed. With many paths it is the brightness found; with few it is the mean
/// over views around, smoothed over the cells around each.
///
/// With weights from the found brightness alone, a cell that happens to be too dark weighs more than one that is too bright. Cells of few paths
/// would then come out too dark (Baker and Cousins 1984, of Neyman's chi-square), and others too bright.
fn expected(cells: &Cells, found: &[f64], around: &[&[f64]], paths: f64) -> Vec<f64> {
    let means = (0..cells.count()).map(|cell| around.iter().map(|view| view[cell]).sum::<f64>() / around.len() as f64);
    let smooth = cells.smoothed(&means.collect::<Vec<_>>());
    let many = paths / (MANY_PATHS * cells.count() as f64);
    let share = 1.0 / (1.0 + many * many);
    found.iter().zip(smooth).map(|(found, smooth)| found + share * (smooth - found)).collect()
}

/// The row of an azimuth, moved so that chords between azimuths err as much at their ends as half way.
///
/// Half way, a chord through unmoved rows is off by an eighth of the second difference.
fn balanced(rows: &[Row], numbers: Views, azimuth: usize, row: usize) -> Row {
    let here = &rows[numbers.number(azimuth, row)];
    let Some(axes) = numbers.axes else { return here.clone() };
    let next = numbers.next_azimuths(azimuth);
    let [before, after] = next.map(|next| &rows[numbers.number(next, row)]);
    let mut moved = here.between(&before.between(after, 0.5), -0.125);
    for (moved, own) in moved.lobes.iter_mut().zip(&here.lobes) {
        // The move takes no light below 0, unless noise has done so already.
        (0..3).for_each(|c| moved.strength[c] = moved.strength[c].max(own.strength[c].min(0.0)));
        moved.share = moved.share.min(1.0);
        // Shears are odd: at an axis of mirror symmetry those on both sides cancel. Both neighbours here are the row on one side.
        if axes.is_mirrored && next[0] == next[1] {
            moved.shear = own.shear;
        }
    }
    (0..3).for_each(|c| moved.wide[c] = moved.wide[c].max(here.wide[c].min(0.0)));
    moved
}

/// Least share above the horizon by which an energy is divided.
const SHARE_MIN: f64 = 1e-3;

/// Weight of the squared distance to the energies of neighbours, against squared residuals over energies.
const NEIGHBOUR_WEIGHT: f64 = 0.1;

/// Rounds in which neighbours pull each other.
const NEIGHBOUR_ROUNDS: u32 = 8;

/// Amounts by view, each pulled to the mean of its neighbours. `solve` gives the amounts of a view for a guess.
fn smoothed(beside: &[Vec<usize>], solve: impl Fn(usize, Option<Guess<'_>>) -> Vec<f64>) -> Vec<Vec<f64>> {
    let mut amounts: Vec<Vec<f64>> = (0..beside.len()).map(|view| solve(view, None)).collect();
    for _ in 0..NEIGHBOUR_ROUNDS {
        for (view, beside) in beside.iter().enumerate() {
            let share = 1.0 / beside.len() as f64;
            let means = (0..amounts[view].len())
                .map(|part| share * beside.iter().map(|other| amounts[*other][part]).sum::<f64>());
            let guess: Vec<f64> = means.collect();
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
    let above = (0..SHARE_POINTS).filter(|i| {
        let u = STEP.map(|step| {
            let place = 0.5 + step * f64::from(*i);
            place - libm::floor(place)
        });
        outside(shape.sample(u), eye, index).is_some()
    });
    above.count() as f64 / f64::from(SHARE_POINTS)
}

fn tail_of(angle: f64) -> f64 {
    let sin = libm::sin(angle);
    sin * sin
}

fn wide_of(p: &[f64], axis: ViewAxis) -> Wide {
    Wide::new([p[p.len() - 2], p[p.len() - 1]], axis)
}

/// Second differences of rows, and shifts and ratios themselves: against ripples.
fn ripple(p: &[f64], lobes: usize, basis: Basis) -> Vec<f64> {
    let mut out = Vec::new();
    for lobe in p[..lobes * basis.per_lobe()].chunks(basis.per_lobe()) {
        for (i, row) in lobe[..basis.rows() * NODES].chunks(NODES).enumerate() {
            out.extend(row.windows(3).map(|t| RIPPLE_WEIGHT * (t[0] - 2.0 * t[1] + t[2])));
            if basis.is_small(i) {
                out.extend(row.iter().map(|value| REST_WEIGHT * value));
            }
        }
    }
    out
}

/// Slopes of [`ripple`], which is linear.
fn ripple_slopes(p: &[f64], lobes: usize, basis: Basis) -> Vec<Column> {
    let per_lobe = basis.per_lobe();
    let columns = (0..lobes * per_lobe).filter(|j| j % per_lobe + 1 < per_lobe).map(|j| {
        let mut unit = vec![0.0; p.len()];
        unit[j] = 1.0;
        (j, ripple(&unit, lobes, basis))
    });
    columns.collect()
}

/// Light that a shape or the remainder sends to each cell, and its slopes by a few numbers.
struct Sent<const N: usize> {
    cells: Vec<f64>,
    slopes: [Vec<f64>; N],
}

impl<const N: usize> Sent<N> {
    fn new(cells: usize) -> Self {
        Self { cells: vec![0.0; cells], slopes: std::array::from_fn(|_| vec![0.0; cells]) }
    }

    /// Adds a value and its relative slopes to a cell.
    fn add(&mut self, cell: usize, value: f64, relative: [f64; N]) {
        self.cells[cell] += value;
        self.slopes.iter_mut().zip(relative).for_each(|(slopes, relative)| slopes[cell] += value * relative);
    }

    /// The slopes of the cells for a unit of energy, and the slope of the share.
    fn normalised(&self) -> [(Vec<f64>, f64); N] {
        let share = self.cells.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        self.slopes.each_ref().map(|slopes| {
            let slope: f64 = slopes.iter().sum();
            let of_unit = slopes.iter().zip(&self.cells).map(|(slopes, cell)| (slopes - cell / share * slope) / share);
            (of_unit.collect(), slope)
        })
    }
}

impl ViewProblem {
    /// The node of shapes before the view, and the share of the next.
    fn node(&self) -> (usize, f64) {
        let first = (self.place as usize).min(NODES - 2);
        (first, self.place - first as f64)
    }

    fn numbers(&self, p: &[f64], lobe: usize) -> Numbers {
        let own = &p[lobe * self.basis.per_lobe()..];
        let (first, t) = self.node();
        self.terms.each_ref().map(|terms| {
            let values = terms.iter().map(|term| {
                let row = &own[term.row * NODES..];
                term.factor * (row[first] + t * (row[first + 1] - row[first]))
            });
            values.sum()
        })
    }

    /// The angle of the tail of a lobe.
    fn tail_angle(&self, p: &[f64], lobe: usize) -> f64 {
        p[(lobe + 1) * self.basis.per_lobe() - 1]
    }

    fn shape(&self, p: &[f64], lobe: usize) -> Shape {
        self.plane.shape(self.numbers(p, lobe), tail_of(self.tail_angle(p, lobe)))
    }

    /// A lobe with its energy by channel, in the half vectors of a medium of relative index `index`.
    pub(in crate::models::lobes) fn lobe(&self, p: &[f64], lobe: usize, index: f64, energy: Rgb) -> Lobe {
        let shape = self.shape(p, lobe);
        let share = share_above(&shape, self.wo, index);
        let [x, y, shear] = shape.sharpness();
        let shift = match self.plane {
            Plane::OfEye(sin) if sin > 0.0 => shape.middle[0] / sin,
            // Along the normal the sine is 0: the shift is the parameter of the last node.
            Plane::OfEye(_) => p[lobe * self.basis.per_lobe() + SHIFT * NODES + NODES - 1],
            Plane::OfTangents(_) => self.numbers(p, lobe)[SHIFT],
        };
        let strength = energy.map(|energy| energy / share.max(SHARE_MIN));
        Lobe { strength, share, shift, sharpness: [x, y], shear, tail: shape.tail }
    }

    /// Light of a shape by cell, with slopes by the middle and by the logarithms of the widths as [`super::ellipse::Slopes`] has them, and by the
    /// angle of the tail.
    fn sent(&self, shape: &Shape, tail_angle: f64) -> Sent<6> {
        let mut sent = Sent::new(self.found.len());
        let tail = shape.tail.max(TAIL_MIN);
        let tail_slope = if shape.tail > TAIL_MIN { libm::sin(2.0 * tail_angle) } else { 0.0 };
        let norm = 1.0 / (PI * shape.width[0] * shape.width[1]);
        // The slope of the logarithm's exponential off the diagonal, over the product of the widths.
        let log_ratio = libm::log(shape.width[0] / shape.width[1]);
        let shear = if log_ratio.abs() < 1e-6 { 2.0 } else { 2.0 * libm::sinh(log_ratio) / log_ratio };
        for point in &self.points {
            let [x, y] = shape.scaled(point.slope);
            let q = x * x + y * y;
            let log = libm::log1p(tail * q);
            let density = norm * libm::exp(-(1.0 + 1.0 / tail) * log);
            let steep = 2.0 * (1.0 + tail) / (1.0 + tail * q);
            let by_tail = log / (tail * tail) - 0.5 * steep * q / tail;
            let relative = [
                steep * x / shape.width[0],
                steep * y / shape.width[1],
                steep * x * x - 1.0,
                steep * y * y - 1.0,
                steep * shear * x * y,
                by_tail * tail_slope,
            ];
            sent.add(point.cell, density * point.area, relative);
        }
        sent
    }

    pub(super) fn profiles(&self, p: &[f64], lobes: usize) -> Profiles {
        let mut cells = vec![vec![0.0; self.found.len()]; lobes + usize::from(self.has_remainder)];
        for (lobe, profile) in cells[..lobes].iter_mut().enumerate() {
            let shape = self.shape(p, lobe);
            self.points.iter().for_each(|point| profile[point.cell] += shape.density(point.slope) * point.area);
        }
        if let Some(remainder) = cells.get_mut(lobes) {
            let wide = wide_of(p, self.axis);
            for point in &self.points {
                remainder[point.cell] += wide.value(point.cos_theta) * point.cos_theta * point.solid_angle;
            }
        }
        let shares: Vec<f64> = cells.iter().map(|profile| profile.iter().sum()).collect();
        for (profile, share) in cells.iter_mut().zip(&shares) {
            let share = share.max(f64::MIN_POSITIVE);
            profile.iter_mut().for_each(|energy| *energy /= share);
        }
        Profiles { cells, shares }
    }

    pub(super) fn residuals(&self, profiles: &Profiles) -> Vec<f64> {
        let Profiles { cells, shares } = profiles;
        let energies = Amounts::new(cells, &self.weights).positive(&self.found, self.total, None);
        let residuals = (0..self.found.len()).map(|cell| {
            let sent: f64 = cells.iter().zip(&energies).map(|(profile, energy)| profile[cell] * energy).sum();
            self.roots[cell] * (self.found[cell] - sent)
        });
        let lobes = shares.len() - usize::from(self.has_remainder);
        let [wanted, weight] = if self.has_tail { [SHARE_WANTED, SHARE_WEIGHT] } else { SHARE_OF_PART };
        residuals.chain(shares[..lobes].iter().map(|share| weight * (wanted - share).max(0.0))).collect()
    }

    /// Difference quotients of the residuals, which are `now`, along slopes of a part's cells and share.
    fn along(&self, profiles: &mut Profiles, part: usize, slopes: &(Vec<f64>, f64), now: &[f64]) -> Vec<f64> {
        let (before, share_before) = (profiles.cells[part].clone(), profiles.shares[part]);
        profiles.cells[part].iter_mut().zip(&slopes.0).for_each(|(cell, slope)| *cell += DIFFERENCE * slope);
        profiles.shares[part] += DIFFERENCE * slopes.1;
        let there = self.residuals(profiles);
        (profiles.cells[part], profiles.shares[part]) = (before, share_before);
        there.iter().zip(now).map(|(a, b)| (a - b) / DIFFERENCE).collect()
    }

    /// Slopes of the residuals, which are `now`. Slopes of profiles are analytic. Amounts follow from profiles, so residuals are differentiated
    /// along profiles by difference quotients.
    fn slopes(&self, p: &[f64], lobes: usize, now: &[f64]) -> Vec<Column> {
        let mut profiles = self.profiles(p, lobes);
        let (first, t) = self.node();
        let mut columns = Vec::new();
        for lobe in 0..lobes {
            let of_lobe = lobe * self.basis.per_lobe();
            let sent = self.sent(&self.shape(p, lobe), self.tail_angle(p, lobe)).normalised();
            for (terms, slopes) in self.terms.iter().zip(self.plane.slopes(self.numbers(p, lobe))) {
                if terms.is_empty() {
                    continue;
                }
                let column = self.along(&mut profiles, lobe, &mixed(&sent, slopes), now);
                for term in terms.iter().filter(|term| term.factor != 0.0) {
                    for (node, share) in [(first, 1.0 - t), (first + 1, t)] {
                        let number = of_lobe + term.row * NODES + node;
                        columns.push((number, column.iter().map(|x| term.factor * share * x).collect()));
                    }
                }
            }
            // A part of the light keeps its tail, so that rows of it can be mixed.
            if !self.has_tail {
                continue;
            }
            let [.., tail] = &sent;
            columns.push((of_lobe + self.basis.per_lobe() - 1, self.along(&mut profiles, lobe, tail, now)));
        }
        if !self.has_remainder {
            return columns;
        }
        let wide = wide_of(p, self.axis);
        let mut sent = Sent::<2>::new(self.found.len());
        for point in &self.points {
            let value = wide.value(point.cos_theta);
            if value > 0.0 {
                let relative = wide.slopes(point.cos_theta).map(|slope| slope / value);
                sent.add(point.cell, value * point.cos_theta * point.solid_angle, relative);
            }
        }
        for (number, slopes) in (p.len() - 2..).zip(&sent.normalised()) {
            columns.push((number, self.along(&mut profiles, lobes, slopes, now)));
        }
        columns
    }
}

/// The sum of slopes, each times its factor.
fn mixed(sent: &[(Vec<f64>, f64); 6], factors: [f64; 5]) -> (Vec<f64>, f64) {
    let mut sum = (vec![0.0; sent[0].0.len()], 0.0);
    for ((slopes, share), factor) in sent.iter().zip(factors).filter(|(_, factor)| *factor != 0.0) {
        sum.0.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += factor * slope);
        sum.1 += factor * share;
    }
    sum
}

/// The view of a row at the azimuth of a cosine and a sine.
pub(in crate::models::lobes) fn seen_from(axis: ViewAxis, [cos, sin]: [f64; 2], row: usize) -> DVec3 {
    let DVec3 { x, z, .. } = direction(axis.cos_theta(row as f64));
    DVec3::new(cos * x, sin * x, z)
}

/// A direction in the plane of x and z.
fn direction(cos_theta: f64) -> DVec3 {
    DVec3::new((1.0 - cos_theta * cos_theta).max(0.0).sqrt(), 0.0, cos_theta)
}

#[cfg(test)]
mod tests {
    use luthier_optics::color::Color;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};

    use super::*;
    use crate::models::lobes::FitSettings;
    use crate::models::lobes::parameters::{Start, parameters};

    fn stack(coat_alphas: [f64; 2], coat_rotation: f64, base_alphas: [f64; 2]) -> Stack {
        let layer = |[alpha_x, alpha_y]: [f64; 2], rotation, base| Layer {
            films: Vec::new(),
            surface: Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation },
            base,
        };
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.2; 3] };
        let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        let metal = Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
        let layers = vec![layer(coat_alphas, coat_rotation, coat), layer(base_alphas, 0.0, metal)];
        Stack { exterior: Ior::vacuum(), layers }
    }

    /// Light in every cell by its own paths alone, by those around it alone, and in a view without light.
    #[test]
    fn cells_with_few_paths_are_expected_to_have_the_light_around_them() {
        let cells = Cells::new(1.0, 0.2);
        let [own, other] = [2.0, 4.0].map(|value| vec![value; cells.count()]);
        let energy = |paths: f64| expected(&cells, &own, &[&other, &other], paths)[7];
        assert!((energy(1e9) - 2.0).abs() < 1e-3 && (energy(1.0) - 4.0).abs() < 1e-3);
        assert!((energy(MANY_PATHS * cells.count() as f64) - 3.0).abs() < 1e-12);
        let dark = Tally::new(&[cells], false);
        assert_eq!((dark.paths(), brightness(&dark, 0)[7]), (0.0, 0.0));
        assert_eq!(expected(&cells, &vec![0.0; cells.count()], &[&own], dark.paths())[7], 2.0);
    }

    /// Oracle: differences of the residuals.
    #[test]
    fn slopes_are_those_of_the_residuals() {
        let stacks =
            [stack([0.3; 2], 0.0, [0.1; 2]), stack([0.3; 2], 0.0, [0.1, 0.3]), stack([0.3, 0.1], 0.4, [0.1, 0.3])];
        for (stack, basis) in stacks.iter().zip([Basis::Isotropic, Basis::Mirrored, Basis::Turned]) {
            let settings = FitSettings { rows: 4, paths: 2000, seed: 1 };
            let simulation = Simulation::new(stack, &Color::ThreeWavelengths([550.0; 3]), settings);
            assert_eq!(simulation.basis(), basis);
            let problem = Problem::coarse(&simulation, 1);
            let lobed = Lobed::new(&problem, 2);
            let starts = [(-1.6, 0.6), (-0.7, 1.0)].map(|(mean, tail)| Start::new(basis, [0.0, mean, 0.2, 0.1], tail));
            let mut p = parameters(starts.to_vec(), [0.3, 0.1]);
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
                            "{basis:?} {block} {j} {i}: {slope} {expected}"
                        );
                    }
                }
            }
        }
    }
}
