//! Lines of a build script to Cargo, and faults for people.

use luthier::{Diagnostic, Error, SceneSource, Severity, Source, Sources, SurfaceSource};

/// The answer of a build: lines for Cargo on standard output, faults with the lines of their files for people on standard error.
///
/// ```
/// let out = tempfile::tempdir()?;
/// std::fs::write(out.path().join("chalk.toml"), "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 80\n")?;
///
/// let told = luthier_build::Build::of([out.path().join("chalk.toml")]).in_folder(out.path());
/// assert!(!told.is_baked && told.faults.contains("albedo = 80"));
/// let error = told.lines.iter().find(|line| line.starts_with("cargo::error=")).unwrap();
/// assert!(error.contains("chalk.toml:5:10: error: "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Told {
    /// Lines for Cargo, each a `cargo::` instruction.
    pub lines: Vec<String>,
    /// The errors with the lines of the files that they are about; empty where all is well.
    pub faults: String,
    /// True where the package and the module are written.
    pub is_baked: bool,
}

impl Told {
    pub(crate) fn line(&mut self, instruction: &str, text: &str) {
        // An instruction ends with its line.
        self.lines.push(format!("cargo::{instruction}={}", text.replace('\n', " ")));
    }

    pub(crate) fn diagnostics<'d>(&mut self, found: impl IntoIterator<Item = &'d Diagnostic>, sources: &Sources) {
        for diagnostic in found {
            self.line(instruction(diagnostic.severity), &diagnostic.to_string());
            if diagnostic.is_error() {
                self.faults.push_str(&diagnostic.render(text(sources, &diagnostic.label)));
                self.faults.push('\n');
            }
        }
    }

    pub(crate) fn error(&mut self, error: &Error, sources: &Sources) {
        self.diagnostics(error.diagnostics(), sources);
        if !error.diagnostics().iter().any(Diagnostic::is_error) {
            self.fault(&error.to_string());
        }
    }

    pub(crate) fn fault(&mut self, sentence: &str) {
        self.line("error", sentence);
        self.faults.push_str(sentence);
        self.faults.push('\n');
    }
}

fn instruction(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

/// The text of a file of sources, by its label.
fn text<'s>(sources: &'s Sources, label: &str) -> &'s str {
    let of_material = |source: &'s Source| (source.label.as_str(), source.text.as_str());
    let of_surface = |source: &'s SurfaceSource| (source.label.as_str(), source.text.as_str());
    let of_scene = |source: &'s SceneSource| (source.label.as_str(), source.text.as_str());
    let materials = sources.scenes.iter().flat_map(|scene| &scene.materials).chain(&sources.materials).map(of_material);
    let mut all = materials.chain(sources.surfaces.iter().map(of_surface)).chain(sources.scenes.iter().map(of_scene));
    all.find(|(known, _)| *known == label).map_or("", |(_, text)| text)
}
