//! `compare`.

use luthier_workshop::material_texts::{lacquer, matte};

use crate::workshop::Workshop;

const SMALL: [&str; 6] = ["--size", "32", "--samples", "1", "--environment-samples", "8"];

#[test]
fn tables_and_arithmetic_look_alike() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let compare = |a: &str, b: &str, more: &[&str]| {
        let args = ["compare", "lacquer.toml", "--a", a, "--b", b, "-o", "seen"];
        workshop.run(&[&args[..], &SMALL, more].concat())
    };
    let run = compare("baked", "full", &["--json"]);
    if run.lacks_adapter() {
        return;
    }
    let json = run.exits(0).json();
    let number = |key: &str| json[key].as_f64().unwrap();
    // Three wavelengths in both, so only tables and arithmetic differ: below what is seen, but not nothing.
    assert!(number("rms_err") > 0.0 && number("rms_err") < 1e-2, "{json}");
    assert!(number("flip_mean") > 0.0 && number("flip_mean") < 0.05, "{json}");
    assert!(number("flip_max") <= 1.0 && number("max_abs_err") >= number("rms_err"), "{json}");
    assert_eq!(workshop.files("seen"), ["a.png", "b.png", "difference.png", "flip.png"]);
    for name in ["a.png", "b.png", "difference.png", "flip.png"] {
        let picture = image::open(workshop.path("seen").join(name)).unwrap();
        assert_eq!((picture.width(), picture.height()), (32, 32), "{name}");
    }
    let same = compare("full", "full", &["--json"]).exits(0).json();
    assert_eq!((same["rms_err"].as_f64(), same["flip_max"].as_f64()), (Some(0.0), Some(0.0)));
    // Another model is another picture.
    let models = compare("elek", "phong/full", &["--json"]).exits(0).json();
    assert_eq!((models["a"].as_str(), models["b"].as_str()), (Some("elek/baked"), Some("phong/full")));
    assert!(models["flip_mean"].as_f64() > json["flip_mean"].as_f64(), "{models}");
    let text = compare("baked", "full", &[]).exits(0).stdout;
    assert!(text.contains("a baked, b full") && text.contains("rmse") && text.contains("flip"), "{text}");
}

/// More samples are nearer to another simulation, and no nearer to a model than its error.
#[test]
fn a_simulation_in_place_of_a_shader() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let compare = |a: &str, b: &str, more: &[&str]| {
        let args = ["compare", "lacquer.toml", "--a", a, "--b", b, "-o", "seen"];
        workshop.run(&[&args[..], &SMALL, more].concat())
    };
    let run = compare("elek", "simulated/64", &["--json"]);
    if run.lacks_adapter() {
        return;
    }
    let few = run.exits(0).json();
    let many = compare("elek", "simulated/1024", &["--json"]).exits(0).json();
    assert_eq!((few["a"].as_str(), few["b"].as_str()), (Some("elek/baked"), Some("simulated/64")));
    let number = |json: &serde_json::Value, key: &str| json[key].as_f64().unwrap();
    assert!(number(&many, "noise") < 0.4 * number(&few, "noise"), "{few} {many}");
    assert!(number(&many, "rms_err") > number(&many, "noise"), "{many}");
    let text = compare("simulated", "full", &[]).exits(0).stdout;
    assert!(text.contains("a simulated/256, b full") && text.contains("of which noise"), "{text}");
    for bad in ["simulated/0", "simulated/x", "simulatedly"] {
        workshop.run(&["compare", "lacquer.toml", "--b", bad, "-o", "no"]).fails(2, &[bad, "simulated/N"]);
    }
}

#[test]
fn what_cannot_be_compared() {
    let workshop = Workshop::with(&[("a.toml", &matte("ash"))]);
    workshop.run(&["compare", "a.toml", "--b", "fast", "-o", "no"]).fails(2, &["`fast`", "baked, full"]);
    workshop.run(&["compare", "a.toml", "--b", "fong/full", "-o", "no"]).fails(2, &["`fong`", "phong"]);
    workshop.run(&["compare", "ash", "--a", "phong", "-o", "no"]).fails(1, &[".toml"]);
    workshop.run(&["compare", "a.toml", "--shape", "grid", "-o", "no"]).fails(1, &["grid"]);
    workshop.run(&["compare", "a.toml"]).fails(2, &["required"]);
    assert!(!workshop.path("no").exists());
}
