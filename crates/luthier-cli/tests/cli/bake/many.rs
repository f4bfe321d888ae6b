//! Bakes of many materials, of some shaders only, and of too much.

use std::fs;
use std::process::Command;

use luthier_manifest::{LAYER_WORDS, MATERIAL_WORDS, Manifest, MaterialTexture, SIDE};
use luthier_workshop::material_texts::{lacquer, matte};
use serde_json::Value;

use crate::library::Library;
use crate::workshop::Workshop;

/// A generated library. Its tables are tested in the baker's tests.
fn library(count: u32) -> Workshop {
    let (workshop, library) = (Workshop::new(), Library { seed: 7, variety: 50 });
    for number in 0..count {
        workshop.write(&format!("m/{number:04}.toml"), library.material(number));
    }
    workshop
}

#[test]
fn a_thousand_materials_bake() {
    let workshop = library(1000);
    workshop.run(&["bake", "m", "-q", "--target", "wgsl,glsl-es300", "--form", "full"]).exits(0);
    let manifest = Manifest::from_json(&workshop.text("out/manifest.json")).unwrap();
    assert_eq!(manifest.materials.len(), 1000);
    let layers: usize = manifest.materials.iter().map(|material| material.layers.len()).sum();
    assert!((1..=4).all(|count| manifest.materials.iter().any(|material| material.layers.len() == count)));

    let words = 1000 * MATERIAL_WORDS + layers * LAYER_WORDS;
    let MaterialTexture { width, height } = manifest.material_texture;
    assert_eq!((width, height as usize), (SIDE, words.div_ceil(2048)));
    let buffer = fs::read(workshop.path("out/materials.bin")).unwrap();
    assert_eq!(buffer.len(), 16 * width as usize * height as usize);
    assert!(buffer[16 * words..].iter().all(|byte| *byte == 0));

    let written: Vec<&str> = manifest.shaders.iter().map(|shader| shader.file.path.as_str()).collect();
    assert_eq!(written, ["shaders/full.wgsl", "shaders/full.es300.glsl"]);
    luthier_shader::validate(&workshop.text("out/shaders/full.wgsl")).unwrap();
    let text = workshop.text("out/shaders/full.es300.glsl");
    let call = "luthier_eval(999u, vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0))";
    workshop.write(
        "full.frag",
        format!(
            "#version 300 es\nprecision highp float;\nprecision highp int;\n{text}\n\
             out vec4 color;\nvoid main() {{\n    color = vec4({call}, 1.0);\n}}\n"
        ),
    );
    match Command::new("glslangValidator").arg(workshop.path("full.frag")).output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout)),
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "{error}: install the package glslang-tools");
            eprintln!("skipped: {error}");
        }
    }
}

#[test]
fn shaders_are_written_as_asked() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    let shaders = |workshop: &Workshop| -> Vec<String> { workshop.files("out/shaders") };
    workshop.run(&["bake", "a.toml", "-q", "--target", "msl,wgsl", "--target", "spirv", "--form", "baked"]).exits(0);
    assert_eq!(shaders(&workshop), ["baked.metal", "baked.spv", "baked.wgsl"]);
    let module = fs::read(workshop.path("out/shaders/baked.spv")).unwrap();
    assert_eq!(module[..4], 0x0723_0203_u32.to_le_bytes(), "the magic number of SPIR-V");

    // Tables are for the form that reads them.
    workshop.run(&["bake", "a.toml", "-q", "--form", "full", "--target", "hlsl"]).exits(0);
    assert_eq!(shaders(&workshop), ["full.hlsl"]);
    let manifest = workshop.json("out/manifest.json");
    assert_eq!(manifest["tables"], Value::Array(Vec::new()));
    assert_eq!(manifest["bindings"].as_array().unwrap().len(), 1);
    assert!(!workshop.path("out/tables/fresnel.ktx2").exists());

    workshop.run(&["bake", "a.toml", "--target", "cg"]).fails(2, &["cg"]).says(&["glsl-es300", "spirv"]);
    workshop.run(&["bake", "a.toml", "--form", "full", "--max-abs", "1e-3"]).fails(2, &["--form full", "no tables"]);
    assert_eq!(shaders(&workshop), ["full.hlsl"]);
}

#[test]
fn what_no_texture_holds_is_refused_before_any_work() {
    let workshop = Workshop::new();
    for number in 0..5 {
        let material = lacquer(&format!("m{number}")).replace("[8, 8]", "[4096, 4096]");
        workshop.write(&format!("m/{number}.toml"), material.replacen("1.5", &format!("1.5{number}"), 1));
    }
    let words = ["bake", "m", "-q", "--model", "belcour"];
    let run = workshop.run(&words);
    let table = "5 tiles of 4096 x 4096 texels in the fgd table";
    run.fails(1, &[table, "8192 x 8192", "holds 4", "`size` in [bake.fgd]", "several folders"]);
    let check = workshop.run(&["check", "m", "--model", "belcour"]).exits(1);
    check.says(&["m/0.toml:2", table, "holds 4"]);
    workshop.run(&["check", "m/0.toml", "m/1.toml", "m/2.toml", "m/3.toml", "--model", "belcour"]).exits(0);
    let told = workshop.run(&[&words[..], &["--events"]].concat()).exits(1).stderr;
    assert!(["planned", "finished"].iter().all(|event| !told.contains(&format!("\"{event}\""))), "{told}");
    assert!(!workshop.path("out").exists());
}

#[test]
fn names_that_are_one_in_shaders_are_refused_before_any_work() {
    let workshop = Workshop::with(&[("a.toml", &matte("a-b")), ("b.toml", &matte("A-B"))]);
    let run = workshop.run(&["bake", "a.toml", "b.toml"]).exits(1);
    run.says(&["`A-B` and `a-b` of a.toml:2", "LUTHIER_MATERIAL_A_B", "b.toml:2:8", "nothing was written"]);
    assert!(!workshop.path("out").exists());
}
