//! Material files.

use std::path::{Path, PathBuf};

use luthier_export::{input, label};
use luthier_material::{Diagnostic, Material, Parsed};
use rayon::prelude::*;

use super::TomlFile;
use crate::{Error, paths, refusals};

/// A material file that was read, and its material or its errors.
///
/// ```
/// use luthier::Source;
///
/// let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 20\n";
/// let source = Source::of_text("gold.toml".as_ref(), text.to_owned());
/// assert!(source.material().is_none());
/// let error = &source.diagnostics()[0];
/// assert_eq!((error.line, error.hint.as_deref()), (6, Some("20 per cent is `roughness = 0.2`")));
/// ```
#[derive(Debug, Clone)]
pub struct Source {
    /// The file, as it was named or found.
    pub label: String,
    /// Its text.
    pub text: String,
    /// The material, or why it is none.
    pub parsed: Result<Parsed, Vec<Diagnostic>>,
}

impl Source {
    /// The errors of an unusable file, or the warnings of a usable one.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match &self.parsed {
            Ok(parsed) => &parsed.warnings,
            Err(errors) => errors,
        }
    }

    /// The material; `None` where the file has errors.
    pub fn material(&self) -> Option<&Material> {
        self.parsed.as_ref().ok().map(|parsed| &parsed.material)
    }

    /// Adds diagnostics; a file with an error has no material.
    pub(crate) fn add(&mut self, found: Vec<Diagnostic>) {
        match &mut self.parsed {
            Ok(parsed) => {
                parsed.warnings.extend(found);
                parsed.warnings.sort_by_key(|d| (d.span.start, d.span.end));
                if parsed.warnings.iter().any(Diagnostic::is_error) {
                    let all = std::mem::take(&mut parsed.warnings);
                    self.parsed = Err(all.into_iter().filter(Diagnostic::is_error).collect());
                }
            }
            Err(errors) => errors.extend(found),
        }
    }

    /// Reads and validates one file.
    ///
    /// ```
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    /// let source = luthier::Source::read(&folder.path().join("chalk.toml"))?;
    /// assert_eq!(source.material().map(|material| material.name.as_str()), Some("chalk"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`], of the file itself: faults of its text are in [`Source::parsed`].
    pub fn read(path: &Path) -> Result<Self, Error> {
        Ok(Self::of(TomlFile::read(path)?))
    }

    /// Validates a file that was read.
    ///
    /// ```
    /// use luthier::{Source, TomlFile};
    ///
    /// let source = Source::of(TomlFile { path: "umber.toml".into(), bytes: b"name = \"umber\xff\"".to_vec() });
    /// assert_eq!((source.diagnostics()[0].line, source.diagnostics()[0].column), (1, 14), "no UTF-8");
    /// ```
    pub fn of(file: TomlFile) -> Self {
        let path = file.path.clone();
        match file.text() {
            Ok(text) => Self::of_text(&path, text),
            Err((text, error)) => Self { label: label(&path), text, parsed: Err(vec![error]) },
        }
    }

    /// Validates a text in the place of a file's. Files that it names are beside that file.
    pub fn of_text(path: &Path, text: String) -> Self {
        let label = label(path);
        let folder = paths::folder(path);
        let (material, mut diagnostics) =
            luthier_material::parse_partly(&label, &text, &|name| input::text(&folder.join(name)));
        let is_usable = !diagnostics.iter().any(Diagnostic::is_error);
        let parsed = match material {
            Some(material) if is_usable => Ok(Parsed { material, warnings: diagnostics }),
            // Faults of pictures are reported too, so that one run shows all there is to mend.
            Some(material) => {
                // A map that has an error already gets no second one.
                let mut of_pictures = refusals::of_pictures(&material);
                of_pictures.retain(|found| found.is_error() && diagnostics.iter().all(|d| d.span != found.span));
                diagnostics.extend(of_pictures);
                diagnostics.sort_by_key(|d| (d.span.start, d.span.end));
                Err(diagnostics)
            }
            None => Err(diagnostics),
        };
        Self { label, text, parsed }
    }
}

/// The material of a text that names no other files. `label` is the name of the text in messages and in the manifest.
///
/// ```
/// let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
/// assert_eq!(luthier::parse("gold.toml", text)?.stack.layers.len(), 1);
/// assert!(luthier::parse("gold.toml", "schema = 1").is_err());
/// # Ok::<(), luthier::Error>(())
/// ```
///
/// # Errors
/// [`Error::Refused`] with all diagnostics.
pub fn parse(label: &str, text: &str) -> Result<Material, Error> {
    match luthier_material::parse(label, text, &|_| Err(std::io::ErrorKind::NotFound.into())) {
        Ok(parsed) => Ok(parsed.material),
        Err(diagnostics) => {
            let sentence = diagnostics.iter().map(|d| d.render(text)).collect::<Vec<_>>().join("\n");
            Err(Error::Refused { sentence, diagnostics })
        }
    }
}

/// Reads files, and the `*.toml` of folders, as materials. Scenes and surfaces have errors that say what they are.
///
/// ```
/// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// # let folder = tempfile::tempdir()?;
/// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
/// let sources = luthier::read_materials(&[folder.path().to_owned()])?;
/// assert!(sources[0].diagnostics().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::File`], [`Error::NoFiles`].
pub fn read_materials(paths: &[PathBuf]) -> Result<Vec<Source>, Error> {
    let files = paths::find(paths)?;
    files.par_iter().map(|path| Source::read(path)).collect::<Vec<_>>().into_iter().collect()
}

/// The files that a material names, beside its own.
///
/// ```
/// let text = "schema = 1\nname = \"oak\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\nmaps = { albedo = \"grain.png\" }\n";
/// let oak = luthier::parse("wood/oak.toml", text)?;
/// assert_eq!(luthier::named_files(&oak).collect::<Vec<_>>(), [std::path::Path::new("wood/grain.png")]);
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn named_files(material: &Material) -> impl Iterator<Item = PathBuf> {
    material.files.iter().map(|file| paths::beside(&material.source, file))
}
