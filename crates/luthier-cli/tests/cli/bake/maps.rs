//! Maps ship with the bake, and the judge notices when one has changed.

use std::fs;

use image::{ImageBuffer, Luma};
use luthier_workshop::material_texts::gold;
use luthier_workshop::sha256;

use crate::workshop::Workshop;

/// A coat over gold with a roughness map, an index from a file, and patina that follows noise.
fn mapped() -> Workshop {
    let workshop = Workshop::new();
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = \"coat.csv\"\nalpha = 0.2\nmaps = { roughness = \"maps/rough.png\" }\n";
    let effects = "\n[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = { seed = 1 } }\n";
    let text = gold("mapped").replacen("[[layer]]", &format!("{coat}\n[[layer]]"), 1).replacen(
        "\n[bake]",
        &format!("{effects}\n[bake]"),
        1,
    );
    workshop.write("m/mapped.toml", text);
    workshop.write("m/coat.csv", "wavelength_nm,n,k\n380,1.5,0\n780,1.49,0\n");
    workshop.write("m/maps/readme", "");
    ImageBuffer::from_fn(4, 2, |x, _| Luma([60 * x as u8])).save(workshop.path("m/maps/rough.png")).unwrap();
    workshop
}

const REPORT: [&str; 4] = ["report", "--no-device", "--pairs", "8"];

#[test]
fn maps_ship_as_they_are_and_noise_as_grey() {
    let workshop = mapped();
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let maps = manifest["materials"][0]["maps"].as_array().unwrap();
    assert_eq!(maps.len(), 2);
    let [rough, patina] = [&maps[0], &maps[1]];
    assert_eq!(
        (&rough["slot"], &rough["layer"], &rough["source"]),
        (&"roughness".into(), &0.into(), &"maps/rough.png".into())
    );
    assert_eq!((&rough["width"], &rough["height"]), (&4.into(), &2.into()));
    let shipped = fs::read(workshop.path("out/maps/mapped-roughness-0.png")).unwrap();
    assert_eq!(shipped, fs::read(workshop.path("m/maps/rough.png")).unwrap());
    assert_eq!(rough["file"]["sha256"], sha256(&shipped));
    assert_eq!((&patina["slot"], &patina["layer"]), (&"patina".into(), &serde_json::Value::Null));
    let noise = image::open(workshop.path("out/maps/mapped-patina.png")).unwrap().into_luma8();
    assert_eq!(noise.dimensions(), (256, 256));
    assert!(noise.pixels().any(|p| p[0] < 3) && noise.pixels().any(|p| p[0] > 252));
    // A bake without them leaves none behind.
    workshop.write("m/mapped.toml", gold("mapped"));
    workshop.run(&["bake", "m", "-q"]).exits(0);
    assert!(!workshop.path("out/maps/mapped-patina.png").exists());
}

/// Pictures are compared by their bytes, whatever their paths. The bake of one of the materials has a file of its own.
#[test]
fn materials_with_one_picture_share_its_file() {
    let workshop = mapped();
    let text = workshop.text("m/mapped.toml");
    fs::copy(workshop.path("m/maps/rough.png"), workshop.path("m/maps/copy.png")).unwrap();
    let renamed = text.replace("mapped", "other").replace("maps/rough.png", "maps/copy.png");
    workshop.write("m/other.toml", renamed);
    workshop.run(&["bake", "m", "-q", "--hashed-names"]).exits(0);
    let of = |manifest: serde_json::Value| {
        let materials = manifest["materials"].as_array().unwrap().clone();
        let maps = materials.iter().flat_map(|material| material["maps"].as_array().unwrap().clone());
        let files = maps.map(|map| (map["source"].clone(), map["file"]["path"].as_str().unwrap().to_owned()));
        files.collect::<Vec<_>>()
    };
    let [rough, noise, copy, same_noise] = of(workshop.json("out/manifest.json")).try_into().unwrap();
    assert_eq!((rough.1.as_str(), &noise.1), (copy.1.as_str(), &same_noise.1));
    assert_ne!(rough.0, copy.0);
    assert_ne!(rough.1, noise.1);
    assert_eq!(fs::read_dir(workshop.path("out/maps")).unwrap().count(), 2);
    workshop.run(&["bake", "m", "--check", "--hashed-names"]).exits(0);
    workshop.run(&REPORT).exits(0);
    workshop.run(&["bake", "m/other.toml", "-q", "--out", "alone"]).exits(0);
    assert_eq!(of(workshop.json("alone/manifest.json"))[0].1, "maps/other-roughness-0.png");
}

#[test]
fn the_judge_notices_another_map_and_another_index() {
    let workshop = mapped();
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop.run(&REPORT).exits(0);
    workshop.edit("m/coat.csv", |text| text.replace("1.49", "1.48"));
    workshop.run(&REPORT).fails(1, &["m/mapped.toml has changed", "a file that it names", "bake again"]);
    workshop.edit("m/coat.csv", |text| text.replace("1.48", "1.49"));
    workshop.run(&REPORT).exits(0);
    ImageBuffer::from_pixel(4, 2, Luma([9u8])).save(workshop.path("m/maps/rough.png")).unwrap();
    workshop.run(&REPORT).fails(1, &["m/mapped.toml has changed", "bake again"]);
}

/// A map that is no PNG is refused before anything is written.
#[test]
fn a_map_that_is_no_picture_is_refused() {
    let workshop = mapped();
    workshop.write("m/maps/rough.png", "not a picture");
    workshop.run(&["bake", "m"]).exits(1).says(&["m/mapped.toml:8:22", "maps/rough.png"]);
    assert!(!workshop.path("out").exists());
}
