//! The manifest of the figures of a folder, and the page about them.

use std::fmt::Write;
use std::io::ErrorKind;
use std::path::Path;

use luthier_export::GENERATOR;
use luthier_terminal::{Failure, Outcome, files};
use serde_json::{Value, json};

use super::Done;
use super::figure::{Figure, Measured};
use crate::cli::{FiguresOptions, PATHS};

/// Version of the manifest.
const SCHEMA: u64 = 3;

/// The manifest.
pub(crate) fn json(made: &[Done]) -> Value {
    let figures = made.iter().map(|Done { figure, size, adapter, command, files, measured, verdict }| {
        let measured: Vec<Value> = measured.iter().map(|m| json!({"what": m.what, "value": m.value})).collect();
        json!({
            "name": figure.name,
            "title": figure.title,
            "source": figure.source,
            "caption": figure.caption,
            "seen": figure.seen,
            "must_show": figure.claim.text,
            "shows": verdict.holds,
            "because": verdict.because,
            "size": size,
            "adapter": adapter,
            "files": files,
            "measured": measured,
            "command": command,
        })
    });
    json!({
        "schema": SCHEMA,
        "generator": GENERATOR,
        "figures": figures.collect::<Vec<Value>>(),
    })
}

/// The manifest of an earlier run; `None` if there is none of this version.
pub(crate) fn read(path: &Path) -> Outcome<Option<Value>> {
    let text = match std::fs::read_to_string(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        text => text.map_err(files(path, "read"))?,
    };
    let manifest: Value = serde_json::from_str(&text).map_err(Failure::input)?;
    Ok(Some(manifest).filter(|manifest| manifest["schema"] == SCHEMA))
}

/// A figure as an earlier run made it; `None` where it did not.
pub(crate) fn kept<'a>(figure: &'a Figure, old: &Value) -> Outcome<Option<Done<'a>>> {
    let entries = old["figures"].as_array().into_iter().flatten();
    let Some(entry) = entries.into_iter().find(|entry| entry["name"] == figure.name) else { return Ok(None) };
    let [files, measured] = ["files", "measured"].map(|key| entry[key].as_array().into_iter().flatten());
    let files = files.filter_map(Value::as_str).map(str::to_owned).collect();
    let measured = measured.filter_map(|measured| {
        Some(Measured { what: measured["what"].as_str()?.to_owned(), value: measured["value"].as_f64()? })
    });
    let size = entry["size"].as_u64().unwrap_or(0) as u32;
    let command = entry["command"].as_str().unwrap_or_default().to_owned();
    let adapter = entry["adapter"].as_str().map(str::to_owned);
    Done::new(figure, size, adapter, command, files, measured.collect()).map(Some)
}

/// The page; its links begin at the folder above the pictures.
pub(crate) fn markdown(options: &FiguresOptions, made: &[Done]) -> String {
    let folder = options.output.file_name().unwrap_or_default().to_string_lossy();
    let mut page = format!(
        "# The papers' figures, made anew\n\nMade by `luthier-lab figures`. Each figure was published in a paper on layered materials; luthier renders it again \
         from the paper's parameters. {} of {} figures show what they must: *must show* has the statement, and the numbers that decide. *By eye* is the judgement of the \
         pictures beside the paper's caption. The other numbers of a figure, the command that makes it and the adapter are below its text. Pictures of shaders have 4 samples to a pixel, and a simulation takes {PATHS} paths per pixel and \
         light, unless the command says otherwise. The tone curve keeps values up to 0.8 and bends larger ones towards 1. RMSE compares \
         linear radiance over all pixels and channels. FLIP compares pictures as a display shows them at 67 pixels per degree. Where a paper does not state a \
         parameter, and for the light and the shapes, the values are luthier's own.\n",
        made.iter().filter(|done| done.verdict.holds).count(),
        made.len(),
    );
    for Done { figure, size, adapter, command, files, measured, verdict } in made {
        let _ = write!(page, "\n## {}: {}\n\n*{}*\n\n", figure.name, figure.title, figure.source);
        for file in files {
            let _ = writeln!(page, "![{}]({folder}/{file})\n", figure.title);
        }
        let verb = if verdict.holds { "It shows this" } else { "**It does not show this**" };
        let _ = writeln!(page, "*Must show:* {} {verb}: {}.\n", figure.claim.text, verdict.because.join("; "));
        let _ = writeln!(page, "*By eye:* {}\n", figure.seen);
        let _ = writeln!(page, "{}\n", figure.caption);
        let adapter = adapter.as_deref().unwrap_or("no adapter");
        let _ = writeln!(page, "| `{command}` | {size} pixels a picture, {adapter} |\n|---|---|");
        for measured in measured {
            let _ = writeln!(page, "| {} | {} |", measured.what, number(measured.value));
        }
    }
    page
}

/// Three significant digits.
pub(crate) fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..10.0 => format!("{value:.3}"),
        10.0..1e4 => format!("{value:.1}"),
        _ => format!("{value:.2e}"),
    }
}

/// The command line of a figure.
pub(crate) fn command(options: &FiguresOptions, name: &str) -> String {
    let mut words = vec![format!("luthier-lab figures {name}")];
    if options.output != Path::new("out/figures") {
        words.push(format!("-o {}", options.output.display()));
    }
    if let Some(size) = options.size {
        words.push(format!("--size {size}"));
    }
    let numbers = [("samples", options.samples, 2), ("paths", options.paths, PATHS)];
    let changed = numbers.into_iter().filter(|(_, value, default)| value != default);
    words.extend(changed.map(|(option, value, _)| format!("--{option} {value}")));
    words.join(" ")
}
