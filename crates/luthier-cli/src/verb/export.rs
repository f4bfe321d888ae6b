//! `export`: materials as parameters of other formats.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use luthier_export::{GENERATOR, input, publish};
use luthier_formats::{Exported, Fate, Format, Line, Numbers, Residual, Settings, exported, files};
use luthier_terminal::{Bar, Failure, Outcome, counted, print, valid};
use serde_json::{Value, json};

use crate::cli::ExportOptions;
use crate::interrupt::whole;

/// Name of the file that says what became of each property.
const REPORT: &str = "export.json";

/// Exports materials, and writes nothing if one of them cannot be read.
pub(crate) fn run(options: &ExportOptions) -> Outcome {
    let mut sources = luthier::read_materials(&options.files).map_err(Failure::from)?;
    luthier::refuse(&mut sources, |_| Vec::new());
    let materials = valid(sources, options.json)?;
    let settings = Settings { noise: options.noise, ..Settings::usual() };
    let bar = Bar::new("fitting materials");
    let made = materials.iter().zip(0..).map(|(material, number)| {
        bar.set(number, materials.len() as u64);
        let folder = Path::new(&material.source).parent().unwrap_or(Path::new("")).to_owned();
        exported(material, options.to, &settings, &|name| input::image(&folder.join(name)))
    });
    let made: Vec<Exported> = made.collect();
    drop(bar);
    let report = report(options.to, &made);
    let mut written = files(options.to, &made, GENERATOR).map_err(Failure::input)?;
    written.insert(REPORT.to_owned(), format!("{report:#}\n").into_bytes());
    if let Some(folder) = &options.output {
        write(folder, &written, options.force)?;
    }
    print(&if options.json { format!("{report:#}") } else { text(options, &made) })
}

/// Writes all files; none, if one is there and may not be replaced.
fn write(folder: &Path, written: &BTreeMap<String, Vec<u8>>, force: bool) -> Outcome {
    let mut places = written.keys().map(|path| folder.join(path));
    if let Some(there) = places.find(|path| !force && path.symlink_metadata().is_ok()) {
        return Err(Failure::Usage(anyhow::anyhow!(
            "{} is there already: choose another folder, or replace files with --force; nothing was written",
            there.display()
        )));
    }
    let listed: Vec<(&str, &[u8])> = written.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
    whole(folder, || publish(folder, &listed))?;
    Ok(())
}

/// All that is known of the materials.
fn report(format: Format, made: &[Exported]) -> Value {
    let line =
        |Line { property, fate, note }: &Line| json!({ "property": property, "fate": fate.name(), "note": note });
    let residual = |at: &Residual| {
        json!({
            "theta_deg": at.theta_deg, "albedo": at.albedo, "albedo_layers": at.expected, "albedo_std_err": at.std_err,
            "lobe_err": at.lobe, "lobe_floor": at.lobe_floor,
        })
    };
    let material = |of: &Exported| {
        json!({
            "name": of.name,
            "numbers": numbers(&of.numbers),
            "fitted": of.fitted,
            "textures": of.textures.len(),
            "max_albedo_err": of.albedo_error(),
            "max_lobe_err": of.lobe_error(),
            "lobe_floor": of.lobe_floor(),
            "views": of.residuals.iter().map(residual).collect::<Vec<_>>(),
            "properties": of.lines.iter().map(line).collect::<Vec<_>>(),
        })
    };
    json!({ "generator": GENERATOR, "format": format.name(), "materials": made.iter().map(material).collect::<Vec<_>>() })
}

/// Numbers by the words that formats share.
fn numbers(of: &Numbers) -> Value {
    json!({
        "base_color": of.base_color, "metallic": of.metallic, "diffuse_roughness": of.diffuse_roughness,
        "specular": of.specular, "specular_color": of.specular_color, "ior": of.ior,
        "roughness": of.roughness, "anisotropy": of.anisotropy, "rotation_deg": of.turn.to_degrees(),
        "coat": of.coat.as_ref().map(|coat| json!({
            "weight": coat.weight, "color": coat.color, "roughness": coat.roughness, "anisotropy": coat.anisotropy,
            "rotation_deg": coat.turn.to_degrees(), "ior": coat.ior, "darkens": coat.darkens,
        })),
        "film": of.film.as_ref().map(|film| json!({
            "weight": film.weight, "ior": film.ior, "thickness_nm": film.thickness_nm,
        })),
    })
}

/// A paragraph for each material: its numbers, what remains, and a line for each property that is not simply kept.
fn text(options: &ExportOptions, made: &[Exported]) -> String {
    let mut out = String::new();
    // Writing to a String does not fail.
    if let Some(folder) = &options.output {
        let path = folder.join(options.to.file_name());
        let _ = writeln!(out, "{}: {}", path.display(), counted(made.len(), "material"));
    }
    for material in made {
        let _ = writeln!(out, "{}: {}", material.name, words(&material.numbers));
        let fitted = if material.fitted > 0 { counted(material.fitted, "number") + " fitted, " } else { String::new() };
        let _ = writeln!(
            out,
            "  {fitted}albedo off by {:.3} at most, lobe by {:.3} (noise {:.3})",
            material.albedo_error(),
            material.lobe_error(),
            material.lobe_floor()
        );
        for Line { property, fate, note } in material.lines.iter().filter(|line| line.fate != Fate::Kept) {
            let _ = writeln!(out, "  {fate}: {property}{}{note}", if note.is_empty() { "" } else { ": " });
        }
    }
    out
}

fn color(rgb: [f64; 3]) -> String {
    format!("({})", rgb.map(|c| format!("{c:.4}")).join(" "))
}

/// Numbers in a line, without those that say nothing.
fn words(of: &Numbers) -> String {
    let mut words = vec![format!("colour {}", color(of.base_color)), format!("metallic {:.3}", of.metallic)];
    let mut add = |name: &str, value: f64, plain: f64| {
        if (value - plain).abs() > 1e-9 {
            words.push(format!("{name} {value:.4}"));
        }
    };
    add("diffuse roughness", of.diffuse_roughness, 0.0);
    add("roughness", of.roughness, -1.0);
    add("anisotropy", of.anisotropy, 0.0);
    add("turned by degrees", of.turn.to_degrees(), 0.0);
    add("index", of.ior, if of.metallic < 1.0 { -1.0 } else { 1.5 });
    add("specular", of.specular, 1.0);
    if of.specular_color != [1.0; 3] {
        words.push(format!("specular colour {}", color(of.specular_color)));
    }
    if let Some(coat) = &of.coat {
        let tint = if coat.color == [1.0; 3] { String::new() } else { format!(" colour {}", color(coat.color)) };
        words.push(format!("coat {:.3} index {:.4} roughness {:.4}{tint}", coat.weight, coat.ior, coat.roughness));
    }
    if let Some(film) = &of.film {
        let [least, most] = film.thickness_nm;
        words.push(format!("film {:.3} index {:.4} of {least:.0} to {most:.0} nm", film.weight, film.ior));
    }
    words.join(", ")
}
