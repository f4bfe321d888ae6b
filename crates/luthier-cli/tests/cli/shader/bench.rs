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
