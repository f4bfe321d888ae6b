//! Figures for `docs/pages/budgets.md`: errors and sizes of searched tables against the fixed tables of the literature.

use std::f64::consts::FRAC_PI_2;

use luthier_layers::layers::ALPHA_MIN;
use luthier_lut::{
    Atlas, AtlasLayout, Axis, Encoding, Image, Mapping, RowBase, TableKind, TexelFormat, WeightBits, bilinear,
};
use luthier_manifest::{Budget, Candidate, MeasuredError};
use luthier_material::Material;
use luthier_optics::microfacet::scaled_distribution;
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use crate::candidates::{Found, WEIGHTS, choose, measured};
use crate::graph::{MemoryStore, Results, Silent};
use crate::kinds::distribution::DistributionJob;
use crate::kinds::distribution::search::axes;
use crate::kinds::fgd::{FgdJob, FgdTruth};
use crate::kinds::fresnel::search::{self as fresnel, FORMATS, Truth};
use crate::kinds::fresnel::{FresnelJob, RowShape};
use crate::plan::Plan;
use crate::relief::ImageReader;
use crate::settings::axis;
use crate::tile::lone_tile;
use crate::{BakeError, planner};

/// Bytes of Elek's rows: 128 texels of three bytes.
pub const ROW_BYTES: u64 = 384;

/// Rows in a format that devices of core WebGPU may lack, for comparison. A material may request it; no search takes
/// it.
const BEYOND_CORE: [(RowBase, TexelFormat); 2] =
    [(RowBase::Zero, TexelFormat::Rgba16Unorm), (RowBase::Schlick, TexelFormat::Rgba16Unorm)];

/// Largest errors of one interface's row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowGoal {
    /// Name of the tile.
    pub name: String,
    /// Error of Elek's row: 128 texels, uniform in the cosine, RGB of 8 bits, node values not adjusted for
    /// interpolation.
    pub elek: f64,
    /// Error of the row of [`Goals::row`].
    pub found: f64,
}

/// A family of rows within [`ROW_BYTES`] at its best mapping, and its least gain over Elek's rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Family {
    /// Base below the texels.
    pub base: RowBase,
    /// Format of the texels.
    pub format: TexelFormat,
    /// Axis of the best row.
    pub axis: Axis,
    /// Elek's error over the error of this row: the least ratio of all interfaces that reflect anything.
    pub least_gain: f64,
}

/// Errors of one albedo tile of 64 x 64 half floats.
#[derive(Debug, Clone, PartialEq)]
pub struct AlbedoGoal {
    /// Name of the tile.
    pub name: String,
    /// Error as sampled, against the function at the points of the scan.
    pub sampled: f64,
    /// Uncertainty of the function itself, from crossed light and left-out wavelengths.
    pub uncertainty: f64,
}

/// A representation of D, and its largest error over the peak for Beckmann and GGX, at all angles and m in 0.001..1.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributionGoal {
    /// Name of the representation.
    pub name: &'static str,
    /// Bytes for one distribution.
    pub bytes: u64,
    /// Beckmann, GGX.
    pub errors: [f64; 2],
}

/// Candidate that a budget on Fresnel rows alone chooses.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The budget `max_abs`.
    pub max_abs: f64,
    /// Candidate that the budget chooses, or words on the nearest.
    pub chosen: Result<Candidate, String>,
}

/// All goals of `docs/pages/budgets.md`, as measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Goals {
    /// The family with the largest least gain, within [`ROW_BYTES`].
    pub row: Family,
    /// Errors of these rows.
    pub rows: Vec<RowGoal>,
    /// The best row of each base and format.
    pub families: Vec<Family>,
    /// Choices for a row of budgets.
    pub steps: Vec<Step>,
    /// Albedo tiles.
    pub albedos: Vec<AlbedoGoal>,
    /// Representations of D.
    pub distributions: Vec<DistributionGoal>,
}

/// Measures the goals for a set of materials.
///
/// # Errors
/// See [`BakeError`].
pub fn goals(materials: &[Material], read_image: ImageReader<'_>) -> Result<Goals, BakeError> {
    let plan = planner::plan(materials, planner::settings(materials)?, read_image)?;
    let tiles = &plan.tiles[TableKind::Fresnel as usize].tiles;
    let rows: Vec<Truth> = tiles.par_iter().filter_map(|(_, key)| Some(Truth::new(plan.graph.get(*key)?))).collect();
    let elek: Vec<f64> = rows.par_iter().map(elek_error).collect();
    let families: Vec<Family> = [FORMATS.as_slice(), &BEYOND_CORE]
        .concat()
        .into_par_iter()
        .filter_map(|(base, format)| {
            let size = (ROW_BYTES / u64::from(format.texel_bytes())) as u32 - base.header_texels();
            // The fitted maps: exponents in twentieths from 1 to 4, bends in twentieths to 1.
            let powers = (20..=80).map(|e| Mapping::Power { exponent: f64::from(e) / 20.0 });
            let bends = (1..=20).map(|b| Mapping::Rational { bend: f64::from(b) / 20.0 });
            let families = powers.chain(bends).map(|mapping| {
                let shape = RowShape { axis: axis("cos_theta", "", [0.0, 1.0], size, mapping), format, base };
                let gains = rows.iter().zip(&elek).filter(|(_, elek)| **elek > 0.0);
                let gains = gains.map(|(truth, elek)| elek / truth.error(&shape, false).max_abs);
                Family { base, format, least_gain: gains.fold(f64::INFINITY, f64::min), axis: shape.axis }
            });
            families.reduce(|a, b| if b.least_gain > a.least_gain { b } else { a })
        })
        .collect();
    // Only formats of core WebGPU ship.
    let core = families.iter().filter(|f| !BEYOND_CORE.contains(&(f.base, f.format)));
    let best = core.cloned().reduce(|a, b| if b.least_gain > a.least_gain { b } else { a });
    let Some(row) = best else { return Err(BakeError::Empty) };
    let shape = RowShape { axis: row.axis.clone(), format: row.format, base: row.base };
    let found: Vec<RowGoal> = tiles
        .iter()
        .zip(&elek)
        .filter_map(|((name, key), &elek)| {
            // Measured as the bake does, with a climb to the worst point.
            let job: &FresnelJob = plan.graph.get(*key)?;
            let found = FresnelJob { shape: shape.clone(), ..job.clone() }.tile().error.max_abs_err;
            Some(RowGoal { name: name.clone(), elek, found })
        })
        .collect();
    let only_rows = fresnel::candidates(&plan, false);
    let steps = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4].map(|max_abs| step(only_rows.as_ref(), max_abs)).to_vec();
    let results = plan.graph.intermediate().run(&Silent, &MemoryStore::default(), Results::default())?;
    let albedos = albedos(&plan, &results);
    let distributions = distributions();
    Ok(Goals { row, rows: found, families, steps, albedos, distributions })
}

fn step(found: Option<&Found>, max_abs: f64) -> Step {
    let budget = Budget { max_abs: Some(max_abs), ..Budget::default() };
    let found: Vec<Found> = found.into_iter().cloned().collect();
    let chosen = match choose(&found, &budget, 0) {
        Ok(chosen) => Ok(found[0].candidates[chosen[0]].clone()),
        Err(refusal) => Err(refusal.to_string()),
    };
    Step { max_abs, chosen }
}

/// Elek's row: the values at the nodes, rounded.
fn elek_error(truth: &Truth) -> f64 {
    let x = axis("cos_theta", "", [0.0, 1.0], 128, Mapping::Linear);
    let mut image = Image::zeros(x.size, 1, 3);
    for i in 0..x.size {
        image.texel_mut(i, 0).copy_from_slice(&truth.at(x.node(i)).map(|v| v as f32));
    }
    let layout = AtlasLayout { x: x.clone(), y: None, apron: 0, columns: 1, tiles: 1, base: RowBase::Zero };
    let format = TexelFormat::Rgba8Unorm;
    let (bytes, texels) = format.texels(&image);
    let atlas = Atlas { kind: TableKind::Fresnel, layout, format, tiles: Vec::new(), truth: image, texels, bytes };
    // Half the points towards grazing angles.
    let points: Vec<([f64; 2], [f64; 4])> = (0..=4096)
        .flat_map(|i| [f64::from(i) / 4096.0, libm::pow(f64::from(i) / 4096.0, 4.0)])
        .map(|c| {
            let [r, g, b] = truth.at(c);
            ([c, 0.0], [r, g, b, 1.0])
        })
        .collect();
    measured(points.iter().map(|(at, rgb)| (at, *rgb)), 3, false, 0.0, |at| atlas.sample(0, at, WEIGHTS)).max_abs
}

fn albedos(plan: &Plan, results: &Results) -> Vec<AlbedoGoal> {
    let goals = plan.tiles[TableKind::Fgd as usize].tiles.iter().filter_map(|(name, key)| {
        let job: &FgdJob = plan.graph.get(*key)?;
        let truth: &FgdTruth = results.part(&job.truth);
        let sampled = sampled_error(truth, &job.truth.grid).max_abs;
        Some(AlbedoGoal { name: name.clone(), sampled, uncertainty: truth.slack })
    });
    goals.collect()
}

/// The error of a tile on the grid of its computation, without the uncertainty of the function itself.
fn sampled_error(truth: &FgdTruth, grid: &[Axis; 2]) -> MeasuredError {
    let atlas = lone_tile(TableKind::Fgd, &[&grid[0], &grid[1]], TexelFormat::Rgba16Float, &truth.image);
    let points = truth.probes.iter().map(|(at, value)| (at, *value));
    measured(points, 4, false, 0.0, |at| atlas.sample(0, at, WEIGHTS))
}

fn distributions() -> Vec<DistributionGoal> {
    let [angle, _] = axes(8.0, 512);
    let linear = [angle, axis("alpha", "", [0.0, 1.0], 512, Mapping::Linear)];
    vec![
        table_goal("u^8, linear m, 512 x 512 halves (Elek)", linear, TexelFormat::R16Float),
        table_goal("u^8, log m, 512 x 512 split roots (fixed default)", axes(8.0, 512), TexelFormat::Rg16Float),
        table_goal("u^8, log m, 128 x 128 split roots", axes(8.0, 128), TexelFormat::Rg16Float),
        table_goal("u^4, log m, 128 x 128 split roots", axes(4.0, 128), TexelFormat::Rg16Float),
        row_goal("row over tan/(m + tan), 256 split roots", 256),
        row_goal("row over tan/(m + tan), 4096 split roots", 4096),
        DistributionGoal { name: "closed form (chosen)", bytes: 0, errors: [0.0; 2] },
    ]
}

fn table_goal(name: &'static str, axes: [Axis; 2], format: TexelFormat) -> DistributionGoal {
    let bytes = u64::from(axes[0].size) * u64::from(axes[1].size) * u64::from(format.texel_bytes());
    let errors = [Distribution::Beckmann, Distribution::Ggx]
        .map(|distribution| table_error(&DistributionJob { distribution, axes: axes.clone(), format }));
    DistributionGoal { name, bytes, errors }
}

fn row_goal(name: &'static str, size: u32) -> DistributionGoal {
    let errors = [Distribution::Beckmann, Distribution::Ggx].map(|distribution| slope_row_error(distribution, size));
    DistributionGoal { name, bytes: 4 * u64::from(size), errors }
}

/// Angles and logarithms of m at which tables of D are compared with it.
const GRID: u32 = 768;

/// Largest error over the peak of D for m in 0.001..1.
fn peak_error(distribution: Distribution, read: impl Fn(f64, f64) -> f64 + Sync) -> f64 {
    let errors: Vec<f64> = (0..GRID)
        .into_par_iter()
        .map(|j| {
            let m = ALPHA_MIN * libm::pow(1.0 / ALPHA_MIN, (f64::from(j) + 0.37) / f64::from(GRID));
            let (mut peak, mut worst) = (1.0_f64, 0.0_f64);
            for i in 0..GRID {
                let theta = FRAC_PI_2 * libm::pow((f64::from(i) + 0.61) / f64::from(GRID), 8.0);
                let (sin, cos) = libm::sincos(theta);
                let exact = scaled_distribution(distribution, m, cos, sin * sin);
                peak = peak.max(exact);
                worst = worst.max((read(theta, m) - exact).abs());
            }
            worst / peak
        })
        .collect();
    errors.into_iter().fold(0.0, f64::max)
}

fn table_error(job: &DistributionJob) -> f64 {
    let atlas = job.atlas();
    peak_error(job.distribution, |theta, m| atlas.sample(0, [theta, m], WEIGHTS)[0])
}

/// Error of a row of slopes. D of Beckmann and of GGX scales: `pi m^2 D cos^4` depends on tan/m alone. The row holds
/// its sixteenth root, and the shader divides by `cos^4`.
fn slope_row_error(distribution: Distribution, size: u32) -> f64 {
    let encoding = Encoding::SplitSixteenthRoot;
    let mut row = Image::zeros(size, 1, 1);
    for i in 0..size {
        let u = f64::from(i) / f64::from(size - 1);
        let slope = u / (1.0 - u);
        row.texel_mut(i, 0)[0] = match distribution {
            _ if i + 1 == size => 0.0,
            Distribution::Beckmann => libm::exp(-slope * slope) as f32,
            _ => libm::pow(1.0 + slope * slope, -2.0) as f32,
        };
    }
    let texels = TexelFormat::Rg16Float.quantise(&encoding.split(&encoding.to_root(&row)));
    peak_error(distribution, |theta, m| {
        let (sin, cos) = libm::sincos(theta);
        let u = sin / (sin + m * cos);
        let texel = bilinear(&texels, [u * f64::from(size - 1) + 0.5, 0.5], WeightBits::Fixed(8));
        encoding.decode(texel)[0] / (cos * cos * cos * cos)
    })
}
