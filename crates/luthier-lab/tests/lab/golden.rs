//! `scripts/golden.sh` and `texels`: a change of a number is told from one of a container.

use std::process::{Command, Output};

use luthier_lut::TexelFormat;
use luthier_texture::{Texture, ktx2};
use luthier_workshop::{Program, root};

use crate::workshop::{Lab, Workshop};

fn golden(workshop: &Workshop, more: &[&str]) -> Output {
    let mut script = Command::new("bash");
    script.arg(root().join("scripts/golden.sh").canonicalize().unwrap());
    let run = script.args(["--of", "bakes", "lists"]).args(more).current_dir(workshop.path(""));
    run.env("LUTHIER_LAB", Lab::PATH).output().unwrap()
}

/// A texture of four halves: 1, 2, 0.5 and a last one.
fn texture(last: [u8; 2]) -> Texture {
    let bytes = [[0x00, 0x3c], [0x00, 0x40], [0x00, 0x38], last].concat();
    Texture { format: TexelFormat::R16Float, width: 2, height: 2, bytes }
}

/// A bake whose texture is in a container, with a manifest that says so, and a shader.
fn bake(workshop: &Workshop, texture: &[u8], buffer: &[u8], shader: &str) {
    workshop.write("bakes/a/tables/fresnel.ktx2", texture);
    workshop.write("bakes/a/materials.bin", buffer);
    workshop.write("bakes/a/shaders/baked.wgsl", shader);
    workshop.write("bakes/a/manifest.json", format!("{{ \"bytes\": {} }}\n", texture.len()));
}

#[test]
fn a_number_is_told_from_a_container() {
    let workshop = Workshop::new();
    let quarter = texture([0x00, 0x34]);
    let (zstd, plain) = (ktx2::encode(&quarter).unwrap(), ktx2::encode_plain(&quarter).unwrap());
    assert_ne!(zstd, plain);
    bake(&workshop, &zstd, b"buffer", "fn f() {}\n");
    workshop.write("lists/.here", "");
    let said = |run: &Output| String::from_utf8_lossy(&run.stdout).into_owned();
    let first = golden(&workshop, &["--update"]);
    assert!(first.status.success(), "{}{}", said(&first), String::from_utf8_lossy(&first.stderr));
    let again = golden(&workshop, &[]);
    assert!(again.status.success() && said(&again).contains("2 files of numbers, 3 of forms"), "{}", said(&again));

    // What a list calls different, and the lines of it.
    let differs = |word: &str, files: &[&str]| {
        let run = golden(&workshop, &[]);
        let said = said(&run);
        assert_eq!(run.status.code(), Some(1), "{said}");
        assert!(said.contains(&format!("changed: {word}")), "{said}");
        let lines = said.lines().filter(|line| line.starts_with("> "));
        let found: Vec<&str> = lines.filter_map(|line| line.split("  ").nth(1)).collect();
        assert_eq!(found, files, "{said}");
    };
    // The same texels in another container, and another text of a shader; comments do not count.
    bake(&workshop, &plain, b"buffer", "// Words.\nfn f() {}\n");
    differs("form alone", &["a/manifest.json", "a/tables/fresnel.ktx2"]);
    bake(&workshop, &zstd, b"buffer", "fn g() {}\n");
    differs("form alone", &["a/shaders/baked.wgsl"]);
    // The last bit of a texel.
    bake(&workshop, &ktx2::encode(&texture([0x01, 0x34])).unwrap(), b"buffer", "fn f() {}\n");
    differs("identity: numbers", &["a/tables/fresnel.ktx2", "a/tables/fresnel.ktx2"]);
    bake(&workshop, &zstd, b"buffex", "fn f() {}\n");
    differs("identity alone", &["a/materials.bin"]);
}

#[test]
fn a_texture_that_cannot_be_decoded_is_named() {
    let workshop = Workshop::with(&[("bakes/a.ktx2", "none")]);
    workshop.run(&["texels", "bakes"]).fails(1, &["cannot decode bakes/a.ktx2"]);
    workshop.run(&["texels", "nowhere"]).fails(3, &["nowhere"]);
}
