//! `check`: faults of files, found without a bake.

use std::collections::BTreeSet;

use luthier::{Files, SceneSource, Source, Sources, SurfaceSource};
use luthier_manifest::ShadingModel;
use luthier_material::{Diagnostic, Severity, Surface};
use luthier_terminal::{Failure, Outcome, counted, diagnostic, print, print_diagnostics};
use serde_json::{Value, json};

use crate::cli::CheckOptions;

/// Validates files, materials of one package as one set; diagnostics go to standard error, one line per file to standard output.
pub(crate) fn run(options: &CheckOptions) -> Outcome {
    let mut packages = Files::packages(&options.sources.paths)?;
    // A bake of scenes has no packages of folders inside.
    if !packages[0].2.scenes.is_empty() {
        packages.truncate(1);
    }
    let shading = options.shading.in_forms(&[]);
    let sets: Vec<Set> = packages.into_iter().map(|(_, _, files)| Set::of(files, shading.clone())).collect();
    if options.json {
        print(&format!("{:#}", sets.iter().flat_map(Set::entries).collect::<Value>()))?;
    } else {
        print(&sets.iter().map(Set::lines).collect::<String>())?;
    }
    if sets.iter().all(|set| set.sources.is_usable()) { Ok(()) } else { Err(Failure::Verdict) }
}

/// Files that are baked together, with their diagnostics.
struct Set {
    shading: luthier::Shading,
    sources: Sources,
}

impl Set {
    fn of(files: Files, shading: luthier::Shading) -> Self {
        let mut sources = Sources::of(files);
        sources.check(&shading);
        Self { shading, sources }
    }

    /// All materials with their models; `None` for materials of a scene, which chooses the models.
    fn all(&self) -> impl Iterator<Item = (&Source, Option<ShadingModel>)> {
        let of_scenes = self.sources.scenes.iter().flat_map(|scene| &scene.materials).map(|source| (source, None));
        let own = self.sources.materials.iter().map(|s| (s, s.material().map(|material| self.shading.model(material))));
        own.chain(of_scenes)
    }

    fn entries(&self) -> Vec<Value> {
        let scenes = self.sources.scenes.iter().map(scene_entry);
        let surfaces = self.sources.surfaces.iter().map(surface_entry);
        scenes.chain(surfaces).chain(self.all().map(|(source, model)| entry(source, model))).collect()
    }

    /// A line for each file. The diagnostics go to standard error.
    fn lines(&self) -> String {
        let mut lines = String::new();
        for scene in &self.sources.scenes {
            print_diagnostics(scene.parsed.as_ref().err().into_iter().flatten(), &scene.text);
            lines.push_str(&scene_line(scene));
        }
        for surface in &self.sources.surfaces {
            print_diagnostics(surface.diagnostics(), &surface.text);
            lines.push_str(&surface_line(surface));
        }
        for (source, model) in self.all() {
            print_diagnostics(source.diagnostics(), &source.text);
            lines.push_str(&line(source, model));
        }
        lines
    }
}

fn count(diagnostics: &[Diagnostic], severity: Severity) -> String {
    let n: usize = diagnostics.iter().filter(|d| d.severity == severity).map(|d| d.count).sum();
    counted(n, severity.name())
}

/// The number of warnings, for the end of a line.
fn warned(diagnostics: &[Diagnostic]) -> String {
    let has_warnings = diagnostics.iter().any(|d| d.severity == Severity::Warning);
    if has_warnings { format!(", {}", count(diagnostics, Severity::Warning)) } else { String::new() }
}

/// The number of errors, and of warnings beside them.
fn failed(diagnostics: &[Diagnostic]) -> String {
    count(diagnostics, Severity::Error) + &warned(diagnostics)
}

fn line(source: &Source, model: Option<ShadingModel>) -> String {
    match &source.parsed {
        Err(errors) => format!("{}: {}\n", source.label, failed(errors)),
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
        Err(errors) => format!("{}: {}\n", scene.label, failed(errors)),
        Ok(parsed) => {
            let broken = scene.materials.iter().filter(|source| source.parsed.is_err()).count();
            let verdict = if broken == 0 { "ok".to_owned() } else { format!("{broken} broken") };
            format!("{}: {verdict}, scene of {}\n", scene.label, counted(parsed.materials.len(), "material"))
        }
    }
}

fn surface_line(surface: &SurfaceSource) -> String {
    match &surface.parsed {
        Err(errors) => format!("{}: {}\n", surface.label, failed(errors)),
        Ok(parsed) => format!("{}: ok, surface of {}{}\n", surface.label, listed(parsed), warned(&surface.warnings)),
    }
}

/// The materials of a surface, each once.
fn listed(surface: &Surface) -> String {
    let named: BTreeSet<&str> = surface.materials().map(|material| material.file.as_str()).collect();
    counted(named.len(), "material")
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
