//! The shaders of `examples/`, around the texts that they paste: as found on disk, put together as each program does it.

use std::fs;
use std::path::{Path, PathBuf};

use luthier_manifest::{FunctionGroup, MaterialEntry};
use luthier_shader::{Form, MaterialSet, Target, bindings, emit, validate};

use crate::scenes::{forms, sets, tables};

/// A shader of an example, with a place for the text of the bake.
struct Shader {
    file: String,
    language: Target,
    text: String,
}

/// Where a template of JavaScript starts that holds GLSL.
const TEMPLATE: &str = "/* glsl */ `";
/// Where it pastes the text of the bake.
const PASTE: &str = "${glsl}";

/// Folders of `examples/` without a shader of their own, or with shaders that scripts of their own compile and run in the host.
const OTHERS: [&str; 11] =
    ["farm", "mitsuba", "c", "shaders", "three", "bevy", "web", "babylon", "playcanvas", "materialx", "godot"];

/// The shaders that call `luthier_eval`, of every folder of `examples/` with a renderer.
fn shaders() -> Vec<Shader> {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut shaders = Vec::new();
    let folders = fs::read_dir(&examples).unwrap().map(|entry| entry.unwrap().path());
    for example in folders.filter(|path| path.is_dir() && !OTHERS.iter().any(|other| path.ends_with(other))) {
        let mut found = Vec::new();
        for path in files(&example) {
            let name = path.strip_prefix(&examples).unwrap().display().to_string();
            let is = |extension: &str| path.extension().is_some_and(|e| e == extension);
            let shader = |language, text| Shader { file: name.clone(), language, text };
            if is("wgsl") {
                found.push(shader(Target::Wgsl, fs::read_to_string(&path).unwrap()));
            } else if is("js") {
                let text = fs::read_to_string(&path).unwrap();
                let templates = text.split(TEMPLATE).skip(1).filter_map(|rest| rest.split('`').next());
                found.extend(templates.map(|template| shader(Target::GlslEs300, template.to_owned())));
            }
        }
        found.retain(|shader| shader.text.contains("luthier_eval("));
        assert!(!found.is_empty(), "{} has no shader that calls luthier_eval", example.display());
        shaders.extend(found);
    }
    shaders
}

/// The files of an example, those of packages left out.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true if path.ends_with("node_modules") || path.ends_with("target") => {}
            true => found.extend(files(&path)),
            false => found.push(path),
        }
    }
    found.sort();
    found
}

/// The shader with the text of a bake, as the example puts them together.
fn paste(shader: &Shader, bake: &str) -> String {
    let Shader { text, language, .. } = shader;
    if *language == Target::GlslEs300 {
        let text = text.replace(PASTE, bake).replace("${lights}", "2");
        // three.js writes the version itself.
        let version = if text.starts_with("#version") { "" } else { "#version 300 es\n" };
        return format!("{version}{text}");
    }
    format!("{bake}\n{text}")
}

/// What a shader of an example calls that is in a file beside it.
const SURROUNDINGS: &str = "ball_surroundings(";

/// The files beside a shader that define its surroundings: none of them, and those of a bake.
const SURROUNDINGS_FILES: [&str; 2] = ["no_surroundings.wgsl", "surroundings.wgsl"];

/// The shader after a file of its folder that defines its surroundings.
fn surrounded(shader: &Shader, file: &str) -> Shader {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(&shader.file).with_file_name(file);
    let text = fs::read_to_string(path).unwrap() + "\n" + &shader.text;
    Shader { file: format!("{} after {file}", shader.file), text, ..*shader }
}

/// Every shader of the examples in a language, around the text of every set of materials, with what it is.
pub(crate) fn composed(language: Target) -> Vec<(String, String)> {
    let mut shaders: Vec<Shader> = shaders().into_iter().filter(|shader| shader.language == language).collect();
    assert!(!shaders.is_empty(), "no example is in {language}");
    let mut lit = Vec::new();
    for shader in &mut shaders {
        if shader.text.contains(SURROUNDINGS) {
            lit.push(surrounded(shader, SURROUNDINGS_FILES[1]));
            *shader = surrounded(shader, SURROUNDINGS_FILES[0]);
        }
    }
    let mut texts = Vec::new();
    let mut add = |shaders: &[Shader], set: &MaterialSet<'_>, name: &str, form| {
        let bake = emit(set, form, language).unwrap();
        texts.extend(shaders.iter().map(|shader| (format!("{} {name} {form}", shader.file), paste(shader, &bake))));
    };
    for (name, materials) in sets() {
        let set = MaterialSet::new(&materials, tables());
        for form in forms(&materials) {
            add(&shaders, &set, name, form);
        }
        if let Some(set) = with_environment(&materials) {
            add(&lit, &set, name, Form::Baked);
        }
    }
    texts
}

/// The materials with the functions of an environment, where they have a prefiltered one.
fn with_environment(materials: &[MaterialEntry]) -> Option<MaterialSet<'_>> {
    let functions = [FunctionGroup::Environment].into_iter().collect();
    let set = MaterialSet { functions, ..MaterialSet::new(materials, tables()) };
    bindings(&set, Form::Baked).iter().any(|entry| entry.name == "luthier_environment_map").then_some(set)
}

#[test]
fn naga_accepts_the_wgsl_of_the_examples() {
    for (what, text) in composed(Target::Wgsl) {
        validate(&text).unwrap_or_else(|error| panic!("{what}: {error}"));
    }
}
