//! Folders of materials inside folders of materials: packages of their own.

use luthier_workshop::material_texts::{gold, matte};
use serde_json::json;

use crate::workshop::Workshop;

/// A folder of materials, one inside it with other ones of which one has the same name, and folders that are no packages.
fn folders() -> Workshop {
    let scene = "scene = 1\nname = \"s\"\n[[material]]\nfile = \"../matte.toml\"\n[[light]]\ntype = \"environment\"\n";
    Workshop::with(&[
        ("m/matte.toml", &matte("matte")),
        ("m/papers/gold.toml", &gold("gold")),
        ("m/papers/matte.toml", &matte("matte")),
        ("m/papers/deeper/other.toml", &gold("other")),
        ("m/scenes/s.toml", scene),
        ("m/settings/tool.toml", "[tool]\nname = \"of another program\"\n"),
    ])
}

fn names(manifest: &serde_json::Value) -> Vec<&str> {
    manifest["materials"].as_array().unwrap().iter().map(|material| material["name"].as_str().unwrap()).collect()
}

#[test]
fn a_folder_inside_is_a_package_of_its_own() {
    let workshop = folders();
    let json = workshop.run(&["bake", "m", "--json", "--depfile", "m.d"]).exits(0).json();
    assert_eq!(json["materials"], json!(["matte"]));
    assert_eq!(json["packages"].as_object().unwrap().len(), 1, "{json}");
    assert_eq!(json["packages"]["papers"]["materials"], json!(["gold", "matte"]));
    assert_eq!(json["packages"]["papers"]["manifest"], "out/papers/manifest.json");
    let [outer, inner] = ["out/manifest.json", "out/papers/manifest.json"].map(|path| workshop.json(path));
    assert_eq!((names(&outer), names(&inner)), (vec!["matte"], vec!["gold", "matte"]));
    assert!(!workshop.path("out/scenes").exists() && !workshop.path("out/settings").exists());
    let rule = "out/manifest.json: m/matte.toml \\\n  m/papers/gold.toml \\\n  m/papers/matte.toml \\\n  m/. \\\n  m/papers/.\n";
    assert_eq!(workshop.text("m.d"), rule, "one target");

    // The package is the one that its folder gives alone.
    workshop.run(&["bake", "m/papers", "--out", "other/alone", "--quiet"]).exits(0);
    for file in ["manifest.json", "materials.bin", "shaders/baked.wgsl", "tables/fresnel.ktx2"] {
        let read = |folder: &str| std::fs::read(workshop.path(&format!("{folder}/{file}"))).unwrap();
        assert!(read("out/papers") == read("other/alone"), "{file}");
    }

    // A file has no folders inside, and a bake of the outer one leaves the inner one's package as it is.
    workshop.run(&["bake", "m/matte.toml", "--quiet"]).exits(0);
    assert!(workshop.path("out/papers/manifest.json").exists());
}

#[test]
fn all_packages_are_checked_and_refused_together() {
    let workshop = folders();
    let lines = workshop.run(&["check", "m"]).exits(0).stdout;
    let files: Vec<&str> = lines.lines().map(|line| line.split(':').next().unwrap()).collect();
    assert_eq!(
        files,
        ["m/matte.toml", "m/papers/gold.toml", "m/papers/matte.toml"],
        "one name in two packages is no error"
    );
    workshop.run(&["bake", "m", "--quiet"]).exits(0);
    let check = ["bake", "m", "--check", "--json"];
    assert_eq!(workshop.run(&check).exits(0).json()["packages"]["papers"]["stale"], json!([]));

    workshop.edit("m/papers/gold.toml", |text| text + "\n# A remark.\n");
    let stale = workshop.run(&check).exits(1).json();
    assert_eq!((&stale["stale"], &stale["packages"]["papers"]["materials"]), (&json!([]), &json!(["gold"])));
    let text = workshop.run(&["bake", "m", "--check"]).exits(1).stdout;
    assert_eq!(text, "up to date: out/manifest.json\n\npapers:\nstale: manifest.json\nchanged: gold\n");

    // Neither package is written where one is refused.
    let before = workshop.text("out/manifest.json");
    workshop.edit("m/matte.toml", |text| text + "\n# A remark.\n");
    workshop.edit("m/papers/gold.toml", |text| text.replace("\"au\"", "\"ua\""));
    workshop.run(&["bake", "m"]).exits(1).says(&["m/papers/gold.toml:"]);
    assert_eq!(workshop.text("out/manifest.json"), before);
    workshop.run(&["check", "m"]).exits(1).says(&["m/papers/gold.toml:"]);
}
