//! Findings in words and by model. Every sentence is made from the numbers.

use super::tables::{Kind, number, table};
use crate::models::{CONTROL, ModelErrors, ModelsReport};

/// Excess of an albedo over 1 that noise and quadrature do not explain.
const GAIN: f64 = 0.005;

/// Largest error that counts as close, of either kind.
const CLOSE: f64 = 0.05;

/// Errors of one model over all materials.
struct Overall<'a> {
    name: &'a str,
    is_model: bool,
    /// Median, and largest with its material: of the albedo error, of the lobe error.
    errors: [(f64, f64, &'a str); 2],
    /// Number of materials on which the error is close: albedo, lobe.
    close: [usize; 2],
    /// Largest albedo and its material.
    brightest: (f64, &'a str),
}

impl<'a> Overall<'a> {
    fn new(report: &'a ModelsReport, row: usize) -> Option<Self> {
        let all = report.materials.iter().map(|material| (material.name.as_str(), &material.models[row]));
        let all: Vec<(&str, &ModelErrors)> = all.collect();
        let first = all.first()?.1;
        let errors = [Kind::Albedo, Kind::Lobe].map(|kind| {
            let mut sorted: Vec<(f64, &str)> = all.iter().map(|(name, e)| (kind.of(e).quantity.error, *name)).collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (largest, material) = sorted[sorted.len() - 1];
            let median = 0.5 * (sorted[(sorted.len() - 1) / 2].0 + sorted[sorted.len() / 2].0);
            (median, largest, material)
        });
        let close = [Kind::Albedo, Kind::Lobe]
            .map(|kind| all.iter().filter(|(_, e)| kind.of(e).quantity.error <= CLOSE).count());
        let albedos = all.iter().flat_map(|(name, e)| e.views.iter().map(|view| (view.albedo_model, *name)));
        let brightest = albedos.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Self { name: first.name, is_model: first.is_model, errors, close, brightest })
    }
}

/// The section.
pub(super) fn findings(report: &ModelsReport) -> String {
    let rows = report.materials.first().map_or(0, |material| material.models.len());
    let all: Vec<Overall<'_>> = (0..rows).filter_map(|row| Overall::new(report, row)).collect();
    if all.is_empty() {
        return String::new();
    }
    let head =
        ["model", "albedo error: median", "largest", "on", "lobe error: median", "largest", "on", "largest albedo"];
    let lines = all.iter().map(|o| {
        let [albedo, lobe] = o.errors.map(|(median, largest, on)| [number(median), number(largest), on.to_owned()]);
        let mut line = vec![o.name.to_owned()];
        line.extend(albedo.into_iter().chain(lobe).chain([number(o.brightest.0)]));
        line
    });
    let head = head.map(str::to_owned);
    format!("\n## By model\n\n{}\n{}", table(&head, lines), sentences(report, &all))
}

fn sentences(report: &ModelsReport, all: &[Overall<'_>]) -> String {
    let mut out = Vec::new();
    let count = report.materials.len();
    for (kind, what) in [(0, "albedo"), (1, "lobe")] {
        let models = all.iter().filter(|o| o.is_model);
        let best = models.clone().min_by(|a, b| a.errors[kind].0.total_cmp(&b.errors[kind].0));
        let close =
            models.max_by(|a, b| a.close[kind].cmp(&b.close[kind]).then(b.errors[kind].0.total_cmp(&a.errors[kind].0)));
        let (Some(best), Some(close)) = (best, close) else { continue };
        out.push(format!(
            "- `{}` has the smallest median {what} error, {}. `{}` is within {CLOSE} most often: on {} of {count} materials.",
            best.name,
            number(best.errors[kind].0),
            close.name,
            close.close[kind],
        ));
        let far: Vec<String> = report
            .materials
            .iter()
            .filter(|m| m.models.iter().filter(|e| e.is_model).all(|e| error(e, kind) > CLOSE))
            .map(|m| m.name.clone())
            .collect();
        if !far.is_empty() {
            out.push(format!("- No model has a {what} error within {CLOSE} on these materials: {}.", far.join(", ")));
        }
    }
    let gains: Vec<String> = all
        .iter()
        .filter(|o| o.brightest.0 > 1.0 + GAIN)
        .map(|o| format!("`{}` ({}, {})", o.name, number(o.brightest.0), o.brightest.1))
        .collect();
    if !gains.is_empty() {
        out.push(format!("- These models reflect more light than falls on the surface (in brackets the largest albedo and its material): {}.", gains.join(", ")));
    }
    for other in all.iter().filter(|o| !o.is_model) {
        let [(_, albedo, at), (_, lobe, lobe_at)] = other.errors;
        let what = if other.name == CONTROL { "Noise alone" } else { "The assumption of one facet alone" };
        out.push(format!(
            "- {what} (`{}`) causes an albedo error of up to {} ({at}) and a lobe error of up to {} ({lobe_at}).",
            other.name,
            number(albedo),
            number(lobe),
        ));
    }
    out.join("\n") + "\n"
}

fn error(errors: &ModelErrors, kind: usize) -> f64 {
    [Kind::Albedo, Kind::Lobe][kind].of(errors).quantity.error
}
