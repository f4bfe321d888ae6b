//! The slope distribution: tables of it, and the closed form.

use std::f64::consts::FRAC_PI_2;

use luthier_layers::layers::ALPHA_MIN;
use luthier_lut::{Axis, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{Candidate, CandidateForm, MeasuredError};
use rayon::prelude::*;

use super::DistributionJob;
use crate::candidates::{Found, cost};
use crate::plan::Plan;
use crate::settings::axis;

const SIDES: [u32; 3] = [32, 64, 128];
const EXPONENTS: [f64; 2] = [4.0, 8.0];
const FORMATS: [TexelFormat; 2] = [TexelFormat::R16Float, TexelFormat::Rg16Float];

/// Cost of the closed form of Beckmann, the dearer of the two (an exponential, two divisions, six products).
const CLOSED_FORM: f64 = 3.0 * cost::QUARTER_RATE + 6.0;

/// Cost of the angle from cosine and sine: a root, two divisions, a polynomial.
const ANGLE: f64 = 3.0 * cost::QUARTER_RATE + 12.0;

pub(super) fn candidates(plan: &Plan) -> Option<Found> {
    let jobs: Vec<&DistributionJob> = plan.graph.of().collect();
    if jobs.is_empty() || plan.settings.asked(TableKind::Distribution).is_any() {
        return None;
    }
    let formats = plan.settings.allowed(&FORMATS);
    let tables: Vec<(f64, u32, TexelFormat)> = EXPONENTS
        .iter()
        .flat_map(|&e| SIDES.iter().map(move |&side| (e, side)))
        .flat_map(|(e, side)| formats.iter().map(move |&format| (e, side, format)))
        .collect();
    let mut candidates = vec![Candidate {
        form: CandidateForm::ClosedForm,
        bytes: 0,
        cost: CLOSED_FORM,
        error: MeasuredError::default(),
    }];
    candidates.par_extend(tables.into_par_iter().map(|(exponent, side, format)| {
        let axes = axes(exponent, side);
        let error = jobs
            .iter()
            .map(|job| DistributionJob { axes: axes.clone(), format, ..(*job).clone() }.tile().error.max_abs_err)
            .fold(0.0, f64::max);
        let price = price(&axes, format);
        let [x, y] = axes;
        let form = CandidateForm::Table { x, y: Some(y), format, base: RowBase::Zero };
        // Values are relative to the peak of D already.
        let error = MeasuredError { max_abs: error, max_rel: error, ..MeasuredError::default() };
        Candidate { bytes: form.bytes(jobs.len() as u32), cost: price, error, form }
    }));
    Some(Found::new(TableKind::Distribution, price(&axes(8.0, 512), TexelFormat::Rg16Float), candidates))
}

/// The axes of a square table: a power of the angle, and logarithms of alpha.
pub(crate) fn axes(exponent: f64, side: u32) -> [Axis; 2] {
    [
        axis("theta_h", "rad", [0.0, FRAC_PI_2], side, Mapping::Power { exponent }),
        axis("alpha", "", [ALPHA_MIN, 1.0], side, Mapping::Logarithmic),
    ]
}

fn price(axes: &[Axis; 2], format: TexelFormat) -> f64 {
    let root = if format == TexelFormat::Rg16Float { 6.0 } else { 0.0 };
    ANGLE + axes.iter().map(cost::axis).sum::<f64>() + cost::read(format) + root
}
