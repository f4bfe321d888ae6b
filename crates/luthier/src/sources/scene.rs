//! Scene files, with the materials that they name.

use std::path::PathBuf;

use luthier_export::{label, plain};
use luthier_material::{Diagnostic, Scene, parse_scene};

use super::{Source, TomlFile, refuse};
use crate::paths;
use crate::refusals::{of_domain, of_scene};

/// A scene file that was read, with its materials and all diagnostics.
///
/// ```
/// use luthier::{SceneSource, TomlFile};
///
/// let file = TomlFile { path: "shelf.toml".into(), bytes: b"scene = 1\nname = \"shelf\"\n".to_vec() };
/// let scene = SceneSource::of(file);
/// assert!(!scene.is_usable(), "it names no materials");
/// assert!(scene.diagnostics().all(|error| error.label == "shelf.toml"));
/// ```
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
    /// Its materials, in its order, with their refusals.
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

    /// True where the scene and its materials can be baked.
    pub fn is_usable(&self) -> bool {
        self.parsed.is_ok() && self.materials.iter().all(|source| source.parsed.is_ok())
    }

    /// Errors of the scene itself, then diagnostics of its materials.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        let own = self.parsed.as_ref().err().into_iter().flatten();
        own.chain(self.materials.iter().flat_map(Source::diagnostics))
    }
}
