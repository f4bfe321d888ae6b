//! The refusal of a budget that no tables hold.

use luthier_lut::TableKind;
use luthier_manifest::{Budget, MeasuredError};
use luthier_material::{Material, Severity};

use crate::BakeError;
use crate::candidates::Refusal;
use crate::options::Options;

/// Number of the tile or material whose error exceeds a budget most.
pub(super) fn worst_of(errors: &[(usize, MeasuredError)], budget: &Budget) -> Option<usize> {
    let worst = errors.iter().max_by(|(_, a), (_, b)| budget.excess(a).total_cmp(&budget.excess(b)));
    worst.map(|(number, _)| *number)
}

/// The refusal of a budget, with the kind whose tables are not good enough, the layer or material that is worst, and
/// the material that states the limit.
pub(super) fn refused(
    refusal: Refusal,
    kind: TableKind,
    worst: Option<(usize, Option<usize>)>,
    materials: &[Material],
    options: &Options<'_>,
) -> BakeError {
    let (reason, hint, place) = match refusal {
        Refusal::Error { limits, words, hint, .. } => {
            let whom = worst.map_or(String::new(), |(number, at)| {
                let (material, which) = (&materials[number], at.map_or(String::new(), |at| format!("layer {at} of ")));
                format!(" for {which}`{}` ({})", material.name, material.place(&layer_key(at)))
            });
            let under: Vec<String> = limits.iter().map(|name| in_words(name, materials, &options.budget)).collect();
            let place = worst.map(|(number, at)| {
                let own = limits.iter().find(|name| stated(name, materials, &options.budget) == Some(number));
                (number, own.map_or_else(|| layer_key(at), |name| format!("budget.{name}")))
            });
            let reason = format!(
                "no {} table is good enough{whom} under {}; nearest: {words}",
                kind.name(),
                under.join(" and ")
            );
            (reason, hint, place)
        }
        Refusal::Whole { limit, reason, hint } => {
            let place = stated(limit, materials, &options.budget).map(|number| (number, format!("budget.{limit}")));
            (format!("{reason} {}", in_words(limit, materials, &options.budget)), hint, place)
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

/// Key of a layer in a material file; of the whole material without one.
fn layer_key(layer: Option<usize>) -> String {
    layer.map_or("name".to_owned(), |layer| format!("layer.{layer}"))
}

fn limit(budget: &Budget, name: &str) -> Option<f64> {
    budget.limits().into_iter().find(|(limit, _)| *limit == name)?.1
}

/// Number of the material that states the tightest limit of this name; none where a `given` one replaces it.
fn stated(name: &str, materials: &[Material], given: &Budget) -> Option<usize> {
    let all = materials.iter().enumerate().filter_map(|(number, m)| Some((number, limit(&m.budget, name)?)));
    let tightest = all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(number, _)| number);
    tightest.filter(|_| limit(given, name).is_none())
}

/// The limit of this name with its value, and where it is stated.
fn in_words(name: &str, materials: &[Material], given: &Budget) -> String {
    let stating = stated(name, materials, given).map(|number| &materials[number]);
    let value = limit(stating.map_or(given, |material| &material.budget), name).unwrap_or_default();
    let place = stating.map_or(String::new(), |m| format!(" of {}", m.place(&format!("budget.{name}"))));
    let value = if value >= 1.0 { format!("{value}") } else { format!("{value:e}") };
    format!("{name} = {value}{place}")
}
