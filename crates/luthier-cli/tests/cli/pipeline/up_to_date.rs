//! Bakes that have nothing to do, and those that say what they would do.

use luthier_workshop::material_texts::{film, gold, lacquer, matte};

use crate::workshop::Workshop;

/// A picture of two grey pixels.
fn picture(workshop: &Workshop, name: &str, grey: u8) {
    image::GrayImage::from_pixel(2, 2, image::Luma([grey])).save(workshop.path(name)).unwrap();
}

#[test]
fn a_bake_of_what_has_not_changed_does_nothing() {
    let workshop = Workshop::with(&[("film.toml", &film("film", "{ image = \"map.png\" }"))]);
    picture(&workshop, "map.png", 100);
    let args = ["bake", "film.toml", "--cache", "store"];
    let bake = |more: &[&str]| workshop.run(&[&args, more].concat()).exits(0);
    assert!(bake(&[]).stdout.contains("wrote out/manifest.json"));
    let before = std::fs::metadata(workshop.path("out/manifest.json")).unwrap().modified().unwrap();
    assert_eq!(bake(&[]).stdout, "up to date: out/manifest.json\n");
    assert_eq!(bake(&["--check"]).stdout, "up to date: out/manifest.json\n");
    assert_eq!(
        bake(&["--check", "--json"]).json(),
        serde_json::json!({ "stale": [], "materials": [], "packages": {} })
    );
    assert_eq!(
        bake(&["--dry-run", "--json"]).json(),
        serde_json::json!({ "jobs": {}, "is_all": true, "packages": {} })
    );
    let json = bake(&["--json"]).json();
    assert_eq!((&json["up_to_date"], &json["materials"]), (&true.into(), &serde_json::json!(["film"])));
    assert_eq!(bake(&["--quiet"]).stdout, "");
    assert_eq!(std::fs::metadata(workshop.path("out/manifest.json")).unwrap().modified().unwrap(), before);
    // Options, the material, the picture that it names, the files of the bake: a change of each is seen.
    assert!(bake(&["--no-zstd"]).stdout.contains("wrote"));
    assert!(bake(&[]).stdout.contains("wrote"));
    picture(&workshop, "map.png", 101);
    assert!(bake(&[]).stdout.contains("wrote"));
    workshop.edit("film.toml", |text| text + "# a comment\n");
    assert!(bake(&[]).stdout.contains("wrote"));
    assert_eq!(bake(&[]).stdout, "up to date: out/manifest.json\n");
    workshop.write("out/materials.bin", "damaged");
    assert!(bake(&[]).stdout.contains("wrote"));
    std::fs::remove_file(workshop.path("out/tables/film.png")).unwrap();
    assert!(bake(&[]).stdout.contains("wrote"));
    assert!(workshop.path("out/tables/film.png").exists());
}

/// With and without a store: a check compares what a bake would write.
#[test]
fn a_check_lists_what_is_stale_and_writes_nothing() {
    let workshop = Workshop::with(&[("a/lacquer.toml", &lacquer("lacquer")), ("a/gold.toml", &gold("gold"))]);
    let first = workshop.run(&["bake", "a", "--check"]).exits(1).stdout;
    assert!(first.contains("stale: manifest.json") && first.contains("changed: gold"), "{first}");
    assert!(!workshop.path("out").exists());
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    assert_eq!(workshop.run(&["bake", "a", "--check"]).exits(0).stdout, "up to date: out/manifest.json\n");
    let before = workshop.tree("out");
    workshop.edit("a/gold.toml", |text| text.replace("\"au\"", "\"cu\""));
    let stale = workshop.run(&["bake", "a", "--check", "--json"]).exits(1).json();
    assert_eq!(stale["materials"], serde_json::json!(["gold"]));
    let files: Vec<&str> = stale["stale"].as_array().unwrap().iter().map(|path| path.as_str().unwrap()).collect();
    assert!(files.contains(&"tables/fresnel.ktx2") && !files.contains(&"tables/distribution.ktx2"), "{files:?}");
    assert_eq!(workshop.tree("out"), before);
    // Files that a bake would remove are stale, too.
    workshop.write("a/lacquer.toml", matte("lacquer"));
    workshop.write("a/gold.toml", matte("gold"));
    let stale = workshop.run(&["bake", "a", "--check"]).exits(1).stdout;
    assert!(stale.contains("stale: tables/fgd.ktx2"), "{stale}");
    workshop.run(&["bake", "a", "--quiet"]).exits(0);
    workshop.run(&["bake", "a", "--check"]).exits(0);
}

#[test]
fn a_dry_run_counts_jobs() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    let dry = ["bake", "gold.toml", "--dry-run", "--cache", "store"];
    let jobs = workshop.run(&[&dry[..], &["--json"]].concat()).exits(0).json();
    let expected = serde_json::json!({ "facet-grid": 1, "fgd": 1, "fgd-truth": 1, "fresnel": 1, "distribution": 1 });
    assert_eq!(jobs["jobs"], expected, "{jobs}");
    assert!(!workshop.path("out").exists());
    workshop.run(&["bake", "gold.toml", "--cache", "store", "--out", "other", "--quiet"]).exits(0);
    assert_eq!(workshop.run(&dry).exits(0).stdout, "no job would run: the store has all results\n");
    assert!(!workshop.path("out").exists());
}

/// Oracle: the names of the files. Bytes of a bake hold no time, so that the variable changes none.
#[test]
fn dependencies_are_a_rule_of_make() {
    let workshop = Workshop::with(&[("a b/film.toml", &film("film", "{ image = \"map.png\" }"))]);
    picture(&workshop, "a b/map.png", 9);
    for _ in 0..2 {
        workshop.run(&["bake", "a b", "--depfile", "film.d", "--cache", "store", "--quiet"]).exits(0);
        assert_eq!(workshop.text("film.d"), "out/manifest.json: a\\ b/film.toml \\\n  a\\ b/map.png \\\n  a\\ b/.\n");
        std::fs::remove_file(workshop.path("film.d")).unwrap();
    }
    workshop.run(&["bake", "a b", "--relock", "--depfile", "film.d", "--cache", "store", "--quiet"]).exits(0);
    workshop.run(&["bake", "a b", "--depfile", "film.d", "--cache", "store", "--quiet"]).exits(0);
    assert!(workshop.text("film.d").ends_with("a\\ b/luthier.lock \\\n  a\\ b/.\n"), "{}", workshop.text("film.d"));
}

#[test]
fn options_that_do_not_go_together_are_refused() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]).apart();
    for (args, parts) in [
        (&["--check", "--dry-run"][..], &["--check"][..]),
        (&["--check", "--watch"], &["--check"]),
        (&["--shard", "3/2"], &["2/8"]),
        (&["--shard", "0/2"], &["2/8"]),
        (&["--shard", "1/2"], &["--shard", "--cache"]),
        (&["--relock", "--no-search"], &["--relock"]),
    ] {
        workshop.run(&[&["bake", "gold.toml"], args].concat()).fails(2, parts);
    }
    workshop.run(&["merge", "gold.toml"]).fails(2, &["merge", "--cache"]);
    workshop.run(&["merge", "gold.toml", "--watch", "--cache", "store"]).fails(2, &["--watch"]);
}
