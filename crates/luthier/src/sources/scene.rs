//! Scene files, with the materials that they name.

use std::path::PathBuf;

use luthier_export::{label, plain};
use luthier_material::{Diagnostic, Scene, parse_scene};

use super::{Source, TomlFile, refuse};
use crate::paths;
use crate::refusals::{of_domain, of_scene};

/// A scene file that was read, with all that can be known before work begins.
#[derive(Debug, Clone)]
pub struct SceneSource {
    /// The file.
    pub path: PathBuf,
    /// The file, as it was named or found.
    pub label: String,
    /// Its text.
    pub text: String,
    /// The scene, or why it is none.
    pub parsed: Result<Scene, Vec<Diagnostic>>,
    /// Its materials, in its order, with what is refused of them.
    pub materials: Vec<Source>,
}

impl SceneSource {
    /// Parses a scene, and reads its materials.
    pub fn of(file: TomlFile) -> Self {
        let TomlFile { path, bytes } = file;
        let (label, text) = (label(&path), String::from_utf8_lossy(&bytes).into_owned());
        let mut parsed = parse_scene(&label, &text);
        let mut materials = Vec::new();
        if let Ok(scene) = &parsed {
            let mut missing = Vec::new();
            for named in &scene.materials {
                match Source::read(&plain(&paths::folder(&path).join(&named.file))) {
                    Ok(source) => materials.push(source),
                    Err(error) => missing.push(scene.diagnostic(named, error.to_string())),
                }
            }
            if missing.is_empty() {
                refuse(&mut materials, |material| [of_domain(material, None), of_scene(material)].concat());
            } else {
                parsed = Err(missing);
            }
        }
        Self { path, label, text, parsed, materials }
    }

    /// Whether it can be baked.
    pub fn is_usable(&self) -> bool {
        self.parsed.is_ok() && self.materials.iter().all(|source| source.parsed.is_ok())
    }

    /// Errors of the scene itself, then diagnostics of its materials.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        let own = self.parsed.as_ref().err().into_iter().flatten();
        own.chain(self.materials.iter().flat_map(Source::diagnostics))
    }
}
