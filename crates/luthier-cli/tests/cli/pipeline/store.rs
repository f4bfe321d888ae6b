//! The store of results: what is found again, what is damaged, what is in the way.

use std::fs;

use luthier_workshop::material_texts::{fine_lacquer, gold, lacquer};

use crate::workshop::Workshop;

/// The number of results of each kind.
pub(super) fn kinds(workshop: &Workshop) -> Vec<(String, u64)> {
    let stats = workshop.run(&["cache", "stats", "--json", "--cache", "store"]).exits(0).json();
    let kinds = stats["kinds"].as_object().unwrap();
    kinds.iter().map(|(kind, usage)| (kind.clone(), usage["entries"].as_u64().unwrap())).collect()
}

/// The files of all results, of a kind.
pub(super) fn entries(workshop: &Workshop, kind: &str) -> Vec<String> {
    workshop.files("store/objects").into_iter().filter(|path| path.ends_with(&format!("-{kind}"))).collect()
}

#[test]
fn results_are_found_again_and_give_the_same_bytes() {
    let workshop = Workshop::with(&[("a/lacquer.toml", &lacquer("lacquer")), ("a/gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "a", "--out", "alone", "--no-cache", "--quiet"]).exits(0);
    let first = workshop.run(&["bake", "a", "--cache", "store", "--json"]).exits(0).json();
    assert!(first["seconds"].as_object().unwrap().contains_key("fresnel"), "{first}");
    assert_eq!(workshop.tree("out"), workshop.tree("alone"));
    let kept = kinds(&workshop);
    for kind in ["fresnel", "fgd", "fgd-truth", "crossed", "search", "stamp"] {
        assert!(kept.iter().any(|(name, _)| name == kind), "{kind}: {kept:?}");
    }
    // Another folder has no stamp, but all results.
    let again = workshop.run(&["bake", "a", "--cache", "store", "--out", "again", "--json"]).exits(0).json();
    assert_eq!(again["seconds"], serde_json::json!({}), "{again}");
    assert_eq!(workshop.tree("again"), workshop.tree("alone"));
    // A change of one material makes its own results alone.
    workshop.edit("a/gold.toml", |text| text.replace("\"au\"", "\"cu\""));
    let run = workshop.run(&["bake", "a", "--cache", "store", "--events", "--quiet"]).exits(0);
    let finished = run.stderr.lines().filter(|line| line.contains("\"finished\"")).count();
    let expected = ["facet-grid", "fgd-truth", "fgd", "fresnel"];
    assert_eq!(finished, expected.len(), "{}", run.stderr);
    for kind in expected {
        assert!(run.stderr.contains(&format!("{{\"event\":\"finished\",\"kind\":\"{kind}\"}}")), "{}", run.stderr);
    }
}

/// Oracle: a bake without a store.
#[test]
fn damaged_results_are_made_anew() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    workshop.run(&["bake", "lacquer.toml", "--out", "alone", "--no-cache", "--quiet"]).exits(0);
    workshop.run(&["bake", "lacquer.toml", "--cache", "store", "--quiet"]).exits(0);
    let path = format!("store/objects/{}", entries(&workshop, "fresnel")[0]);
    let whole = fs::read(workshop.path(&path)).unwrap();
    let mut damaged = whole.clone();
    *damaged.last_mut().unwrap() ^= 1;
    workshop.write(&path, &damaged);
    let run = workshop.run(&["bake", "lacquer.toml", "--cache", "store", "--out", "again", "--quiet"]).exits(0);
    assert!(
        run.stderr.contains("warning: cannot read store/objects/") && run.stderr.contains("damaged"),
        "{}",
        run.stderr
    );
    assert_eq!(workshop.tree("again"), workshop.tree("alone"));
    assert_eq!(fs::read(workshop.path(&path)).unwrap(), whole);
    workshop.write(&path, &damaged[..10]);
    let verified = workshop.run(&["cache", "verify", "--cache", "store"]).exits(1);
    assert!(verified.stdout.contains("removed a damaged result: store/objects/"), "{}", verified.stdout);
    workshop.run(&["cache", "verify", "--cache", "store"]).exits(0);
    let cleared = workshop.run(&["cache", "clear", "--cache", "store"]).exits(0);
    assert!(cleared.stdout.starts_with("removed "), "{}", cleared.stdout);
    assert_eq!(kinds(&workshop), []);
}

#[test]
fn a_store_that_cannot_be_used_is_named() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("file", "")]).apart();
    workshop.run(&["bake", "lacquer.toml", "--cache", "file"]).fails(3, &["cannot make the folder", "file/tmp"]);
    workshop.run(&["bake", "lacquer.toml", "--cache", "a", "--no-cache"]).fails(2, &["--no-cache"]);
    workshop.run(&["cache", "stats"]).fails(2, &["no store", "--cache"]);
    assert!(!workshop.path("out").exists());
}

/// Oracle: a store without such a limit, which holds more.
#[test]
fn a_small_store_stays_small() {
    let texts: Vec<(String, String)> = (0..4).map(|i| (format!("a/{i}.toml"), lacquer(&format!("m{i}")))).collect();
    let files: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let workshop = Workshop::with(&files);
    workshop.edit("a/0.toml", |text| text.replace("size = [32, 32]", "size = [512, 512]"));
    for i in 1..4 {
        workshop.edit(&format!("a/{i}.toml"), |text| text.replace("distribution = { size = [32, 32] }\n", ""));
    }
    workshop.edit("a/0.toml", |text| text + "tables = [\"distribution\"]\n");
    workshop.run(&["bake", "a", "--cache", "large", "--out", "other", "--quiet"]).exits(0);
    let large = workshop.run(&["cache", "stats", "--json", "--cache", "large"]).exits(0).json();
    assert!(large["bytes"].as_u64().unwrap() > 1 << 20, "{large}");
    workshop.run(&["bake", "a", "--cache", "store", "--cache-size", "1", "--quiet"]).exits(0);
    let stats = workshop.run(&["cache", "stats", "--json", "--cache", "store", "--cache-size", "1"]).exits(0).json();
    assert_eq!(stats["limit"], 1 << 20);
    assert!(stats["bytes"].as_u64().unwrap() <= 1 << 20, "{stats}");
}

/// Oracle: the number of searches that the store has. A row does not depend on the roughness, and so its search is the one that was made.
#[test]
fn a_changed_roughness_makes_no_search_anew() {
    let workshop = Workshop::with(&[("a/lacquer.toml", &fine_lacquer("lacquer")), ("a/gold.toml", &gold("gold"))]);
    workshop.edit("a/gold.toml", |text| text.replace("fresnel = { size = 64 }\n", ""));
    let searches = |workshop: &Workshop| {
        workshop.run(&["bake", "a", "--cache", "store", "--quiet"]).exits(0);
        kinds(workshop).into_iter().find(|(kind, _)| kind == "search").map_or(0, |(_, entries)| entries)
    };
    let before = searches(&workshop);
    assert!(before > 0);
    workshop.edit("a/lacquer.toml", |text| text.replace("roughness = 0.4", "roughness = 0.3"));
    assert_eq!(searches(&workshop), before);
    workshop.edit("a/lacquer.toml", |text| text.replace("ior = 1.5", "ior = 1.6"));
    assert!(searches(&workshop) > before, "another index has another row");
}
