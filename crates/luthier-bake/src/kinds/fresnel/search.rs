//! Fresnel rows: plain or over Schlick's form, in every format, mapping and size.

use luthier_lut::{Axis, Mapping, RowBase, SchlickBase, TableKind, TexelFormat};
use luthier_manifest::{Candidate, CandidateForm, MeasuredError};
use luthier_optics::Rgb;
use luthier_optics::interpolation::cubic_stencil;
use rayon::prelude::*;

use super::{Fit, FresnelJob, RowCurve, RowShape, cos_theta};
use crate::candidates::{DEFAULT_BUDGET, Found, WEIGHTS, cost, measured, row_form};
use crate::plan::Plan;
use crate::settings::{Asked, axis};

/// Nodes of a row: four sizes to the octave, and the sizes of rows of 384 bytes with texels of 4 and 8 bytes.
pub(crate) const SIZES: [u32; 33] = [
    2, 3, 4, 5, 6, 7, 8, 10, 11, 13, 16, 19, 23, 27, 32, 38, 45, 48, 54, 64, 76, 93, 96, 108, 128, 152, 181, 215, 256,
    304, 362, 431, 512,
];

const MAPPINGS: [Mapping; 13] = [
    Mapping::Linear,
    Mapping::Power { exponent: 1.25 },
    Mapping::Power { exponent: 1.5 },
    Mapping::Power { exponent: 2.0 },
    Mapping::Power { exponent: 2.5 },
    Mapping::Power { exponent: 3.0 },
    Mapping::Power { exponent: 4.0 },
    Mapping::Rational { bend: 0.025 },
    Mapping::Rational { bend: 0.05 },
    Mapping::Rational { bend: 0.1 },
    Mapping::Rational { bend: 0.2 },
    Mapping::Rational { bend: 0.4 },
    Mapping::Rational { bend: 0.8 },
];

/// Texel formats of plain rows and of rows over Schlick's form.
pub(crate) const FORMATS: [(RowBase, TexelFormat); 7] = [
    (RowBase::Zero, TexelFormat::Rgba8Unorm),
    (RowBase::Zero, TexelFormat::Rgb10a2Unorm),
    (RowBase::Zero, TexelFormat::Rg11b10Ufloat),
    (RowBase::Zero, TexelFormat::Rgba16Float),
    (RowBase::Zero, TexelFormat::Rgba32Float),
    (RowBase::Schlick, TexelFormat::Rgba8Unorm),
    (RowBase::Schlick, TexelFormat::Rgb10a2Unorm),
];

/// Points between two nodes.
const PER_CELL: u32 = 5;

/// More texels are tried while the error falls by a tenth within an octave.
const STALLED: f64 = 0.9;

/// The reflectance of one interface, from nodes at cubes of equal steps: they are dense at grazing angles, where it is
/// steep.
pub(crate) struct Truth {
    nodes: Vec<Rgb>,
    pub(crate) fit: SchlickBase,
}

impl Truth {
    const NODES: u32 = 2049;

    pub(crate) fn new(job: &FresnelJob) -> Self {
        let curve = RowCurve::new(&job.interface, &job.color);
        let last = f64::from(Self::NODES - 1);
        let nodes = (0..Self::NODES).map(|i| f64::from(i) / last).map(|u| curve.at(u * u * u)).collect();
        Self { nodes, fit: SchlickBase::fit(&|cos_theta| curve.at(cos_theta)) }
    }

    pub(crate) fn at(&self, cos_theta: f64) -> Rgb {
        let index = libm::cbrt(cos_theta.clamp(0.0, 1.0)) * f64::from(Self::NODES - 1);
        let (first, weights) = cubic_stencil(index, Self::NODES as usize);
        let mut rgb = [0.0; 3];
        for (node, weight) in self.nodes[first..].iter().zip(weights) {
            (0..3).for_each(|c| rgb[c] += weight * node[c]);
        }
        rgb
    }

    /// The error of a row of this shape.
    pub(crate) fn error(&self, shape: &RowShape, colors: bool) -> MeasuredError {
        let (atlas, _) = shape.row(&|cos_theta| self.at(cos_theta), &self.fit);
        let count = shape.axis.intervals() * PER_CELL;
        let points: Vec<([f64; 2], [f64; 4])> = (0..=count)
            .map(|i| {
                let value = shape.axis.decode(f64::from(i) / f64::from(count));
                let [r, g, b] = self.at(cos_theta(&shape.axis, value));
                ([value, 0.0], [r, g, b, 1.0])
            })
            .collect();
        measured(points.iter().map(|(at, rgb)| (at, *rgb)), 3, colors, 0.0, |at| atlas.sample(0, at, WEIGHTS))
    }
}

/// Number of rows that candidates are measured on, the hardest of a plan. These are enough for the worst to be among
/// them.
const HARDEST: usize = 64;

/// Number of equal steps of the root of the cosine by which rows are ranked.
const STEPS: u32 = 64;

/// Largest error of linear interpolation between [`STEPS`], in the middle of a step.
fn hardness(job: &FresnelJob) -> f64 {
    let curve = RowCurve::new(&job.interface, &job.color);
    let halves = (0..=2 * STEPS).map(|half| f64::from(half) / f64::from(2 * STEPS));
    let halves: Vec<Rgb> = halves.map(|u| curve.at(u * u)).collect();
    let missed = halves
        .windows(3)
        .step_by(2)
        .map(|step| (0..3).map(|c| (0.5 * (step[0][c] + step[2][c]) - step[1][c]).abs()).fold(0.0, f64::max));
    missed.fold(0.0, f64::max)
}

/// The rows of a plan with the numbers of their tiles. Many rows are sorted, the hardest first.
fn rows(plan: &Plan) -> Vec<(usize, &FresnelJob)> {
    let rows: Vec<(usize, &FresnelJob)> = plan.jobs(TableKind::Fresnel).collect();
    if rows.len() <= HARDEST {
        return rows;
    }
    let mut ranked: Vec<_> = rows.into_par_iter().map(|row| (hardness(row.1), row)).collect();
    ranked.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    ranked.into_iter().map(|(_, row)| row).collect()
}

/// The truths of the hardest of some rows.
fn truths(rows: &[(usize, &FresnelJob)]) -> Vec<Truth> {
    rows.par_iter().take(HARDEST).map(|(_, job)| Truth::new(job)).collect()
}

/// A candidate of some shape.
pub(crate) fn candidate(shape: &RowShape, truths: &[&Truth], rows: usize, colors: bool) -> Candidate {
    let error = truths.iter().map(|t| t.error(shape, colors)).reduce(|a, b| a.max(&b)).unwrap_or_default();
    let form = row_form(shape.axis.clone(), shape.format, shape.base);
    Candidate { bytes: form.bytes(rows as u32), cost: price(shape), error, form }
}

/// The cost of a look-up.
pub(crate) fn price(shape: &RowShape) -> f64 {
    let angle = if shape.axis.quantity == "theta" { 6.0 * cost::QUARTER_RATE } else { 0.0 };
    let header = f64::from(shape.base.header_texels());
    // Three fetches, a power, and for each channel a handful of products.
    let base = if shape.base.is_zero() { 0.0 } else { header * cost::FETCH + 10.0 + 3.0 * 8.0 };
    angle + cost::axis(&shape.axis) + cost::read(shape.format) + base
}

pub(crate) fn candidates(plan: &Plan, colors: bool) -> Option<Found> {
    let rows = rows(plan);
    of_rows(plan, &truths(&rows).iter().collect::<Vec<_>>(), rows.len(), colors)
}

/// The errors of the hardest rows in this form, by the numbers of their tiles.
pub(super) fn errors(plan: &Plan, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
    let CandidateForm::Table { x, format, base, .. } = form else { return Vec::new() };
    let shape = RowShape { axis: x.clone(), format: *format, base: *base };
    rows(plan).par_iter().take(HARDEST).map(|(tile, job)| (*tile, Truth::new(job).error(&shape, true))).collect()
}

/// The affordable candidates for the rows that some of them serve, and the numbers of the rows that none serves.
pub(super) fn served(plan: &Plan) -> Option<Found> {
    let rows = rows(plan);
    let all = of_rows(plan, &truths(&rows).iter().collect::<Vec<_>>(), rows.len(), false)?.affordable();
    if all.comes_near(&DEFAULT_BUDGET) {
        return Some(all);
    }
    let (mut served, mut left_out) = (Vec::new(), Vec::new());
    for (tile, job) in &rows {
        let truth = Truth::new(job);
        if !of_rows(plan, &[&truth], rows.len(), false).is_some_and(|f| f.affordable().comes_near(&DEFAULT_BUDGET)) {
            left_out.push(*tile);
        } else if served.len() + 1 < HARDEST {
            served.push(truth);
        } else {
            break;
        }
    }
    let found = of_rows(plan, &served.iter().collect::<Vec<_>>(), rows.len(), false).map_or(all, Found::affordable);
    Some(Found { left_out, is_whole: rows.len() <= HARDEST, ..found })
}

/// The candidates of a plan with so many `rows`, measured on these truths.
fn of_rows(plan: &Plan, truths: &[&Truth], rows: usize, colors: bool) -> Option<Found> {
    let asked = plan.settings.asked(TableKind::Fresnel);
    let given = RowShape::of(plan.settings.fixed(TableKind::Fresnel));
    if truths.is_empty() || asked == Asked::all(true) {
        return None;
    }
    let mappings: Vec<Axis> = if asked.mapping {
        vec![given.axis.clone()]
    } else {
        MAPPINGS.map(|mapping| axis("cos_theta", "", [0.0, 1.0], given.axis.size, mapping)).to_vec()
    };
    let formats: Vec<(RowBase, TexelFormat)> = if asked.format {
        vec![(RowBase::Zero, given.format)]
    } else {
        FORMATS.into_iter().filter(|(_, format)| plan.settings.formats.has(*format)).collect()
    };
    let families: Vec<(RowBase, TexelFormat, &Axis)> = formats
        .iter()
        .flat_map(|&(base, format)| mappings.iter().map(move |axis| (base, format, axis)))
        .filter(|(base, _, axis)| base.is_zero() || axis.quantity == "cos_theta")
        .collect();
    let sizes: &[u32] = if asked.size { &[given.axis.size] } else { &SIZES };
    let measured: Vec<Vec<Candidate>> = families
        .into_par_iter()
        .map(|(base, format, mapping)| {
            let mut family: Vec<Candidate> = Vec::new();
            for &size in sizes {
                let shape = RowShape { axis: Axis { size, ..mapping.clone() }, format, base };
                family.push(candidate(&shape, truths, rows, colors));
                let earlier = family.len().checked_sub(5).map(|i| family[i].error.max_abs);
                let best = family.iter().map(|c| c.error.max_abs).fold(f64::INFINITY, f64::min);
                if size >= 16 && earlier.is_some_and(|earlier| best > STALLED * earlier) {
                    break;
                }
            }
            family
        })
        .collect();
    let fixed = RowShape {
        axis: axis("cos_theta", "", [0.0, 1.0], 128, Mapping::Linear),
        format: TexelFormat::Rgba16Float,
        base: RowBase::Zero,
    };
    let is_whole = truths.len() == rows;
    Some(Found { is_whole, ..Found::new(TableKind::Fresnel, price(&fixed), measured.concat()) })
}
