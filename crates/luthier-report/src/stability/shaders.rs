//! The shaders: tables in f64, and both forms on the adapter.

use luthier_layers::layers::Layers;
use luthier_manifest::Form;
use luthier_optics::Rgb;
use rayon::prelude::*;

use super::case::StressCase;
use super::{Cell, Fault, Level};
use crate::error::ReportError;
use crate::measure::device::{Device, run};
use crate::measure::directions::Pair;
use crate::measure::references::{References, evaluate};
use crate::measure::statistics::{FLOOR, brightest, relative_error};
use crate::measure::subject::Subject;
use crate::measure::table_terms::{TableTerms, Weights};

/// Size below which a negative channel is rounding.
pub(super) const ROUNDING: f64 = 1e-6;

/// Values of a case in f64: on exact terms for the form with tables and for the form without, and on the tables.
struct Expected {
    pairs: Vec<Pair>,
    baked: Vec<Rgb>,
    full: Option<Vec<Rgb>>,
    read: Vec<Rgb>,
}

/// The shaders of a model on all cases. The materials of the subject are the cases, in order. Without a device, only tables are judged.
///
/// `tables` describes special tables: it follows the name of the model in the names of methods, and the form without tables is left out.
///
/// # Errors
/// See [`ReportError`].
pub fn shader_cells(
    subject: &Subject<'_>,
    device: Option<&dyn Device>,
    cases: &[StressCase],
    tables: Option<&str>,
    progress: &mut dyn FnMut(),
) -> Result<Vec<Cell>, ReportError> {
    subject.check()?;
    let expected: Vec<Expected> = (0..cases.len().min(subject.manifest.materials.len()))
        .into_par_iter()
        .map(|number| {
            let (stack, entry) = (&cases[number].stack, &subject.manifest.materials[number]);
            let pairs = cases[number].aim.pairs(&Layers::isotropic_rgb(stack).layers);
            let references = References::new(stack, entry);
            let twin = &references.twin;
            let terms = TableTerms::new(subject, number, Weights::EightBit)?;
            let baked = evaluate(twin, references.baked(), &pairs);
            let full = entry.model.has(Form::Full).then(|| evaluate(twin, references.full(), &pairs));
            let read = evaluate(twin, &terms, &pairs);
            Ok(Expected { pairs, baked, full, read })
        })
        .collect::<Result<_, ReportError>>()?;
    let mut cells = Vec::new();
    for (number, (case, expected)) in cases.iter().zip(&expected).enumerate() {
        let Expected { pairs, baked, full, read } = expected;
        let model = subject.manifest.materials[number].model.name();
        let method = tables.map_or(model.to_owned(), |tables| format!("{model}, {tables}"));
        let of = |level, found: &[Rgb], truth: &[Rgb]| cell(level, &method, case, pairs, found, truth);
        cells.push(of(Level::Table, read, baked));
        if let Some(device) = device {
            if let Some(full) = full.as_ref().filter(|_| tables.is_none() && device.has(Form::Full)) {
                cells.push(of(Level::F32, &run(device, Form::Full, number as u32, pairs)?, full));
            }
            cells.push(of(Level::Device, &run(device, Form::Baked, number as u32, pairs)?, baked));
        }
        progress();
    }
    Ok(cells)
}

fn cell(level: Level, method: &str, case: &StressCase, pairs: &[Pair], found: &[Rgb], truth: &[Rgb]) -> Cell {
    let Stress { not_finite, negative, error } = Stress::of(pairs, found, truth);
    if not_finite > 0 {
        return Cell::new(level, method, &case.id, Some(Fault::NotFinite), 0.0);
    }
    let fault = (negative > ROUNDING * bright_floor(truth)).then_some(Fault::Negative);
    Cell::new(level, method, &case.id, fault, if fault.is_some() { negative } else { error })
}

/// Values at stressed directions against the truth there.
pub(super) struct Stress {
    /// Values that are NaN or infinite. The rest is of the others.
    pub(super) not_finite: u64,
    /// Largest magnitude of a negative value where the truth is not negative, and of light at or below the horizon.
    pub(super) negative: f64,
    /// Largest relative error; infinite where the truth is NaN.
    pub(super) error: f64,
}

impl Stress {
    pub(super) fn of(pairs: &[Pair], found: &[Rgb], truth: &[Rgb]) -> Self {
        let mut out = Self { not_finite: 0, negative: 0.0, error: 0.0 };
        for ((&(wi, wo), found), truth) in pairs.iter().zip(found).zip(truth) {
            let is_lit = wi[2] > 0.0 && wo[2] > 0.0;
            let bright = brightest(truth);
            for (value, expected) in found.iter().zip(truth) {
                if !value.is_finite() {
                    out.not_finite += 1;
                    continue;
                }
                if !is_lit {
                    out.negative = out.negative.max(value.abs());
                } else if *value < -ROUNDING && *expected >= 0.0 {
                    out.negative = out.negative.max(-value);
                }
                let error = relative_error(*value, *expected, bright, FLOOR);
                // NaN in the truth counts as an infinite error: it must not pass for agreement.
                out.error = if error.is_nan() { f64::INFINITY } else { out.error.max(error) };
            }
        }
        out
    }
}

/// The divisor of rounding errors: the brightest value, at least 1.
pub(super) fn bright_floor(values: &[Rgb]) -> f64 {
    values.iter().map(brightest).fold(1.0, f64::max)
}
