//! The build script of the examples, run as Cargo runs one: in a folder with `materials`, with OUT_DIR.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use luthier::{Form, Package};

const RED: &str = "schema = 1\nname = \"red\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.05, 0.05]\n";

/// A map that is not there.
const LEATHER: &str = "schema = 1\nname = \"leather\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n\
                       [[layer]]\ntype = \"diffuse\"\nalbedo = 0.3\n[layer.maps]\nalbedo = \"grain.png\"\n";

/// A scene, which the baker of packages does not bake.
const SHELF: &str = "scene = 1\nname = \"shelf\"\n[[material]]\nfile = \"red.toml\"\n\
                     [[light]]\ntype = \"directional\"\nfrom_eye_deg = 40\n[budget]\nmax_rel = 0.1\n";

/// The example beside this test, which Cargo builds with it.
fn script() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    test.parent().and_then(Path::parent).unwrap().join(format!("examples/build{}", std::env::consts::EXE_SUFFIX))
}

fn run(files: &[(&str, &str)]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("materials")).unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join("materials").join(name), text).unwrap();
    }
    let output =
        Command::new(script()).current_dir(&folder).env("OUT_DIR", folder.path().join("out")).output().unwrap();
    (folder, output)
}

#[test]
fn the_script_has_at_most_twenty_lines() {
    assert!(include_str!("../examples/build.rs").lines().count() <= 20);
}

#[test]
fn a_folder_is_baked() {
    let (folder, output) = run(&[("red.toml", RED)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let told = String::from_utf8(output.stdout).unwrap();
    assert_eq!(
        told.lines().collect::<Vec<_>>(),
        ["cargo::rerun-if-changed=materials", "cargo::rerun-if-changed=materials/red.toml"]
    );
    let package = Package::read(&folder.path().join("out/materials")).unwrap();
    assert_eq!(package.manifest.materials[0].name, "red");
    package.wgsl(Form::Baked).unwrap();
}

#[test]
fn diagnostics_are_those_of_cargo() {
    let (folder, output) = run(&[("red.toml", RED), ("leather.toml", LEATHER)]);
    assert!(!output.status.success());
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("cargo::rerun-if-changed=materials/leather.toml\n"), "{told}");
    let error = told.lines().find(|line| line.starts_with("cargo::error=materials/leather.toml:")).unwrap();
    assert!(error.contains("grain.png"), "{told}");
    assert!(!folder.path().join("out").exists(), "nothing is written");

    let (_folder, output) = run(&[("red.toml", RED), ("shelf.toml", SHELF)]);
    let refused = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && refused.contains("materials/shelf.toml is a scene"), "{refused}");

    let dim = "schema = 1\nname = \"dim\"\n[[layer]]\ntype = \"conductor\"\nf0 = 0.9\nalpha = 0.5\n[bake]\nmasking = \"implicit\"\nmodel = \"microfacet\"\n";
    let (_folder, output) = run(&[("dim.toml", dim)]);
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && told.contains("cargo::warning=materials/dim.toml:"), "{told}");
}
