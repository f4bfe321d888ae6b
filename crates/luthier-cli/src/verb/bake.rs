use std::collections::BTreeSet;
use std::path::{Component, Path};
use std::time::Instant;

use luthier_bake::{Observer, Silent};
use luthier_manifest::{CandidateForm, Manifest};
use luthier_material::Diagnostic;
use luthier_shader::{Form, Target};
use serde_json::{Value, json};

use crate::bake_files::{BakeFiles, MANIFEST, REPORT_FILES, REPORT_FOLDER, Shaders};
use crate::cli::{BakeOptions, Emission};
use crate::doubts;
use crate::failure::{Failure, Outcome, files};
use crate::materials::{Source, read, read_image, shaded, valid};
use crate::misses;
use crate::output::{bytes, print};
use crate::progress::BakeProgress;
use crate::refusals;
use crate::staging::Staging;
use crate::verb::check::diagnostics;
use crate::verb::scene;

/// Bakes files into a folder. The folder changes only once everything is made.
pub(crate) fn run(options: &BakeOptions) -> Outcome {
    let start = Instant::now();
    if let Some(scenes) = scene::find(&options.sources.paths)? {
        return scene::run(options, &scenes);
    }
    if options.allow_miss || !options.budgets.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!("--allow-miss and --budgets are for scenes (docs/scenes.md)")));
    }
    let mut sources = read(&options.sources.paths)?;
    refusals::find(&mut sources, |material| doubts::of_model(material, options.shading.model));
    let mut told: Vec<Diagnostic> = sources.iter().flat_map(Source::diagnostics).cloned().collect();
    let materials = shaded(valid(sources, options.quiet)?, &options.shading);
    let shaders = options.emission.shaders();
    let limits = options.limits.options();
    if shaders.forms == [Form::Full] && !limits.budget.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "limits are those of tables, and a bake of --form full has no tables"
        )));
    }
    let progress = BakeProgress::new();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot start threads")))?;
    let made = pool.install(|| {
        let observer: &dyn Observer = if options.quiet { &Silent } else { &progress };
        // Without a shader that reads them, there are no tables.
        if shaders.forms == [Form::Full] {
            return BakeFiles::without_tables(&materials, &shaders);
        }
        let bake = luthier_bake::bake_with(&materials, &limits, &read_image, observer);
        BakeFiles::new(&materials, &bake.map_err(Failure::input)?, &shaders)
    })?;
    publish(options, &made)?;
    told.extend(misses::name(&made.manifest, options.quiet)?);

    if options.json {
        let mut summary = summary(options, &made.manifest, &progress, start);
        summary["diagnostics"] = diagnostics(&told);
        print(&format!("{summary:#}"))
    } else if options.quiet {
        Ok(())
    } else {
        print(&text(options, &made.manifest, &progress, start))
    }
}

impl Emission {
    /// The shaders to write, each once.
    pub(super) fn shaders(&self) -> Shaders {
        let all = Shaders::default();
        let targets: BTreeSet<Target> = self.target.iter().copied().collect();
        let forms: BTreeSet<Form> = self.form.iter().copied().collect();
        Shaders {
            targets: if targets.is_empty() { all.targets } else { targets.into_iter().collect() },
            forms: if forms.is_empty() { all.forms } else { forms.into_iter().collect() },
        }
    }
}

/// Moves everything into place, the manifest last, and removes what an earlier bake left and this one does not have; the
/// report on another bake too.
pub(super) fn publish(options: &BakeOptions, made: &BakeFiles) -> Outcome {
    let plain = if options.no_zstd { Some(made.without_zstd()?) } else { None };
    let made = plain.as_ref().unwrap_or(made);
    let manifest = made.manifest.to_json().map_err(Failure::input)?;
    // Unreadable is as good as none: what it named, nobody knows.
    let old = std::fs::read_to_string(options.out.join(MANIFEST)).unwrap_or_default();
    let stale = if old == manifest { Vec::new() } else { left_by(&old) };
    let mut staging = Staging::for_folder(&options.out)?;
    for (path, bytes) in &made.files {
        staging.write(path, bytes)?;
    }
    staging.write(MANIFEST, manifest.as_bytes())?;
    staging.publish()?;
    let current: BTreeSet<&Path> =
        made.files.iter().map(|(path, _)| path.as_str()).chain([MANIFEST]).map(Path::new).collect();
    for path in stale.iter().filter(|p| !current.contains(Path::new(p))) {
        let path = options.out.join(path);
        if path.is_file() {
            std::fs::remove_file(&path).map_err(files(&path, "remove"))?;
        }
    }
    if !stale.is_empty() {
        // Stays if something else is in it.
        let _ = std::fs::remove_dir(options.out.join(REPORT_FOLDER));
    }
    Ok(())
}

/// The files of an earlier bake, and of the report on it: whatever its manifest, of any schema, names with a hash. A manifest
/// of another program names nothing of ours.
fn left_by(manifest: &str) -> Vec<String> {
    let Ok(manifest) = serde_json::from_str::<Value>(manifest) else { return Vec::new() };
    if !manifest["generator"].as_str().is_some_and(|g| g.starts_with("luthier ")) {
        return Vec::new();
    }
    let mut paths: Vec<String> = REPORT_FILES.map(str::to_owned).into();
    let mut open = vec![&manifest];
    while let Some(value) = open.pop() {
        match value {
            Value::Array(items) => open.extend(items),
            Value::Object(entries) => {
                if let (Some(Value::String(path)), Some(Value::String(_))) =
                    (entries.get("path"), entries.get("sha256"))
                {
                    paths.push(path.clone());
                }
                open.extend(entries.values());
            }
            _ => {}
        }
    }
    // We write nothing outside the folder, and remove nothing there.
    paths.retain(|p| Path::new(p).components().all(|part| matches!(part, Component::Normal(_))));
    paths
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
            CandidateForm::Table { .. } => format!("{} bytes, error {:.1e}", chosen.bytes, chosen.error.max_abs),
        };
        let (kind, front, measured) = (search.kind.name(), search.front.len(), search.measured);
        out.push_str(&format!("{kind:<13} {what}; cost {:.0}; {front} on the front of {measured}\n", chosen.cost));
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
    let seconds: Value = progress.seconds().iter().map(|(kind, s)| (kind.name().to_owned(), json!(s))).collect();
    json!({
        "manifest": options.out.join(MANIFEST).to_string_lossy(),
        "materials": manifest.materials.iter().map(|m| &m.name).collect::<Vec<_>>(),
        "tables": tables,
        "searches": &manifest.searches,
        "seconds": seconds,
        "seconds_all": start.elapsed().as_secs_f64(),
    })
}
