//! `bench`.

use luthier_workshop::material_texts::lacquer;

use crate::workshop::Workshop;

#[test]
fn every_shader_is_timed_against_phong_and_the_full_form() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let few = ["--evaluations", "2000", "--repeats", "3", "--warm-up", "1"];
    let run = workshop.run(&[&["bench", "lacquer.toml", "--model", "elek", "--json"], few.as_slice()].concat());
    if run.lacks_adapter() {
        return;
    }
    let report = run.exits(0).json();
    assert_eq!(report["schema"], 1);
    for name in ["name", "driver", "backend"] {
        assert!(report["adapter"][name].is_string(), "{report:#}");
    }
    assert!(report["adapter"]["software"].is_boolean());
    assert!(report["clock"] == "device" || report["clock"] == "host");
    // Whole workgroups of 64 threads with 16 evaluations each.
    assert_eq!((&report["evaluations"], &report["repeats"]), (&2048.into(), &3.into()));
    let rows = report["rows"].as_array().unwrap();
    let names: Vec<String> =
        rows.iter().map(|r| format!("{} {} {}", r["model"], r["form"], r["closed"]).replace('"', "")).collect();
    assert_eq!(names, ["phong full true", "phong baked true", "elek full true", "elek baked false", "elek baked true"]);
    for row in rows {
        let number = |name: &str| row[name].as_f64().unwrap_or_else(|| panic!("{name} in {row:#}"));
        assert!(number("median_ns") > 0.0 && number("harness_ns") > 0.0 && number("mad_ns") >= 0.0, "{row:#}");
        assert!(number("p10_ns") <= number("median_ns") && number("median_ns") <= number("p90_ns"), "{row:#}");
        assert!((number("net_ns") - (number("median_ns") - number("harness_ns"))).abs() < 1e-9, "{row:#}");
    }
    let ratio = |i: usize, name: &str| rows[i][name].as_f64().unwrap();
    assert_eq!((ratio(0, "of_phong"), ratio(0, "of_full"), ratio(2, "of_full")), (1.0, 1.0, 1.0));
}

/// Costs of the adapter at hand are printed and written, and other verbs read them.
#[test]
fn costs_of_operations_are_fitted_to_the_times() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let args = ["bench", "lacquer.toml", "--no-fit", "--evaluations", "65536", "--repeats", "3", "--fit"];
    let run = workshop.run(&[&args[..], &["here.json"]].concat());
    if run.lacks_adapter() {
        return;
    }
    let said = run.exits(0).stdout;
    for part in ["filtered_reads", "special", "of the shorter of reads", "error on the ", "of counts alone"] {
        assert!(said.contains(part), "no `{part}` in\n{said}");
    }
    let costs = luthier_cost::DeviceCost::parse(&workshop.text("here.json")).unwrap();
    assert_eq!((costs.name.as_str(), costs.unit), ("here", luthier_cost::CostUnit::Picoseconds));
    assert!(!costs.device.is_empty() && !costs.driver.is_empty() && costs.fit.rows > 8, "{costs:?}");
    workshop.run(&["bench", "lacquer.toml", "--json", "--fit"]).exits(2).says(&["name it"]);
    // What the fit says of a shader is what `cost` says of it.
    let args = ["cost", "lacquer.toml", "--model", "elek", "--form", "full", "--costs", "here.json"];
    let report = workshop.run(&[&args[..], &["--json"]].concat()).exits(0).json();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &report["device"]["name"]), (2, &"here".into()));
    for row in rows {
        let counts = luthier_cost::StaticCounts::NAMES.map(|name| row["counts"][name].as_u64().unwrap() as u32);
        let cost = costs.cost(&luthier_cost::StaticCounts::of_values(counts));
        assert!((row["cost"].as_f64().unwrap() - cost).abs() <= 1e-9 * cost, "{row:#}");
        assert_eq!(counts[0], 0, "the form `full` reads no texture: {row:#}");
    }
    let page = workshop.run(&args).exits(0).stdout;
    assert!(page.contains("# What the shaders cost on here") && page.contains("predicted from counts"), "{page}");
}
