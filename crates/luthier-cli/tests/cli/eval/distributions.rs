//! Distributions of slopes beside Beckmann's and GGX: from files to the device, by hand, and drawn directions.

use std::f64::consts::PI;

use luthier::{Bake, MemoryStore};
use luthier_export::Shader;
use luthier_layers::effects::textured::TextureSample;
use luthier_layers::models::parts::Parts;
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_lut::TableKind;
use luthier_manifest::Masking;
use luthier_manifest::{Form, FunctionGroup, ShadingModel};
use luthier_material::{Material, parse};
use luthier_optics::color::Color;

use super::draws;
use super::twin::{compare_sets, error, gpu, pairs, wide};
use crate::workshop::Workshop;

/// Largest difference between the device and f64, relative to the larger of the value and a tenth of a white Lambert surface's BRDF.
const TOLERANCE: f64 = 2e-5;

const METAL: &str = "[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\n";
const COAT: &str =
    "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nthickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.03]\n";

/// Surfaces of layers: wide and narrow, with little of a tail and with much.
const SURFACES: [(&str, &str); 8] = [
    ("blinn", "alpha = 0.4\ndistribution = \"blinn\""),
    ("polished", "exponent = 20000\ndistribution = \"blinn\""),
    ("dull", "alpha = 0.95\ndistribution = \"blinn\""),
    ("abc", "abc = { b = 1000, c = 1.2 }"),
    ("abc-steep", "abc = { b = 3, c = 20 }"),
    ("abc-flat", "abc = { b = 50000, c = 0.7 }"),
    ("sgd", "sgd = { alpha = 0.05, p = 0.7 }"),
    ("sgd-sharp", "sgd = { alpha = 0.002, p = 1.3 }"),
];

fn material(name: &str, model: &str, body: &str) -> Material {
    let masking = if model == "microfacet" { "masking = \"v-cavity\"\n" } else { "" };
    let text = format!("schema = 1\nname = \"{name}\"\n{body}[bake]\nmodel = \"{model}\"\n{masking}");
    let parsed = parse(name, &text, &|_| Err(std::io::Error::other("none")));
    parsed.unwrap_or_else(|errors| panic!("{}", errors[0].render(&text))).material
}

/// A metal of each surface; coats of two distributions; metals of others.
fn materials(model: &str) -> Vec<Material> {
    let mut found: Vec<Material> =
        SURFACES.iter().map(|(name, surface)| material(name, model, &format!("{METAL}{surface}\n"))).collect();
    let coated = |first: &str, second: &str| format!("{COAT}{first}\n{METAL}{second}\n");
    found.extend([
        material("blinn-on-sgd", model, &coated(SURFACES[0].1, SURFACES[6].1)),
        material("abc-on-brushed", model, &coated(SURFACES[3].1, "alpha_x = 0.2\nalpha_y = 0.5\nrotation_deg = 30")),
        material("beckmann", model, &format!("{METAL}alpha = 0.3\ndistribution = \"beckmann\"\n")),
        material("brushed", model, &format!("{METAL}alpha_x = 0.1\nalpha_y = 0.3\nrotation_deg = 30\n")),
    ]);
    found
}

fn parts(model: &str) -> Parts {
    let masking = if model == "microfacet" { Masking::VCavity } else { Masking::Smith };
    Parts { masking, ..Parts::PLAIN }
}

/// Each surface in a set of its own and all in one: the shaders differ.
#[test]
fn the_device_agrees_with_f64() {
    let Some(gpu) = gpu() else { return };
    let three = [645.0, 525.0, 445.0];
    for model in ["elek", "weidlich-wilkie", "microfacet"] {
        compare_sets(&gpu, model, &materials(model), |material| {
            Shaded::with(
                model.parse().unwrap(),
                &material.stack,
                three,
                Color::ThreeWavelengths(three),
                &Place::NONE,
                parts(model),
            )
            .unwrap()
        });
    }
}

/// A factor of a roughness map changes the exponent of Blinn's distribution, and stretches the slopes of the others.
#[test]
fn roughness_maps_scale_all_of_them() {
    let Some(gpu) = gpu() else { return };
    let pairs = pairs();
    let three = [645.0, 525.0, 445.0];
    let materials = materials("weidlich-wilkie");
    let bake = Bake { functions: [FunctionGroup::Surface].into_iter().collect(), ..Bake::wgsl(&[Form::Full]) };
    let mut package = bake.package(&materials, &MemoryStore::default()).unwrap();
    for (factor, variance) in [(0.5, 0.0), (1.8, 0.0), (1.0, 0.01)] {
        let emitted = package.wgsl(Form::Full).unwrap().to_owned();
        let wgsl = emitted.replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!(
                "\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    var place = luthier_place();\n    \
                 place.alpha_factor = {factor:?};\n    place.slope_variance = {variance:?};\n    \
                 return luthier_eval_at(place, material, wi, wo);\n}}\n"
            );
        package.shaders = vec![Shader::wgsl(Form::Full, wgsl)];
        let scene = gpu.scene(&package, Form::Full).unwrap();
        let sample = TextureSample { alpha_factor: factor, slope_variance: variance, ..TextureSample::NONE };
        let place = Place { sample, ..Place::NONE };
        for (number, material) in (0..).zip(&materials) {
            let twin = Shaded::new(
                ShadingModel::WeidlichWilkie,
                &material.stack,
                three,
                Color::ThreeWavelengths(three),
                &place,
            )
            .unwrap();
            for (&(wi, wo), found) in pairs.iter().zip(scene.evaluate(number, &pairs).unwrap()) {
                let expected = twin.eval(wide(wi), wide(wo));
                let error = error(found, expected);
                assert!(
                    error < TOLERANCE,
                    "{}, {factor} {variance}: {wi:?} {wo:?}: {found:?} {expected:?}",
                    material.name
                );
            }
        }
        package.shaders = vec![Shader::wgsl(Form::Full, emitted)];
    }
}

/// D from a table, within the error that the manifest states: relative to the peak, of which f has a quarter over the cosine.
#[test]
fn tables_hold_them() {
    let Some(gpu) = gpu() else { return };
    let table = "[bake.distribution]\nsize = [512, 512]\n";
    let of = |(name, surface): &(&str, &str)| {
        let mut found = material(name, "elek", &format!("{METAL}{surface}\n{table}"));
        found.bake.model = Some(ShadingModel::Elek);
        found
    };
    let materials: Vec<Material> = SURFACES.iter().map(of).collect();
    let package = Bake::wgsl(&[Form::Baked]).package(&materials, &MemoryStore::default()).unwrap();
    let tiles: Vec<_> =
        package.manifest.materials.iter().map(|m| m.layers[0].tiles[TableKind::Distribution].unwrap()).collect();
    // One tile for the three of Blinn, and one for each pair of parameters.
    assert_eq!((tiles[0], tiles[1], tiles.iter().max()), (tiles[2], tiles[2], Some(&5)), "{tiles:?}");
    let table = package.manifest.tables.iter().find(|table| table.kind == TableKind::Distribution).unwrap();
    let scene = gpu.scene(&package, Form::Baked).unwrap();
    let pairs = pairs();
    for (number, material) in (0..).zip(&materials) {
        let surface = material.stack.layers[0].surface;
        let color = Color::ThreeWavelengths(material.bake.wavelengths_nm());
        let twin =
            Shaded::new(ShadingModel::Elek, &material.stack, material.bake.wavelengths_nm(), color, &Place::NONE)
                .unwrap();
        let peak = 1.0 / (PI * surface.alpha_x * surface.alpha_x);
        let stated = table.tiles[tiles[number as usize] as usize].error.max_abs_err;
        for (&(wi, wo), found) in pairs.iter().zip(scene.evaluate(number, &pairs).unwrap()) {
            let expected = twin.eval(wide(wi), wide(wo));
            let bound = 1e-3 * expected[1] + stated * peak / (4.0 * f64::from(wo[2]));
            let off = (f64::from(found[1]) - expected[1]).abs();
            assert!(off < bound + 1e-4, "{}: {wi:?} {wo:?}: {found:?} {expected:?}", material.name);
        }
    }
}

/// Shaders of both forms with all functions: naga has to take them.
#[test]
fn every_model_has_its_shaders() {
    let store = MemoryStore::default();
    for model in ["elek", "weidlich-wilkie", "microfacet"] {
        let functions = FunctionGroup::NAMES.iter().filter_map(|name| FunctionGroup::from_name(name)).collect();
        (Bake { functions, ..Bake::wgsl(&[]) }).package(&materials(model), &store).unwrap();
    }
}

/// Directions are drawn as the density says, and their weights are those of the surface.
#[test]
fn directions_are_drawn_as_the_density_says() {
    for model in ["microfacet", "elek"] {
        let materials = materials(model);
        let Some(scene) = draws::scene(&materials) else { return };
        let mut found = draws::Found::default();
        for (number, material) in (0..).zip(&materials) {
            for (seed, theta) in (0..).zip(draws::EYES) {
                let what = format!("{model} {} {theta}", material.name);
                draws::judge(&scene, number, theta, 1000 + u64::from(number) * 8 + seed, &what, &mut found);
            }
        }
        assert!(found.faults.is_empty(), "{}", found.faults.join("\n"));
    }
}

/// The command, by hand: seen from the normal and lit along it a mirror of F0 1 shows D / 4, times the cosine where the eye and the light lean
/// by 60 degrees to either side. Elsewhere the half vector leans by 30 degrees, and nothing is masked.
#[test]
fn the_command_evaluates_the_formulas() {
    let workshop = Workshop::new();
    let value = |surface: &str, wi: &str, wo: &str| {
        workshop.write(
            "metal.toml",
            format!(
                "schema = 1\nname = \"metal\"\n[[layer]]\ntype = \"conductor\"\nf0 = 1\n{surface}\n[bake]\nmodel = \"microfacet\"\n\
                 masking = \"v-cavity\"\n"
            ),
        );
        let arguments = ["eval", "metal.toml", "--model", "microfacet", "--wi", wi, "--wo", wo, "--json"];
        workshop.run(&arguments).exits(0).json()["values"][0]["value"][0].as_f64().unwrap()
    };
    let cos_h = libm::cos(PI / 6.0);
    let tan_sq = 1.0 / 3.0;
    // 2 cos_h cos_o / cos_d of the lower direction: cos_h = cos_d.
    let (masking, cos_o) = (1.0, 0.5);
    let blinn = |n: f64, cos: f64| (n + 2.0) / (2.0 * PI) * libm::pow(cos, n);
    // Closed form of the norm: with B = 1 + b, 2 pi (B I(c) - I(c - 1)) / b^2, I(c) = (B^(1 - c) - 1)/(1 - c).
    let abc = |b: f64, c: f64, cos: f64| {
        let i = |c: f64| (libm::pow(1.0 + b, 1.0 - c) - 1.0) / (1.0 - c);
        let norm = 2.0 * PI * ((1.0 + b) * i(c) - i(c - 1.0)) / (b * b);
        libm::pow(1.0 + b * (1.0 - cos), -c) / norm
    };
    // p = 1/2: Gamma(1/2, a) = sqrt(pi) erfc(sqrt a).
    let sgd = |a: f64, tan_sq: f64| {
        let gamma = libm::sqrt(PI) * libm::erfc(libm::sqrt(a));
        let t = (a * a + tan_sq) / a;
        let secant_sq = 1.0 + tan_sq;
        libm::pow(a, -0.5) * libm::exp(-t) / (gamma * libm::sqrt(a * a + tan_sq)) * secant_sq * secant_sq / PI
    };
    type Case<'a> = (&'a str, f64, f64);
    let cases: [Case<'_>; 5] = [
        ("distribution = \"blinn\"\nexponent = 30", blinn(30.0, 1.0), blinn(30.0, cos_h)),
        ("distribution = \"blinn\"\nalpha = 0.5", blinn(6.0, 1.0), blinn(6.0, cos_h)),
        ("abc = { b = 100, c = 1.3 }", abc(100.0, 1.3, 1.0), abc(100.0, 1.3, cos_h)),
        ("abc = { b = 3, c = 2.5 }", abc(3.0, 2.5, 1.0), abc(3.0, 2.5, cos_h)),
        ("sgd = { alpha = 0.2, p = 0.5 }", sgd(0.2, 0.0), sgd(0.2, tan_sq)),
    ];
    for (surface, peak, aside) in cases {
        let found = value(surface, "0,0", "0,0");
        assert!((found / (peak / 4.0) - 1.0).abs() < 1e-6, "{surface}: {found} for {}", peak / 4.0);
        let found = value(surface, "0,0", "60,0");
        assert!((found / (aside * masking / (4.0 * cos_o)) - 1.0).abs() < 1e-6, "{surface}: {found}");
    }
}

/// Refusals of such a distribution: one each, with the line and a way out.
#[test]
fn what_does_not_take_them_refuses() {
    let workshop = Workshop::new();
    let file = |body: &str| workshop.write("x.toml", format!("schema = 1\nname = \"x\"\n{body}"));
    let blinn = format!("{METAL}alpha = 0.4\ndistribution = \"blinn\"\n");
    let refused = |command: &[&str], says: &[&str]| {
        let run = workshop.run(command).exits(1);
        // `bake` ends with the number of files that it cannot use.
        let is_told = |line: &&&str| !line.contains("material files cannot be used");
        assert_eq!(run.errors().iter().filter(is_told).count(), 1, "{}", run.stderr);
        for part in says {
            assert!(run.stderr.contains(part), "{command:?}: no `{part}` in\n{}", run.stderr);
        }
    };
    let eval = |model: &str| {
        refused(
            &["eval", "x.toml", "--model", model, "--wi", "0,0", "--wo", "0,0"],
            &["`blinn`", &format!("`{model}`")],
        );
    };
    for model in ShadingModel::NAMES.iter().filter(|model| !["elek", "weidlich-wilkie", "microfacet"].contains(model)) {
        file(&format!("{blinn}[bake]\nmodel = \"{model}\"\n"));
        for verb in [&["check", "x.toml"][..], &["bake", "x.toml", "--out", "out"]] {
            refused(verb, &["x.toml:7", &format!("the model `{model}` has no distribution `blinn`")]);
        }
        eval(model);
    }
    ["layered-mc", "random-walk", "density-layers-local"].into_iter().for_each(eval);
    for (body, says) in [
        (format!("{blinn}[bake]\nmodel = \"microfacet\"\n"), ["x.toml:7", "masking = \"v-cavity\""]),
        (format!("{blinn}[bake]\nmodel = \"microfacet\"\nmasking = \"smith-separable\"\n"), ["x.toml:10", "v-cavity"]),
        (format!("{blinn}[bake]\nmodel = \"elek\"\ntables = [\"fgd\"]\n"), ["x.toml:7", "`fgd`"]),
        (format!("{METAL}alpha_x = 0.1\nalpha_y = 0.2\ndistribution = \"blinn\"\n"), ["x.toml:6", "isotropic"]),
        (format!("{METAL}exponent = 20\n"), ["x.toml:6", "distribution = \"blinn\""]),
        (format!("{METAL}abc = {{ b = 20, c = 1 }}\ndistribution = \"ggx\"\n"), ["x.toml:7", "`abc`"]),
        (format!("{METAL}abc = {{ b = 20 }}\n"), ["x.toml:6", "`c` is missing"]),
        (format!("{METAL}abc = {{ b = -20, c = 1 }}\n"), ["x.toml:6", "`b` must be above 0"]),
        (format!("{METAL}sgd = {{ alpha = 8, p = 0.5 }}\n"), ["x.toml:6", "smaller `alpha`"]),
        (format!("{METAL}abc = {{ b = 20, c = 1 }}\nalpha = 0.2\n"), ["x.toml:6", "a second surface"]),
    ] {
        file(&body);
        refused(&["check", "x.toml"], &says);
    }
    // A file that names no model gets one that has it.
    file(&format!("{COAT}alpha = 0.2\n{blinn}"));
    let check = workshop.run(&["check", "x.toml"]).exits(0);
    assert!(check.stderr.contains("`elek` takes its place"), "{}", check.stderr);
}
