//! `papers` and `shapes`: what a driver's compiler says; `throughput`: what a clock says.

use luthier_workshop::material_texts::{gold, lacquer};

use crate::workshop::Workshop;

#[test]
fn the_page_has_the_papers_figures_beside_ours() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["papers", "lacquer.toml", "--family", "gcn5", "-o", "page.md"]);
    if run.lacks_driver() {
        return;
    }
    assert_eq!(run.exits(0).stdout, "");
    let page = workshop.text("page.md");
    for part in [
        "Made by `luthier-lab papers lacquer.toml --family gcn5 -o page.md`, luthier ",
        "| 436 | – | 236 | 104 | 0.54 | 2.27 | 6 % |",
        "| precomputed F and D |",
        "Goal: ",
    ] {
        assert!(page.contains(part), "no `{part}` in\n{page}");
    }
}

#[test]
fn papers_are_about_two_layers() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["papers", "gold.toml"]).fails(1, &["two layers"]);
}

/// Both forms of every model, for the material as it is and without its coat.
#[test]
fn shapes_are_counted_by_model_and_form() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let run = workshop.run(&["shapes", "lacquer.toml"]);
    if run.lacks_driver() {
        return;
    }
    let table: luthier_scene::CostTable = serde_json::from_str(&run.exits(0).stdout).unwrap();
    assert_eq!(table.family, "rdna2");
    assert!(table.driver.contains("Mesa"), "{}", table.driver);
    for model in luthier_manifest::ShadingModel::ALL {
        for form in luthier_manifest::Form::ALL.into_iter().filter(|&form| model.has(form)) {
            assert!(table.rows.iter().any(|row| (row.model, row.form) == (model, form)), "{model}, {form}");
        }
    }
    assert!(table.rows.iter().all(|row| row.cycles > 0), "{table:?}");
}

/// Ten shaders of a material of two layers, each with its time; ratios of the page are those of the numbers.
#[test]
fn shaders_of_the_papers_are_timed() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("gold.toml", &gold("gold"))]);
    let small = ["--evaluations", "65536", "--repeats", "5", "--data", "data.json"];
    let run = workshop.run(&[&["throughput", "lacquer.toml"][..], &small].concat());
    if run.lacks_adapter() {
        return;
    }
    let page = run.exits(0).stdout;
    let data: serde_json::Value = serde_json::from_str(&workshop.text("data.json")).unwrap();
    let rows = data["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 10, "{data}");
    let net = |row: &serde_json::Value| row["net_ns"].as_f64().unwrap();
    for row in rows {
        assert!(row["median_ns"].as_f64().unwrap() > 0.0 && row["harness_ns"].as_f64().unwrap() > 0.0, "{row}");
        let full = rows.iter().find(|r| r["shader"] == "full" && r["constant"] == row["constant"]).unwrap();
        let numbers = if row["constant"] == true { ", constants" } else { "" };
        let line = format!("| {}{numbers} | ", row["shader"].as_str().unwrap());
        let of_full = format!(" | {:.2} | ", net(full) / net(row));
        assert!(page.lines().any(|l| l.starts_with(&line) && l.contains(&of_full)), "no {line}{of_full} in {page}");
    }
    assert!(page.contains("| 348 | – | 757 | 1648 | 2.18 | 4.74 |"), "{page}");
    workshop.run(&["throughput", "gold.toml"]).fails(1, &["two layers"]);
}
