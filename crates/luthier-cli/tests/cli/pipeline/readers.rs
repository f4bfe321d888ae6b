//! Verbs that write no bake, and read the store of those that do.

use std::fs;

use luthier_workshop::material_texts::{gold, lacquer};

use super::store::{entries, kinds};
use crate::workshop::Workshop;

const EVAL: [&str; 8] = ["eval", "lacquer.toml", "--model", "lobes", "--wi", "30,0", "--wo", "40,180"];
const FURNACE: [&str; 7] = ["eval", "lacquer.toml", "--model", "lobes", "--furnace", "--angles", "45"];
const SHADER: [&str; 4] = ["shader", "lacquer.toml", "--model", "lobes"];
const REPORT: [&str; 5] = ["report", "--no-device", "--pairs", "64", "--reference=16"];

/// Number of results of a kind.
fn count(workshop: &Workshop, kind: &str) -> u64 {
    kinds(workshop).into_iter().find(|(name, _)| name == kind).map_or(0, |(_, entries)| entries)
}

/// Standard output of a command with the store.
fn printed(workshop: &Workshop, words: &[&str]) -> String {
    let run = workshop.run(&[words, &["--cache", "store"]].concat()).exits(0);
    assert_eq!(run.stderr, "", "{words:?}");
    run.stdout
}

/// Damages the one result of a kind: the command says so, and makes it anew.
fn repairs(workshop: &Workshop, kind: &str, words: &[&str]) -> String {
    let [entry] = entries(workshop, kind).try_into().unwrap();
    let path = format!("store/objects/{entry}");
    let whole = fs::read(workshop.path(&path)).unwrap();
    let mut damaged = whole.clone();
    *damaged.last_mut().unwrap() ^= 1;
    workshop.write(&path, &damaged);
    let run =
        workshop.run(&[words, &["--cache", "store"]].concat()).exits(0).says(&["warning: cannot read", "damaged"]);
    assert_eq!(fs::read(workshop.path(&path)).unwrap(), whole);
    run.stdout
}

/// Oracle: the fit without a store.
#[test]
fn lobes_are_fitted_once_for_values_shaders_and_bakes() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let [value, furnace, shader] =
        [&EVAL[..], &FURNACE, &SHADER].map(|words| workshop.run(&[words, &["--no-cache"]].concat()).exits(0).stdout);
    assert_eq!(workshop.files("."), ["lacquer.toml"]);
    for _ in 0..2 {
        assert_eq!(printed(&workshop, &EVAL), value);
        assert_eq!(count(&workshop, "fit"), 1);
    }
    assert_eq!(repairs(&workshop, "fit", &EVAL), value);
    assert_eq!(printed(&workshop, &SHADER), shader);
    let bake = ["bake", "lacquer.toml", "--model", "lobes", "--cache", "store", "--json"];
    let baked = workshop.run(&bake).exits(0).json();
    let seconds = baked["seconds"].as_object().unwrap();
    assert!(seconds.contains_key("lobes") && !seconds.contains_key("fit"), "{baked}");
    assert_eq!(count(&workshop, "fit"), 1);
    // The furnace has another stack: it absorbs nothing.
    for _ in 0..2 {
        assert_eq!(printed(&workshop, &FURNACE), furnace);
        assert_eq!(count(&workshop, "fit"), 2);
    }
}

/// Oracle: the errors without a store.
#[test]
fn models_are_compared_with_their_reference_once() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "gold.toml", "--quiet"]).exits(0);
    workshop.run(&[&REPORT[..], &["--no-cache"]].concat()).exits(0);
    let report = workshop.text("out/report/report.json");
    for _ in 0..2 {
        printed(&workshop, &REPORT);
        assert_eq!(workshop.text("out/report/report.json"), report);
        assert_eq!(count(&workshop, "reference"), 1);
    }
    repairs(&workshop, "reference", &REPORT);
    assert_eq!(workshop.text("out/report/report.json"), report);
    // Other paths are another reference.
    printed(&workshop, &["report", "--no-device", "--pairs", "64", "--reference=17"]);
    assert_eq!(count(&workshop, "reference"), 2);
}

/// Oracle: the report that is made without a store; counted are the judgements that the store has.
#[test]
fn what_has_not_changed_is_not_judged_again() {
    let workshop = Workshop::with(&[("a/gold.toml", &gold("gold")), ("a/lacquer.toml", &lacquer("lacquer"))]);
    let report = |more: &[&str]| {
        workshop.run(&[&["report", "--no-device"], more].concat()).exits(0);
        workshop.text("out/report/report.json")
    };
    let bake = || workshop.run(&["bake", "a", "--cache", "store", "--quiet"]).exits(0);
    let counts = || ["judged", "judge-tile"].map(|kind| count(&workshop, kind));
    bake();
    let alone = report(&["--pairs", "64", "--no-cache"]);
    assert_eq!(report(&["--pairs", "64", "--cache", "store"]), alone);
    let [materials, tiles] = counts();
    assert_eq!(materials, 2);
    assert_eq!(report(&["--pairs", "64", "--cache", "store"]), alone);
    assert_eq!(counts(), [materials, tiles]);
    // One material of two is another: its tile of albedos has the roughness on an axis, and stays but for its reader.
    workshop.edit("a/gold.toml", |text| text.replace("roughness = 0.5", "roughness = 0.4"));
    bake();
    let changed = report(&["--pairs", "64", "--cache", "store"]);
    let [more, more_tiles] = counts();
    assert_eq!(more, materials + 1);
    let read = |json: &str| -> u64 {
        let report: serde_json::Value = serde_json::from_str(json).unwrap();
        let tiles = report["tables"].as_array().unwrap().iter().flat_map(|table| table["tiles"].as_array().unwrap());
        tiles.filter(|tile| tile["users"].as_array().unwrap().iter().any(|user| user == "gold/0")).count() as u64
    };
    assert_eq!(more_tiles, tiles + read(&changed));
    assert_eq!(report(&["--pairs", "64", "--no-cache"]), changed);
    // Other pairs are another judgement.
    let settings = report(&["--pairs", "65", "--cache", "store"]);
    assert_eq!(counts()[0], more + 2);
    assert_ne!(settings, changed);
}

/// A coat that returns more light than falls in, where a closed form lacks 1/n^2 below it.
const BRIGHT: &str = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";

/// Albedos of a model, of which a bake warns, are kept by the stack: a new name computes none, and a new index does.
#[test]
fn albedos_of_models_are_kept() {
    let workshop = Workshop::with(&[("coat.toml", BRIGHT)]);
    let warned = || {
        let run = workshop.run(&["bake", "coat.toml", "--model", "weidlich-wilkie", "--cache", "store"]).exits(0);
        let warnings = run.stderr.lines().filter(|line| line.contains("times the light that falls in"));
        warnings.map(str::to_owned).collect::<Vec<_>>()
    };
    let first = warned();
    assert_eq!(first.len(), 1, "{first:?}");
    let kept = count(&workshop, "energy");
    assert!(kept > 0);
    workshop.edit("coat.toml", |text| text.replace("name = \"coat\"", "name = \"lacquer\""));
    assert_eq!((warned(), count(&workshop, "energy")), (first.clone(), kept));
    workshop.edit("coat.toml", |text| text.replace("ior = 1.5", "ior = 1.7"));
    assert_ne!(warned(), first);
    assert!(count(&workshop, "energy") > kept);
}
