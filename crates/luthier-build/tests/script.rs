//! What a build script tells Cargo, and the module that it writes, as rustc and a program read it.

use std::fs;
use std::path::Path;
use std::process::Command;

use luthier::{Bake, Form, Package, Target};
use luthier_build::{Build, Told};

const RED: &str = "schema = 1\nname = \"red\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.05, 0.05]\n";

/// A name that begins with a digit in Rust, and tables.
const GOLD: &str = "schema = 1\nname = \"24-carat\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.05\n[bake]\nmodel = \"microfacet\"\n";

/// A map that is not there.
const LEATHER: &str = "schema = 1\nname = \"leather\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n\
                       [[layer]]\ntype = \"diffuse\"\nalbedo = 0.3\n[layer.maps]\nalbedo = \"grain.png\"\n";

/// A scene, which the baker of packages does not bake.
const SHELF: &str = "scene = 1\nname = \"shelf\"\n[[material]]\nfile = \"red.toml\"\n\
                     [[light]]\ntype = \"directional\"\nfrom_eye_deg = 40\n[budget]\nmax_rel = 0.1\n";

/// A folder `materials` with files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("materials")).unwrap();
    for (name, text) in files {
        fs::write(folder.path().join("materials").join(name), text).unwrap();
    }
    folder
}

/// A build of the folder, with paths from the folder in place of whole ones.
fn told(folder: &Path, build: &Build<'_>) -> Told {
    let build = Build { paths: vec![folder.join("materials")], ..build.clone() };
    let Told { lines, faults, is_baked } = build.in_folder(&folder.join("out"));
    let root = format!("{}/", folder.display());
    Told { lines: lines.iter().map(|line| line.replace(&root, "")).collect(), faults, is_baked }
}

fn plain() -> Build<'static> {
    Build::of(["materials"])
}

#[test]
fn a_folder_is_baked() {
    let folder = folder(&[("red.toml", RED), ("gold.toml", GOLD)]);
    let told = told(folder.path(), &plain());
    assert!(told.is_baked && told.faults.is_empty(), "{told:?}");
    let read = ["materials", "materials/gold.toml", "materials/red.toml"];
    assert_eq!(told.lines, read.map(|path| format!("cargo::rerun-if-changed={path}")));
    let package = Package::read(&folder.path().join("out/materials")).unwrap();
    assert_eq!(package.manifest.materials.len(), 2);
    package.wgsl(Form::Baked).unwrap();
}

/// A second build that reads the same writes no file.
#[test]
fn an_equal_build_leaves_the_module_alone() {
    let folder = folder(&[("red.toml", RED)]);
    let module = folder.path().join("out/materials.rs");
    let mut times = [0, 1].map(|_| {
        told(folder.path(), &plain());
        fs::metadata(&module).unwrap().modified().unwrap()
    });
    assert_eq!(times[0], times[1]);
    fs::write(folder.path().join("materials/gold.toml"), GOLD).unwrap();
    told(folder.path(), &plain());
    times[1] = fs::metadata(&module).unwrap().modified().unwrap();
    assert!(times[1] > times[0]);
}

#[test]
fn diagnostics_are_those_of_cargo() {
    let bad = folder(&[("red.toml", RED), ("leather.toml", LEATHER)]);
    let refused = told(bad.path(), &plain());
    assert!(!refused.is_baked);
    assert!(refused.lines.contains(&"cargo::rerun-if-changed=materials/leather.toml".to_owned()), "{refused:?}");
    let error = refused.lines.iter().find(|line| line.starts_with("cargo::error=materials/leather.toml:")).unwrap();
    assert!(error.contains("grain.png"), "{error}");
    assert!(refused.faults.contains("albedo = \"grain.png\""), "the line of the file: {}", refused.faults);
    assert!(!bad.path().join("out").exists(), "nothing is written");

    let scene = told(folder(&[("red.toml", RED), ("shelf.toml", SHELF)]).path(), &plain());
    let sentence = "cargo::error=materials/shelf.toml is a scene";
    assert!(!scene.is_baked && scene.lines.iter().any(|line| line.starts_with(sentence)), "{scene:?}");

    let dim = "schema = 1\nname = \"dim\"\n[[layer]]\ntype = \"conductor\"\nf0 = 0.9\nalpha = 0.5\n[bake]\nmasking = \"implicit\"\nmodel = \"microfacet\"\n";
    let doubted = told(folder(&[("dim.toml", dim)]).path(), &plain());
    let warning = "cargo::warning=materials/dim.toml:";
    assert!(doubted.is_baked && doubted.lines.iter().any(|line| line.starts_with(warning)), "{doubted:?}");

    let none = told(folder(&[]).path(), &plain());
    let [watched, error] = none.lines.as_slice() else { panic!("{none:?}") };
    assert_eq!(watched, "cargo::rerun-if-changed=materials", "so that the script runs when a file comes");
    assert!(error.starts_with("cargo::error=no *.toml in the folder "), "{error}");
}

/// A program that includes the module is compiled and run: numbers, texts and bytes are those of the package.
#[test]
fn a_program_includes_the_module() {
    let folder = folder(&[("red.toml", RED), ("gold.toml", GOLD)]);
    let bake = Bake { targets: vec![Target::Wgsl, Target::SpirV], ..Bake::wgsl(&[Form::Baked]) };
    let build = Build { name: "metals".to_owned(), bake, ..plain() };
    assert!(told(folder.path(), &build).is_baked);
    let out = folder.path().join("out");
    let package = Package::read(&out.join("metals")).unwrap();

    let program = r#"
        #![deny(warnings)]
        mod metals { include!("metals.rs"); }
        use metals::{FILES, MATERIAL_BUFFER, material, shader, table};
        fn main() {
            println!("{} {} {:?}", material::_24_CARAT, material::RED, material::NAMES);
            println!("{} {} {}", shader::BAKED_WGSL.len(), shader::BAKED_SPIRV.len() % 4, table::FRESNEL.len() % 4);
            println!("{} {}", MATERIAL_BUFFER.len() % 16, FILES.len());
        }
    "#;
    fs::write(out.join("main.rs"), program).unwrap();
    let rustc = |arguments: &[&str]| {
        let output = Command::new("rustc").args(arguments).current_dir(&out).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    rustc(&["--edition=2024", "main.rs", "-o", "main"]);
    let output = Command::new(out.join("main")).output().unwrap();
    let wgsl = package.wgsl(Form::Baked).unwrap().len();
    let files = 2 + package.manifest.shaders.len() + package.manifest.tables.len();
    let expected = format!("0 1 [\"24-carat\", \"red\"]\n{wgsl} 0 0\n0 {files}\n");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
}
