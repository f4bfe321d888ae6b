//! `fit`: fits Granier and Heidrich's model to values of a lobe, and writes a material file.

use std::fmt::Write as _;
use std::path::Path;

use luthier_layers::beam_fit::{Fitted, Form, fit, samples};
use luthier_material::DEFAULT_WAVELENGTHS_NM;
use luthier_terminal::{Failure, Outcome, deliver, print};
use serde_json::json;

use crate::cli::{FitOptions, Thicknesses};
use crate::input;

/// Fits a lobe.
pub(crate) fn run(options: &FitOptions) -> Outcome {
    let is_standard = options.lobe == Path::new("-");
    let (text, label) = input::labelled(&options.lobe)?;
    let lobe = samples(&text).map_err(|error| Failure::Input(anyhow::anyhow!("{label}{error}")))?;
    let form = Form {
        wavelengths_nm: DEFAULT_WAVELENGTHS_NM,
        thickness_nm: options.film.map(|Thicknesses(range)| range),
        leans: options.lean,
    };
    let fitted = fit(&lobe, &form).ok_or_else(|| {
        Failure::Input(anyhow::anyhow!("{label}: {} values are too few for a fit, or all are 0", lobe.len()))
    })?;
    if options.json {
        return print(&format!("{:#}", numbers(&fitted, lobe.len())));
    }
    let stem = options.lobe.file_stem().and_then(|stem| stem.to_str()).filter(|_| !is_standard).unwrap_or("lobe");
    deliver(&material(&fitted, stem, &label, lobe.len()), options.output.as_deref())
}

/// Lean of the inner boundary in degrees, and its azimuth.
fn lean([x, y]: [f64; 2]) -> [f64; 2] {
    [libm::atan(libm::hypot(x, y)).to_degrees(), libm::atan2(y, x).to_degrees()]
}

fn numbers(fitted: &Fitted, samples: usize) -> serde_json::Value {
    let [inner_tilt_deg, inner_azimuth_deg] = lean(fitted.lean);
    json!({
        "ior": fitted.index,
        "thickness_nm": fitted.thickness_nm,
        "exponents": fitted.exponents,
        "specular_weight": fitted.specular_weight,
        "diffuse": fitted.diffuse,
        "inner_tilt_deg": inner_tilt_deg,
        "inner_azimuth_deg": inner_azimuth_deg,
        "samples": samples,
        "rms_err": fitted.rms_err,
        "lobe_err": fitted.lobe_err,
    })
}

/// A material file with the numbers, six digits each.
fn material(fitted: &Fitted, stem: &str, label: &str, samples: usize) -> String {
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(100).collect();
    let label = label.replace(|c: char| c.is_control() || c == '"' || c == '\\', "-");
    let Fitted { index, thickness_nm, exponents, specular_weight, diffuse, rms_err, lobe_err, .. } = *fitted;
    let ior = format!("{{ n = {:?}, wavelengths_nm = {DEFAULT_WAVELENGTHS_NM:?} }}", index.map(short));
    let most = diffuse.iter().fold(1.0, |most: f64, d| most.max(*d));
    let mut out = format!(
        "schema = 1\nname = \"{name}\"\ndescription = \"Fitted to {samples} values of {label}: weighted error {rms_err:.4}, lobe error {lobe_err:.4}.\"\n"
    );
    if let Some(nm) = thickness_nm {
        let below = index.iter().fold(2.0, |most: f64, n| most.max(n + 0.1));
        let _ = write!(
            out,
            "\n[[layer]]\ntype = \"thin-film\"\nior = {ior}\nthickness_nm = {}\n\n[[layer]]\ntype = \"dielectric\"\n\
             ior = {}                  # the model does not see it\n",
            short(nm),
            short(below)
        );
    } else {
        let _ = write!(out, "\n[[layer]]\ntype = \"dielectric\"\nior = {ior}\n");
    }
    let albedo = diffuse.map(|d| short(d / most));
    let _ = write!(
        out,
        "exponents = {:?}\n\n[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo:?}\n\n[bake]\nmodel = \"granier-heidrich\"\n\
         color = \"three-wavelengths\"\n\n[bake.granier-heidrich]\nspecular_weight = {}\ndiffuse_weight = {}\n",
        exponents.map(short),
        short(specular_weight),
        short(most)
    );
    let [tilt, azimuth] = lean(fitted.lean);
    if tilt > 0.0 {
        let _ = writeln!(out, "inner_tilt_deg = {}\ninner_azimuth_deg = {}", short(tilt), short(azimuth));
    }
    out
}

/// A number rounded to six digits.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
