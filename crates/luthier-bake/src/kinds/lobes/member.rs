//! Materials of a search, each with the forms that it has.

use std::collections::BTreeSet;

use luthier_layers::models::lobes::FitError;
use luthier_manifest::{Budget, MeasuredError};
use luthier_material::Material;

use super::fit::{FitJob, Fits, fit};
use super::rows::{has_lone_rows, of_model, side};
use crate::form::{RowForm, Widths};
use crate::graph::{Job, Key, Results};
use crate::plan::Plan;

/// The fits to a stack, and whether rows of all its materials are alone.
pub(super) struct Member<'a> {
    pub(super) key: Key,
    pub(super) fits: &'a Fits,
    /// Rows over a factor, or of layers below a coat, leave a polynomial and widths by the view no place in the words of a material.
    is_lone: bool,
}

impl Member<'_> {
    /// Whether it has a short lobe.
    pub(super) fn is_short(&self) -> bool {
        self.is_lone && self.fits.of(Some(1)).short.is_some()
    }

    /// Whether it has one width.
    pub(super) fn has_one_width(&self) -> bool {
        self.fits.of(Some(1)).own.of_one_width.is_some()
    }

    /// Whether it has these widths.
    fn has(&self, widths: Widths) -> bool {
        match widths {
            Widths::Two => true,
            Widths::One => self.is_lone && self.has_one_width(),
            Widths::Short => self.is_short(),
        }
    }

    /// A form with so many lobes and such widths, and its error with so many rows: with a polynomial for the first interface where it has one and that holds the
    /// limits.
    pub(super) fn formed(&self, (most, widths, rows): Choice, limits: &Budget) -> (RowForm, FitError) {
        let of = |is_curved| {
            let form = RowForm { most: Some(most), widths, is_curved };
            (form, self.fits.error(form, rows))
        };
        let has_curve = self.is_lone && self.fits.of(Some(0)).curved.is_some();
        let curved = has_curve.then(|| of(true)).filter(|(_, error)| holds(*error, limits));
        curved.unwrap_or_else(|| of(false))
    }

    /// The form with the fewest reads that holds the limits with so many rows, up to one that others take; where none holds, the nearest. Nothing takes less than a short
    /// lobe.
    pub(super) fn cheapest(&self, choice: Choice, limits: &Budget) -> (RowForm, FitError) {
        let (most, widths, rows) = choice;
        let end = STEPS.iter().position(|step| *step == (most, widths)).unwrap_or(STEPS.len());
        let fewer = if widths == Widths::Short { &[] } else { &STEPS[..end] };
        let fewer = fewer.iter().filter(|(_, widths)| self.has(*widths)).map(|&(most, widths)| (most, widths, rows));
        let formed: Vec<_> = fewer.chain([choice]).map(|choice| self.formed(choice, limits)).collect();
        let excess = |(_, error): &(RowForm, FitError)| limits.excess(&measured(*error)).max(1.0);
        // Of equal ones the first.
        let found = formed.into_iter().min_by(|a, b| excess(a).total_cmp(&excess(b)));
        found.unwrap_or_else(|| unreachable!("a choice is a form"))
    }
}

/// Most lobes, their widths, and the number of rows.
pub(super) type Choice = (usize, Widths, usize);

/// A form, and whether each material has its own up to it.
pub(super) type Pick = (Choice, bool);

/// Forms of a material among others, from the fewest reads of a view to the most.
const STEPS: [(usize, Widths); 6] =
    [(0, Widths::Two), (1, Widths::Short), (1, Widths::One), (1, Widths::Two), (2, Widths::Two), (3, Widths::Two)];

/// The fits of a plan.
pub(super) fn members<'a>(plan: &Plan, materials: &[Material], results: &'a Results) -> Vec<Member<'a>> {
    let sides = materials.iter().filter_map(side).map(|side| fit(&side, true).key());
    let others = of_model(materials).filter(|material| !has_lone_rows(material) || side(material).is_some());
    let not_lone: BTreeSet<Key> = others.map(|material| fit(material, true).key()).chain(sides).collect();
    let jobs = plan.graph.of::<FitJob>().map(|job| job.key());
    jobs.filter_map(|key| Some(Member { key, fits: results.get(key)?, is_lone: !not_lone.contains(&key) })).collect()
}

/// Whether an error is within limits.
fn holds(error: FitError, limits: &Budget) -> bool {
    limits.excess(&measured(error)) <= 1.0
}

/// Errors of a fit as a search has them.
pub(super) fn measured(error: FitError) -> MeasuredError {
    MeasuredError { lobe: Some(error.lobe), albedo: Some(error.albedo), ..MeasuredError::default() }
}
