//! One reader of a bake's folder, whoever asks: nothing outside it is read, and nothing that the manifest does not know.

use luthier_workshop::material_texts::gold;
use luthier_workshop::sha256;
use serde_json::{Value, json};

use crate::workshop::Workshop;

fn baked() -> Workshop {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "gold.toml", "-q"]).exits(0);
    workshop
}

/// The texture of the first table: its path below the folder, and its bytes.
fn texture(workshop: &Workshop) -> (String, Vec<u8>) {
    let path = workshop.json("out/manifest.json")["tables"][0]["texture"]["path"].as_str().unwrap().to_owned();
    let bytes = std::fs::read(workshop.path("out").join(&path)).unwrap();
    (path, bytes)
}

/// Every verb that reads the folder refuses it with the same words.
fn refused(workshop: &Workshop, parts: &[&str]) {
    workshop.run(&["report", "--no-device", "--pairs", "1"]).fails(1, parts);
    if cfg!(feature = "gpu") {
        // What is wrong with the folder is found before an adapter is asked for.
        workshop.run(&["report", "--pairs", "1"]).fails(1, parts);
        workshop.run(&["preview", "gold", "-o", "ball.png", "--size", "8"]).fails(1, parts);
    }
}

fn change(workshop: &Workshop, change: impl FnOnce(&mut Value)) {
    let mut manifest = workshop.json("out/manifest.json");
    change(&mut manifest);
    workshop.write("out/manifest.json", manifest.to_string());
}

#[test]
fn paths_that_leave_the_folder_are_refused() {
    let workshop = baked();
    let (_, texture) = texture(&workshop);
    workshop.write("elsewhere.ktx2", &texture);
    let outside = workshop.path("elsewhere.ktx2");
    let good = workshop.text("out/manifest.json");
    // The file is the right one each time, and its hash with it.
    for path in ["../elsewhere.ktx2", outside.to_str().unwrap(), "tables/../../elsewhere.ktx2", ""] {
        change(&workshop, |m| m["tables"][0]["texture"] = json!({"path": path, "sha256": sha256(&texture)}));
        refused(&workshop, &["not a path inside its folder", path]);
        workshop.write("out/manifest.json", &good);
    }
    workshop.run(&["report", "--no-device", "--pairs", "1"]).exits(0);
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder_are_refused() {
    let workshop = baked();
    let (path, _) = texture(&workshop);
    let link = workshop.path("out").join(&path);
    std::fs::rename(&link, workshop.path("elsewhere.ktx2")).unwrap();
    std::os::unix::fs::symlink("../../elsewhere.ktx2", &link).unwrap();
    refused(&workshop, &["not a path inside its folder", &path]);
}

#[test]
fn changed_files_are_known_by_their_hash() {
    let workshop = baked();
    let (path, mut bytes) = texture(&workshop);
    *bytes.last_mut().unwrap() ^= 1;
    workshop.write(&format!("out/{path}"), &bytes);
    refused(&workshop, &[&path, &sha256(&bytes), "bake again"]);
}

#[test]
fn texels_are_those_that_the_manifest_describes() {
    let workshop = baked();
    change(&workshop, |m| m["tables"][0]["layout"]["x"]["size"] = json!(3));
    refused(&workshop, &["table is", "the manifest says"]);
}
