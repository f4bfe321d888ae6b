//! `luthier export`: materials to other formats.

use luthier_workshop::root;

use crate::workshop::Workshop;

const LACQUER: &str = "schema = 1\nname = \"lacquer\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.3\n\
                       [[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.8, 0.5, 0.2]\nmetallic = 1\nroughness = 0.4\n";

/// Numbers and errors are printed; with a folder the file, the report and nothing else is written, which the import reads.
#[test]
fn what_is_exported_imports() {
    let workshop = Workshop::with(&[("lacquer.toml", LACQUER)]);
    let quick =
        |words: &[&str]| workshop.run(&[&["export", "lacquer.toml", "--noise", "0.05", "--to"], words].concat());
    let said = quick(&["gltf"]).exits(0).stdout;
    assert!(said.starts_with("lacquer: colour (") && said.contains("4 numbers fitted, albedo off by 0."), "{said}");
    assert_eq!(workshop.files(""), ["lacquer.toml"]);
    for (format, file) in
        [("gltf", "materials.gltf"), ("openpbr", "materials.mtlx"), ("standard-surface", "materials.mtlx")]
    {
        let report = quick(&[format, "-o", format, "--json"]).exits(0).json();
        assert_eq!(workshop.files(format), ["export.json", file]);
        assert_eq!(report, workshop.json(&format!("{format}/export.json")));
        let material = &report["materials"][0];
        assert_eq!(material["numbers"]["metallic"], 1.0);
        assert!(material["max_albedo_err"].as_f64().unwrap() < 0.2, "{material}");
        assert_eq!(material["views"].as_array().unwrap().len(), 4);
        let imported = format!("again-{format}");
        workshop.run(&["import", &format!("{format}/{file}"), "-o", &imported]).exits(0);
        workshop.run(&["check", &imported]).exits(0);
    }
}

/// A file with a mistake, a missing one and a folder that has files already leave all as it was.
#[test]
fn nothing_is_written_but_all() {
    let broken = LACQUER.replace("1.5", "\"nothing\"");
    let workshop = Workshop::with(&[("lacquer.toml", LACQUER), ("broken.toml", &broken), ("file", "")]);
    let export = |words: &[&str]| workshop.run(&[&["export", "--to", "gltf", "--noise", "0.1"], words].concat());
    export(&["lacquer.toml", "broken.toml", "-o", "out"]).exits(1).says(&["broken.toml:5", "nothing was written"]);
    export(&["none.toml", "-o", "out"]).fails(3, &["none.toml"]);
    export(&["lacquer.toml", "-o", "file"]).fails(3, &["cannot make the folder file: a file is in its place"]);
    workshop.run(&["export", "lacquer.toml", "--to", "usd"]).fails(2, &["usd"]).says(&["openpbr"]);
    workshop.run(&["export", "lacquer.toml"]).exits(2).says(&["--to"]);
    assert!(!workshop.path("out").exists());
    export(&["lacquer.toml", "-o", "out"]).exits(0);
    let first = workshop.tree("out");
    workshop.write("out/materials.gltf", "mine");
    let edited = workshop.tree("out");
    export(&["lacquer.toml", "-o", "out"]).fails(2, &["out/export.json is there already", "--force"]);
    assert!(workshop.tree("out") == edited);
    export(&["lacquer.toml", "-o", "out", "--force"]).exits(0);
    assert!(workshop.tree("out") == first);
}

/// Maps of a material are textures beside the file, by names that the file has.
#[test]
fn maps_are_textures() {
    let workshop = Workshop::new();
    let oak = root().join("materials/textured/board/varnished-oak.toml");
    let words = ["export", "--to", "gltf", oak.to_str().unwrap(), "-o", "oak", "--noise", "0.1"];
    workshop.run(&words).exits(0);
    let file = workshop.json("oak/materials.gltf");
    let uris = file["images"].as_array().unwrap().iter().map(|image| image["uri"].as_str().unwrap().to_owned());
    let uris: Vec<String> = uris.collect();
    assert!(!uris.is_empty() && uris.iter().all(|uri| workshop.path(&format!("oak/{uri}")).is_file()), "{file}");
    assert!(file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"].is_u64(), "{file}");
}
