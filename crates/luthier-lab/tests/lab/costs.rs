//! `papers` and `shapes`: what a driver's compiler says.

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
