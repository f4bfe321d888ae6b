//! `check`: what is wrong with files, without a bake.

use std::collections::BTreeSet;
use std::path::PathBuf;

use luthier_export::{
    Gathered, Source, SurfaceSource, doubt_surfaces, find, gather, inner_packages, input, read_all, refuse,
    refuse_surfaces, refuse_too_many,
};
use luthier_manifest::ShadingModel;
use luthier_material::{Diagnostic, Severity, Surface, is_scene};
use luthier_terminal::{Failure, Outcome, diagnostic, files, print, print_diagnostics};
use serde_json::{Value, json};

use crate::cli::{CheckOptions, Shading};
use crate::materials::shaded;
use crate::misses;
use crate::verb::scene::SceneSource;

/// Validates files, materials of one package as one set; diagnostics go to standard error, one line per file to standard output.
pub(crate) fn run(options: &CheckOptions) -> Outcome {
    let mut sets = vec![Set::read(&options.sources.paths, &options.shading)?];
    // A bake of scenes has no other packages.
    if sets[0].scenes.is_empty() {
        for paths in inner_packages(&options.sources.paths)?.values() {
            sets.push(Set::read(paths, &options.shading)?);
        }
    }
    if options.json {
        print(&format!("{:#}", sets.iter().flat_map(Set::entries).collect::<Value>()))?;
    } else {
        print(&sets.iter().map(Set::lines).collect::<String>())?;
    }
    if sets.iter().all(Set::is_usable) { Ok(()) } else { Err(Failure::Verdict) }
}

/// Files that are baked together, with all that is wrong with them.
struct Set<'a> {
    shading: &'a Shading,
    scenes: Vec<SceneSource>,
    surfaces: Vec<SurfaceSource>,
    materials: Vec<Source>,
}

impl<'a> Set<'a> {
    fn read(paths: &[PathBuf], shading: &'a Shading) -> Outcome<Self> {
        let (mut others, mut scenes) = (Vec::new(), Vec::new());
        for path in find(paths)? {
            let bytes = input::bytes(&path).map_err(files(&path, "read"))?;
            if is_scene(&String::from_utf8_lossy(&bytes)) {
                scenes.push(SceneSource::read(&path)?);
            } else {
                others.push(path);
            }
        }
        let Gathered { materials, mut surfaces, .. } = gather(&others)?;
        let mut materials = read_all(&materials)?;
        refuse(&mut materials, |material| shading.doubts_and_energy(material, &[]));
        refuse_surfaces(&mut surfaces, &materials);
        doubt_surfaces(&mut surfaces);
        refuse_too_many(&mut materials, |materials| shaded(materials, shading, &[]));
        misses::foresee(&mut materials);
        Ok(Self { shading, scenes, surfaces, materials })
    }

    /// All materials, and their models: those of a scene are the scene's to choose.
    fn all(&self) -> impl Iterator<Item = (&Source, Option<ShadingModel>)> {
        let model = |source: &Source| source.parsed.as_ref().ok().map(|p| self.shading.model(&p.material));
        let of_scenes = self.scenes.iter().flat_map(|scene| &scene.materials).map(|source| (source, None));
        self.materials.iter().map(move |source| (source, model(source))).chain(of_scenes)
    }

    fn entries(&self) -> Vec<Value> {
        let scenes = self.scenes.iter().map(scene_entry);
        let surfaces = self.surfaces.iter().map(surface_entry);
        scenes.chain(surfaces).chain(self.all().map(|(source, model)| entry(source, model))).collect()
    }

    /// A line for each file. The diagnostics go to standard error.
    fn lines(&self) -> String {
        let mut lines = String::new();
        for scene in &self.scenes {
            scene.print_diagnostics();
            lines.push_str(&scene_line(scene));
        }
        for surface in &self.surfaces {
            print_diagnostics(surface.diagnostics(), &surface.text);
            lines.push_str(&surface_line(surface));
        }
        for (source, model) in self.all() {
            print_diagnostics(source.diagnostics(), &source.text);
            lines.push_str(&line(source, model));
        }
        lines
    }

    fn is_usable(&self) -> bool {
        self.materials.iter().all(|s| s.parsed.is_ok())
            && self.surfaces.iter().all(|s| s.parsed.is_ok())
            && self.scenes.iter().all(SceneSource::is_usable)
    }
}

fn count(diagnostics: &[Diagnostic], severity: Severity) -> String {
    let n: usize = diagnostics.iter().filter(|d| d.severity == severity).map(|d| d.count).sum();
    format!("{n} {}{}", severity.name(), if n == 1 { "" } else { "s" })
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
            format!("{}: {verdict}, scene of {} materials\n", scene.label, parsed.materials.len())
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
