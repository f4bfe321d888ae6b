//! FGD tables in every size, mapping and format.

use luthier_lut::{Axis, Mapping, TableKind, TexelFormat};

use super::{FgdJob, FgdTruth};
use crate::candidates::Found;
use crate::candidates::grids::{self, Fine};
use crate::graph::Results;
use crate::plan::Plan;

/// Sides of tiles.
const SIDES: [u32; 9] = [8, 12, 16, 20, 24, 32, 40, 48, 64];
/// Exponents of the axes, cosine and alpha.
const EXPONENTS: [[f64; 2]; 4] = [[2.0, 3.0], [2.0, 2.0], [3.0, 3.0], [3.0, 2.0]];
const FORMATS: [TexelFormat; 4] =
    [TexelFormat::Bc6hRgbUfloat, TexelFormat::Rgba8Unorm, TexelFormat::Rgba16Float, TexelFormat::Rgba32Float];

pub(super) fn candidates(plan: &Plan, results: &Results, colors: bool) -> Option<Found> {
    let (asked, fixed) = (plan.settings.asked(TableKind::Fgd), plan.settings.fixed(TableKind::Fgd));
    let tiles = tiles(plan, results);
    if tiles.is_empty() || asked.size && asked.format {
        return None;
    }
    let formats = if asked.format { vec![fixed.format] } else { plan.settings.allowed(&FORMATS) };
    let fixed_cost = grids::price(&fixed.axes(), TexelFormat::Rgba16Float);
    let found = grids::candidates(&tiles, axes(plan), &formats, colors);
    Some(Found::new(TableKind::Fgd, fixed_cost, found))
}

/// The tiles of a plan on the grid of their computation.
pub(super) fn tiles(plan: &Plan, results: &Results) -> Vec<Fine> {
    let tiles = plan.jobs(TableKind::Fgd).map(|(_, job): (usize, &FgdJob)| {
        let FgdTruth { image, mut probes, kinks, slack, .. } = results.part::<FgdTruth>(&job.truth).clone();
        probes.extend(kinks);
        let grid = plan.settings.fixed(TableKind::Fgd).axes();
        Fine { kind: TableKind::Fgd, grid, image, probes, channels: 4, slack }
    });
    tiles.collect()
}

fn axes(plan: &Plan) -> Vec<[Axis; 2]> {
    let [x, y] = plan.settings.fixed(TableKind::Fgd).axes();
    if plan.settings.asked(TableKind::Fgd).size {
        return vec![[x, y]];
    }
    let mut axes = Vec::new();
    for [p, q] in EXPONENTS {
        for columns in SIDES {
            for rows in SIDES {
                axes.push([power(&x, columns, p), power(&y, rows, q)]);
            }
        }
    }
    axes
}

fn power(axis: &Axis, size: u32, exponent: f64) -> Axis {
    Axis { size, mapping: Mapping::Power { exponent }, ..axis.clone() }
}
