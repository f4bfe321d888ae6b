//! `check`: what is wrong with files, without a bake.

use std::collections::BTreeSet;

use luthier_export::{
    Source, SurfaceSource, doubt_surfaces, find, gather, input, read_all, refuse, refuse_surfaces, refuse_too_many,
};
use luthier_manifest::ShadingModel;
use luthier_material::{Diagnostic, Surface, is_scene};
use luthier_terminal::{Failure, Outcome, diagnostic, files, print, print_diagnostics};
use serde_json::{Value, json};

use crate::cli::CheckOptions;
use crate::materials::shaded;
use crate::misses;
use crate::verb::scene::SceneSource;

/// Validates files, materials as one set; diagnostics go to standard error, one line per file to standard output.
pub(crate) fn run(options: &CheckOptions) -> Outcome {
    let (mut others, mut scenes) = (Vec::new(), Vec::new());
    for path in find(&options.sources.paths)? {
        let bytes = input::bytes(&path).map_err(files(&path, "read"))?;
        if is_scene(&String::from_utf8_lossy(&bytes)) {
            scenes.push(SceneSource::read(&path)?);
        } else {
            others.push(path);
        }
    }
    let mut found = gather(&others)?;
    let mut sources = read_all(&found.materials)?;
    let surfaces = &mut found.surfaces;
    let shading = &options.shading;
    refuse(&mut sources, |material| shading.doubts(material, &[]));
    refuse_surfaces(surfaces, &sources);
    doubt_surfaces(surfaces);
    refuse_too_many(&mut sources, |materials| shaded(materials, shading, &[]));
    misses::foresee(&mut sources);
    // Models of materials of a scene are the scene's to choose.
    let of_scenes = || scenes.iter().flat_map(|scene| &scene.materials).map(|source| (source, None));
    let alone =
        || sources.iter().map(|source| (source, source.parsed.as_ref().ok().map(|p| shading.model(&p.material))));
    let all = || alone().chain(of_scenes());
    if options.json {
        let entries = scenes
            .iter()
            .map(scene_entry)
            .chain(surfaces.iter().map(surface_entry))
            .chain(all().map(|(source, model)| entry(source, model)));
        print(&format!("{:#}", Value::from_iter(entries)))?;
    } else {
        let mut lines = String::new();
        for scene in &scenes {
            scene.print_diagnostics();
            lines.push_str(&scene_line(scene));
        }
        for surface in surfaces.iter() {
            print_diagnostics(surface.diagnostics(), &surface.text);
            lines.push_str(&surface_line(surface));
        }
        for (source, model) in all() {
            print_diagnostics(source.diagnostics(), &source.text);
            lines.push_str(&line(source, model));
        }
        print(&lines)?;
    }
    let is_usable = sources.iter().all(|s| s.parsed.is_ok())
        && surfaces.iter().all(|s| s.parsed.is_ok())
        && scenes.iter().all(SceneSource::is_usable);
    if is_usable { Ok(()) } else { Err(Failure::Verdict) }
}

fn count(diagnostics: &[Diagnostic], what: &str) -> String {
    let n: usize = diagnostics.iter().map(|d| d.count).sum();
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// The number of warnings, for the end of a line.
fn warned(warnings: &[Diagnostic]) -> String {
    if warnings.is_empty() { String::new() } else { format!(", {}", count(warnings, "warning")) }
}

fn line(source: &Source, model: Option<ShadingModel>) -> String {
    match &source.parsed {
        Err(errors) => format!("{}: {}\n", source.label, count(errors, "error")),
        Ok(parsed) => {
            let class = parsed.material.class;
            let warnings = warned(&parsed.warnings);
            let model = model.map_or_else(String::new, |model| format!(", model {model}"));
            format!("{}: ok, class {} ({}){model}{warnings}\n", source.label, class.symbol(), class.name())
        }
    }
}

fn scene_line(scene: &SceneSource) -> String {
    match &scene.parsed {
        Err(errors) => format!("{}: {}\n", scene.label, count(errors, "error")),
        Ok(parsed) => {
            let broken = scene.materials.iter().filter(|source| source.parsed.is_err()).count();
            let verdict = if broken == 0 { "ok".to_owned() } else { format!("{broken} broken") };
            format!("{}: {verdict}, scene of {} materials\n", scene.label, parsed.materials.len())
        }
    }
}

fn surface_line(surface: &SurfaceSource) -> String {
    match &surface.parsed {
        Err(errors) => format!("{}: {}\n", surface.label, count(errors, "error")),
        Ok(parsed) => format!("{}: ok, surface of {}{}\n", surface.label, listed(parsed), warned(&surface.warnings)),
    }
}

/// The materials of a surface, each once.
fn listed(surface: &Surface) -> String {
    let named: BTreeSet<&str> = surface.materials().map(|material| material.file.as_str()).collect();
    match named.len() {
        1 => "1 material".to_owned(),
        count => format!("{count} materials"),
    }
}

fn surface_entry(surface: &SurfaceSource) -> Value {
    let named = surface
        .parsed
        .as_ref()
        .map(|s| json!({"name": s.name, "materials": s.materials().map(|m| m.file.as_str()).collect::<Vec<_>>()}));
    json!({"file": surface.label, "surface": named.ok(), "diagnostics": diagnostics(surface.diagnostics())})
}

fn entry(source: &Source, model: Option<ShadingModel>) -> Value {
    let material = source.parsed.as_ref().ok().map(|parsed| {
        let m = &parsed.material;
        let mut about = json!({"name": m.name, "class": m.class.symbol(), "class_name": m.class.name()});
        if let Some(model) = model {
            about["model"] = json!(model.name());
        }
        about
    });
    json!({"file": source.label, "material": material, "diagnostics": diagnostics(source.diagnostics())})
}

fn scene_entry(scene: &SceneSource) -> Value {
    let (parsed, errors) = (scene.parsed.as_ref().ok(), scene.parsed.as_ref().err());
    let named = parsed
        .map(|s| json!({"name": s.name, "materials": scene.materials.iter().map(|m| &m.label).collect::<Vec<_>>()}));
    json!({"file": scene.label, "scene": named, "diagnostics": diagnostics(errors.map(Vec::as_slice).unwrap_or_default())})
}

/// Diagnostics for programs.
pub(crate) fn diagnostics<'d>(all: impl IntoIterator<Item = &'d Diagnostic>) -> Value {
    all.into_iter().map(diagnostic).collect()
}
