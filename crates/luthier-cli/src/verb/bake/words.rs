//! The result of a bake in words, and as JSON.

use luthier_export::MANIFEST;
use luthier_manifest::{CandidateForm, LobesError, LobesForm, LobesRecord, Manifest};
use luthier_terminal::{bytes, counted};
use serde_json::{Value, json};

use crate::cli::BakeOptions;
use crate::progress::BakeProgress;

pub(super) fn text(options: &BakeOptions, manifest: &Manifest, progress: &BakeProgress) -> String {
    let mut out =
        format!("{}, {}\n\n", counted(manifest.materials.len(), "material"), counted(manifest.tables.len(), "table"));
    out.push_str(&format!(
        "{:<13} {:>6}  {:>11}  {:<11} {:>10}  {:>9}\n",
        "table", "tiles", "texels", "format", "size", "max error"
    ));
    for table in &manifest.tables {
        let [width, height] = table.layout.size();
        let worst = table.tiles.iter().map(|t| t.error.max_abs_err).fold(0.0, f64::max);
        out.push_str(&format!(
            "{:<13} {:>6}  {:>11}  {:<11} {:>10}  {worst:>9.1e}\n",
            table.kind.name(),
            table.layout.tiles,
            format!("{width}x{height}"),
            table.format.name(),
            bytes(table.texel_bytes),
        ));
    }
    if !manifest.searches.is_empty() {
        out.push_str("\nsearched\n");
    }
    for search in &manifest.searches {
        let chosen = &search.front[search.chosen];
        let what = match &chosen.form {
            CandidateForm::ClosedForm => "computed, no table".to_owned(),
            CandidateForm::Table { .. } => {
                let error = chosen.error.lobe.map_or_else(
                    || format!("error {:.1e}", chosen.error.max_abs),
                    |lobe| format!("lobe error {lobe:.3}"),
                );
                format!("{} bytes, {error}", chosen.bytes)
            }
        };
        let (kind, front, measured) = (search.kind.name(), search.front.len(), search.measured);
        out.push_str(&format!("{kind:<13} {what}; cost {:.0}; {front} on the front of {measured}\n", chosen.cost));
    }
    let lobes = fitted_lobes(manifest);
    for (number, (name, record, error)) in lobes.into_iter().enumerate() {
        let LobesError { lobe, lobe_noise, albedo, albedo_noise } = error;
        if number == 0 {
            out.push_str("\nlobes against the simulated stack, of unseen views the worst\n");
        }
        out.push_str(&format!(
            "{name:<30} lobe error {lobe:.3}, of noise {lobe_noise:.3}; error of the albedo {albedo:.4}, standard error {albedo_noise:.4}; {}\n",
            form_in_words(&record)
        ));
    }
    let jobs: Vec<String> = progress.seconds().iter().map(|(kind, s)| format!("{} {s:.2}", kind.name())).collect();
    out.push_str(&format!("\nseconds: {}; all {:.2}\n", jobs.join(", "), progress.seconds_all()));
    out.push_str(&format!("jobs: {} run, {} found in the store\n", progress.run(), progress.had()));
    out.push_str(&format!("wrote {}\n", options.out.join(MANIFEST).display()));
    out
}

/// The form of rows, and whether a polynomial is the reflectance of the first interface.
fn form_in_words(record: &LobesRecord) -> String {
    let form = LobesForm::of(record).map_or("rows over more than the view", LobesForm::words);
    let reflectance = record.reflectance.map_or("", |_| ", polynomial reflectance");
    format!("{form}{reflectance}")
}

/// The lobes of each material and their errors, and those of what a weight leaves bare where that has lobes of its own.
fn fitted_lobes(manifest: &Manifest) -> Vec<(String, LobesRecord, LobesError)> {
    let fitted = manifest.materials.iter().flat_map(|material| {
        let side = material.constants.coat.as_ref().and_then(|coat| coat.side);
        let where_bare = if side.is_some_and(|side| side.without_film) { "without its film" } else { "below the coat" };
        let of = |name: String, lobes: Option<LobesRecord>| {
            let record = lobes?;
            Some((name, record, record.error?))
        };
        let below = of(format!("{}, {where_bare}", material.name), side.and_then(|side| side.lobes));
        of(material.name.clone(), material.constants.lobes).into_iter().chain(below)
    });
    fitted.collect()
}

pub(super) fn summary(options: &BakeOptions, manifest: &Manifest, progress: &BakeProgress) -> Value {
    let tables: Vec<Value> = manifest
        .tables
        .iter()
        .map(|t| {
            let worst = t.tiles.iter().map(|t| t.error.max_abs_err).fold(0.0, f64::max);
            json!({
                "kind": t.kind.name(),
                "tiles": t.layout.tiles,
                "size": t.layout.size(),
                "format": t.format.name(),
                "texel_bytes": t.texel_bytes,
                "max_abs_err": worst,
            })
        })
        .collect();
    let lobes = fitted_lobes(manifest).into_iter().map(|(name, record, error)| {
        json!({
            "material": name,
            "form": LobesForm::of(&record),
            "is_polynomial": record.reflectance.is_some(),
            "error": error,
        })
    });
    let lobes: Vec<Value> = lobes.collect();
    let seconds: Value = progress.seconds().iter().map(|(kind, s)| (kind.name().to_owned(), json!(s))).collect();
    let phases: Value = progress.phases().iter().map(|(phase, s)| ((*phase).to_owned(), json!(s))).collect();
    json!({
        "manifest": options.out.join(MANIFEST).to_string_lossy(),
        "materials": manifest.materials.iter().map(|m| &m.name).collect::<Vec<_>>(),
        "tables": tables,
        "searches": &manifest.searches,
        "lobes": lobes,
        "jobs": { "run": progress.run(), "found": progress.had() },
        "seconds": seconds,
        "phases": phases,
        "seconds_all": progress.seconds_all(),
    })
}
