//! Texts about figures.

use std::fmt::Write;
use std::path::Path;

use luthier_export::GENERATOR;
use serde_json::{Value, json};

use super::figure::{Figure, Made};
use super::studio::Studio;
use crate::cli::FiguresOptions;

/// The manifest.
pub(crate) fn json(options: &FiguresOptions, studio: &Studio, made: &[(&Figure, Made)]) -> Value {
    let entry = |(figure, made): &(&Figure, Made)| {
        let files: Vec<&str> = made.files.iter().map(|(file, _)| file.as_str()).collect();
        let measured: Vec<Value> = made.measured.iter().map(|m| json!({"what": m.what, "value": m.value})).collect();
        json!({
            "name": figure.name,
            "title": figure.title,
            "source": figure.source,
            "caption": figure.caption,
            "files": files,
            "measured": measured,
            "command": command(options, Some(figure.name)),
        })
    };
    json!({
        "schema": 1,
        "generator": GENERATOR,
        "adapter": studio.adapter_name(),
        "size": options.size,
        "samples": options.samples,
        "paths": options.paths,
        "figures": made.iter().map(entry).collect::<Vec<Value>>(),
    })
}

/// The page; its links begin at the folder above the pictures.
pub(crate) fn markdown(options: &FiguresOptions, studio: &Studio, made: &[(&Figure, Made)]) -> String {
    let folder = options.output.file_name().unwrap_or_default().to_string_lossy();
    let mut page = format!(
        "# The papers' figures, made anew\n\nMade by `{}`. Each figure was published in a paper on layered materials; luthier \
         renders it again from the paper's parameters. A single picture is {} pixels wide, with {} samples to a pixel. A \
         simulation takes {} paths per pixel, light and channel. Adapter: {}. The tone curve keeps values up to 0.8 and bends larger \
         ones towards 1. RMSE compares linear radiance over all pixels and channels. FLIP compares pictures as a display shows \
         them at 67 pixels per degree. Where a paper does not state a parameter, and for the light and the shapes, the values are luthier's own.\n",
        command(options, None),
        options.size,
        options.samples * options.samples,
        options.paths,
        studio.adapter_name().unwrap_or_else(|| "none was needed".to_owned()),
    );
    for (figure, made) in made {
        let _ = write!(page, "\n## {}: {}\n\n*{}*\n\n", figure.name, figure.title, figure.source);
        for (file, _) in &made.files {
            let _ = writeln!(page, "![{}]({folder}/{file})\n", figure.title);
        }
        let _ = writeln!(page, "{}\n", figure.caption);
        if !made.measured.is_empty() {
            page.push_str("| measured | |\n|---|---|\n");
        }
        for measured in &made.measured {
            let _ = writeln!(page, "| {} | {} |", measured.what, number(measured.value));
        }
    }
    page
}

/// Three significant digits.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..10.0 => format!("{value:.3}"),
        10.0..1e4 => format!("{value:.1}"),
        _ => format!("{value:.2e}"),
    }
}

/// The command line of a figure, or of the page.
fn command(options: &FiguresOptions, name: Option<&str>) -> String {
    let mut words = vec!["luthier-lab figures".to_owned()];
    match name {
        Some(name) => words.push(name.to_owned()),
        None => words.extend(options.names.iter().cloned()),
    }
    if options.output != Path::new("out/figures") {
        words.push(format!("-o {}", options.output.display()));
    }
    let numbers = [
        ("size", u64::from(options.size), 128),
        ("samples", u64::from(options.samples), 2),
        ("paths", options.paths, 128),
    ];
    let changed = numbers.into_iter().filter(|(_, value, default)| value != default);
    words.extend(changed.map(|(option, value, _)| format!("--{option} {value}")));
    words.join(" ")
}
