//! Bakes of scenes: a model for each material, and only the code and the tables that these models need.

mod page;

use luthier::{Files, SceneSource, TomlFile};
use luthier_export::{MANIFEST, label};
use luthier_manifest::{LayerKind, MaterialChoice, SceneChoice};
use luthier_material::{Material, Scene};
use luthier_scene::{DeviceCost, Director, Made, SceneFailure, cost_text, label as candidate_label};
use luthier_terminal::{Broken, Failure, Outcome, bytes, counted, print, print_diagnostics, valid};
use serde_json::{Value, json};

use crate::cli::BakeOptions;
use crate::interrupt::whole;
use crate::materials::{refuse_environment, tell_misses};
use crate::progress::published;
use crate::store::store;
use crate::verb::check::diagnostics;

/// Refuses scenes among other files.
pub(super) fn refuse_mixture(files: &Files) -> Outcome {
    let [scene, ..] = files.scenes.as_slice() else { return Ok(()) };
    match files.paths().find(|path| files.scenes.iter().all(|scene| scene.path != *path)) {
        None => Ok(()),
        Some(other) => Err(Failure::Usage(anyhow::anyhow!(
            "{} is a scene and {} is not: a scene names its materials itself",
            scene.path.display(),
            other.display()
        ))),
    }
}

fn director<'a>(options: &BakeOptions, scene: &'a Scene, materials: &'a [Material]) -> Outcome<Director<'a>> {
    let director = Director::new(scene, materials, options.emission.targets(), store()?);
    let director = director.with_functions(options.emission.functions()).with_names(options.emission.names.names());
    let director = match options.costs_of.load()? {
        Some(device) => director.with_costs(device),
        None => director,
    };
    Ok(if options.shading.no_fit { director.without_fits() } else { director })
}

/// Bakes a scene, or prints the choices of several budgets for scenes.
pub(super) fn run(options: &BakeOptions, scenes: Vec<TomlFile>) -> Outcome {
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
    let pool = options.pool()?;
    if !options.budgets.is_empty() {
        return pool.install(|| tighten(options, scenes));
    }
    let Ok([file]) = <[TomlFile; 1]>::try_from(scenes) else {
        let text = "one scene at a time is baked into a folder; several are for --budgets";
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    };
    let (scene, materials) = read(file, options.quiet)?;
    let mut director = director(options, &scene, &materials)?;
    let made = pool.install(|| director.step(None, options.allow_miss)).map_err(failure)?;
    let mut first = made.package.manifest.materials.iter().filter_map(|material| material.layers.first());
    let is_shown = first.any(|layer| layer.kind != LayerKind::Diffuse);
    refuse_environment(&options.emission.functions, is_shown)?;
    let encoded = options.encoded(&made.package)?;
    whole(&options.out, || encoded.write(&options.out))?;
    published(&options.out);
    let missed = tell_misses(&made.package.manifest, &materials, options.quiet);
    if options.json {
        let manifest = options.out.join(MANIFEST);
        let (bytes, cost) = (made.bytes(), made.cost());
        let summary = json!({
            "manifest": manifest.to_string_lossy(), "texel_bytes": bytes, "cost": cost, "choice": made.choice,
            "diagnostics": diagnostics(&missed),
        });
        print(&format!("{summary:#}"))
    } else if options.quiet {
        Ok(())
    } else {
        print(&text(options, &made, director.device()))
    }
}

/// The failure of a choice: a scene without models is an unusable input, and other errors keep their kind.
fn failure(error: SceneFailure) -> Failure {
    match error {
        SceneFailure::Export(error) => error.into(),
        SceneFailure::Package(error) => error.into(),
        _ => Failure::input(error),
    }
}

/// The steps of every scene, loosest budget first, as a page or as JSON.
fn tighten(options: &BakeOptions, scenes: Vec<TomlFile>) -> Outcome {
    let mut budgets = options.budgets.clone();
    budgets.sort_by(|a, b| b.total_cmp(a));
    let mut tightened = Vec::new();
    for file in scenes {
        let (scene, materials) = read(file, options.quiet)?;
        let mut director = director(options, &scene, &materials)?;
        let steps = budgets.iter().map(|&limit| director.step(Some(limit), options.allow_miss).map_err(failure));
        let steps = steps.collect::<Outcome<Vec<Made>>>()?;
        let device = director.device().clone();
        let unchosen = director.without_choice();
        tightened.push(page::Tightened { scene, device, steps, unchosen });
    }
    if options.json {
        let scenes: Value = tightened
            .iter()
            .map(|page::Tightened { steps, .. }| steps.iter().map(summary).collect::<Value>())
            .collect();
        return print(&format!("{:#}", json!({ "budgets": budgets, "scenes": scenes })));
    }
    print(&page::markdown(&command(options), &budgets, &tightened))
}

fn summary(made: &Made) -> Value {
    json!({ "texel_bytes": made.bytes(), "cost": made.cost(), "choice": made.choice })
}

/// A scene and its materials. If they cannot be used, all diagnostics are printed and the result is a failure.
fn read(file: TomlFile, quiet: bool) -> Outcome<(Scene, Vec<Material>)> {
    let SceneSource { label, text, parsed, materials, .. } = SceneSource::of(file);
    print_diagnostics(parsed.as_ref().err().into_iter().flatten(), &text);
    let scene = parsed.map_err(|diagnostics| {
        let sentence = format!("{label} cannot be used; nothing was written");
        Failure::input(Broken { sentence, diagnostics })
    })?;
    Ok((scene, valid(materials, quiet)?))
}

fn text(options: &BakeOptions, made: &Made, device: &DeviceCost) -> String {
    let SceneChoice { scene, form, materials, neighbours_differ, .. } = &made.choice;
    let differ = match *neighbours_differ {
        0.0 => String::new(),
        share => format!(" where a share of {share} of neighbours differs"),
    };
    let mut out = format!(
        "{scene}: {}, form {form}, {} of tables, {} in all{differ}\ncosts: {}\n\n",
        counted(materials.len(), "material"),
        bytes(made.bytes()),
        cost_text(made.cost(), device.unit),
        device.label(),
    );
    for MaterialChoice { name, reason, disagreements, .. } in materials {
        out.push_str(&format!("{name}: {reason}\n"));
        disagreements.iter().for_each(|sentence| out.push_str(&format!("  {sentence}\n")));
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
    words.extend(options.costs_of.device.iter().map(|name| format!("--device {name}")));
    words.extend(options.costs_of.costs.iter().map(|path| format!("--costs {}", label(path))));
    words.join(" ")
}
