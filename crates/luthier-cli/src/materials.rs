//! Material files on disk.

use std::collections::BTreeSet;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};
use std::string::FromUtf8Error;

use luthier_lut::{Image, TableKind};
use luthier_material::{Diagnostic, Material, Parsed, Severity, parse};

use crate::cli::Shading;
use crate::doubts;
use crate::failure::{Broken, Failure, Outcome, files};
use crate::input;
use crate::output::{complain, has_colour};
use crate::refusals;

/// A file that was read, and what became of it.
pub(crate) struct Source {
    /// The file, as it was named or found.
    pub(crate) label: String,
    pub(crate) text: String,
    /// The material, or why it is none.
    pub(crate) parsed: Result<Parsed, Vec<Diagnostic>>,
}

impl Source {
    /// Errors or warnings, whichever there are.
    pub(crate) fn diagnostics(&self) -> &[Diagnostic] {
        match &self.parsed {
            Ok(parsed) => &parsed.warnings,
            Err(errors) => errors,
        }
    }

    /// Prints all diagnostics to standard error.
    pub(crate) fn print_diagnostics(&self) {
        print_diagnostics(self.diagnostics(), &self.text);
    }
}

/// Prints diagnostics of a text to standard error.
pub(crate) fn print_diagnostics<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>, text: &str) {
    let colour = has_colour();
    for diagnostic in diagnostics {
        let rendered = if colour { diagnostic.render_coloured(text) } else { diagnostic.render(text) };
        complain(&format!("{rendered}\n"));
    }
}

/// Reads files, and the `*.toml` of folders, each once, in the order given and by name within a folder.
pub(crate) fn read(paths: &[PathBuf]) -> Outcome<Vec<Source>> {
    find(paths)?.iter().map(|path| read_one(path)).collect()
}

/// The files that [`read`] reads.
pub(crate) fn find(paths: &[PathBuf]) -> Outcome<Vec<PathBuf>> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for path in paths {
        let here = if path.is_dir() { toml_files(path)? } else { vec![path.clone()] };
        if here.is_empty() {
            return Err(Failure::Input(anyhow::anyhow!("no *.toml in the folder {}", path.display())));
        }
        found.extend(here.into_iter().filter(|p| seen.insert(p.canonicalize().unwrap_or_else(|_| p.clone()))));
    }
    Ok(found)
}

/// Reads and validates one file.
pub(crate) fn read_one(path: &Path) -> Outcome<Source> {
    let bytes = input::bytes(path).map_err(files(path, "read"))?;
    let label = label(path);
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(source) => return Ok(not_utf8(label, &source)),
    };
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let parsed = parse(&label, &text, &|name| input::text(&folder.join(name)));
    Ok(Source { label, text, parsed })
}

/// A file of other bytes than text: they are shown as replacement characters.
fn not_utf8(label: String, source: &FromUtf8Error) -> Source {
    let start = source.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(source.as_bytes()).into_owned();
    let before = &text[..start];
    let diagnostic = Diagnostic {
        severity: Severity::Error,
        label: label.clone(),
        line: before.matches('\n').count() + 1,
        column: before.chars().rev().take_while(|&c| c != '\n').count() + 1,
        span: start..start + char::REPLACEMENT_CHARACTER.len_utf8(),
        message: "the file is not UTF-8".to_owned(),
        hint: Some("save it as UTF-8".to_owned()),
        count: 1,
    };
    Source { label, text, parsed: Err(vec![diagnostic]) }
}

/// The materials of all files; or, when any is invalid, its diagnostics and a failure.
pub(crate) fn valid(sources: Vec<Source>, quiet: bool) -> Outcome<Vec<Material>> {
    let broken = sources.iter().filter(|s| s.parsed.is_err()).count();
    if broken > 0 {
        let broken_sources = || sources.iter().filter(|s| s.parsed.is_err());
        broken_sources().for_each(Source::print_diagnostics);
        let sentence = format!("{broken} of {} material files cannot be used; nothing was written", sources.len());
        let diagnostics = broken_sources().flat_map(Source::diagnostics).cloned().collect();
        return Err(Failure::input(Broken { sentence, diagnostics }));
    }
    if !quiet {
        for source in &sources {
            source.print_diagnostics();
        }
    }
    Ok(sources.into_iter().filter_map(|s| s.parsed.ok()).map(|parsed| parsed.material).collect())
}

/// The materials that can be baked, shaded by the model that the command line asks for; or, when anything is refused, its diagnostics
/// and a failure.
pub(crate) fn bakeable(mut sources: Vec<Source>, shading: &Shading, quiet: bool) -> Outcome<Vec<Material>> {
    refusals::find(&mut sources, |material| doubts::of_model(material, shading.model));
    Ok(shaded(valid(sources, quiet)?, shading))
}

/// The materials, shaded by the model that the command line asks for, with its tables.
pub(crate) fn shaded(mut materials: Vec<Material>, shading: &Shading) -> Vec<Material> {
    if shading.model.is_some() {
        materials.iter_mut().for_each(|material| material.bake.model = shading.model);
    }
    with_tables(materials, &shading.tables)
}

/// The materials, each asking for some kinds of tables beside its own.
pub(crate) fn with_tables(mut materials: Vec<Material>, tables: &[TableKind]) -> Vec<Material> {
    materials.iter_mut().for_each(|material| material.bake.tables.extend(tables));
    materials
}

/// Reads an image that a material names, relative to the material's file.
pub(crate) fn read_image(material: &str, path: &str) -> Result<Image, String> {
    let bytes = input::image(&beside(material, path)).map_err(|source| source.to_string())?;
    luthier_texture::png::decode_gray(&bytes).map_err(|source| source.to_string())
}

/// The path of a file that a material names.
pub(crate) fn beside(material: &str, path: &str) -> PathBuf {
    Path::new(material).parent().unwrap_or(Path::new("")).join(path)
}

/// A path as messages and manifests have it: with forward slashes everywhere.
pub(crate) fn label(path: &Path) -> String {
    path.to_string_lossy().replace(MAIN_SEPARATOR, "/")
}

fn toml_files(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(files(folder, "list"))? {
        let path = entry.map_err(files(folder, "list"))?.path();
        if path.extension().is_some_and(|e| e == "toml") && path.is_file() {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
