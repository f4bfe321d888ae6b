//! Phase rows of films: tables, and the cosines computed instead.

use luthier_lut::{Axis, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{Candidate, CandidateForm, MeasuredError};
use rayon::prelude::*;

use super::PhaseJob;
use crate::candidates::{Found, cost, row_form};
use crate::plan::Plan;
use crate::settings::axis;

const SIZES: [u32; 10] = [16, 32, 64, 128, 192, 256, 384, 512, 768, 1024];
const FORMATS: [TexelFormat; 2] = [TexelFormat::Rgba16Float, TexelFormat::Rgba32Float];

/// Cost of the cosines of three phases, each reduced to one cycle first.
const CLOSED_FORM: f64 = 3.0 * (cost::QUARTER_RATE + 6.0);

pub(super) fn candidates(plan: &Plan) -> Option<Found> {
    let jobs: Vec<&PhaseJob> = plan.graph.of().collect();
    if jobs.is_empty() || plan.settings.asked(TableKind::Phase).is_any() {
        return None;
    }
    let formats = plan.settings.allowed(&FORMATS);
    let shapes: Vec<(u32, TexelFormat)> =
        SIZES.iter().flat_map(|&size| formats.iter().map(move |&format| (size, format))).collect();
    // Means over channels have no closed form.
    let is_closed = jobs.iter().all(|job| job.color.is_none());
    let closed = is_closed.then(|| Candidate {
        form: CandidateForm::ClosedForm,
        bytes: 0,
        cost: CLOSED_FORM,
        error: MeasuredError::default(),
    });
    let mut candidates: Vec<Candidate> = closed.into_iter().collect();
    candidates.par_extend(shapes.into_par_iter().map(|(size, format)| {
        let axis = axis("s", "", [0.0, 1.0], size, Mapping::Linear);
        let errors = jobs.iter().map(|job| error(job, &axis, format));
        let error = errors.reduce(|a, b| a.max(&b)).unwrap_or_default();
        let form = row_form(axis, format, RowBase::Zero);
        Candidate { bytes: form.bytes(jobs.len() as u32), cost: price(format), error, form }
    }));
    Some(Found::new(TableKind::Phase, price(TexelFormat::Rgba16Float), candidates))
}

/// The cost of three look-ups, one for the cosine of each channel.
fn price(format: TexelFormat) -> f64 {
    3.0 * (2.0 + cost::read(format))
}

/// The errors of rows in this form, by the numbers of their tiles.
pub(super) fn errors(plan: &Plan, form: &CandidateForm) -> Vec<(usize, MeasuredError)> {
    let CandidateForm::Table { x, format, .. } = form else { return Vec::new() };
    plan.jobs(TableKind::Phase).map(|(tile, job)| (tile, error(job, x, *format))).collect()
}

fn error(job: &PhaseJob, axis: &Axis, format: TexelFormat) -> MeasuredError {
    let error = PhaseJob { axis: axis.clone(), format, ..job.clone() }.tile().error.max_abs_err;
    // The values swing between -2 and 2 and pass through 0. Errors are relative to 2.
    MeasuredError { max_abs: error, max_rel: 0.5 * error, ..MeasuredError::default() }
}
