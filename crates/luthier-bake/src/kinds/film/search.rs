//! Film tables in every size, mapping and format.

use luthier_lut::{Axis, Mapping, TableKind, TexelFormat};

use super::FilmJob;
use crate::candidates::Found;
use crate::candidates::grids::{self, Fine};
use crate::plan::Plan;
use crate::settings::axis;

const COLUMNS: [u32; 5] = [16, 32, 48, 64, 96];
const ROWS: [u32; 5] = [32, 64, 128, 256, 384];
const EXPONENTS: [f64; 3] = [2.0, 3.0, 4.0];
const FORMATS: [TexelFormat; 5] = [
    TexelFormat::Bc6hRgbUfloat,
    TexelFormat::Rgba8Unorm,
    TexelFormat::Rgb10a2Unorm,
    TexelFormat::Rgba16Float,
    TexelFormat::Rgba32Float,
];

/// Points at which tiles are compared with the function.
const PROBES: u32 = 4096;

pub(super) fn candidates(plan: &Plan, colors: bool) -> Option<Found> {
    let tiles = tiles(plan);
    if tiles.is_empty() {
        return None;
    }
    let fixed_cost = grids::price(&finest(2.0), TexelFormat::Rgba16Float);
    let found = grids::candidates(&tiles, axes(), &plan.settings.allowed(&FORMATS), colors);
    // Errors of film tiles are steep ridges along grazing angles. The points of a search miss their tops.
    Some(Found { is_whole: false, ..Found::new(TableKind::Film, fixed_cost, found) })
}

/// The tiles of a plan on the finest grid.
pub(super) fn tiles(plan: &Plan) -> Vec<Fine> {
    let grid = finest(3.0);
    let tiles = plan.jobs(TableKind::Film).map(|(_, job): (usize, &FilmJob)| Fine {
        kind: TableKind::Film,
        image: FilmJob { axes: grid.clone(), ..job.clone() }.truth(),
        grid: grid.clone(),
        probes: job.probes(PROBES),
        channels: 3,
        slack: 0.0,
    });
    tiles.collect()
}

/// Axes of the finest tiles that are tried.
fn finest(exponent: f64) -> [Axis; 2] {
    [
        axis("cos_theta", "", [0.0, 1.0], 96, Mapping::Power { exponent }),
        axis("fraction", "", [0.0, 1.0], 384, Mapping::Linear),
    ]
}

fn axes() -> Vec<[Axis; 2]> {
    let mut axes = Vec::new();
    for exponent in EXPONENTS {
        for columns in COLUMNS {
            for rows in ROWS {
                let [x, y] = finest(exponent);
                axes.push([Axis { size: columns, ..x }, Axis { size: rows, ..y }]);
            }
        }
    }
    axes
}
