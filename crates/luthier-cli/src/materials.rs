//! Material files on disk.

use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use luthier_lut::Image;
use luthier_material::{Diagnostic, Material, Parsed, parse};

use crate::failure::{Failure, Outcome, files};

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
        let colour = std::io::stderr().is_terminal();
        for diagnostic in self.diagnostics() {
            let text = if colour { diagnostic.render_coloured(&self.text) } else { diagnostic.render(&self.text) };
            eprintln!("{text}\n");
        }
    }
}

/// Reads files, and the `*.toml` of folders, each once, in the order given and by name within a folder.
pub(crate) fn read(paths: &[PathBuf]) -> Outcome<Vec<Source>> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for path in paths {
        let here = if path.is_dir() { toml_files(path)? } else { vec![path.clone()] };
        if here.is_empty() {
            return Err(Failure::Input(anyhow::anyhow!("no *.toml in the folder {}", path.display())));
        }
        found.extend(here.into_iter().filter(|p| seen.insert(p.clone())));
    }
    found.iter().map(|path| read_one(path)).collect()
}

/// Reads and validates one file.
pub(crate) fn read_one(path: &Path) -> Outcome<Source> {
    let bytes = std::fs::read(path).map_err(files(path, "read"))?;
    let label = label(path);
    let text = String::from_utf8(bytes).map_err(|source| {
        let line = source.as_bytes()[..source.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        Failure::Input(anyhow::anyhow!("{label}:{line}: the file is not UTF-8; save it as UTF-8"))
    })?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let parsed = parse(&label, &text, &|name| std::fs::read_to_string(folder.join(name)));
    Ok(Source { label, text, parsed })
}

/// The materials of all files; or, when any is invalid, all diagnostics and a failure.
pub(crate) fn valid(sources: Vec<Source>) -> Outcome<Vec<Material>> {
    let broken = sources.iter().filter(|s| s.parsed.is_err()).count();
    if broken > 0 {
        for source in sources.iter().filter(|s| s.parsed.is_err()) {
            source.print_diagnostics();
        }
        let total = sources.len();
        return Err(Failure::Input(anyhow::anyhow!(
            "{broken} of {total} material files cannot be used; nothing was written"
        )));
    }
    for source in &sources {
        source.print_diagnostics();
    }
    Ok(sources.into_iter().filter_map(|s| s.parsed.ok()).map(|parsed| parsed.material).collect())
}

/// Reads an image that a material names, relative to the material's file.
pub(crate) fn read_image(material: &str, path: &str) -> Result<Image, String> {
    let path = Path::new(material).parent().unwrap_or(Path::new("")).join(path);
    let bytes = std::fs::read(&path).map_err(|source| source.to_string())?;
    luthier_texture::png::decode_gray(&bytes).map_err(|source| source.to_string())
}

/// A path as messages and manifests have it: with forward slashes everywhere.
fn label(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
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
