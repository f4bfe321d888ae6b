//! `eval --model fluorescence` with a re-radiation matrix.

use std::f64::consts::PI;

use luthier_workshop::material_texts::{gold, smooth_coat};

use crate::workshop::Workshop;

/// Synthetic: a dye that takes green light and gives orange.
const DYE: &str = "# share of the power, by wavelength of the light (columns)\nnm,530,600\n530,0.1,0\n600,0.7,0.2\n";

fn workshop() -> Workshop {
    Workshop::with(&[("c.toml", &smooth_coat("c")), ("g.toml", &gold("g")), ("dye.csv", DYE)])
}

const GREEN_TO_ORANGE: [&str; 6] = ["--matrix", "dye.csv", "--excitation", "530", "--wavelength", "600"];

fn eval(workshop: &Workshop, more: &[&str]) -> f64 {
    let args = ["eval", "c.toml", "--model", "fluorescence", "--wi", "0,0", "--wo", "60,0", "--json"];
    let json = workshop.run(&[&args, more].concat()).exits(0).json();
    json["values"][0]["value"][0].as_f64().unwrap()
}

/// Values by hand: a smooth coat of 1.5 holds R = 0.5963457597 of diffuse light back. Green stays green after 1/(1 - 0.1 R) bounces; orange
/// comes of it after 0.7/((1 - 0.1 R)(1 - 0.2 R)). Off the mirror direction, T(0) = 0.96 and T(60) = 1 - 0.0891867128 pass, and radiance
/// spreads by 1/2.25.
#[test]
fn light_of_one_wavelength_seen_at_another() {
    let workshop = workshop();
    let held = 0.5963457597;
    let across = 0.96 * (1.0 - 0.0891867128) / (2.25 * PI);
    let expected = across * 0.7 / ((1.0 - 0.1 * held) * (1.0 - 0.2 * held));
    let found = eval(&workshop, &GREEN_TO_ORANGE);
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    let back = eval(&workshop, &["--matrix", "dye.csv", "--excitation", "600", "--wavelength", "530"]);
    assert_eq!(back, 0.0);
    // The nearest bins are taken, and named.
    let args = ["eval", "c.toml", "--model", "fluorescence", "--matrix", "dye.csv", "--excitation", "540"];
    let json = workshop.run(&[&args[..], &["--wavelength", "590", "--albedo", "--json"]].concat()).exits(0).json();
    assert_eq!((json["excitation_nm"].as_f64(), json["wavelength_nm"].as_f64()), (Some(530.0), Some(600.0)));
    let args = ["eval", "c.toml", "--model", "fluorescence", "--wi", "0,0", "--wo", "60,0", "--json"];
    let json = workshop.run(&[&args[..], &GREEN_TO_ORANGE].concat()).exits(0).json();
    assert_eq!(json["color"], serde_json::json!({"excitation_nm": 530.0, "wavelength_nm": 600.0}));
}

/// A matrix without anything off its diagonal is the model without a matrix.
#[test]
fn a_diagonal_matrix_is_ordinary_reflection() {
    let workshop = workshop();
    workshop.write("grey.csv", "nm,500,600\n500,0.8,0\n600,0,0.8\n");
    let with = eval(&workshop, &["--matrix", "grey.csv", "--excitation", "600", "--wavelength", "600"]);
    assert!((with / eval(&workshop, &["--wavelength", "600"]) - 1.0).abs() < 1e-12);
}

#[test]
fn matrices_and_materials_that_do_not_serve() {
    let workshop = workshop();
    let run = |file: &str, model: &str, more: &[&str]| {
        workshop.run(&[&["eval", file, "--model", model, "--albedo"], more].concat())
    };
    run("g.toml", "fluorescence", &GREEN_TO_ORANGE).fails(1, &["not a single transparent coat over a diffuse base"]);
    run("c.toml", "elek", &GREEN_TO_ORANGE).fails(2, &["`elek` does not take --matrix", "fluorescence"]);
    run("c.toml", "fluorescence", &["--matrix", "dye.csv"]).fails(2, &["required"]);
    run("c.toml", "fluorescence", &["--excitation", "530", "--wavelength", "600"]).fails(2, &["required"]);
    run("c.toml", "fluorescence", &["--matrix", "dye.csv", "--excitation", "530"]).fails(2, &["required"]);
    let far = ["--matrix", "dye.csv", "--excitation", "400", "--wavelength", "600"];
    run("c.toml", "fluorescence", &far).fails(2, &["530 to 600 nm", "400 nm"]);
    let missing = ["--matrix", "no.csv", "--excitation", "530", "--wavelength", "600"];
    run("c.toml", "fluorescence", &missing).fails(3, &["no.csv"]);
    for (text, part) in [
        ("nm,530,600\n530,0.1,0\n", "dye.csv: expected 2 rows"),
        ("nm,530,600\n530,0.1,0\n600,0.7\n", "dye.csv:3: expected 2 shares after the wavelength, found 1"),
        ("nm,530,600\n530,0.5,0\n600,0.7,0\n", "dye.csv:1: 1.2 of the power of the light at 530 nm comes out"),
        ("nm,530,600\n530,-0.5,0\n600,0.7,0\n", "dye.csv:2: the share -0.5 of the light at 530 nm is negative"),
    ] {
        workshop.write("dye.csv", text);
        run("c.toml", "fluorescence", &GREEN_TO_ORANGE).fails(1, &[part]);
    }
}
