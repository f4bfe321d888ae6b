//! Shares of many processes, and the bake that is made of them.

use luthier_workshop::material_texts::{film, gold, lacquer};

use crate::workshop::Workshop;

/// Oracle: a bake of one process without a store. Shares run in any order; one that never ran is made up for.
#[test]
fn shares_together_are_the_bake() {
    let workshop = Workshop::with(&[
        ("a/film.toml", &film("film", "{ noise = { seed = 1, frequency = 4, octaves = 2 } }")),
        ("a/gold.toml", &gold("gold")),
        ("a/lacquer.toml", &lacquer("lacquer")),
    ]);
    workshop.run(&["bake", "a", "--out", "alone", "--no-cache", "--quiet"]).exits(0);
    let mut run = 0;
    for share in ["3/3", "1/3", "2/3"] {
        let share = workshop.run(&["bake", "a", "--shard", share, "--cache", "store", "--json"]).exits(0).json();
        run += share["jobs"].as_u64().unwrap();
        assert!(share["jobs"].as_u64().unwrap() > 0, "{share}");
    }
    assert!(!workshop.path("out").exists());
    let merged = workshop.run(&["merge", "a", "--cache", "store", "--json"]).exits(0).json();
    assert_eq!(merged["seconds"], serde_json::json!({}), "{merged}");
    assert_eq!(workshop.tree("out"), workshop.tree("alone"));
    // Two thirds of it.
    for share in ["1/3", "3/3"] {
        workshop.run(&["bake", "a", "--shard", share, "--cache", "part", "--quiet"]).exits(0);
    }
    let merge = workshop.run(&["merge", "a", "--cache", "part", "--out", "late", "--events", "--quiet"]).exits(0);
    let made = merge.stderr.lines().filter(|line| line.contains("\"finished\"")).count() as u64;
    assert!(0 < made && made < run, "{made} of {run}: {}", merge.stderr);
    assert_eq!(workshop.tree("late"), workshop.tree("alone"));
}
