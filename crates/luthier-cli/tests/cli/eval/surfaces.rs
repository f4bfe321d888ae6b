//! Surfaces from file to shader: `eval` at a place against the device, and what is refused.

use crate::workshop::Workshop;

const LILAC: &str = "schema = 1\nname = \"lilac\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.56\nalpha = 0.3\n\
                     [[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.5, 0.7]\n[bake]\nmodel = \"weidlich-wilkie\"\n";
const MICA: &str = "schema = 1\nname = \"mica\"\n[[layer]]\ntype = \"conductor\"\nior = \"ag\"\nalpha = 0.3\n\
                    [bake]\nmodel = \"weidlich-wilkie\"\n";
const STONE: &str = "surface = 1\nname = \"stone\"\n\n[cells]\nseed = 3\nfrequency = 20\n\
                     materials = [\"lilac.toml\", \"deep/grey.toml\"]\n\n\
                     [glitter]\nseed = 4\nfrequency = 25\nfilled = 0.4\ntilt_deg = 20\nmaterials = [\"mica.toml\"]\n";

/// Veins in the stone, and larger cells without grains, for its end.
const SWITCHES: &str = "\n[[switch]]\nnoise = { seed = 5, frequency = 5, octaves = 3, between = [-0.1, 0.1] }\n\
                        cells = { seed = 6, frequency = 40, materials = [\"pale.toml\", \"mica.toml\"] }\n\n\
                        [[switch]]\ntiles = { seed = 7, frequency = 6, share = 0.4 }\ncells = { materials = [\"lilac.toml\"] }\n";

fn workshop() -> Workshop {
    let grey = LILAC.replace("lilac", "grey").replace("0.6, 0.5, 0.7", "0.2, 0.3, 0.1");
    Workshop::with(&[("lilac.toml", LILAC), ("deep/grey.toml", &grey), ("mica.toml", MICA), ("stone.toml", STONE)])
}

/// The stone with switches, and a material for its veins.
fn veined() -> Workshop {
    let workshop = workshop();
    workshop.write("pale.toml", LILAC.replace("lilac", "pale").replace("0.6, 0.5, 0.7", "0.9, 0.9, 0.8"));
    workshop.write("stone.toml", STONE.to_owned() + SWITCHES);
    workshop
}

#[test]
fn surfaces_are_checked_and_baked_with_their_materials() {
    let workshop = workshop();
    let run = workshop.run(&["check", "stone.toml", "mica.toml"]).exits(0);
    assert!(run.stdout.starts_with("stone.toml: ok, surface of 3 materials\nmica.toml: ok"), "{}", run.stdout);
    workshop.run(&["bake", "stone.toml", "mica.toml", "--out", "out", "--depfile", "out.d"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let names: Vec<&str> =
        manifest["materials"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    // Files that were given come first, then those that the surface names.
    assert_eq!(names, ["mica", "lilac", "grey"]);
    let surface = &manifest["surfaces"][0];
    assert_eq!(surface["cells"]["materials"], serde_json::json!([1, 2]));
    assert_eq!(surface["glitter"]["cells"]["materials"], serde_json::json!([0]));
    let depfile = workshop.text("out.d");
    assert!(["stone.toml", "deep/grey.toml"].iter().all(|file| depfile.contains(file)), "{depfile}");
    // A material of the surface is an input of the bake.
    workshop.edit("deep/grey.toml", |text| text.replace("0.2, 0.3, 0.1", "0.2, 0.3, 0.2"));
    let run = workshop.run(&["bake", "stone.toml", "mica.toml", "--out", "out", "--check"]).exits(1);
    assert!(run.stdout.contains("changed: grey"), "{}", run.stdout);
    for target in ["wgsl", "glsl450", "hlsl", "msl", "glsl-es300"] {
        let shader = workshop.run(&["shader", "stone.toml", "--target", target]).exits(0).stdout;
        assert!(shader.contains("luthier_pick(") && shader.contains("LUTHIER_SURFACE_STONE"), "{target}");
    }
    let without = workshop.run(&["shader", "lilac.toml"]).exits(0).stdout;
    assert!(!without.contains("luthier_pick") && !without.contains("LUTHIER_SURFACE"));
}

#[test]
fn switches_are_checked_and_baked() {
    let workshop = veined();
    let run = workshop.run(&["check", "stone.toml"]).exits(0);
    assert!(run.stdout.starts_with("stone.toml: ok, surface of 4 materials"), "{}", run.stdout);
    workshop.run(&["bake", "stone.toml", "--out", "out"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let names: Vec<&str> =
        manifest["materials"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["lilac", "grey", "pale", "mica"]);
    assert_eq!(
        manifest["surfaces"][0]["switches"],
        serde_json::json!([
            {
                "noise": { "seed": 5, "frequency": 5.0, "octaves": 3, "between": [-0.1, 0.1] },
                "cells": { "seed": 6, "frequency": 40.0, "materials": [2, 3] },
            },
            {
                "tiles": { "seed": 7, "frequency": 6.0, "share": 0.4 },
                "cells": { "seed": 0, "frequency": 20.0, "materials": [0] },
            },
        ])
    );
    assert_eq!(manifest["surfaces"][0]["glitter"]["cells"]["materials"], serde_json::json!([3]));
    for target in ["wgsl", "glsl450", "hlsl", "msl", "glsl-es300"] {
        let shader = workshop.run(&["shader", "stone.toml", "--target", target]).exits(0).stdout;
        assert!(shader.contains("luthier_perlin("), "{target}");
    }
    workshop.write("stone.toml", STONE);
    let without = workshop.run(&["bake", "stone.toml", "--out", "out"]).exits(0);
    assert!(workshop.json("out/manifest.json")["surfaces"][0].get("switches").is_none(), "{}", without.stdout);
    assert!(!workshop.run(&["shader", "stone.toml"]).exits(0).stdout.contains("luthier_perlin"));
}

#[test]
fn what_cannot_be_baked_is_pointed_at() {
    let workshop = veined();
    workshop.write("bumpy.toml", MICA.replace("\"mica\"", "\"bumpy\"") + "[effects.glitter]\n");
    for (from, to, words) in [
        ("lilac.toml", "violet.toml", ["cannot read violet.toml", "stone.toml:7:14"]),
        ("lilac.toml", "stone.toml", ["is a surface", "stone.toml:7:14"]),
        ("mica.toml", "bumpy.toml", ["bumpy.toml has glitter", "stone.toml:14:14"]),
        ("\"stone\"", "\"mica\"", ["has this name", "stone.toml:2:8"]),
        ("filled", "filed", ["did you mean `filled`?", "stone.toml:12:1"]),
        ("surface = 1", "surface = 2", ["`surface` must be 1", "stone.toml:1"]),
        ("pale.toml", "paler.toml", ["cannot read paler.toml", "stone.toml:18:50"]),
        ("[-0.1, 0.1]", "[0.1, -0.1]", ["between = [-0.1, 0.1]", "stone.toml:17:59"]),
        ("share", "filled", ["unknown key `filled`", "stone.toml:21:36"]),
    ] {
        workshop.write("stone.toml", (STONE.to_owned() + SWITCHES).replace(from, to));
        for verb in ["check", "bake"] {
            workshop.run(&[verb, "stone.toml"]).exits(1).says(&words);
        }
    }
    workshop.write("stone.toml", STONE);
    workshop.run(&["gallery", "stone.toml", "-o", "x.png"]).exits(1).says(&["this is a surface, not a material"]);
    let other =
        ["eval", "stone.toml", "--model", "heterogeneous", "--other", "mica.toml", "--wi", "0,0", "--wo", "0,0"];
    workshop.run(&other).exits(2).says(&["a surface has materials of its own"]);
}

/// The command at places of the surface, against `luthier_pick` and `luthier_eval_at`. Places at the edges of cells and of switches are left
/// out.
#[cfg(feature = "gpu")]
#[test]
fn places_are_those_of_the_shader() {
    use glam::{DVec2, DVec3};
    use luthier::{Bake, MemoryStore, Sources, surface_map};
    use luthier_export::Shader;
    use luthier_manifest::Form;

    let Some(gpu) = super::twin::gpu() else { return };
    let workshop = veined();
    let sources = Sources::read([workshop.path("stone.toml")]).unwrap();
    let materials: Vec<_> = sources.materials.iter().map(|source| source.material().unwrap().clone()).collect();
    let surfaces = sources.surface_entries();
    let map = surface_map(&surfaces[0]);
    let bake = Bake { surfaces, ..Bake::wgsl(&[Form::Full]) };
    let mut package = bake.package(&materials, &MemoryStore::default()).unwrap();
    // The place comes in as the direction of a light, which is the same for all.
    let body = "let pick = luthier_pick(0u, wi.xy);\nvar place = luthier_place();\nplace.normal = pick.normal;\n\
                return luthier_eval_at(place, pick.material, vec3<f32>(0.5, 0.0, 0.8660254), wo);";
    let wgsl = package.wgsl(Form::Full).unwrap().replace("fn luthier_eval(", "fn emitted_eval(")
        + &format!("\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n");
    package.shaders = vec![Shader::wgsl(Form::Full, wgsl)];
    let scene = gpu.scene(&package, Form::Full).unwrap();

    let (mut seen, mut worst) = (std::collections::BTreeMap::new(), 0.0f64);
    for i in 1..=80u32 {
        let part = |step: f64| f64::from((f64::from(i) * step).fract() as f32);
        let uv = DVec2::new(part(0.754_877_666), part(0.569_840_291));
        let near = |d: DVec2| map.pick(uv + 1e-5 * d) == map.pick(uv);
        if ![DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].iter().all(|&d| near(d)) {
            continue;
        }
        let (theta, phi) = (80.0 * part(0.819_172_513), 360.0 * part(0.671_043_606));
        let (place, eye) = (format!("{},{}", uv.x, uv.y), format!("{theta},{phi}"));
        let command = ["eval", "stone.toml", "--model", "weidlich-wilkie", "--three-wavelengths", "--json", "--uv"];
        let json = workshop.run(&[&command[..], &[&place, "--wi", "30,0", "--wo", &eye]].concat()).exits(0).json();
        let expected = [0, 1, 2].map(|c: usize| json["values"][0]["value"][c].as_f64().unwrap());
        let (sin, cos) = libm::sincos(theta.to_radians());
        let wo = DVec3::new(sin * libm::cos(phi.to_radians()), sin * libm::sin(phi.to_radians()), cos);
        let at = [uv.x as f32, uv.y as f32, 0.5];
        let found = scene.evaluate(0, &[(at, wo.as_vec3().to_array())]).unwrap()[0];
        worst = worst.max(super::twin::error(found, expected));
        *seen.entry(json["material"].as_str().unwrap().to_owned()).or_insert(0) += 1;
        assert_eq!(json["surface"], "stone");
    }
    assert!(worst < 2e-5, "{worst}");
    assert!(seen.len() == 4 && seen.values().all(|count| *count >= 5), "{seen:?}");
}
