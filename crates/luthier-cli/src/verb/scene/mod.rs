//! Bakes of scenes: a model for each material, and only the code and the tables that these models need.

mod page;

use std::path::{Path, PathBuf};

use luthier_export::{
    MANIFEST, Source, find as find_files, input, label, of_domain, of_scene, plain, read_one, refuse,
};
use luthier_manifest::{MaterialChoice, SceneChoice};
use luthier_material::{Diagnostic, Material, Scene, is_scene, parse_scene};
use luthier_scene::{Director, Made, SceneFailure, label as candidate_label};
use luthier_terminal::{Broken, Failure, Outcome, bytes, files, print, print_diagnostics, valid};
use serde_json::json;

use crate::cli::BakeOptions;
use crate::interrupt::whole;
use crate::materials::refuse_environment;
use crate::misses;
use crate::progress::published;
use crate::store::store;
use crate::verb::check::diagnostics;

/// The scenes among the files; `None` where there is none, and files are materials.
pub(super) fn find(paths: &[PathBuf]) -> Outcome<Option<Vec<PathBuf>>> {
    let mut scenes = Vec::new();
    let mut others = Vec::new();
    for path in find_files(paths)? {
        // What is no text is left to whoever reads materials.
        let text = input::bytes(&path).map_err(files(&path, "read"))?;
        if is_scene(&String::from_utf8_lossy(&text)) { scenes.push(path) } else { others.push(path) }
    }
    match (scenes.first(), others.first()) {
        (None, _) => Ok(None),
        (Some(_), None) => Ok(Some(scenes)),
        (Some(scene), Some(other)) => Err(Failure::Usage(anyhow::anyhow!(
            "{} is a scene and {} is not: a scene names its materials itself",
            scene.display(),
            other.display()
        ))),
    }
}

fn director<'a>(options: &BakeOptions, scene: &'a Scene, materials: &'a [Material]) -> Outcome<Director<'a>> {
    let director = Director::new(scene, materials, options.emission.targets(), store()?);
    let director = director.with_functions(options.emission.functions());
    Ok(if options.shading.no_fit { director.without_fits() } else { director })
}

/// Bakes a scene, or prints what budgets would choose for some.
pub(super) fn run(options: &BakeOptions, scenes: &[PathBuf]) -> Outcome {
    let limits = options.limits.options();
    if !options.emission.form.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "the form of a scene's shaders is chosen with its models: leave out --form"
        )));
    }
    let shading = &options.shading;
    if shading.model.is_some()
        || shading.fresnel.is_some()
        || !shading.tables.is_empty()
        || !limits.search
        || !limits.budget.is_empty()
    {
        let text = "a scene has its limits in its [budget] and [target], and its models are chosen: leave out --model, --fresnel, --tables, \
                    --no-search and limits on tables";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot start threads")))?;
    if !options.budgets.is_empty() {
        return pool.install(|| tighten(options, scenes));
    }
    let [path] = scenes else {
        let text = "one scene at a time is baked into a folder; several are for --budgets";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    };
    let (scene, materials) = read(path, options.quiet)?;
    let mut director = director(options, &scene, &materials)?;
    let made = pool.install(|| director.step(None, options.allow_miss)).map_err(failure)?;
    let is_shown = made.package.manifest.materials.iter().any(|m| m.model.is_fitted());
    refuse_environment(&options.emission.functions, is_shown)?;
    let encoded = options.encoded(&made.package)?;
    whole(&options.out, || encoded.write(&options.out))?;
    published(&options.out);
    let missed = misses::name(&made.package.manifest, Path::new(""), options.quiet)?;
    if options.json {
        let manifest = options.out.join(MANIFEST);
        let (bytes, cycles) = (made.bytes(), made.cycles());
        let summary = json!({
            "manifest": manifest.to_string_lossy(), "texel_bytes": bytes, "cycles": cycles, "choice": made.choice,
            "diagnostics": diagnostics(&missed),
        });
        print(&format!("{summary:#}"))
    } else if options.quiet {
        Ok(())
    } else {
        print(&text(options, &made))
    }
}

/// A scene without models is an input that is not usable; what its materials say is theirs.
fn failure(error: SceneFailure) -> Failure {
    match error {
        SceneFailure::Export(error) => error.into(),
        SceneFailure::Package(error) => error.into(),
        _ => Failure::input(error),
    }
}

/// The steps of every scene, loosest budget first, as a page or as JSON.
fn tighten(options: &BakeOptions, scenes: &[PathBuf]) -> Outcome {
    let mut budgets = options.budgets.clone();
    budgets.sort_by(|a, b| b.total_cmp(a));
    let mut tightened = Vec::new();
    for path in scenes {
        let (scene, materials) = read(path, options.quiet)?;
        let mut director = director(options, &scene, &materials)?;
        let mut step = |&limit: &f64| director.step(Some(limit), options.allow_miss).map_err(failure);
        let steps: Vec<Made> = budgets.iter().map(&mut step).collect::<Outcome<_>>()?;
        tightened.push((scene, steps));
    }
    if options.json {
        let step = |made: &Made| json!({ "texel_bytes": made.bytes(), "cycles": made.cycles(), "choice": made.choice });
        let scenes: Vec<_> = tightened.iter().map(|(_, steps)| steps.iter().map(step).collect::<Vec<_>>()).collect();
        return print(&format!("{:#}", json!({ "budgets": budgets, "scenes": scenes })));
    }
    print(&page::markdown(&command(options), &budgets, &tightened))
}

/// A scene file that was read, and the files that it names.
pub(crate) struct SceneSource {
    /// The file, as it was named or found.
    pub(crate) label: String,
    pub(crate) text: String,
    /// The scene, or why it is none.
    pub(crate) parsed: Result<Scene, Vec<Diagnostic>>,
    /// Its materials, in its order, with what is refused of them.
    pub(crate) materials: Vec<Source>,
}

impl SceneSource {
    /// Reads a scene and its materials, and finds out all that can be known before work begins.
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let content = input::bytes(path).map_err(files(path, "read"))?;
        let (label, text) = (label(path), String::from_utf8_lossy(&content).into_owned());
        let mut parsed = parse_scene(&label, &text);
        let mut materials = Vec::new();
        if let Ok(scene) = &parsed {
            let folder = path.parent().unwrap_or(Path::new(""));
            let mut missing = Vec::new();
            for named in &scene.materials {
                match read_one(&plain(&folder.join(&named.file))).map_err(Failure::from) {
                    Ok(source) => materials.push(source),
                    Err(failure) => missing.push(scene.diagnostic(named, failure.sentence())),
                }
            }
            if missing.is_empty() {
                refuse(&mut materials, |material| [of_domain(material, None), of_scene(material)].concat());
            } else {
                parsed = Err(missing);
            }
        }
        Ok(Self { label, text, parsed, materials })
    }

    /// Whether it can be baked.
    pub(crate) fn is_usable(&self) -> bool {
        self.parsed.is_ok() && self.materials.iter().all(|source| source.parsed.is_ok())
    }

    /// Prints what is wrong with the scene to standard error; its materials have diagnostics of their own.
    pub(crate) fn print_diagnostics(&self) {
        print_diagnostics(self.parsed.as_ref().err().into_iter().flatten(), &self.text);
    }
}

/// A scene and its materials; or all diagnostics and a failure.
fn read(path: &Path, quiet: bool) -> Outcome<(Scene, Vec<Material>)> {
    let source = SceneSource::read(path)?;
    source.print_diagnostics();
    let scene = source.parsed.map_err(|diagnostics| {
        let sentence = format!("{} cannot be used; nothing was written", path.display());
        Failure::input(Broken { sentence, diagnostics })
    })?;
    Ok((scene, valid(source.materials, quiet)?))
}

fn text(options: &BakeOptions, made: &Made) -> String {
    let SceneChoice { scene, form, materials, .. } = &made.choice;
    let mut out = format!(
        "{scene}: {} materials, form {form}, {} of tables, {:.0} cycles in all\n\n",
        materials.len(),
        bytes(made.bytes()),
        made.cycles()
    );
    for MaterialChoice { name, reason, .. } in materials {
        out.push_str(&format!("{name}: {reason}\n"));
    }
    let models: Vec<String> = materials.iter().map(|choice| candidate_label(choice.candidate())).collect();
    let tables: Vec<&str> = made.package.manifest.tables.iter().map(|table| table.kind.name()).collect();
    out.push_str(&format!("\nmodels: {}\n", models.join("; ")));
    out.push_str(&format!("tables: {}\n", if tables.is_empty() { "none".to_owned() } else { tables.join(", ") }));
    out.push_str(&format!("wrote {}\n", options.out.join(MANIFEST).display()));
    out
}

/// The command line that makes the page.
fn command(options: &BakeOptions) -> String {
    let mut words = vec!["luthier bake".to_owned()];
    words.extend(options.sources.paths.iter().map(|path| label(path)));
    let budgets: Vec<String> = options.budgets.iter().map(f64::to_string).collect();
    words.push(format!("--budgets {}", budgets.join(",")));
    if options.allow_miss {
        words.push("--allow-miss".to_owned());
    }
    words.join(" ")
}
