//! Live numbers: `eval --live`, and pictures, are those of the file with other numbers.

use luthier::{Bake, MemoryStore, Source};
use luthier_export::Package;
use luthier_gpu::{Environment, LiveValue, RenderSettings, Scene, Shape};
use luthier_manifest::{Form, MapSlot};

use super::twin::gpu;
use crate::workshop::Workshop;

/// A coat over a surface of engines, by thickness, absorption, weight and slope parameter of the coat, and colour, metal and slope parameter of the base.
fn text(model: &str, coat: [&str; 4], base: [&str; 3], is_live: bool) -> String {
    let ([thickness, absorption, weight, alpha], [color, metallic, base_alpha]) = (coat, base);
    let live = |keys: &str| if is_live { format!("live = {{ {keys} }}\n") } else { String::new() };
    // A surface whose maps vary its metal is one without metal in the stack.
    let white = "maps = { base_color = \"white.png\", metallic = \"white.png\" }\n";
    format!(
        "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nthickness_um = {thickness}\nabsorption_per_um = {absorption}\n\
         weight = {weight}\nalpha = {alpha}\n{}[[layer]]\ntype = \"metallic-roughness\"\nbase_color = {color}\nmetallic = {metallic}\nalpha = {base_alpha}\n{}\
         {}[bake]\nmodel = \"{model}\"\ncolor = \"three-wavelengths\"\n",
        live("thickness = true, absorption = true, weight = true, alpha = [0.05, 0.4]"),
        live("base_color = true, metallic = true, alpha = [0.1, 0.6]"),
        if is_live { "" } else { white },
    )
}

/// The file, and the file with the numbers that the values make.
fn texts(model: &str) -> [String; 2] {
    let own = (["20", "0.05", "0.8", "0.2"], ["[0.8, 0.6, 0.4]", "0.25", "0.3"]);
    let other = (["30", "[0.01, 0.05, 0.15]", "0.4", "0.1"], ["[0.2, 0.7, 0.9]", "0.625", "0.45"]);
    [text(model, own.0, own.1, true), text(model, other.0, other.1, false)]
}

const VALUES: [(MapSlot, u32, [f32; 3]); 7] = [
    (MapSlot::Thickness, 0, [1.5; 3]),
    (MapSlot::Absorption, 0, [0.2, 1.0, 3.0]),
    (MapSlot::Weight, 0, [0.5; 3]),
    (MapSlot::Alpha, 0, [0.5; 3]),
    (MapSlot::BaseColor, 1, [0.2, 0.7, 0.9]),
    (MapSlot::Metallic, 1, [0.625; 3]),
    (MapSlot::Alpha, 1, [1.5; 3]),
];

fn workshop(model: &str) -> Workshop {
    let [live, plain] = texts(model);
    let workshop = Workshop::with(&[("live.toml", &live), ("plain.toml", &plain)]);
    image::RgbImage::from_pixel(1, 1, image::Rgb([255; 3])).save(workshop.path("white.png")).unwrap();
    workshop
}

#[test]
fn eval_is_that_of_another_file() {
    for model in ["elek", "weidlich-wilkie", "yamaguchi"] {
        let workshop = workshop(model);
        let values = VALUES.map(|(slot, layer, value)| {
            let count = if matches!(slot, MapSlot::Absorption | MapSlot::BaseColor) { 3 } else { 1 };
            let value: Vec<String> = value[..count].iter().map(|value| value.to_string()).collect();
            format!("--live=layer.{layer}.{}={}", slot.name().replace('-', "_"), value.join(","))
        });
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        let run = |file: &str, more: &[&str]| {
            let args = ["eval", file, "--model", model, "--wi", "40,20", "--wo", "25,170", "--rgb"];
            let run = workshop.run(&[&args[..], more].concat()).exits(0);
            let last: Vec<f64> =
                run.stdout.lines().last().unwrap().split(',').skip(4).map(|v| v.parse().unwrap()).collect();
            assert_eq!(last.len(), 3, "{}", run.stdout);
            last
        };
        let [found, expected, plain] = [run("live.toml", &values), run("plain.toml", &[]), run("live.toml", &[])];
        // The veil over a base, of models of statistics, stays that of the file.
        let bound = if model == "yamaguchi" { 0.1 } else { 1e-6 };
        for c in 0..3 {
            assert!((found[c] / expected[c] - 1.0).abs() < bound, "{model}: {found:?} {expected:?}");
            assert!((plain[c] / expected[c] - 1.0).abs() > 0.02, "{model}: {plain:?}");
        }
    }
}

#[test]
fn what_is_not_live_is_told() {
    let workshop = workshop("elek");
    let eval = ["eval", "live.toml", "--model", "elek", "--wi", "40,20", "--wo", "25,170"];
    let run = |more: &[&str]| workshop.run(&[&eval[..], more].concat());
    run(&["--live", "layer.1.thickness=2"]).fails(2, &["has no live `layer.1.thickness`", "layer.0.thickness"]);
    run(&["--live", "layer.0.alpha=9"]).fails(2, &["`layer.0.alpha` is from 0.25", "to 2.0"]);
    run(&["--live", "layer.0.absorption=1"]).fails(2, &["takes 3 numbers, not 1"]);
    run(&["--live", "alpha=1"]).fails(2, &["layer.1.base_color=0.8,0.3,0.1"]);
}

/// The manifest lists the numbers with their ranges and places.
#[test]
fn the_manifest_has_them() {
    let workshop = workshop("weidlich-wilkie");
    workshop.run(&["bake", "live.toml", "--target", "wgsl", "--form", "full", "--out", "out"]).exits(0);
    let live = workshop.json("out/manifest.json")["materials"][0]["live"].clone();
    let members: Vec<&str> = live.as_array().unwrap().iter().map(|live| live["member"].as_str().unwrap()).collect();
    let expected = [
        "slab_factor",
        "layers[0].absorption_factors",
        "weight_factor",
        "layers[0].alpha_factors",
        "layers[1].alpha_factors",
        "luthier_metallic_place",
        "luthier_metallic_place",
    ];
    assert_eq!(members, expected);
    assert_eq!(live[3]["range"]["least"], 0.25);
    assert_eq!(live[3]["number"][0], 0.2);
    assert_eq!(live[2]["range"]["most"], 1.25);
    assert_eq!(live[0]["range"]["most"], serde_json::Value::Null);
}

#[test]
fn pictures_are_those_of_another_file() {
    let Some(gpu) = gpu() else { return };
    let workshop = workshop("weidlich-wilkie");
    let package = |file: &str| -> Package {
        let parsed = Source::read(&workshop.path(file)).unwrap().parsed.unwrap_or_else(|errors| panic!("{errors:?}"));
        let bake = Bake { refuses: false, ..Bake::wgsl(&[Form::Full]) };
        bake.package(&[parsed.material], &MemoryStore::default()).unwrap()
    };
    let picture = |scene: &Scene| {
        let mut settings = RenderSettings::new(Shape::Sphere).unwrap();
        settings.environment = std::sync::Arc::new(Environment::new(luthier_lut::Image::zeros(16, 8, 3)).unwrap());
        (settings.size, settings.samples, settings.environment_samples) = (24, 1, 1);
        settings.light_angular_radius = 0.0;
        scene.render(&[0], &settings).unwrap().data
    };
    let mut scene = gpu.scene(&package("live.toml"), Form::Full).unwrap();
    let before = picture(&scene);
    scene.set_live(&VALUES.map(|(slot, layer, value)| LiveValue { material: 0, slot, layer, value }));
    let found = picture(&scene);
    let expected = picture(&gpu.scene(&package("plain.toml"), Form::Full).unwrap());
    let apart =
        |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs() / a.max(*b).max(0.01)).fold(0.0f32, f32::max);
    assert!(apart(&found, &expected) < 1e-3, "{}", apart(&found, &expected));
    assert!(apart(&before, &expected) > 0.05);
    // Without values the file's numbers hold again.
    scene.set_live(&[]);
    assert_eq!(picture(&scene), before);
}
