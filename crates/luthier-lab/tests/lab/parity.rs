//! `parity`.

use luthier_workshop::material_texts::{fine_lacquer, gold, lacquer};
use serde_json::Value;

use crate::workshop::Workshop;

#[test]
fn every_shader_is_compared_with_its_twin() {
    // With all tables of the default size: the statistical models read albedos.
    let lacquer = fine_lacquer("lacquer");
    let lacquer = lacquer.split("\n[bake]").next().unwrap();
    let workshop = Workshop::with(&[("m/lacquer.toml", lacquer), ("gold.toml", &gold("gold"))]);
    let run = workshop.run(&["parity", "m", "--pairs", "60", "--json"]);
    if run.lacks_adapter() {
        return;
    }
    let report: Value = serde_json::from_str(&run.exits(0).stdout).unwrap();
    let rows = report["rows"].as_array().unwrap();
    let of = |model: &str| rows.iter().filter(|row| row["model"] == model).count();
    for model in ["elek", "weidlich-wilkie", "granier-heidrich", "belcour", "yamaguchi", "phong", "microfacet"] {
        assert_eq!(of(model), 2, "{model}: two forms");
    }
    assert_eq!(of("lobes"), 1, "one form");
    for row in rows {
        assert_eq!((&row["pairs"], &row["not_finite"]), (&Value::from(300), &Value::from(0)), "{row}");
        assert!(row["total"]["max"].as_f64().unwrap() > 0.0, "f32 is never exact everywhere: {row}");
    }

    let run = workshop.run(&["parity", "gold.toml", "--model", "phong", "--pairs", "8", "-o", "page.md"]).exits(0);
    assert_eq!(run.stdout, "");
    let page = workshop.text("page.md");
    assert!(page.contains("luthier-lab parity gold.toml --model phong --pairs 8 -o page.md"), "{page}");
    assert!(page.contains("## phong") && !page.contains("## elek"), "{page}");
}

/// Tables of a few texels are far off: their error is no arithmetic's, has no reason that is known, and fails the run.
#[test]
fn coarse_tables_break_their_tolerance() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["parity", "lacquer.toml", "--model", "elek", "--pairs", "60"]);
    if run.lacks_adapter() {
        return;
    }
    let run = run.exits(1);
    assert!(run.stderr.contains("elek, baked, lacquer: 0 not finite; beyond its tolerance: table"), "{}", run.stderr);
    assert!(run.stdout.contains("**not accepted**"), "{}", run.stdout);
}

#[test]
fn what_cannot_be_compared() {
    let workshop = Workshop::with(&[("a.toml", &gold("gold"))]);
    workshop.run(&["parity", "missing.toml"]).fails(3, &["missing.toml"]);
    workshop.run(&["parity", "a.toml", "--model", "no-such-model"]).fails(2, &["no-such-model"]);
}

/// Places of surfaces that vary: every kind that the models of a path and that of films have, within what the page allows.
#[test]
fn shaders_at_places_are_compared_with_their_twins() {
    let workshop = Workshop::with(&[]);
    let models = ["--model", "elek", "--model", "weidlich-wilkie", "--model", "granier-heidrich"];
    let run = workshop.run(&[&["places", "--pairs", "40"][..], &models].concat());
    if run.lacks_adapter() {
        return;
    }
    let page = run.exits(0).stdout;
    for (kind, model) in [
        ("normal map", "granier-heidrich"),
        ("bumps of one interface", "elek"),
        ("patina", "weidlich-wilkie"),
        ("glitter", "elek"),
        ("surface of several materials", "granier-heidrich"),
        ("fluorescent base", "weidlich-wilkie"),
    ] {
        let row = page.lines().find(|line| line.starts_with(&format!("| {kind} |")) && line.contains(model));
        let cells: Vec<&str> = row.unwrap_or_else(|| panic!("{kind}, {model}: no row\n{page}")).split('|').collect();
        let number = |cell: usize| cells[cell].trim().parse::<f64>().unwrap();
        assert!(number(4) <= 2e-5 && number(4) > 0.0, "{kind}, {model}: {cells:?}");
        // A shader that ignored the place would be off by more than the page allows.
        assert!(number(8) > 0.1, "{kind}, {model}: {cells:?}");
    }
    assert!(!page.contains("`belcour` |"), "{page}");
}
