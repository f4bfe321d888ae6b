//! `import`: material files from other formats.

mod page;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use luthier_export::{input, label};
use luthier_import::{Fate, ImportError, Imported, Line, Source, import, report, together};
use luthier_terminal::{Failure, Outcome, counted, deliver, files, print};
use serde_json::Value;

use crate::cli::ImportOptions;

/// Name of the file that says what became of each property.
const REPORT: &str = "import.json";

/// Imports files, and writes nothing if one of them cannot be read.
pub(crate) fn run(options: &ImportOptions) -> Outcome {
    let mut read = Vec::new();
    for path in &options.files {
        let bytes = input::mesh(path).map_err(files(path, "read"))?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let label = label(path);
        let name = path.file_name().map_or_else(|| label.clone(), |name| name.to_string_lossy().into_owned());
        let root = options.root.as_deref().unwrap_or(&folder);
        let import = import(&name, &bytes, &|beside| input::beside(root, &folder, beside));
        let import = import.map_err(|error: ImportError| {
            Failure::Input(anyhow::Error::new(error).context(path.display().to_string()))
        })?;
        read.push(Source { label, import });
    }
    let written = together(&mut read);
    let report = report(&read, luthier_export::GENERATOR);
    if let Some(html) = &options.html {
        refuse_among(html, options, &written)?;
    }
    write(options, written, &report)?;
    if let Some(html) = &options.html {
        deliver(&page::page(&read), Some(html))?;
    }
    print(&if options.json { format!("{report:#}") } else { text(options, &read) })
}

/// Writes all files; none, if one is there and may not be replaced.
fn write(options: &ImportOptions, written: BTreeMap<String, Vec<u8>>, report: &Value) -> Outcome {
    // The report comes last: it names files that are there.
    let written = written.into_iter().chain([(REPORT.to_owned(), format!("{report:#}\n").into_bytes())]);
    let places: Vec<(PathBuf, Vec<u8>)> = written.map(|(path, bytes)| (options.output.join(path), bytes)).collect();
    if let Some((there, _)) = places.iter().find(|(path, _)| !options.force && path.symlink_metadata().is_ok()) {
        return Err(Failure::Usage(anyhow::anyhow!(
            "{} is there already: choose another folder, or replace files with --force; nothing was written",
            there.display()
        )));
    }
    // All that can be seen to fail fails before the first file.
    for (path, _) in &places {
        if path.is_dir() {
            return Err(Failure::Files(anyhow::anyhow!("{} is a folder; nothing was written", path.display())));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder).map_err(files(folder, "make"))?;
    }
    for (path, bytes) in places {
        luthier_export::replace(&path, &bytes).map_err(files(&path, "write"))?;
    }
    Ok(())
}

/// Refuses a page in place of a file of the import.
fn refuse_among(html: &Path, options: &ImportOptions, written: &BTreeMap<String, Vec<u8>>) -> Outcome {
    let mut own = written.keys().map(String::as_str).chain([REPORT]);
    match own.find(|path| options.output.join(path) == html) {
        Some(path) => Err(Failure::Usage(anyhow::anyhow!(
            "{} is `{path}` of the import: give the page another name; nothing was written",
            html.display()
        ))),
        None => Ok(()),
    }
}

/// A line for each material, and one for each property that is not in its file as it was.
fn text(options: &ImportOptions, read: &[Source]) -> String {
    let mut out = String::new();
    let say = |lines: &[Line]| {
        let mut text = String::new();
        for Line { property, fate, note } in lines.iter().filter(|line| line.fate != Fate::Kept) {
            // Writing to a String does not fail.
            let _ = writeln!(text, "  {fate}: {property}{}{note}", if note.is_empty() { "" } else { ": " });
        }
        text
    };
    for Source { label, import } in read {
        let _ = writeln!(out, "{label}: {}", counted(import.materials.len(), "material"));
        out.push_str(&say(&import.lines));
        for Imported { name, source_name, lines, .. } in &import.materials {
            let source = if source_name.is_empty() { String::new() } else { format!(" (`{source_name}`)") };
            let _ =
                writeln!(out, "{}{source}: {}", options.output.join(format!("{name}.toml")).display(), counts(lines));
            out.push_str(&say(lines));
        }
    }
    out
}

/// How many properties have each fate.
fn counts<'a>(lines: impl IntoIterator<Item = &'a Line>) -> String {
    let mut counts = [0; Fate::ALL.len()];
    lines.into_iter().for_each(|line| counts[line.fate as usize] += 1);
    let counts = Fate::ALL.iter().zip(counts).filter(|(_, count)| *count > 0);
    counts.map(|(fate, count)| format!("{count} {fate}")).collect::<Vec<_>>().join(", ")
}
