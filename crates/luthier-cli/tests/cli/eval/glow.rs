//! Fluorescent bases from file to pixel: check, bake, manifest, shader on the device against the f64 twin, picture.

use glam::DVec3;
use luthier::{Bake, MemoryStore};
use luthier_export::Shader;
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_manifest::{Form, FunctionGroup, ShadingModel};
use luthier_material::{Material, parse};
use luthier_optics::Rgb;
use luthier_optics::color::Color;

use super::twin::gpu;
use crate::workshop::Workshop;

/// Largest difference of device and twin, relative to the larger of the value and a tenth of a white Lambert surface's BRDF.
const TOLERANCE: f64 = 2e-5;
const FLOOR: f64 = 0.1 * std::f64::consts::FRAC_1_PI;

/// A dye that takes light below 570 nm and sends two thirds of it out from 580 to 640 nm, in bins of 20 nm.
fn dye() -> String {
    let nm: Vec<f64> = (0..19).map(|i| 370.0 + 20.0 * f64::from(i)).collect();
    let row = |values: &dyn Fn(f64) -> f64| nm.iter().map(|&nm| format!(",{:.4}", values(nm))).collect::<String>();
    let mut text = format!("nm{}\n", row(&|nm| nm));
    for &to in &nm {
        let share = |from: f64| match (from < 570.0, to == from) {
            (true, true) => 0.1,
            (true, false) if to > 580.0 && to < 640.0 => 0.6 / 3.0,
            (false, true) => 0.85,
            _ => 0.0,
        };
        text += &format!("{to}{}\n", row(&share));
    }
    text
}

fn file(model: &str, coat: &str) -> String {
    format!(
        "schema = 1\nname = \"dye\"\n{coat}[[layer]]\ntype = \"diffuse\"\nreradiation = \"dye.csv\"\n[bake]\nmodel = \"{model}\"\n"
    )
}

const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\nthickness_um = 10\nabsorption_per_um = [0.01, 0.03, 0.08]\n";

fn material(model: &str, coat: &str) -> Material {
    parsed("dye.toml", model, coat)
}

/// The material of a file of this name, beside which lies the matrix.
fn parsed(label: &str, model: &str, coat: &str) -> Material {
    let read = |name: &str| match name {
        "dye.csv" => Ok(dye()),
        _ => Err(std::io::Error::other("no such file")),
    };
    parse(label, &file(model, coat), &read).unwrap().material
}

fn directions() -> Vec<([f32; 3], [f32; 3])> {
    let unit = |i: u32, a: f64, b: f64| {
        let z = 0.05 + 0.94 * (f64::from(i) * a).fract();
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (f64::from(i) * b).fract());
        let r = libm::sqrt(1.0 - z * z);
        DVec3::new(r * cos, r * sin, z).as_vec3().to_array()
    };
    (1..200).map(|i| (unit(i, 0.754_877_666, 0.569_840_291), unit(i, 0.819_172_513, 0.671_043_606))).collect()
}

/// Oracle: the f64 twin, whose own oracles are in the tests of luthier-layers.
#[test]
fn device_and_twin_agree_for_lights_of_all_colours() {
    let Some(gpu) = gpu() else { return };
    let workshop = Workshop::new();
    workshop.write("dye.csv", dye());
    let label = workshop.path("dye.toml").display().to_string();
    let mut compared = 0;
    for model in ["elek", "weidlich-wilkie"] {
        for coat in [String::new(), COAT.to_owned(), format!("{COAT}{COAT}")] {
            let material = parsed(&label, model, &coat);
            for light in [[1.0f32, 1.0, 1.0], [0.0, 0.0, 2.0], [0.1, 1.5, 0.7]] {
                let functions = [FunctionGroup::Light].into_iter().collect();
                let bake = Bake { functions, ..Bake::wgsl(&[Form::Full]) };
                let mut package = bake.package(std::slice::from_ref(&material), &MemoryStore::default()).unwrap();
                let [r, g, b] = light;
                let body = format!(
                    "\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    \
                     return luthier_light_lit(luthier_prepare(material, wo), wi, vec3<f32>({r:?}, {g:?}, {b:?}));\n}}\n"
                );
                let wgsl = package.wgsl(Form::Full).unwrap().replace("fn luthier_eval(", "fn emitted_eval(") + &body;
                package.shaders = vec![Shader::wgsl(Form::Full, wgsl)];
                let pairs = directions();
                let found = gpu.scene(&package, Form::Full).unwrap().evaluate(0, &pairs).unwrap();

                let nm = material.bake.wavelengths_nm();
                let place = Place { reradiation: material.reradiation(), ..Place::NONE };
                let twin =
                    Shaded::new(model.parse().unwrap(), &material.stack, nm, Color::ThreeWavelengths(nm), &place)
                        .unwrap();
                for (&(wi, wo), found) in pairs.iter().zip(found) {
                    let [wi, wo] = [wi, wo].map(|w| DVec3::from(w.map(f64::from)));
                    let expected = twin.eval_lit(light.map(f64::from), wi, wo);
                    let brightest = expected.iter().fold(FLOOR, |most, value| most.max(*value));
                    for c in 0..3 {
                        let error = (f64::from(found[c]) - expected[c]).abs() / brightest;
                        assert!(error < TOLERANCE, "{model} {light:?} {wi} {wo}: {found:?} {expected:?}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 10_000, "{compared}");
}

/// The command line: what is baked, what is refused, and what is seen.
#[test]
fn a_fluorescent_base_goes_from_file_to_pixel() {
    let workshop = Workshop::new();
    workshop.write("dye.csv", dye());
    workshop.write("dye.toml", file("elek", COAT));
    workshop.run(&["check", "dye.toml"]).exits(0);
    workshop.run(&["bake", "dye.toml", "--out", "out", "--form", "full"]).exits(0);
    let manifest = std::fs::read_to_string(workshop.path("out/manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    let base = &manifest["materials"][0]["layers"][1];
    let rows: [Rgb; 3] = serde_json::from_value(base["reradiation"].clone()).unwrap();
    assert_eq!(Some(rows), material("elek", COAT).reradiation());
    assert!(manifest["materials"][0]["layers"][0].get("reradiation").is_none());
    // Blue light becomes red, and the red of white light is more than a perfect reflector's.
    assert!(rows[0][2] > 0.3 && rows[0].iter().sum::<f64>() > 1.0, "{rows:?}");
    // `eval` is white light on the twin.
    let eval =
        ["eval", "dye.toml", "--model", "elek", "--wi", "30,0", "--wo", "45,180", "--json", "--three-wavelengths"];
    let found = workshop.run(&eval).exits(0).json();
    let nm = material("elek", COAT).bake.wavelengths_nm();
    let place = Place { reradiation: Some(rows), ..Place::NONE };
    let twin = Shaded::new(ShadingModel::Elek, &material("elek", COAT).stack, nm, Color::ThreeWavelengths(nm), &place)
        .unwrap();
    let at = |theta: f64, sign: f64| {
        let (sin, cos) = libm::sincos(theta.to_radians());
        DVec3::new(sign * sin, 0.0, cos)
    };
    let expected = twin.eval(at(30.0, 1.0), at(45.0, -1.0));
    for (c, expected) in expected.into_iter().enumerate() {
        let value = found["values"][0]["value"][c].as_f64().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
    }
    workshop.write("bad.csv", "nm,450,550\n450,0.5,0\n550,0.7,0.4\n");
    workshop.write("bad.toml", file("elek", COAT).replace("dye.csv", "bad.csv"));
    workshop
        .run(&["check", "bad.toml"])
        .exits(1)
        .says(&["`bad.csv`:1: 1.2 of the power of the light at 450 nm comes out", "bad.toml:11"]);
    workshop.write("other.toml", file("belcour", COAT));
    workshop.run(&["check", "other.toml"]).exits(0).says(&["re-radiation"]);
    assert_eq!(material("belcour", COAT).model(), ShadingModel::Belcour);
    if gpu().is_some() {
        workshop.run(&["preview", "dye.toml", "-o", "dye.png", "--size", "64"]).exits(0);
    }
}
