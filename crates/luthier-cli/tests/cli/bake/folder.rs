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

/// All files that a manifest names, with their hashes.
fn named(manifest: &Value) -> Vec<(String, String)> {
    match manifest {
        Value::Object(entries) => {
            let own = entries.get("path").and_then(Value::as_str).zip(entries.get("sha256").and_then(Value::as_str));
            let own = own.map(|(path, hash)| (path.to_owned(), hash.to_owned()));
            own.into_iter().chain(entries.values().flat_map(named)).collect()
        }
        Value::Array(items) => items.iter().flat_map(named).collect(),
        _ => Vec::new(),
    }
}

/// Oracle: a bake under plain names, whose files have the same bytes.
#[test]
fn names_contain_hashes_where_that_is_asked_for() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    let bake = ["bake", "gold.toml", "--hashed-names", "--cache", "store"];
    workshop.run(&["bake", "gold.toml", "-q", "--out", "plain"]).exits(0);
    workshop.run(&bake).exits(0);
    let whole = |folder: &str| {
        let manifest = workshop.json(&format!("{folder}/manifest.json"));
        let found = named(&manifest);
        for (path, hash) in &found {
            assert_eq!(&sha256(&std::fs::read(workshop.path(folder).join(path)).unwrap()), hash, "{path}");
        }
        found
    };
    let (plain, first) = (whole("plain"), whole("out"));
    assert_eq!(plain.len(), first.len());
    for ((plain, hash), (path, own)) in plain.iter().zip(&first) {
        let (stem, extension) = plain.rsplit_once('.').unwrap();
        assert_eq!((path, own), (&format!("{stem}.{}.{extension}", &hash[..16]), hash));
    }
    // Whoever reads the manifest finds them.
    workshop.run(&["report", "--no-device", "--pairs", "1"]).exits(0);
    workshop.run(&["gallery", "out", "--html", "page.html"]).exits(0);
    if cfg!(feature = "gpu") && workshop.run(&["preview", "gold", "-o", "ball.png", "--size", "8"]).code != Some(0) {
        assert!(workshop.run(&["report", "--pairs", "1"]).lacks_adapter());
    }
    workshop.run(&[&bake[..], &["--check"]].concat()).exits(0);
    let before = workshop.text("out/manifest.json");
    assert_eq!(workshop.run(&bake).exits(0).stdout, "up to date: out/manifest.json\n");
    // Plain names are another bake.
    workshop.run(&["bake", "gold.toml", "--cache", "store", "--check"]).exits(1);
    // The generation before stays, and the one before that goes.
    let change = |from: &str, to: &str| workshop.edit("gold.toml", |text| text.replace(from, to));
    change("roughness = 0.5", "roughness = 0.4");
    workshop.run(&bake).exits(0);
    let second = whole("out");
    assert!(
        named(&serde_json::from_str(&before).unwrap()).iter().all(|(path, _)| workshop.path("out").join(path).exists())
    );
    assert_ne!(first, second);
    change("\"au\"", "\"cu\"");
    workshop.run(&bake).exits(0);
    let third = whole("out");
    let kept = |path: &String| second.iter().chain(&third).any(|(kept, _)| kept == path);
    for (path, _) in &first {
        assert_eq!(workshop.path("out").join(path).exists(), kept(path), "{path}");
    }
    for path in workshop.files("out") {
        assert!(kept(&path) || ["manifest.json", ".luthier-before.json"].contains(&path.as_str()), "{path}");
    }
}
