//! The refusal of a budget that no tables hold.

use luthier_lut::TableKind;
use luthier_manifest::{Budget, MeasuredError};
use luthier_material::{Material, Severity};

use crate::BakeError;
use crate::candidates::Refusal;
use crate::options::Options;

/// The number with the error that exceeds a budget most.
pub(super) fn worst_of(errors: &[(usize, MeasuredError)], budget: &Budget) -> Option<usize> {
    let excess = |(_, error): &(usize, MeasuredError)| budget.excess(error);
    errors.iter().max_by(|a, b| excess(a).total_cmp(&excess(b))).map(|(number, _)| *number)
}

/// The refusal of a budget: what no tables of a kind are good enough for, a layer of a material or all of it, and the material that states the limit.
pub(super) fn refused(
    refusal: Refusal,
    kind: TableKind,
    worst: Option<(usize, Option<usize>)>,
    materials: &[Material],
    options: &Options<'_>,
) -> BakeError {
    let limit = |budget: &Budget, name: &str| budget.limits().into_iter().find(|(limit, _)| *limit == name)?.1;
    // The tightest limit of files counts, unless an option replaces it.
    let stated = |name: &str| {
        let all = materials.iter().enumerate().filter_map(|(number, m)| Some((number, limit(&m.budget, name)?)));
        let tightest = all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(number, _)| number);
        tightest.filter(|_| limit(&options.budget, name).is_none())
    };
    let key = |name: &str| format!("budget.{name}");
    let of = |name: &str| {
        let stating = stated(name).map(|number| &materials[number]);
        let value = limit(stating.map_or(&options.budget, |material| &material.budget), name).unwrap_or_default();
        let place = stating.map_or(String::new(), |material| format!(" of {}", material.place(&key(name))));
        let value = if value >= 1.0 { format!("{value}") } else { format!("{value:e}") };
        format!("{name} = {value}{place}")
    };
    let (reason, hint, place) = match refusal {
        Refusal::Error { limits, words, hint, .. } => {
            let layer = |layer: Option<usize>| layer.map_or("name".to_owned(), |layer| format!("layer.{layer}"));
            let whom = worst.map_or(String::new(), |(number, at)| {
                let (material, which) = (&materials[number], at.map_or(String::new(), |at| format!("layer {at} of ")));
                format!(" for {which}`{}` ({})", material.name, material.place(&layer(at)))
            });
            let under: Vec<String> = limits.iter().map(|name| of(name)).collect();
            let own = |number: usize| limits.iter().find(|name| stated(name) == Some(number)).map(|name| key(name));
            let reason = format!(
                "no {} table is good enough{whom} under {}; nearest: {words}",
                kind.name(),
                under.join(" and ")
            );
            (reason, hint, worst.map(|(number, at)| (number, own(number).unwrap_or_else(|| layer(at)))))
        }
        Refusal::Whole { limit, reason, hint } => {
            (format!("{reason} {}", of(limit)), hint, stated(limit).map(|number| (number, key(limit))))
        }
    };
    let mut error = BakeError::Budget { reason, hint, diagnostics: Vec::new() };
    let message = error.to_string();
    if let (BakeError::Budget { diagnostics, hint, .. }, Some((number, key))) = (&mut error, place) {
        let hint = Some(format!("write `{hint}`, or leave the limit out"));
        diagnostics.push(materials[number].diagnostic(Severity::Error, &key, message, hint));
    }
    error
}
