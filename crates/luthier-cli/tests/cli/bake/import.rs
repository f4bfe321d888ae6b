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

/// The page has what the text has, and is none of the files of the import.
#[test]
fn what_became_of_each_property_is_a_page() {
    let workshop = Workshop::with(&[("car.gltf", &car())]);
    workshop.run(&["import", "car.gltf", "-o", "m", "--html", "car.html"]).exits(0);
    let page = workshop.text("car.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("KHR_materials_sheen"), "{page}");
    assert!(page.contains("paint.toml") && page.contains("class=\"dropped\">dropped"), "{page}");
    workshop.run(&["import", "car.gltf", "-o", "n", "--html", "n/paint.toml"]).fails(2, &["n/paint.toml", "page"]);
    assert!(!workshop.path("n").exists());
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

/// Pictures of several files that have one name get numbers, none of which is the name of another picture of their file.
#[test]
fn renamed_pictures_are_those_of_their_materials() {
    let workshop = Workshop::new();
    for (name, grey) in [("first/a.png", 10), ("second/a.png", 20), ("second/a-2.png", 30)] {
        let path = workshop.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        image::RgbImage::from_pixel(2, 2, image::Rgb([grey; 3])).save(path).unwrap();
    }
    let file = |pictures: &[&str]| {
        let all = |text: &dyn Fn(usize) -> String| (0..pictures.len()).map(text).collect::<Vec<_>>().join(", ");
        let images = all(&|i| format!("{{\"uri\": \"{}\"}}", pictures[i]));
        let textures = all(&|i| format!("{{\"source\": {i}}}"));
        let materials = all(&|i| {
            format!(
                "{{\"name\": \"m{i}\", \"pbrMetallicRoughness\": {{\"metallicFactor\": 0, \"baseColorTexture\": {{\"index\": {i}}}}}}}"
            )
        });
        format!(
            "{{\"asset\": {{\"version\": \"2.0\"}}, \"images\": [{images}], \"textures\": [{textures}], \"materials\": [{materials}]}}"
        )
    };
    workshop.write("first/x.gltf", file(&["a.png"]));
    workshop.write("second/x.gltf", file(&["a.png", "a-2.png"]));
    workshop.run(&["import", "first/x.gltf", "second/x.gltf", "-o", "m"]).exits(0);
    for (material, grey) in [("m0", 10), ("m0-2", 20), ("m1", 30)] {
        let text = workshop.text(&format!("m/{material}.toml"));
        let path = text.split("image = \"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        let picture = image::open(workshop.path(&format!("m/{path}"))).unwrap().into_rgb8();
        assert_eq!(picture.get_pixel(0, 0).0, [grey; 3], "{material}: {path}");
    }
}
