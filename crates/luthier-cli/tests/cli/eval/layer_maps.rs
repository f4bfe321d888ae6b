//! Maps of single layers: `eval` at a texture coordinate, the shader at a place, and the renderer, which reads the maps itself.

use luthier::{Bake, MemoryStore, Source};
use luthier_export::{Package, Shader};
use luthier_gpu::{Environment, RenderSettings, Shape};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;

use super::twin::{Pair, error, gpu, pairs};
use crate::workshop::Workshop;

/// Largest difference between the device and `eval`.
const TOLERANCE: f64 = 2e-5;

const UV: &str = "0.3,0.7";

/// A stack with every map of single layers; the second layer has those of a slab.
fn text(model: &str) -> String {
    format!(
        "schema = 1\nname = \"m\"\n\
         [[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha_x = 0.4\nalpha_y = 0.2\nrotation_deg = 20\n\
         thickness_um = 1\nabsorption_per_um = [0.1, 0.2, 0.3]\n\
         maps = {{ bumps = \"n.png\", alpha_x = \"a.png\", tangent = \"t.png\" }}\n\
         [[layer]]\ntype = \"dielectric\"\nior = 1.3\nalpha = 0.5\nthickness_um = 1\nabsorption_per_um = [0.5, 0.3, 0.1]\n\
         maps = {{ thickness = \"a.png\", alpha = \"b.png\" }}\n\
         [[layer]]\ntype = \"conductor\"\nior = {{ n = 0.2, k = 3.4 }}\nalpha_x = 0.3\nalpha_y = 0.6\n\
         maps = {{ bumps = \"o.png\", tangent = \"u.png\", alpha_y = \"b.png\" }}\n\
         [bake]\nmodel = \"{model}\"\ncolor = \"three-wavelengths\"\n"
    )
}

fn workshop(model: &str) -> Workshop {
    let workshop = Workshop::with(&[("m.toml", &text(model))]);
    for (name, from, to) in [
        ("n.png", [150u8, 110, 240], [100u8, 140, 250]),
        ("o.png", [120, 150, 245], [135, 100, 240]),
        ("a.png", [200, 0, 0], [120, 0, 0]),
        ("b.png", [250, 0, 0], [140, 0, 0]),
        ("t.png", [240, 90, 0], [200, 200, 0]),
        ("u.png", [30, 100, 0], [60, 200, 0]),
    ] {
        let mixed =
            |s: f32| [0, 1, 2].map(|c: usize| (f32::from(from[c]) * (1.0 - s) + f32::from(to[c]) * s).round() as u8);
        let texel = |x: u32, y: u32| image::Rgb(mixed((x as f32 + 2.0 * y as f32) / 9.0));
        image::RgbImage::from_fn(4, 4, texel).save(workshop.path(name)).unwrap();
    }
    workshop
}

fn material(workshop: &Workshop) -> Material {
    Source::read(&workshop.path("m.toml")).unwrap().parsed.unwrap_or_else(|errors| panic!("{errors:?}")).material
}

/// The values of the place as `eval` states them, written into the shader.
fn place(workshop: &Workshop, model: &str) -> String {
    let json = workshop
        .run(&["eval", "m.toml", "--model", model, "--uv", UV, "--json", "--wi", "30,0", "--wo", "20,90", "--rgb"]);
    let json = json.exits(0).json();
    let list = |value: &serde_json::Value| -> String {
        let numbers: Vec<String> =
            value.as_array().unwrap().iter().map(|v| format!("{:?}", v.as_f64().unwrap())).collect();
        numbers.join(", ")
    };
    let layers = json["place"]["layers"].as_array().unwrap();
    let mut out = String::new();
    for (i, layer) in layers.iter().enumerate() {
        let shown = |name: &str| model != "elek" || !["tangent"].contains(&name);
        for (name, kind) in [("normal", "vec3<f32>"), ("alpha_factors", "vec2<f32>"), ("tangent", "vec2<f32>")] {
            if shown(name) {
                out.push_str(&format!("place.layers[{i}].{name} = {kind}({});\n", list(&layer[name])));
            }
        }
        out.push_str(&format!("place.layers[{i}].slab_factor = {:?};\n", layer["slab_factor"].as_f64().unwrap()));
    }
    out
}

fn package(material: &Material, body: Option<&str>) -> Package {
    package_in(Form::Full, material, body)
}

fn package_in(form: Form, material: &Material, body: Option<&str>) -> Package {
    let bake = Bake { refuses: false, ..Bake::wgsl(&[form]) };
    let mut package = bake.package(std::slice::from_ref(material), &MemoryStore::default()).unwrap();
    if let Some(body) = body {
        let wgsl = package.wgsl(form).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
            + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
        package.shaders = vec![Shader::wgsl(form, wgsl)];
    }
    package
}

fn listed(pairs: &[Pair]) -> String {
    let angles = |w: [f32; 3]| {
        let [x, y, z] = w.map(f64::from);
        format!("{:?},{:?}", libm::atan2(libm::hypot(x, y), z).to_degrees(), libm::atan2(y, x).to_degrees())
    };
    let rows: Vec<String> = pairs.iter().map(|(wi, wo)| format!("{},{}", angles(*wi), angles(*wo))).collect();
    rows.join("\n")
}

#[test]
fn the_shader_at_a_place_is_eval_there() {
    let Some(gpu) = gpu() else { return };
    for model in ["elek", "weidlich-wilkie"] {
        let workshop = workshop(model);
        let pairs: Vec<Pair> = pairs().into_iter().step_by(3).collect();
        workshop.write("pairs.csv", listed(&pairs));
        let body = format!(
            "var place = luthier_place();\n{}return luthier_eval_at(place, material, wi, wo);",
            place(&workshop, model)
        );
        let material = material(&workshop);
        assert_eq!(material.model(), ShadingModel::from_name(model).unwrap());
        let found = gpu.scene(&package(&material, Some(&body)), Form::Full).unwrap().evaluate(0, &pairs).unwrap();
        let eval = |more: &[&str]| -> Vec<[f64; 3]> {
            let base =
                ["eval", "m.toml", "--model", model, "--three-wavelengths", "--json", "--directions", "pairs.csv"];
            let json = workshop.run(&[&base, more].concat()).exits(0).json();
            let rows = json["values"].as_array().unwrap();
            rows.iter().map(|row| [0, 1, 2].map(|c: usize| row["value"][c].as_f64().unwrap())).collect()
        };
        let (with, without) = (eval(&["--uv", UV]), eval(&["--no-effects"]));
        let worst = found.iter().zip(&with).map(|(f, e)| error(*f, *e)).fold(0.0, f64::max);
        let ignored = found.iter().zip(&without).map(|(f, e)| error(*f, *e)).fold(0.0, f64::max);
        eprintln!("{model}: {worst:.1e}; without maps {ignored:.1e}");
        assert!(worst < TOLERANCE && ignored > 0.1, "{model}: {worst} {ignored}");
    }
}

/// What a model does not show is said.
#[test]
fn maps_that_a_model_lacks_are_named() {
    let workshop = workshop("lobes");
    let run = workshop.run(&["check", "m.toml"]);
    let said = run.exits(0).stderr;
    for part in ["the alpha map of one layer", "the tangent map", "the thickness map of an inner slab"] {
        assert!(said.contains(&format!("the model `lobes` leaves out {part}")), "{said}");
    }
}

/// Oracle: the file with the numbers that maps of one colour make of it, which needs no maps.
#[test]
fn pictures_with_maps_of_one_colour_are_those_of_other_numbers() {
    let Some(gpu) = gpu() else { return };
    let workshop = Workshop::new();
    for (name, texel) in [("t.png", [64u8, 230, 0]), ("a.png", [200, 150, 100])] {
        image::RgbImage::from_pixel(2, 2, image::Rgb(texel)).save(workshop.path(name)).unwrap();
    }
    let turn = 0.5 * libm::atan2(2.0 * 230.0 / 255.0 - 1.0, 2.0 * 64.0 / 255.0 - 1.0).to_degrees();
    let factor = 200.0 / 255.0;
    let metal = |alpha_x: f64, alpha_y: f64, turn: f64, maps: &str| {
        format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n[[layer]]\ntype = \"conductor\"\nior = \"cu\"\n\
             alpha_x = {alpha_x:?}\nalpha_y = {alpha_y:?}\nrotation_deg = {turn:?}\n{maps}"
        )
    };
    let paint = |albedo: [f64; 3], maps: &str| {
        format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo:?}\n{maps}"
        )
    };
    let engine = |color: [f64; 3], metallic: f64, maps: &str| {
        format!(
            "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {color:?}\nmetallic = {metallic:?}\nalpha = 0.3\n{maps}"
        )
    };
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\ndarkening = false\n".to_owned();
    let half = format!("{coat}weight = 0.5\n");
    let texel = [200.0, 150.0, 100.0].map(|value| value / 255.0);
    let color = [0.9, 0.8, 0.7];
    let seen = [0, 1, 2].map(|c: usize| color[c] * texel[c]);
    for (with, without, plain) in [
        (
            metal(0.4, 0.1, 10.0, "maps = { tangent = \"t.png\", alpha_x = \"a.png\" }\n"),
            metal(0.4 * factor, 0.1, 10.0 + turn, ""),
            metal(0.4, 0.1, 10.0, ""),
        ),
        (paint(color, "maps = { albedo = \"a.png\" }\n"), paint(seen, ""), paint(color, "")),
        (
            engine(color, 0.9, "maps = { base_color = \"a.png\", metallic = \"a.png\" }\n"),
            engine(seen, 0.9 * factor, ""),
            engine(color, 0.9, ""),
        ),
        // Below coats that do not darken them, one of half a weight, and with a map of metal alone.
        (
            half.clone() + &engine(color, 0.9, "maps = { base_color = \"a.png\", metallic = \"a.png\" }\n"),
            half.clone() + &engine(seen, 0.9 * factor, ""),
            half + &engine(color, 0.9, ""),
        ),
        (
            coat.clone() + &engine(color, 0.9, "maps = { metallic = \"a.png\" }\n"),
            coat.clone() + &engine(color, 0.9 * factor, ""),
            coat + &engine([0.1, 0.9, 0.2], 0.9, ""),
        ),
    ] {
        let picture = |layers: &str| {
            let head = "schema = 1\nname = \"m\"\n";
            let bake = "[bake]\nmodel = \"weidlich-wilkie\"\ncolor = \"three-wavelengths\"\n";
            workshop.write("m.toml", format!("{head}{layers}{bake}"));
            let scene = gpu.scene(&package(&material(&workshop), None), Form::Full).unwrap();
            let mut settings = RenderSettings::new(Shape::Sphere).unwrap();
            settings.environment = std::sync::Arc::new(Environment::new(luthier_lut::Image::zeros(16, 8, 3)).unwrap());
            (settings.size, settings.samples, settings.environment_samples) = (24, 1, 1);
            settings.light_angular_radius = 0.0;
            scene.render(&[0], &settings).unwrap().data
        };
        let [with, without, plain] = [with, without, plain].map(|layers| picture(&layers));
        let apart = |a: &[f32], b: &[f32]| {
            a.iter().zip(b).map(|(a, b)| (a - b).abs() / a.max(*b).max(0.01)).fold(0.0f32, f32::max)
        };
        eprintln!("{:.1e}; without maps {:.1e}", apart(&with, &without), apart(&plain, &without));
        assert!(apart(&with, &without) < 1e-3 && apart(&plain, &without) > 0.05);
    }
}

/// Blurred maps of the environment know no layer's own textures.
#[test]
fn a_blurred_environment_refuses_maps_of_layers() {
    let Some(gpu) = gpu() else { return };
    let workshop = workshop("weidlich-wilkie");
    let bake = Bake { refuses: false, ..Bake::wgsl(&[Form::Baked]) };
    let package = bake.package(&[material(&workshop)], &MemoryStore::default()).unwrap();
    let scene = gpu.scene(&package, Form::Baked).unwrap();
    let settings = RenderSettings::new(Shape::Sphere).unwrap();
    let error = scene.render(&[0], &settings).unwrap_err().to_string();
    assert!(error.contains("`m` has maps of single layers"), "{error}");
}

/// Maps that change a coat, each together with a map of the base under it, under `lobes`. Oracle: the simulation of the file with the numbers that they make.
#[test]
fn maps_together_show_the_light_of_the_numbers_that_they_make() {
    let Some(gpu) = gpu() else { return };
    let workshop = Workshop::new();
    for (name, texel) in [("factor.png", [15u8; 3]), ("base.png", [204, 156, 96])] {
        image::RgbImage::from_pixel(1, 1, image::Rgb(texel)).save(workshop.path(name)).unwrap();
    }
    let (factor, base) = (15.0 / 255.0, [204.0, 156.0, 96.0].map(|texel| texel / 255.0));
    let file = |alpha: f64, thickness_um: f64, maps: &str, albedo: [f64; 3], base_maps: &str| {
        format!(
            "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = {alpha:?}\nthickness_um = {thickness_um:?}\n\
             absorption_per_um = [0.0006, 0.004, 0.016]\n{maps}[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo:?}\n{base_maps}"
        )
    };
    let pairs: Vec<Pair> = pairs().into_iter().step_by(20).collect();
    workshop.write("pairs.csv", listed(&pairs));
    for (map, member, [alpha, thickness_um]) in
        [("thickness", "slab_factor", [0.09, 255.0]), ("roughness", "alpha_factor", [0.5, 15.0])]
    {
        let maps = format!("maps = {{ {map} = \"factor.png\" }}\n");
        workshop.write("m.toml", file(alpha, thickness_um, &maps, [1.0; 3], "maps = { albedo = \"base.png\" }\n"));
        let material = material(&workshop);
        assert_eq!(material.model(), ShadingModel::Lobes);
        let body = format!(
            "var place = luthier_place();\nplace.{member} = {factor:?};\nplace.base_color = vec3<f32>({:?}, {:?}, {:?});\n\
             return luthier_eval_at(place, material, wi, wo);",
            base[0], base[1], base[2]
        );
        let package = package_in(Form::Baked, &material, Some(&body));
        let found = gpu.scene(&package, Form::Baked).unwrap().evaluate(0, &pairs).unwrap();
        let [alpha, thickness_um] =
            if map == "thickness" { [alpha, thickness_um * factor] } else { [alpha * factor, thickness_um] };
        workshop.write("plain.toml", file(alpha, thickness_um, "", base, ""));
        let mut eval = vec!["eval", "plain.toml", "--model", "layered-mc", "--samples", "40000", "--json"];
        eval.extend(["--directions", "pairs.csv"]);
        let json = workshop.run(&eval).exits(0).json();
        let rows = json["values"].as_array().unwrap();
        let mut worst = 0.0_f64;
        for (found, row) in found.iter().zip(rows) {
            let number = |c: usize| row["value"][c].as_f64().unwrap();
            worst = worst.max(error(*found, [0, 1, 2].map(number)));
        }
        eprintln!("{map} and albedo: {worst:.1e}");
        assert!(rows.len() == pairs.len() && worst < 0.05, "{map}: {worst}");
    }
}
