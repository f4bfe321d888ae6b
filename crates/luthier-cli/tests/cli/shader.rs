use std::process::Command;

use crate::material_texts::{NOISE, film, gold, lacquer, matte};
use crate::workshop::{Workshop, is_installed};

const FORMS: [&str; 2] = ["baked", "full"];

/// Names on the command line, and endings in a bake.
const TARGETS: [(&str, &str); 3] = [("wgsl", "wgsl"), ("glsl450", "450.glsl"), ("glsl-es300", "es300.glsl")];

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
            for (target, ending) in TARGETS {
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

#[test]
fn complete_shaders_pass_the_khronos_compiler() {
    if !is_installed("glslangValidator", "glslang-tools") {
        return;
    }
    let workshop = sets();
    for set in ["all", "gold", "matte"] {
        for form in FORMS {
            for target in ["glsl450", "glsl-es300"] {
                let run = workshop.run(&["shader", set, "--form", form, "--target", target, "--complete"]).exits(0);
                workshop.write("shader.frag", &run.stdout);
                let verdict = Command::new("glslangValidator").arg(workshop.path("shader.frag")).output().unwrap();
                let said = String::from_utf8_lossy(&verdict.stdout);
                assert!(verdict.status.success(), "{set} {form} {target}\n{said}\n{}", run.stdout);
            }
        }
    }
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
    workshop.run(&["shader", "all", "gold"]).fails(1, &["`gold`", "all/gold.toml", "gold/gold.toml"]);
    workshop.run(&["shader", "all", "--target", "hlsl"]).fails(2, &["hlsl", "--target"]).says(&["glsl450"]);
    workshop.run(&["shader", "all", "--form", "half"]).fails(2, &["half", "--form"]);
}
