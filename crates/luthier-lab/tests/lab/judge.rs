//! `judge`.

use assert_cmd::cargo::cargo_bin_cmd;
use luthier_workshop::material_texts::matte;

use crate::workshop::Workshop;

/// Lambert's surface, which most models have exactly.
#[test]
fn models_are_judged_on_a_material() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    let args = ["judge", "m.toml", "--samples", "500"];
    let page = workshop.run(&args).exits(0).stdout;
    assert!(page.starts_with("# ") && page.contains("\n    luthier-lab judge m.toml --samples 500\n"), "{page}");
    for part in ["500 paths", "## Albedo error", "## Lobe error", "| m | ", "layered-mc-one-facet"] {
        assert!(page.contains(part), "no {part} in {page}");
    }
    let on_one_thread = cargo_bin_cmd!("luthier-lab")
        .current_dir(workshop.path(""))
        .args(args)
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .unwrap();
    assert_eq!(String::from_utf8(on_one_thread.stdout).unwrap(), page);

    let json = workshop.run(&[&args[..], &["--json"]].concat()).exits(0).json();
    let models = json["materials"][0]["models"].as_array().unwrap();
    let elek = models.iter().find(|model| model["name"] == "elek").unwrap();
    assert_eq!(elek["views"].as_array().unwrap().len(), 12);
    // Lambert's surface, of which every path has the weight of the albedo.
    assert!(elek["albedo"]["error"].as_f64().unwrap() < 1e-3, "{elek}");
    let view = &elek["views"][0];
    assert!((view["albedo_reference"].as_f64().unwrap() - 0.6).abs() < 1e-12, "{view}");
    let (lobe, floor) = (view["lobe"]["error"].as_f64().unwrap(), view["lobe_floor"].as_f64().unwrap());
    assert!(lobe > 0.0 && lobe < 2.0 * floor, "{view}");
}

#[test]
fn models_are_judged_on_materials_only() {
    let workshop = Workshop::with(&[("bad.toml", "schema = 1\n")]);
    workshop.run(&["judge", "bad.toml"]).exits(1).says(&["1 of 1 material files cannot be used"]);
    workshop.run(&["judge", "none.toml"]).fails(3, &["none.toml"]);
    workshop.run(&["judge", "bad.toml", "--samples", "0"]).fails(2, &["0"]);
}
