//! Tables of two axes whose values are costly: one fine grid of each tile is computed, and coarser ones are interpolated from it.

use luthier_lut::{Axis, Image, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{Candidate, CandidateForm, MeasuredError};
use rayon::prelude::*;

use super::{Found, WEIGHTS, cost, measured};
use crate::graph::{Job, Results};
use crate::grid::resampled;
use crate::kinds::fgd::{FgdJob, FgdTruth};
use crate::kinds::film::FilmJob;
use crate::plan::Plan;
use crate::settings::axis;
use crate::tile::lone_tile;

/// Sides of albedo tiles.
const FGD_SIDES: [u32; 9] = [8, 12, 16, 20, 24, 32, 40, 48, 64];
/// Exponents of its axes, cosine and alpha.
const FGD_EXPONENTS: [[f64; 2]; 4] = [[2.0, 3.0], [2.0, 2.0], [3.0, 3.0], [3.0, 2.0]];
const FGD_FORMATS: [TexelFormat; 4] =
    [TexelFormat::Bc6hRgbUfloat, TexelFormat::Rgba8Unorm, TexelFormat::Rgba16Float, TexelFormat::Rgba32Float];

const FILM_COLUMNS: [u32; 5] = [16, 32, 48, 64, 96];
const FILM_ROWS: [u32; 5] = [32, 64, 128, 256, 384];
const FILM_EXPONENTS: [f64; 3] = [2.0, 3.0, 4.0];
const FILM_FORMATS: [TexelFormat; 5] = [
    TexelFormat::Bc6hRgbUfloat,
    TexelFormat::Rgba8Unorm,
    TexelFormat::Rgb10a2Unorm,
    TexelFormat::Rgba16Float,
    TexelFormat::Rgba32Float,
];
/// Points at which film tiles are compared with the function.
const FILM_PROBES: u32 = 4096;

/// A tile on its fine grid, and points off it.
struct Fine {
    grid: [Axis; 2],
    image: Image,
    /// Axis values, and the function there.
    probes: Vec<([f64; 2], [f64; 4])>,
    /// Error of the function itself.
    slack: f64,
}

/// The jobs of the tiles of a kind, in the order of the tiles.
fn jobs<J: Job>(plan: &Plan, kind: TableKind) -> impl Iterator<Item = &J> {
    plan.tiles[kind as usize].tiles.iter().filter_map(|(_, key)| plan.graph.get(*key))
}

fn fgd_tiles(plan: &Plan, results: &Results) -> Vec<Fine> {
    let tile = |job: &FgdJob| {
        let FgdTruth { image, mut probes, kinks, slack, .. } = results.part::<FgdTruth>(&job.truth).clone();
        probes.extend(kinks);
        Fine { grid: plan.settings.fixed(TableKind::Fgd).axes(), image, probes, slack }
    };
    jobs(plan, TableKind::Fgd).map(tile).collect()
}

fn fgd_axes(plan: &Plan) -> Vec<[Axis; 2]> {
    let [x, y] = &plan.settings.fixed(TableKind::Fgd).axes();
    if plan.settings.asked(TableKind::Fgd).size {
        return vec![[x.clone(), y.clone()]];
    }
    let power = |axis: &Axis, size, exponent| Axis { size, mapping: Mapping::Power { exponent }, ..axis.clone() };
    let mut axes = Vec::new();
    for [p, q] in FGD_EXPONENTS {
        for columns in FGD_SIDES {
            for rows in FGD_SIDES {
                axes.push([power(x, columns, p), power(y, rows, q)]);
            }
        }
    }
    axes
}

pub(crate) fn fgd(plan: &Plan, results: &Results, colors: bool) -> Option<Found> {
    let (asked, fixed) = (plan.settings.asked(TableKind::Fgd), plan.settings.fixed(TableKind::Fgd));
    let tiles = fgd_tiles(plan, results);
    if tiles.is_empty() || asked.size && asked.format {
        return None;
    }
    let formats = if asked.format { vec![fixed.format] } else { allowed(&FGD_FORMATS, plan) };
    let fixed_cost = price(&fixed.axes(), TexelFormat::Rgba16Float);
    let candidates = candidates(TableKind::Fgd, &tiles, fgd_axes(plan), &formats, 4, colors);
    Some(Found::new(TableKind::Fgd, fixed_cost, candidates))
}

/// The errors of albedo tiles in this form, in their order.
pub(crate) fn fgd_errors(plan: &Plan, results: &Results, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
    of_form(TableKind::Fgd, &fgd_tiles(plan, results), form, 4)
}

/// The errors of film tiles in this form, in their order.
pub(crate) fn film_errors(plan: &Plan, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
    of_form(TableKind::Film, &film_tiles(plan), form, 3)
}

fn of_form(kind: TableKind, tiles: &[Fine], form: &CandidateForm, channels: usize) -> Vec<(usize, MeasuredError)> {
    let CandidateForm::Table { x, y: Some(y), format, .. } = form else { return Vec::new() };
    let axes = [x.clone(), y.clone()];
    tiles.iter().map(|tile| tile.error(kind, &tile.on(&axes), &axes, *format, channels, true)).enumerate().collect()
}

impl Fine {
    /// The tile on other axes.
    fn on(&self, axes: &[Axis; 2]) -> Image {
        if *axes == self.grid { self.image.clone() } else { resampled(&self.image, &self.grid, axes) }
    }

    /// The error of the tile in a format, from its image on these axes.
    fn error(
        &self,
        kind: TableKind,
        image: &Image,
        axes: &[Axis; 2],
        format: TexelFormat,
        channels: usize,
        colors: bool,
    ) -> MeasuredError {
        let channels = channels.min(format.channels() as usize);
        let atlas = lone_tile(kind, &[&axes[0], &axes[1]], format, image);
        let points = self.probes.iter().map(|(at, value)| (at, *value));
        measured(points, channels, colors, self.slack, |at| atlas.sample(0, at, WEIGHTS))
    }
}

/// The finest film tiles that are tried.
fn finest(exponent: f64) -> [Axis; 2] {
    [
        axis("cos_theta", "", [0.0, 1.0], 96, Mapping::Power { exponent }),
        axis("fraction", "", [0.0, 1.0], 384, Mapping::Linear),
    ]
}

fn film_tiles(plan: &Plan) -> Vec<Fine> {
    let grid = finest(3.0);
    let tile = |job: &FilmJob| Fine {
        image: FilmJob { axes: grid.clone(), ..job.clone() }.truth(),
        grid: grid.clone(),
        probes: job.probes(FILM_PROBES),
        slack: 0.0,
    };
    jobs(plan, TableKind::Film).map(tile).collect()
}

fn film_axes() -> Vec<[Axis; 2]> {
    let mut axes = Vec::new();
    for exponent in FILM_EXPONENTS {
        for columns in FILM_COLUMNS {
            for rows in FILM_ROWS {
                let [x, y] = finest(exponent);
                axes.push([Axis { size: columns, ..x }, Axis { size: rows, ..y }]);
            }
        }
    }
    axes
}

pub(crate) fn film(plan: &Plan, colors: bool) -> Option<Found> {
    let tiles = film_tiles(plan);
    if tiles.is_empty() {
        return None;
    }
    let fixed_cost = price(&finest(2.0), TexelFormat::Rgba16Float);
    let candidates = candidates(TableKind::Film, &tiles, film_axes(), &allowed(&FILM_FORMATS, plan), 3, colors);
    // Errors of film tiles are steep ridges along grazing angles, between the points of a search.
    Some(Found { is_whole: false, ..Found::new(TableKind::Film, fixed_cost, candidates) })
}

/// The formats of a list that the search may take.
fn allowed(formats: &[TexelFormat], plan: &Plan) -> Vec<TexelFormat> {
    formats.iter().copied().filter(|format| plan.settings.formats.has(*format)).collect()
}

fn candidates(
    kind: TableKind,
    tiles: &[Fine],
    axes: Vec<[Axis; 2]>,
    formats: &[TexelFormat],
    channels: usize,
    colors: bool,
) -> Vec<Candidate> {
    let measured: Vec<Vec<Candidate>> = axes
        .into_par_iter()
        .map(|axes| {
            let images: Vec<Image> = tiles.iter().map(|tile| tile.on(&axes)).collect();
            let is_whole =
                |format: &&TexelFormat| axes.iter().all(|axis| axis.size.is_multiple_of(format.block_side()));
            let with = |&format: &TexelFormat| {
                let error = |(tile, image): (&Fine, &Image)| tile.error(kind, image, &axes, format, channels, colors);
                let errors = tiles.iter().zip(&images).map(error);
                let error = errors.reduce(|a, b| a.max(&b)).unwrap_or_default();
                let [x, y] = axes.clone();
                let form = CandidateForm::Table { x, y: Some(y), format, base: RowBase::Zero };
                Candidate { bytes: form.bytes(tiles.len() as u32), cost: price(&axes, format), error, form }
            };
            formats.iter().filter(is_whole).map(with).collect()
        })
        .collect();
    measured.concat()
}

/// The error of a tile on the grid where it is computed, without what the function may be off itself.
pub(super) fn sampled_error(truth: &FgdTruth, grid: &[Axis; 2], format: TexelFormat) -> MeasuredError {
    let atlas = lone_tile(TableKind::Fgd, &[&grid[0], &grid[1]], format, &truth.image);
    let points = truth.probes.iter().map(|(at, value)| (at, *value));
    measured(points, 4, false, 0.0, |at| atlas.sample(0, at, WEIGHTS))
}

fn price(axes: &[Axis; 2], format: TexelFormat) -> f64 {
    axes.iter().map(cost::axis).sum::<f64>() + cost::read(format)
}
