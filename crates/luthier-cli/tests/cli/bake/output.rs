//! Files of a bake are what its manifest says.

use std::collections::BTreeSet;

use luthier_manifest::Manifest;
use luthier_workshop::material_texts::{NOISE, doubtful, film, gold, lacquer, matte};
use luthier_workshop::sha256;
use serde_json::Value;

use crate::workshop::Workshop;

/// A lacquer, gold and a film: every kind of table.
fn three() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("m/lacquer.toml", lacquer("lacquer"));
    workshop.write("m/gold.toml", gold("gold"));
    workshop.write("m/film.toml", film("film", NOISE));
    workshop.write("m/notes.txt", "not a material");
    workshop.write("m/deeper/other.toml", "not looked at");
    workshop
}

/// Path and hash of every file that a manifest names, found by shape and not by schema.
fn listed(value: &Value) -> Vec<(String, String)> {
    let inner: Vec<(String, String)> = match value {
        Value::Array(items) => items.iter().flat_map(listed).collect(),
        Value::Object(entries) => entries.values().flat_map(listed).collect(),
        _ => Vec::new(),
    };
    let own = value["path"].as_str().zip(value["sha256"].as_str()).map(|(p, h)| (p.to_owned(), h.to_owned()));
    own.into_iter().chain(inner).collect()
}

/// Every file listed and of the listed hash, nothing else there.
#[track_caller]
fn assert_complete(workshop: &Workshop, out: &str) {
    let tree = workshop.tree(out);
    let mut expected = BTreeSet::from(["manifest.json".to_owned()]);
    for (path, hash) in listed(&workshop.json(&format!("{out}/manifest.json"))) {
        assert_eq!(tree.get(&path).map(|bytes| sha256(bytes)), Some(hash), "{path}");
        assert!(expected.insert(path.clone()), "{path} is listed twice");
    }
    assert_eq!(workshop.files(out), expected.into_iter().collect::<Vec<_>>());
}

fn names<'a>(list: &'a Value, key: &str) -> Vec<&'a str> {
    list.as_array().unwrap().iter().map(|entry| entry[key].as_str().unwrap()).collect()
}

#[test]
fn a_bake_is_what_its_manifest_says() {
    let workshop = three();
    let run = workshop.run(&["bake", "m"]).exits(0);
    assert_eq!(run.stderr, "", "no warnings, and no bar where there is no terminal");
    assert_complete(&workshop, "out");

    let manifest = workshop.json("out/manifest.json");
    assert_eq!(names(&manifest["materials"], "name"), ["film", "gold", "lacquer"], "by file name");
    assert_eq!(names(&manifest["materials"], "source"), ["../m/film.toml", "../m/gold.toml", "../m/lacquer.toml"]);
    for material in manifest["materials"].as_array().unwrap() {
        let source = workshop.text(&format!("out/{}", material["source"].as_str().unwrap()));
        assert_eq!(material["source_hash"], sha256(source.as_bytes()));
    }
    let kinds = ["fresnel", "distribution", "fgd", "phase", "thickness", "film"];
    assert_eq!(names(&manifest["tables"], "kind"), kinds, "in binding order");
    assert!(kinds.iter().all(|kind| run.stdout.contains(kind)), "{}", run.stdout);
    Manifest::from_json(&workshop.text("out/manifest.json")).unwrap();

    let shaders: Vec<(&str, &str)> = manifest["shaders"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| (s["form"].as_str().unwrap(), s["target"].as_str().unwrap()))
        .collect();
    for form in ["baked", "full"] {
        for target in ["wgsl", "glsl450", "glsl-es300"] {
            assert!(shaders.contains(&(form, target)), "{form} {target}");
        }
    }
    assert_eq!(shaders.len(), 6);
}

/// First bytes: KTX 2.0 specification, section 3.1; OpenEXR file layout; PNG specification, section 5.2.
#[test]
fn containers_are_what_they_are_called() {
    let workshop = three();
    workshop.run(&["bake", "m", "--quiet"]).exits(0);
    let magic: [(&str, &[u8]); 3] =
        [("ktx2", b"\xabKTX 20\xbb\r\n\x1a\n"), ("exr", &[0x76, 0x2f, 0x31, 0x01]), ("png", b"\x89PNG\r\n\x1a\n")];
    let tables = workshop.tree("out/tables");
    assert_eq!(tables.len(), 18);
    for (path, bytes) in tables {
        let (_, start) = magic.iter().find(|(extension, _)| path.ends_with(extension)).unwrap();
        assert!(bytes.starts_with(start), "{path}");
    }
}

#[test]
fn bytes_depend_on_inputs_only() {
    let workshop = three();
    workshop.run(&["bake", "m", "--out", "one", "--threads", "1"]).exits(0);
    workshop.run(&["bake", "m", "--out", "two", "--threads", "2"]).exits(0);
    let one = workshop.tree("one");
    assert!(one == workshop.tree("two"), "1 and 2 threads");
    workshop.run(&["bake", "m", "--out", "two"]).exits(0);
    assert!(one == workshop.tree("two"), "again, over the first");
}

#[test]
fn the_next_bake_sweeps_up_after_the_last() {
    let workshop = three();
    workshop.write("matte.toml", matte("matte"));
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop.run(&["report", "--no-device", "--pairs", "8"]).exits(0);
    let report = workshop.tree("out/report");
    assert_eq!(report.len(), 3);

    workshop.run(&["bake", "m", "-q"]).exits(0);
    assert!(workshop.tree("out/report") == report, "the report on the same bake stays");

    workshop.write("out/mine.txt", "mine");
    workshop.run(&["bake", "m/lacquer.toml", "-q"]).exits(0);
    assert!(!workshop.path("out/report").exists(), "the report on another bake does not");
    assert!(!workshop.path("out/tables/phase.ktx2").exists());
    assert_eq!(workshop.text("out/mine.txt"), "mine");
    std::fs::remove_file(workshop.path("out/mine.txt")).unwrap();
    assert_complete(&workshop, "out");

    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    assert_complete(&workshop, "out");
    assert_eq!(workshop.json("out/manifest.json")["tables"], serde_json::json!([]));
}

/// Manifests of other versions name their files too. What is outside the folder, or new, or named by a manifest of another
/// program stays.
#[test]
fn leftovers_of_another_version_go_too() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte")), ("precious", "precious")]);
    let old = |generator: &str| {
        workshop.write("out/tables/old.dds", "old");
        let paths = [
            "tables/old.dds",
            "../precious",
            "",
            "manifest.json",
            "shaders/../shaders/full.wgsl",
            "shaders//full.wgsl",
        ];
        let stuff = paths.map(|path| serde_json::json!({"path": path, "sha256": ""}));
        let manifest = serde_json::json!({"schema": 0, "generator": generator, "stuff": stuff});
        workshop.write("out/manifest.json", manifest.to_string());
    };
    old("someone else");
    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    assert_eq!(workshop.text("out/tables/old.dds"), "old");

    old("luthier 0.0.1");
    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    assert_complete(&workshop, "out");
    assert_eq!(workshop.text("precious"), "precious");

    workshop.write("out/manifest.json", "not JSON");
    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    assert_complete(&workshop, "out");
}

#[test]
fn a_file_named_twice_is_baked_once() {
    let workshop = Workshop::with(&[("m/a.toml", &matte("a")), ("m/b.toml", &matte("b"))]);
    let run = workshop.run(&["bake", "m/b.toml", "m", "./m/a.toml", "--json"]).exits(0);
    assert_eq!(run.json()["materials"], serde_json::json!(["b", "a"]), "in the order given");
}

#[test]
fn json_says_what_was_made() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    let run = workshop.run(&["bake", "gold.toml", "--out", "deep/down", "--json"]).exits(0);
    let json = run.json();
    assert_eq!(json["manifest"], "deep/down/manifest.json");
    assert_eq!(json["materials"], serde_json::json!(["gold"]));
    let tables: Vec<(&str, &Value, &Value)> = json["tables"]
        .as_array()
        .unwrap()
        .iter()
        .map(|t| (t["kind"].as_str().unwrap(), &t["size"], &t["texel_bytes"]))
        .collect();
    let size = |w: u32, h: u32| serde_json::json!([w, h]);
    // 64 texels of 8 bytes, 32 x 32 of 4, 8 x 8 of 8.
    let (fresnel, distribution, fgd) = (size(64, 1), size(32, 32), size(8, 8));
    assert_eq!(
        tables,
        [("fresnel", &fresnel, &512.into()), ("distribution", &distribution, &4096.into()), ("fgd", &fgd, &512.into())]
    );
    for table in json["tables"].as_array().unwrap() {
        assert!(table["max_abs_err"].as_f64().unwrap() > 0.0, "{table}");
    }
    assert!(json["seconds_all"].as_f64().unwrap() > 0.0);
}

#[test]
fn quiet_is_quiet() {
    let workshop = Workshop::with(&[("doubtful.toml", &doubtful("doubtful"))]).apart();
    let run = workshop.run(&["bake", "doubtful.toml", "--quiet"]).exits(0);
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    let run = workshop.run(&["bake", "doubtful.toml"]).exits(0);
    assert!(run.stderr.contains("doubtful.toml:6:7"), "{}", run.stderr);
    assert!(run.stdout.contains("out/manifest.json"), "{}", run.stdout);
}

/// Two checkouts at different places, which a build system names by absolute paths from a folder of its own. The judge finds the files from anywhere.
#[test]
fn checkouts_give_the_same_bytes() {
    let workshop = Workshop::new();
    for checkout in ["one", "far/away/two"] {
        workshop.write(&format!("{checkout}/m/gold.toml"), gold("gold"));
        workshop.write(&format!("{checkout}/m/matte.toml"), matte("matte"));
    }
    let at = |path: &str| workshop.path(path).to_str().unwrap().to_owned();
    for checkout in ["one", "far/away/two"] {
        let (from, to) = (at(&format!("{checkout}/m")), at(&format!("{checkout}/build/luts")));
        workshop.run(&["bake", &from, "--out", &to, "--quiet"]).exits(0);
    }
    let trees = ["one", "far/away/two"].map(|checkout| workshop.tree(&format!("{checkout}/build/luts")));
    assert!(trees[0] == trees[1] && trees[0].len() > 3);
    let manifest = workshop.json("one/build/luts/manifest.json");
    assert_eq!(names(&manifest["materials"], "source"), ["../../m/gold.toml", "../../m/matte.toml"]);
    // However the paths are written.
    let before = workshop.tree("one/build/luts");
    workshop.run(&["bake", "./one/../one/m", "--out", "one/m/../build/luts", "--quiet"]).exits(0);
    assert!(workshop.tree("one/build/luts") == before);
    std::fs::rename(workshop.path("far/away/two"), workshop.path("three")).unwrap();
    for out in ["one/build/luts".to_owned(), at("three/build/luts")] {
        workshop.run(&["report", "--no-device", "--pairs", "8", "--out", &out]).exits(0);
    }
}

/// Names that mean something in a language, to the shaders themselves, or to a file system.
#[test]
fn names_are_free() {
    let workshop = Workshop::new();
    for name in ["words", "con", "float", "main", "layer-words"] {
        workshop.write(&format!("m/{name}.toml"), matte(name));
    }
    workshop.run(&["check", "m"]).exits(0);
    workshop.run(&["bake", "m", "--target", "wgsl,glsl450,glsl-es300,hlsl,msl,spirv", "--quiet"]).exits(0);
    assert!(workshop.text("out/shaders/baked.wgsl").contains("const LUTHIER_MATERIAL_WORDS_ID: u32 = 4u;"));
    workshop.write("m/id.toml", matte("words-id"));
    workshop.run(&["check", "m"]).exits(1).says(&["`words` and `words-id`", "LUTHIER_MATERIAL_WORDS_ID"]);
}

/// The version is that of the lock file, by which the program was built.
#[test]
fn shaders_name_the_judges_that_they_passed() {
    let workshop = Workshop::with(&[("m/chalk.toml", &matte("chalk"))]);
    workshop.run(&["bake", "m", "--target", "wgsl,glsl450,glsl-es300,hlsl,msl,spirv", "--quiet"]).exits(0);
    let lock = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.lock");
    let lock = std::fs::read_to_string(lock).unwrap();
    let version = lock.split("name = \"naga\"\nversion = \"").nth(1).unwrap().split('"').next().unwrap();
    let shaders = workshop.json("out/manifest.json")["shaders"].as_array().unwrap().clone();
    assert_eq!(shaders.len(), 12);
    for shader in &shaders {
        let checks = shader["checks"].as_array().unwrap();
        let naga = serde_json::json!({"by": format!("naga {version}"), "read": "wgsl", "capabilities": []});
        assert_eq!(checks[0], naga, "{shader}");
        // The lint reads the text itself.
        let target = shader["target"].as_str().unwrap();
        let has_lint = ["hlsl", "msl"].contains(&target);
        assert_eq!(checks.len(), if has_lint { 2 } else { 1 }, "{shader}");
        assert!(!has_lint || (checks[1]["read"] == target && checks[1]["by"].as_str().unwrap().starts_with("lint ")));
    }
    // The report has them, too.
    workshop.run(&["report", "--no-device", "--pairs", "8"]).exits(0);
    let report = workshop.json("out/report/report.json");
    assert_eq!(report["shaders"].as_array().unwrap().len(), 12);
    assert_eq!(report["shaders"][0]["checks"], shaders[0]["checks"]);
    let page = workshop.text("out/report/index.html");
    assert!(page.contains(&format!("naga {version} on this text, no capability beyond core WebGPU")), "{version}");
    assert!(page.contains("on the wgsl that it was translated from"), "{version}");
}
