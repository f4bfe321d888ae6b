//! `eval --out`: the tables that a bake ships.

use luthier_workshop::material_texts::{fine_lacquer, gold, lacquer};

use crate::workshop::Workshop;

const PAIR: [&str; 5] = ["--wi", "30,0", "--wo", "50,180", "--json"];

fn values(workshop: &Workshop, words: &[&str]) -> Vec<f64> {
    let run = workshop.run(&[&["eval", "a.toml", "--model"][..], words, &PAIR].concat()).exits(0);
    let value = &run.json()["values"][0]["value"];
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// Tables are near exact terms, at a place, too; and they are not these: half floats of a few texels.
#[test]
fn tables_that_ship_are_near_exact_terms() {
    let workshop = Workshop::with(&[("a.toml", &fine_lacquer("a"))]);
    workshop.run(&["bake", "a.toml", "-q", "--target", "wgsl", "--out", "o"]).exits(0);
    for place in [&[][..], &["--alpha-factor", "0.6", "--slab-factor", "0.5", "--base-color", "0.3,0.6,0.1"]] {
        let exact = values(&workshop, &[&["elek"][..], place].concat());
        let shipped = values(&workshop, &[&["elek", "--out", "o"][..], place].concat());
        for (shipped, exact) in shipped.iter().zip(&exact) {
            let apart = (shipped / exact - 1.0).abs();
            assert!(apart < 2e-2 && apart > 1e-9, "{place:?}: {shipped} {exact}");
        }
    }
}

/// Rows of lobes are those of the bake, in half floats; without them `eval` fits anew, and says so where something varies.
#[test]
fn lobes_are_read_where_a_bake_has_them() {
    let text = lacquer("a").replace("\"elek\"", "\"lobes\"");
    let workshop = Workshop::with(&[("a.toml", &text)]);
    workshop.run(&["bake", "a.toml", "-q", "--target", "wgsl", "--out", "o"]).exits(0);
    let (fitted, shipped) = (values(&workshop, &["lobes"]), values(&workshop, &["lobes", "--out", "o"]));
    for (shipped, fitted) in shipped.iter().zip(&fitted) {
        assert!((shipped / fitted - 1.0).abs() < 2e-2 && shipped != fitted, "{shipped} {fitted}");
    }
    let place = ["eval", "a.toml", "--model", "lobes", "--base-color", "0.3,0.6,0.1"];
    let run = workshop.run(&[&place[..], &PAIR].concat()).exits(0);
    assert!(run.stderr.contains("`--out FOLDER` reads the rows that a bake ships"), "{}", run.stderr);
}

#[test]
fn what_a_bake_does_not_have() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a")), ("b.toml", &gold("b"))]);
    workshop.run(&["bake", "b.toml", "--model", "elek", "-q", "--target", "wgsl", "--out", "o"]).exits(0);
    let of = |file, model| [&["eval", file, "--model", model, "--out", "o"][..], &PAIR[..4]].concat();
    workshop.run(&of("a.toml", "elek")).fails(1, &["o: the bake has no material `a`"]);
    workshop.run(&of("b.toml", "phong")).fails(1, &["the bake shades `b` by `elek`, not by `phong`"]);
    workshop.write("b.toml", gold("b").replace("0.5", "0.4"));
    workshop.run(&of("b.toml", "elek")).fails(1, &["b.toml has changed since it was baked", "bake again"]);
    workshop
        .run(&[&["eval", "b.toml", "--model", "elek", "--out", "none"][..], &PAIR[..4]].concat())
        .fails(3, &["none"]);
}
