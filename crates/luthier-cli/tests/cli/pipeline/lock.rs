//! Locks: tables keep their sizes, axes and formats until a budget breaks, and materials their numbers.

use serde_json::Value;

use crate::workshop::Workshop;

/// Size of a Fresnel row.
fn row_size(workshop: &Workshop) -> Value {
    let manifest = workshop.json("out/manifest.json");
    let tables = manifest["tables"].as_array().unwrap();
    let fresnel = tables.iter().find(|table| table["kind"] == "fresnel").unwrap();
    fresnel["layout"]["x"].clone()
}

const BARE: &str = "schema = 1\nname = \"bare\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.3\n\
                    [[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n[bake]\nmodel = \"elek\"\n";

/// A thick film, whose row needs more nodes than one of glass.
const FILM: &str = "schema = 1\nname = \"film\"\n[[layer]]\ntype = \"thin-film\"\nior = 1.6\nthickness_nm = 700\n\
                    [[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.3\n[bake]\nmodel = \"elek\"\n";

#[test]
fn a_lock_keeps_tables_until_their_budget_breaks() {
    let workshop = Workshop::with(&[("a/bare.toml", BARE)]);
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    assert!(!workshop.path("a/luthier.lock").exists());
    let small = row_size(&workshop);
    let without = workshop.tree("out/tables");
    let run = workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    assert!(run.stderr.contains("wrote a/luthier.lock"), "{}", run.stderr);
    assert_eq!(workshop.tree("out/tables"), without);
    // From the lock: no candidates were compared, and the bake is the one that wrote it.
    workshop.run(&["bake", "a", "--out", "again", "--quiet"]).exits(0);
    assert_eq!(workshop.tree("again"), workshop.tree("out"));
    let searches = workshop.json("out/manifest.json")["searches"].clone();
    assert!(searches.as_array().unwrap().iter().all(|search| search["measured"] == 1), "{searches}");
    // Glass beside glass would have another search; the lock stays.
    workshop.write("a/other.toml", BARE.replace("bare", "other").replace("1.5", "1.7"));
    let decisions = |workshop: &Workshop| workshop.json("a/luthier.lock")["decisions"].clone();
    let first = decisions(&workshop);
    let run = workshop.run(&["bake", "a", "--quiet"]).exits(0);
    assert!(run.stderr.contains("wrote a/luthier.lock: 1 material more"), "{}", run.stderr);
    assert_eq!((row_size(&workshop), decisions(&workshop)), (small.clone(), first));
    let lock = workshop.text("a/luthier.lock");
    // A film breaks it: the bake says so.
    workshop.write("a/film.toml", FILM);
    let stale = workshop.run(&["bake", "a", "--check"]).exits(1).stdout;
    assert!(stale.contains("stale: a/luthier.lock"), "{stale}");
    assert_eq!(workshop.text("a/luthier.lock"), lock);
    let run = workshop.run(&["bake", "a", "--quiet"]).exits(0);
    assert!(run.stderr.contains("warning: the tables that a/luthier.lock decides"), "{}", run.stderr);
    assert_ne!(row_size(&workshop), small);
    assert_ne!(workshop.text("a/luthier.lock"), lock);
    let large = row_size(&workshop);
    // Without the film the larger rows stay, unless the lock is made anew.
    std::fs::remove_file(workshop.path("a/film.toml")).unwrap();
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    assert_eq!(row_size(&workshop), large);
    std::fs::remove_file(workshop.path("a/other.toml")).unwrap();
    workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    assert_eq!(row_size(&workshop), small);
}

/// Names of the materials of a bake, in the order of their numbers.
fn names(workshop: &Workshop, manifest: &str) -> Vec<String> {
    let manifest = workshop.json(manifest);
    let materials = manifest["materials"].as_array().unwrap();
    materials.iter().map(|material| material["name"].as_str().unwrap().to_owned()).collect()
}

/// Materials are in the order of their files' names; with a lock, in that of the lock, and new ones come last.
#[test]
fn a_material_that_is_added_changes_no_number() {
    let named = |name: &str| BARE.replace("bare", name);
    let workshop = Workshop::with(&[("a/gold.toml", &named("gold")), ("a/zinc.toml", &named("zinc"))]);
    workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    assert_eq!(names(&workshop, "out/manifest.json"), ["gold", "zinc"]);
    workshop.write("a/iron.toml", named("iron"));
    let stale = workshop.run(&["bake", "a", "--check"]).exits(1).stdout;
    assert!(stale.contains("stale: a/luthier.lock"), "{stale}");
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    workshop.write("a/brass.toml", named("brass"));
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    let all = ["gold", "zinc", "iron", "brass"];
    assert_eq!(names(&workshop, "out/manifest.json"), all);
    assert!(workshop.text("out/shaders/baked.wgsl").contains("const LUTHIER_MATERIAL_BRASS: u32 = 3u;"));
    workshop.run(&["bake", "a", "--check"]).exits(0);
    // A bake of some of them forgets no other.
    let lock = workshop.text("a/luthier.lock");
    workshop.run(&["bake", "a/iron.toml", "a/gold.toml", "--out", "some", "--quiet"]).exits(0);
    assert_eq!(names(&workshop, "some/manifest.json"), ["gold", "iron"]);
    assert_eq!(workshop.text("a/luthier.lock"), lock);
    // A new search keeps numbers, and drops the names of materials that are gone.
    std::fs::remove_file(workshop.path("a/zinc.toml")).unwrap();
    workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    assert_eq!(names(&workshop, "out/manifest.json"), ["gold", "iron", "brass"]);
    assert_eq!(workshop.json("a/luthier.lock")["materials"], serde_json::json!(["gold", "iron", "brass"]));
    // Two folders with equal files have equal bakes.
    for name in ["gold", "iron", "brass"] {
        workshop.write(&format!("b/{name}.toml"), named(name));
    }
    workshop.write("b/luthier.lock", workshop.text("a/luthier.lock"));
    workshop.run(&["bake", "b", "--out", "other", "--quiet"]).exits(0);
    assert_eq!(workshop.tree("other/tables"), workshop.tree("out/tables"));
    assert_eq!(workshop.tree("other/shaders"), workshop.tree("out/shaders"));
}

/// Such a row does not count for the search, and does not break the lock that it is in.
#[test]
fn a_row_that_no_table_serves_breaks_no_lock() {
    let thick = FILM.replace("= 700", "= 20000");
    let workshop = Workshop::with(&[("a/bare.toml", BARE), ("a/film.toml", &thick)]);
    workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let worst = manifest["tables"][0]["tiles"][1]["error"]["max_abs_err"].as_f64().unwrap();
    assert!(worst > 0.05, "{worst}");
    let searches = manifest["searches"].as_array().unwrap();
    assert!(searches.iter().all(|search| search["measured"] == 1), "{searches:?}");
}

/// A stated budget is held whatever the lock says.
#[test]
fn a_lock_never_breaks_a_budget() {
    let workshop = Workshop::with(&[("a/bare.toml", BARE)]);
    let bake = |limit: &str, more: &[&str]| {
        let args = ["bake", "a", "--max-abs", limit, "--json"];
        workshop.run(&[&args[..], more].concat()).exits(0).json()
    };
    bake("1e-2", &["--relock"]);
    let coarse = row_size(&workshop);
    bake("2e-2", &[]);
    assert_eq!(row_size(&workshop), coarse);
    let fine = bake("1e-3", &[]);
    assert_ne!(row_size(&workshop), coarse);
    for table in fine["tables"].as_array().unwrap() {
        assert!(table["max_abs_err"].as_f64().unwrap() <= 1e-3, "{table}");
    }
}

#[test]
fn a_broken_lock_is_refused() {
    let workshop = Workshop::with(&[("a/bare.toml", BARE), ("a/luthier.lock", "{")]);
    workshop.run(&["bake", "a"]).fails(1, &["a/luthier.lock: it is no lock"]).says(&["--relock"]);
    workshop.write("a/luthier.lock", "{\"schema\": 9, \"decisions\": []}");
    workshop.run(&["bake", "a"]).fails(1, &["schema is 9"]);
    workshop.run(&["bake", "a", "--relock", "--quiet"]).exits(0);
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
}
