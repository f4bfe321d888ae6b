//! `bake`: files into a folder.

use std::collections::BTreeSet;
use std::time::Instant;

use luthier_bake::{Observer, Silent};
use luthier_export::{Bake, Compression, MANIFEST, MemoryStore, Package, Source, read, refuse};
use luthier_manifest::{CandidateForm, Functions, LobesError, Manifest};
use luthier_material::Diagnostic;
use luthier_shader::{Form, Target};
use luthier_terminal::{Failure, Outcome, bytes, print, valid};
use serde_json::{Value, json};

use crate::cli::{BakeOptions, Emission};
use crate::interrupt::whole;
use crate::materials::{refuse_environment, shaded, shows_environment};
use crate::misses;
use crate::progress::BakeProgress;
use crate::verb::check::diagnostics;
use crate::verb::scene;

/// Bakes files into a folder. The folder changes only once everything is made.
pub(crate) fn run(options: &BakeOptions) -> Outcome {
    let start = Instant::now();
    if let Some(scenes) = scene::find(&options.sources.paths)? {
        return scene::run(options, &scenes);
    }
    if options.allow_miss || !options.budgets.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "--allow-miss and --budgets are for scenes (docs/pages/scenes.md)"
        )));
    }
    let mut sources = read(&options.sources.paths)?;
    let forms = options.emission.forms();
    refuse(&mut sources, |material| options.shading.doubts(material, &forms));
    let mut told: Vec<Diagnostic> = sources.iter().flat_map(Source::diagnostics).cloned().collect();
    let materials = shaded(valid(sources, options.quiet)?, &options.shading, &forms);
    let is_shown = materials.iter().any(shows_environment) && forms != [Form::Full];
    refuse_environment(&options.emission.functions, is_shown)?;
    let limits = options.limits.options();
    if forms == [Form::Full] && !limits.budget.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "limits are those of tables, and a bake of --form full has no tables"
        )));
    }
    let progress = BakeProgress::new();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot start threads")))?;
    let encoded = pool.install(|| {
        let observer: &dyn Observer = if options.quiet { &Silent } else { &progress };
        let (targets, functions) = (options.emission.targets(), options.emission.functions());
        let bake = Bake { options: limits, targets, forms, functions, observer, ..Bake::default() };
        Ok::<_, Failure>(Package::new(&materials, &bake, &MemoryStore::default())?.encode(options.compression())?)
    })?;
    whole(&options.out, || encoded.write(&options.out))?;
    let manifest = &encoded.manifest;
    told.extend(misses::name(manifest, options.quiet)?);

    if options.json {
        let mut summary = summary(options, manifest, &progress, start);
        summary["diagnostics"] = diagnostics(&told);
        print(&format!("{summary:#}"))
    } else if options.quiet {
        Ok(())
    } else {
        print(&text(options, manifest, &progress, start))
    }
}

impl Emission {
    /// The languages of the shaders to write, each once.
    pub(super) fn targets(&self) -> Vec<Target> {
        let asked: BTreeSet<Target> = self.target.iter().copied().collect();
        if asked.is_empty() { Bake::default().targets } else { asked.into_iter().collect() }
    }

    /// The forms that are asked for, each once.
    fn forms(&self) -> Vec<Form> {
        self.form.iter().copied().collect::<BTreeSet<Form>>().into_iter().collect()
    }

    /// The groups of functions of each shader.
    pub(super) fn functions(&self) -> Functions {
        self.functions.iter().copied().collect()
    }
}

impl BakeOptions {
    pub(super) fn compression(&self) -> Compression {
        if self.no_zstd { Compression::None } else { Compression::Zstd }
    }
}

fn text(options: &BakeOptions, manifest: &Manifest, progress: &BakeProgress, start: Instant) -> String {
    let mut out = format!("{} materials, {} tables\n\n", manifest.materials.len(), manifest.tables.len());
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
    let lobes = manifest.materials.iter().filter_map(|m| Some((&m.name, m.constants.lobes?.error?)));
    for (number, (name, LobesError { lobe, lobe_noise, albedo, albedo_noise })) in lobes.enumerate() {
        if number == 0 {
            out.push_str("\nlobes against the simulated stack, of unseen views the worst\n");
        }
        out.push_str(&format!(
            "{name:<30} lobe error {lobe:.3}, of noise {lobe_noise:.3}; error of the albedo {albedo:.4}, standard error {albedo_noise:.4}\n"
        ));
    }
    let jobs: Vec<String> = progress.seconds().iter().map(|(kind, s)| format!("{} {s:.2}", kind.name())).collect();
    out.push_str(&format!("\nseconds: {}; all {:.2}\n", jobs.join(", "), start.elapsed().as_secs_f64()));
    out.push_str(&format!("wrote {}\n", options.out.join(MANIFEST).display()));
    out
}

fn summary(options: &BakeOptions, manifest: &Manifest, progress: &BakeProgress, start: Instant) -> Value {
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
    let lobes: Vec<Value> = (manifest.materials.iter())
        .filter_map(|m| Some(json!({ "material": m.name, "error": m.constants.lobes?.error? })))
        .collect();
    let seconds: Value = progress.seconds().iter().map(|(kind, s)| (kind.name().to_owned(), json!(s))).collect();
    json!({
        "manifest": options.out.join(MANIFEST).to_string_lossy(),
        "materials": manifest.materials.iter().map(|m| &m.name).collect::<Vec<_>>(),
        "tables": tables,
        "searches": &manifest.searches,
        "lobes": lobes,
        "seconds": seconds,
        "seconds_all": start.elapsed().as_secs_f64(),
    })
}
