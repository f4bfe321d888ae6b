//! Fresnel rows: plain or over Schlick's form, in every format, mapping and size.

use luthier_lut::{Axis, Candidate, Mapping, MeasuredError, RowBase, SchlickBase, TableKind, TexelFormat};
use luthier_optics::Rgb;
use luthier_optics::interpolation::cubic_stencil;
use rayon::prelude::*;

use super::{Found, WEIGHTS, cost, measured, row_form};
use crate::fresnel::{Fit, FresnelJob, RowShape, cos_theta};
use crate::job::{Job, JobKind};
use crate::plan::Plan;
use crate::settings::axis;

/// Nodes of a row: four to the octave, and those that make 384 bytes of texels of 4 and 8 bytes.
pub(super) const SIZES: [u32; 33] = [
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
pub(super) const FORMATS: [(RowBase, TexelFormat); 7] = [
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

/// The exact reflectance of one interface, from nodes at cubes of equal steps.
pub(crate) struct Truth {
    nodes: Vec<Rgb>,
    pub(crate) fit: SchlickBase,
}

impl Truth {
    const NODES: u32 = 2049;

    pub(crate) fn new(job: &FresnelJob) -> Self {
        let sampled = job.interface.sampled(&job.color);
        let last = f64::from(Self::NODES - 1);
        let nodes = (0..Self::NODES).map(|i| f64::from(i) / last).map(|u| sampled.rgb(u * u * u)).collect();
        Self { nodes, fit: SchlickBase::fit(&|cos_theta| sampled.rgb(cos_theta)) }
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

/// The truth of every row of a plan.
pub(crate) fn truths(plan: &Plan) -> Vec<Truth> {
    let jobs: Vec<&FresnelJob> = plan
        .graph
        .of_kind(JobKind::Fresnel)
        .filter_map(|job| if let Job::Fresnel(job) = job { Some(job) } else { None })
        .collect();
    jobs.into_par_iter().map(Truth::new).collect()
}

/// A candidate of some shape.
pub(crate) fn candidate(shape: &RowShape, truths: &[Truth], colors: bool) -> Candidate {
    let error = truths.iter().map(|t| t.error(shape, colors)).reduce(|a, b| a.max(&b)).unwrap_or_default();
    let form = row_form(shape.axis.clone(), shape.format, shape.base);
    Candidate { bytes: form.bytes(truths.len() as u32), cost: price(shape), error, form }
}

/// The cost of a look-up.
pub(super) fn price(shape: &RowShape) -> f64 {
    let angle = if shape.axis.quantity == "theta" { 6.0 * cost::QUARTER_RATE } else { 0.0 };
    let header = f64::from(shape.base.header_texels());
    // Three fetches, a power, and for each channel a handful of products.
    let base = if shape.base.is_zero() { 0.0 } else { header * cost::FETCH + 10.0 + 3.0 * 8.0 };
    angle + cost::axis(&shape.axis) + cost::read(shape.format) + base
}

pub(super) fn candidates(plan: &Plan, colors: bool) -> Option<Found> {
    let (asked, given) = (plan.settings.asked, &plan.settings.fresnel);
    let truths = truths(plan);
    if truths.is_empty() || asked.fresnel_size && asked.fresnel_format && asked.fresnel_mapping {
        return None;
    }
    let mappings: Vec<Axis> = if asked.fresnel_mapping {
        vec![given.axis.clone()]
    } else {
        MAPPINGS.map(|mapping| axis("cos_theta", "", [0.0, 1.0], given.axis.size, mapping)).to_vec()
    };
    let formats: Vec<(RowBase, TexelFormat)> = if asked.fresnel_format {
        vec![(RowBase::Zero, given.format)]
    } else {
        FORMATS.into_iter().filter(|(_, format)| plan.settings.formats.has(*format)).collect()
    };
    let families: Vec<(RowBase, TexelFormat, &Axis)> = formats
        .iter()
        .flat_map(|&(base, format)| mappings.iter().map(move |axis| (base, format, axis)))
        .filter(|(base, _, axis)| base.is_zero() || axis.quantity == "cos_theta")
        .collect();
    let measured: Vec<Vec<Candidate>> = families
        .into_par_iter()
        .map(|(base, format, mapping)| {
            let shape = |size| RowShape { axis: Axis { size, ..mapping.clone() }, format, base };
            if asked.fresnel_size {
                return vec![candidate(&shape(given.axis.size), &truths, colors)];
            }
            let mut family: Vec<Candidate> = Vec::new();
            for size in SIZES {
                family.push(candidate(&shape(size), &truths, colors));
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
    Some(Found::new(TableKind::Fresnel, price(&fixed), measured.concat()))
}
