//! `shader`.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

use luthier_workshop::material_texts::{NOISE, film, gold, lacquer, matte};
use luthier_workshop::{is_installed, root};

use crate::workshop::Workshop;

const FORMS: [&str; 2] = ["baked", "full"];

/// Targets that a bake writes: names on the command line, and endings.
const BAKED: [(&str, &str); 3] = [("wgsl", "wgsl"), ("glsl450", "450.glsl"), ("glsl-es300", "es300.glsl")];

fn sets() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("all/film.toml", film("film", NOISE));
    workshop.write("all/gold.toml", gold("gold"));
    workshop.write("all/lacquer.toml", lacquer("lacquer"));
    workshop.write("gold/gold.toml", gold("gold"));
    workshop.write("matte/matte.toml", matte("matte"));
    workshop
}

/// Tables need not be baked to know the shader: it is the one that a bake writes.
#[test]
fn it_prints_what_a_bake_writes() {
    let workshop = sets();
    for set in ["all", "gold", "matte"] {
        workshop.run(&["bake", set, "-q"]).exits(0);
        for form in FORMS {
            for (target, ending) in BAKED {
                let run = workshop.run(&["shader", set, "--form", form, "--target", target]).exits(0);
                let written = workshop.text(&format!("out/shaders/{form}.{ending}"));
                assert_eq!(run.stdout, written, "{set} {form} {target}");
                assert!(written.contains("luthier_eval"), "{set} {form} {target}");
            }
        }
    }
}

#[test]
fn the_default_is_wgsl_with_tables() {
    let workshop = sets();
    let default = workshop.run(&["shader", "all"]).exits(0).stdout;
    assert_eq!(default, workshop.run(&["shader", "all", "--target", "wgsl", "--form", "baked"]).stdout);
    assert!(default.contains("texture_2d<f32>"));
    assert!(!workshop.run(&["shader", "all", "--form", "full"]).stdout.contains("texture_2d"), "only the buffer");
}

/// Groups of functions are there where they are asked for, in a bake as well, whose manifest lists them.
#[test]
fn functions_are_asked_for() {
    let workshop = sets();
    let plain = workshop.run(&["shader", "all"]).exits(0).stdout;
    assert_eq!(plain, workshop.run(&["shader", "all", "--functions", "eval"]).exits(0).stdout);
    let text = workshop.run(&["shader", "all", "--functions", "sample,albedo"]).exits(0).stdout;
    for function in ["prepare", "light", "sample", "pdf", "albedo"] {
        let declaration = format!("fn luthier_{function}(");
        assert!(text.contains(&declaration) && !plain.contains(&declaration), "{function}");
    }
    let manifest = || serde_json::from_str::<serde_json::Value>(&workshop.text("out/manifest.json")).unwrap();
    workshop.run(&["bake", "all", "-q"]).exits(0);
    assert!(manifest().get("functions").is_none());
    workshop.run(&["bake", "all", "-q", "--functions", "albedo,sample"]).exits(0);
    assert_eq!(workshop.text("out/shaders/baked.wgsl"), text);
    assert_eq!(manifest()["functions"], serde_json::json!(["eval", "light", "sample", "albedo"]));
    let refusal = workshop.run(&["shader", "all", "--functions", "smaple"]).exits(2).stderr;
    assert!(refusal.contains("possible values: eval, light, sample, propose, albedo"), "{refusal}");
}

/// What no shader has is refused, not left out: the environment of a base alone, of `lobes` in the form `full`.
#[test]
fn an_environment_that_nothing_shows_is_refused() {
    let workshop = sets();
    for arguments in [
        &["shader", "matte", "--model", "lobes"][..],
        &["shader", "matte", "--model", "elek"],
        &["bake", "matte", "-q", "--no-fit"],
    ] {
        let refusal = workshop.run(&[arguments, &["--functions", "environment"]].concat()).exits(2).stderr;
        assert!(refusal.contains("there is none: leave it out"), "{arguments:?}: {refusal}");
    }
    assert!(!workshop.path("out").exists());
    let bake = ["bake", "gold", "-q", "--model", "elek", "--functions", "environment", "--out", "both"];
    workshop.run(&bake).exits(0);
    for form in ["baked", "full"] {
        let text = std::fs::read_to_string(workshop.path(&format!("both/shaders/{form}.wgsl"))).unwrap();
        assert!(text.contains("fn luthier_environment_outside("), "{form}");
    }
    for (model, form, lobe) in [
        ("lobes", "baked", "luthier_environment_lobes("),
        ("elek", "baked", "luthier_environment_outside("),
        ("elek", "full", "luthier_environment_outside("),
    ] {
        let arguments = ["shader", "gold", "--model", model, "--form", form, "--functions", "environment"];
        let text = workshop.run(&arguments).exits(0).stdout;
        assert!(text.contains("fn luthier_environment(") && text.contains(lobe), "{model} {form}");
    }
}

/// A set mentions the tables that it needs, and no other.
#[test]
fn tables_that_are_not_needed_are_not_mentioned() {
    let workshop = sets();
    for (set, needed) in [("all", 5), ("gold", 3), ("matte", 0)] {
        let text = workshop.run(&["shader", set]).exits(0).stdout;
        let mentioned: Vec<_> = ["fresnel", "distribution", "fgd", "phase", "thickness"]
            .into_iter()
            .filter(|kind| text.contains(&format!("luthier_{kind}:")))
            .collect();
        assert_eq!(mentioned.len(), needed, "{set}: {mentioned:?}");
    }
}

/// Every language, for the shipped materials: its file, and the command that judges it, but for the name of the file.
const JUDGES: [(&str, &str, &[&str]); 6] = [
    ("wgsl", "shader.wgsl", &["node", "TINT"]),
    ("glsl450", "shader.frag", &["glslangValidator", "-V", "-o", "from-glsl.spv"]),
    ("glsl-es300", "es.frag", &["glslangValidator"]),
    ("hlsl", "hlsl.frag", &["glslangValidator", "-D", "-V", "-e", "main", "-o", "from-hlsl.spv"]),
    ("spirv", "shader.spv", &["spirv-val", "--target-env", "vulkan1.1"]),
    // No compiler for it here.
    ("msl", "shader.metal", &[]),
];

#[test]
fn shaders_of_all_shipped_materials_are_valid() {
    let workshop = Workshop::new();
    let script = root().join("scripts/tint/validate.mjs");
    let at = |name: &str| root().join("materials").join(name).display().to_string();
    let fitted = ["copper-patina.toml", "red-lacquer.toml", "soap-film.toml"].map(at);
    // Fits are made once, and kept.
    let sets =
        [vec![at("papers")], vec![at(""), "--no-fit".to_owned()], [&fitted[..], &["--cache=kept".to_owned()]].concat()];
    for (set, (target, file, judge)) in sets.iter().flat_map(|set| JUDGES.map(|judge| (set, judge))) {
        let has_judge = match judge.first() {
            Some(&"node") => has_tint(&script),
            Some(&"spirv-val") => is_installed("spirv-val", "spirv-tools"),
            Some(program) => is_installed(program, "glslang-tools"),
            None => false,
        };
        for form in FORMS {
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            let how = ["shader", "--form", form, "--target", target, "--complete", "-o", file];
            let run = workshop.run(&[&how[..], &set].concat());
            assert_eq!(run.exits(0).stdout, "", "{form} {target}");
            let Some((program, arguments)) = judge.split_first().filter(|_| has_judge) else { continue };
            let mut command = Command::new(program);
            for argument in arguments {
                command.arg(if *argument == "TINT" { script.as_os_str() } else { OsStr::new(argument) });
            }
            let verdict = command.arg(file).current_dir(workshop.path("")).output().unwrap();
            let said = String::from_utf8_lossy(&verdict.stdout) + String::from_utf8_lossy(&verdict.stderr);
            assert!(verdict.status.success(), "{form} {target}\n{said}");
        }
    }
}

/// Whether the WGSL compiler of `scripts/tint` can run. On a build server it must.
fn has_tint(script: &Path) -> bool {
    if script.with_file_name("node_modules").exists() && is_installed("node", "nodejs") {
        return true;
    }
    let hint = "Tint is missing: run `npm install --prefix scripts/tint` (Debian packages nodejs, npm)";
    assert!(std::env::var_os("CI").is_none(), "{hint}");
    eprintln!("skipped: {hint}");
    false
}

#[test]
fn a_file_holds_what_is_printed() {
    let workshop = sets();
    for target in ["wgsl", "glsl450", "glsl-es300", "hlsl", "msl"] {
        let printed = workshop.run(&["shader", "all", "--target", target]).exits(0).stdout;
        let run = workshop.run(&["shader", "all", "--target", target, "-o", "written"]).exits(0);
        assert_eq!((workshop.text("written"), run.stdout.as_str()), (printed, ""), "{target}");
    }
    workshop.run(&["shader", "all", "-o", "nowhere/written"]).fails(3, &["nowhere"]);
}

/// A module begins with SPIR-V's magic number; a library has `OpCapability Linkage`, a shader has not.
#[test]
fn spirv_is_bytes() {
    let workshop = sets();
    let is_library = |complete: &[&str]| {
        let args = [&["shader", "all", "--target", "spirv", "--output", "module.spv"], complete].concat();
        workshop.run(&args).exits(0);
        let bytes = std::fs::read(workshop.path("module.spv")).unwrap();
        let words: Vec<u32> = bytes.chunks(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(words[0], 0x0723_0203);
        words.windows(2).any(|pair| pair == [0x0002_0011, 5])
    };
    assert!(is_library(&[]));
    assert!(!is_library(&["--complete"]));
}

/// `script` gives a program a terminal.
#[cfg(target_os = "linux")]
#[test]
fn spirv_is_not_for_a_terminal() {
    if !is_installed("script", "bsdutils") {
        return;
    }
    let workshop = sets();
    let luthier = assert_cmd::cargo::cargo_bin!("luthier");
    let command = format!("{} shader gold --target spirv", luthier.display());
    let mut script = Command::new("script");
    let output = script.current_dir(workshop.path("")).args(["-qec", &command, "/dev/null"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("-o"));
}

#[test]
fn complete_wgsl_has_an_entry_point() {
    let workshop = sets();
    for form in FORMS {
        let snippet = workshop.run(&["shader", "all", "--form", form]).exits(0).stdout;
        let complete = workshop.run(&["shader", "all", "--form", form, "--complete"]).exits(0).stdout;
        assert!(complete.contains("@fragment") && !snippet.contains("@fragment"));
    }
}

#[test]
fn refusals() {
    let workshop = sets();
    workshop.write("bad.toml", matte("bad").replace("albedo", "albeddo"));
    workshop.run(&["shader", "bad.toml"]).exits(1).says(&["bad.toml:6:1"]);
    workshop.run(&["shader", "nowhere.toml"]).fails(3, &["nowhere.toml"]);
    workshop.run(&["shader", "all", "gold"]).exits(1).says(&["`gold`: all/gold.toml:2 and gold/gold.toml:2"]);
    workshop.run(&["shader", "all", "--target", "cg"]).fails(2, &["cg", "--target"]).says(&["glsl450", "spirv"]);
    workshop.run(&["shader", "all", "--form", "half"]).fails(2, &["half", "--form"]);
}
