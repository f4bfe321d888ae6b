//! `luthier import`: glTF to material files that bake.

use std::fs;

use luthier_workshop::root;

use crate::workshop::Workshop;

/// Lacquer over paint whose roughness and metal vary, and a film on titanium.
fn car() -> String {
    fs::read_to_string(root().join("crates/luthier-cli/tests/cli/bake/car.gltf")).unwrap()
}

#[test]
fn what_is_imported_bakes() {
    let workshop = Workshop::with(&[("car.gltf", &car())]);
    let said = workshop.run(&["import", "car.gltf", "-o", "m"]).exits(0).stdout;
    assert!(said.contains("car.gltf: 2 materials") && said.contains("dropped: KHR_materials_sheen"), "{said}");
    assert!(workshop.text("m/paint.toml").contains("darkening = false"));
    let report = workshop.json("m/import.json");
    let properties = &report["sources"][0]["materials"][0]["properties"];
    assert!(properties.as_array().is_some_and(|lines| lines.len() > 5), "{report}");
    workshop.run(&["check", "m"]).exits(0).says(&[]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let found = manifest["materials"].as_array().unwrap().iter().map(|material| {
        (
            material["name"].as_str().unwrap(),
            material["model"].as_str().unwrap(),
            material["maps"].as_array().unwrap().len(),
        )
    });
    assert_eq!(found.collect::<Vec<_>>(), [("exhaust", "lobes", 0), ("paint", "lobes", 2)]);
}

/// Nothing is replaced without a word, and a broken file leaves the folder as it was.
#[test]
fn files_are_replaced_by_force_alone() {
    let workshop = Workshop::with(&[("car.gltf", &car()), ("broken.gltf", "{\"asset\": {\"version\": \"2.0\"}}")]);
    workshop.run(&["import", "car.gltf", "broken.gltf", "-o", "m"]).fails(1, &["broken.gltf", "no materials"]);
    assert!(!workshop.path("m").exists());
    workshop.run(&["import", "car.gltf", "-o", "m", "--json"]).exits(0).json();
    let first = workshop.tree("m");
    workshop.edit("m/paint.toml", |text| text.replace("0.25", "0.3"));
    let edited = workshop.tree("m");
    workshop.run(&["import", "car.gltf", "-o", "m"]).fails(2, &["is there already", "--force"]);
    assert!(workshop.tree("m") == edited);
    workshop.run(&["import", "car.gltf", "-o", "m", "--force"]).exits(0);
    assert!(workshop.tree("m") == first);
    // Two files of the same names get numbers, and one copy of pictures that are alike.
    workshop.run(&["import", "car.gltf", "car.gltf", "-o", "two"]).exits(0);
    assert!(workshop.text("two/paint-2.toml").contains("name = \"paint-2\""));
    let pictures = |folder: &str| fs::read_dir(workshop.path(folder)).unwrap().count();
    assert_eq!(pictures("two/maps"), pictures("m/maps"));
    workshop.run(&["check", "two"]).exits(0);
    workshop.run(&["import", "none.gltf", "-o", "x"]).fails(3, &["none.gltf"]);
    workshop.run(&["import", "car.gltf", "-o", "car.gltf"]).fails(3, &["car.gltf"]);
}
